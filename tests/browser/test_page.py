"""What a user does on the page of `fdspec explore`, in a real browser."""

import csv
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Download, Page, Response

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.units import G
from tests.browser.conftest import NARROW, PATIENCE, SETTLED, WIDE, Watched
from tests.explored import PERIOD, PRETENSION, STIFFNESS_RATIO, own_motion, small_cube, unpack

pytestmark = pytest.mark.browser

CARDS = [
    "map-0",
    "surface-0",
    "history-0",
    "over-pretension",
    "best-pretension",
    "all-records",
    "energy-0",
]


def drawn(page: Page, card: str, trace: int = 0) -> dict[str, Any]:
    """Return what a picture was given to draw; missing numbers are None."""
    return json.loads(
        page.evaluate(
            "([card, k]) => JSON.stringify(document.querySelector(`#${card} .plot`).data[k],"
            " (_, v) => ArrayBuffer.isView(v) ? Array.from(v) : v)",
            [card, trace],
        )
    )


def words(page: Page, card: str) -> str:
    return page.locator(f"#{card} figcaption").inner_text().replace("\xa0", " ")


def slice_of(cube: xr.Dataset, record: str, ratio: float, name: str = "peak_acceleration") -> np.ndarray:
    return cube[name].sel(record=record, stiffness_ratio=ratio).transpose("pretension", "period").values


def at_cell(page: Page, card: str, period: float, pretension: float) -> tuple[float, float]:
    """Return the pixel of a point of a picture with axes of period (s) and pretension (kN)."""
    x, y = page.evaluate(
        """([card, x, y]) => {
            const plot = document.querySelector(`#${card} .plot`);
            plot.scrollIntoView({ block: "center" });
            const { xaxis, yaxis } = plot._fullLayout, box = plot.getBoundingClientRect();
            return [box.x + xaxis._offset + xaxis.d2p(x), box.y + yaxis._offset + yaxis.d2p(y)];
        }""",
        [card, period, pretension],
    )
    return x, y


def clicked_history(
    watched: Watched, x: float, y: float, held: float = 0.0
) -> tuple[Response, dict[str, Any]]:
    """Click there, the button held for so many ms; return the server's answer and what it holds."""
    page = watched.page
    with page.expect_response(re.compile(r"/history\?")) as coming:
        page.mouse.move(x - 3, y)
        page.mouse.move(x, y)
        page.mouse.click(x, y, delay=held)
    about, arrays = unpack(coming.value.body())
    watched.settled()
    return coming.value, {**about, **arrays}


def place_of(response: Response) -> dict[str, int]:
    """Return the positions that a history was asked for at."""
    return {name: int(value) for name, value in re.findall(r"(\w+)=(\d+)", response.url)}


def test_it_loads_draws_everything_and_asks_nobody_else(wide: Watched, address: str) -> None:
    page = wide.open(address)
    for card in CARDS:
        assert page.locator(f"#{card} .plot .main-svg").count() > 0, card
    assert page.locator("#surface-0 canvas").count() > 0
    assert page.locator("#status").inner_text() == ""
    assert {url.split("/")[2] for url in wide.requests if url.startswith("http")} == {address.split("/")[2]}
    assert not [url for url in wide.requests if not url.startswith(("http", "data:", "blob:"))]


def test_the_slider_moves_map_and_surface(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    pictures = []
    for ratio, key in ((4.0, ""), (8.0, "ArrowRight"), (1.0, "Home")):
        if key:
            page.locator("#ratio").press(key)
            wide.settled()
        wanted = slice_of(cube, "FSR1", ratio) / G
        for card in ("map-0", "surface-0"):
            assert np.allclose(drawn(page, card)["z"], wanted, rtol=1e-15), (card, ratio)
        assert page.locator("#ratio").get_attribute("aria-valuetext") == f"{ratio:g}"
        assert f"stiffness ratio {ratio:g}" in page.locator("#surface-0 h2").inner_text()
        pictures.append(page.locator("#surface-0 .plot").screenshot())
    assert len(set(pictures)) == 3


@pytest.mark.parametrize(("period", "pretension"), [(0.35, 60.0), (1.2, 210.0)])
def test_a_click_on_the_map_runs_the_history_of_that_cell(
    wide: Watched, address: str, cube: xr.Dataset, period: float, pretension: float
) -> None:
    page = wide.open(address)
    response, history = clicked_history(wide, *at_cell(page, "map-0", period, pretension))
    assert place_of(response) == {
        "record": 0,
        "stiffness_ratio": STIFFNESS_RATIO.index(4.0),
        "pretension": PRETENSION.index(pretension * 1e3),
        "period": PERIOD.index(period),
    }
    cell = cube.sel(record="FSR1", stiffness_ratio=4.0, pretension=pretension * 1e3, period=period)
    peak = cell["peak_acceleration"].item() / G
    assert history["compared"][0]["history"] == pytest.approx(peak, rel=1e-9)
    assert f"{peak:.4g} g" in words(page, "history-0")
    assert "The cube's cell says the same." in words(page, "history-0")
    assert f"pretension {pretension:g} kN" in page.locator("#history-0 h2").inner_text().replace("\xa0", " ")
    floor, brace, friction, acceleration = (drawn(page, "history-0", k)["y"] for k in range(4))
    assert 0.9 * peak < np.abs(acceleration).max() <= peak * (1 + 1e-12)
    assert np.abs(floor).max() == pytest.approx(cell["peak_displacement"].item() * 1e3, rel=0.02)
    assert np.abs(friction).max() <= cell["slip_force"].item() / 1e3 * (1 + 1e-9)
    assert len(brace) == len(floor)
    assert len(drawn(page, "history-0", 5)["x"]) > 10


def test_a_click_on_the_surface_runs_a_history_too(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    box = page.locator("#surface-0 .plot").bounding_box()
    assert box is not None
    x, y = box["x"] + 0.55 * box["width"], box["y"] + 0.5 * box["height"]
    page.mouse.move(x - 8, y)
    page.mouse.move(x, y, steps=4)
    page.wait_for_selector("#surface-0 .hovertext", state="attached")
    response, history = clicked_history(
        wide, x, y, held=600.0
    )  # the surface looks at the button in each of its frames
    place = {name: k for name, k in place_of(response).items() if name != "record"}
    peak = cube["peak_acceleration"].isel(record=0, **place).item() / G
    assert history["compared"][0]["history"] == pytest.approx(peak, rel=1e-9)
    assert f"{peak:.4g} g" in words(page, "history-0")


def test_the_line_of_the_best_pretension(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    wanted = cube["peak_acceleration"].sel(record="FSR1", stiffness_ratio=4.0).idxmin("pretension") / 1e3
    for card, trace in (("map-0", 1), ("surface-0", 1), ("best-pretension", 0)):
        line = drawn(page, card, trace)
        assert line["x"] == PERIOD
        assert line["y"] == wanted.values.tolist(), card
    page.select_option("#index", label="Slip travel")
    wide.settled()
    assert drawn(page, "map-0", 1)["x"] == []
    assert page.locator("#best-pretension").count() == 0
    assert "no best pretension" in words(page, "map-0")
    assert page.locator("#best").is_disabled()


def test_the_best_pretension_is_searched_between_the_cubes(wide: Watched, address: str) -> None:
    page = wide.open(address)
    motion = fdspec.load_record("FSR1")
    best = fdspec.best_pretension(motion, period=PERIOD, stiffness_ratio=4.0).isel(
        record=0, stiffness_ratio=0
    )
    star = drawn(page, "over-pretension", 1)
    here = best.isel(period=PERIOD.index(0.5))
    assert star["x"] == pytest.approx([here["pretension"].item() / 1e3], rel=1e-12)
    assert star["y"] == pytest.approx([here["peak_acceleration"].item() / G], rel=1e-12)
    band = page.evaluate("document.querySelector('#over-pretension .plot').layout.shapes[0]")
    assert band["x0"] == pytest.approx(here["band_start"].item() / 1e3, rel=1e-12)
    assert f"the best is {here['pretension'].item() / 1e3:.4g} kN" in words(page, "over-pretension")
    page.locator("#line").click()
    page.wait_for_function("!document.querySelector('#line').disabled", timeout=PATIENCE)
    wide.settled()
    for card, trace in (("map-0", 1), ("best-pretension", 0)):
        assert drawn(page, card, trace)["y"] == pytest.approx((best["pretension"] / 1e3).values, rel=1e-12)
    assert "searched" in words(page, "map-0")


def test_two_records_share_one_scale_and_both_have_histories(
    wide: Watched, address: str, cube: xr.Dataset
) -> None:
    page = wide.open(address)
    page.select_option("#compare", label="FMR1")
    wide.settled()
    first, second = drawn(page, "map-0"), drawn(page, "map-1")
    assert np.allclose(second["z"], slice_of(cube, "FMR1", 4.0) / G, rtol=1e-15)
    assert (first["zmin"], first["zmax"]) == (second["zmin"], second["zmax"])
    largest = cube["peak_acceleration"].sel(record=["FSR1", "FMR1"]).max().item() / G
    assert first["zmax"] >= largest
    ids = page.evaluate("Array.from(document.querySelectorAll('figure'), (figure) => figure.id)")
    assert ids[:6] == ["map-0", "surface-0", "map-1", "surface-1", "history-0", "history-1"]
    assert "FMR1" in page.locator("#history-1 h2").inner_text()
    curves = page.evaluate(
        "document.querySelector('#over-pretension .plot').data.filter((t) => t.showlegend !== false)"
    )
    assert [(curve["name"], curve["line"]["dash"]) for curve in curves] == [
        ("FSR1", "solid"),
        ("FMR1", "dash"),
    ]
    page.select_option("#compare", label="no other")
    wide.settled()
    assert page.locator("#map-1, #surface-1, #history-1").count() == 0


def test_colours_end_where_nobody_would_choose(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    page.select_option("#index", label="Reduction of acceleration against the bare frame")
    wide.settled()
    peak, bare = (cube[name].sel(record="FSR1") for name in ("peak_acceleration", "elastic_acceleration"))
    reduction = 100 * (1 - peak / bare).sel(stiffness_ratio=4.0).transpose("pretension", "period").values
    assert reduction.min() < -100.0
    assert np.allclose(drawn(page, "map-0")["z"], reduction, rtol=1e-12)
    assert drawn(page, "map-0")["zmin"] == -100.0
    assert "Colours end at -100 %." in words(page, "map-0")
    assert f"{reduction.min():.4g} %" in words(page, "map-0")


def saved(page: Page, card: str, label: str, folder: Path) -> Path:
    with page.expect_download() as coming:
        page.locator(f"#{card} .save button", has_text=label).click()
    found: Download = coming.value
    path = folder / found.suggested_filename
    found.save_as(path)
    return path


def rows_of(path: Path) -> list[dict[str, str]]:
    lines = path.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_pictures_download(wide: Watched, address: str, tmp_path: Path) -> None:
    page = wide.open(address)
    for card in CARDS:
        png = saved(page, card, "PNG", tmp_path).read_bytes()
        assert png.startswith(b"\x89PNG")
        assert (int.from_bytes(png[16:20]), int.from_bytes(png[20:24])) == (2200, 1400)
    svg = saved(page, "map-0", "SVG", tmp_path).read_text(encoding="utf-8")
    assert svg.startswith("<svg")
    assert "FSR1, stiffness ratio 4" in svg
    assert "stand-in for the study" in svg


def test_the_numbers_behind_pictures_download_to_the_bit(
    wide: Watched, address: str, cube: xr.Dataset, tmp_path: Path
) -> None:
    page = wide.open(address)
    path = saved(page, "map-0", "CSV", tmp_path)
    assert path.name == "FSR1-acceleration-SR4-map.csv"
    rows = rows_of(path)
    found = np.array([float(row["acceleration_g"]) for row in rows]).reshape(len(PRETENSION), len(PERIOD))
    assert np.array_equal(found, slice_of(cube, "FSR1", 4.0) * (1.0 / G))
    assert [float(row["period_s"]) for row in rows[: len(PERIOD)]] == PERIOD
    assert "# cube: cube.nc" in path.read_text(encoding="utf-8")
    best = rows_of(saved(page, "best-pretension", "CSV", tmp_path))
    wanted = cube["peak_acceleration"].sel(record="FSR1", stiffness_ratio=4.0).idxmin("pretension") / 1e3
    assert [float(row["FSR1_best_pretension_kN"]) for row in best] == wanted.values.tolist()
    history = rows_of(saved(page, "history-0", "CSV", tmp_path))
    assert [float(row["displacement_mm"]) for row in history] == drawn(page, "history-0", 0)["y"]
    assert [float(row["friction_force_kN"]) for row in history] == drawn(page, "history-0", 2)["y"]
    file = store.open(saved(page, "history-0", "netCDF", tmp_path))
    peak = np.abs(file["displacement"].values).max() * 1e3
    assert peak == pytest.approx(np.abs(drawn(page, "history-0", 0)["y"]).max(), rel=1e-12)


def test_a_record_that_cannot_be_found_is_a_message(wide: Watched, address: str) -> None:
    page = wide.open(address)
    page.select_option("#record", label="mine")
    wide.settled()
    assert "record 'mine' is not in the catalogue" in page.locator("#status").inner_text()
    assert "--record mine=FILE" in page.locator("#status").inner_text()
    assert "Traceback" not in page.content()
    assert page.locator("#history-0").count() == 0
    assert "mine" in page.locator("#map-0 h2").inner_text()
    # The refusal is what the browser itself writes to its console about the answer 422.
    assert [text for text in wide.complaints if "422" not in text] == []
    wide.complaints.clear()
    page.select_option("#record", label="FMR1")
    wide.settled()
    assert page.locator("#status").inner_text() == ""
    assert page.locator("#history-0").count() == 1


def test_everything_is_reached_and_used_by_keys(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    reached = []
    page.locator("body").press("Tab")
    for _ in range(100):
        reached.append(
            page.evaluate("document.activeElement.id || document.activeElement.textContent.trim()")
        )
        if reached[-1] == "Where the numbers come from":
            break
        page.keyboard.press("Tab")
    controls = ["record", "compare", "index", "ratio", "period", "force", "best", "line", "turn"]
    assert [name for name in reached if name in controls] == controls
    assert reached[0] == "Skip to the pictures"
    assert reached.count("PNG") == reached.count("CSV") == len(CARDS)
    page.locator("#period").press("End")
    wide.settled()
    page.locator("#best").press("Enter")
    wide.settled()
    best = fdspec.best_pretension(fdspec.load_record("FSR1"), period=PERIOD[-1], stiffness_ratio=4.0)
    assert f"{best['peak_acceleration'].item() / G:.4g} g" in words(page, "history-0")
    before = page.locator("#surface-0 .plot").screenshot()
    page.locator("#turn").press("PageUp")
    page.wait_for_timeout(500)
    assert page.locator("#surface-0 .plot").screenshot() != before


def test_pictures_have_words_that_follow_them(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    pictures = page.locator("[role=img]")
    assert pictures.count() == len(CARDS)
    told = []
    for k in range(pictures.count()):
        label = pictures.nth(k).get_attribute("aria-label") or ""
        described = page.locator(f"#{pictures.nth(k).get_attribute('aria-describedby')}").inner_text()
        assert "FSR1" in label
        assert len(described) > 20
        told.append((label, described))
    low = slice_of(cube, "FSR1", 4.0).min() / G
    assert f"{low:.4g}" in words(page, "map-0")
    page.locator("#ratio").press("Home")
    wide.settled()
    for k, (label, _) in enumerate(told):
        assert pictures.nth(k).get_attribute("aria-label") != label
    assert f"{slice_of(cube, 'FSR1', 1.0).min() / G:.4g}" in words(page, "map-0")


@pytest.mark.parametrize("size", [WIDE, NARROW], ids=["1440", "390"])
def test_axe_finds_no_violation_and_nothing_sticks_out(
    request: pytest.FixtureRequest, address: str, size: dict[str, int]
) -> None:
    watched: Watched = request.getfixturevalue("wide" if size is WIDE else "narrow")
    page = watched.open(address)
    page.select_option("#compare", label="FMR1")
    watched.settled()
    for summary in page.locator("summary").all():
        summary.click()
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    assert page.evaluate("document.documentElement.scrollWidth") == size["width"]
    boxes = [
        locator.bounding_box() for locator in page.locator("header, figure, #controls, main details").all()
    ]
    for k, one in enumerate(boxes):
        assert one is not None
        assert one["x"] >= 0
        assert one["x"] + one["width"] <= size["width"]
        for other in boxes[:k]:
            assert other is not None
            apart_x = one["x"] >= other["x"] + other["width"] or other["x"] >= one["x"] + one["width"]
            apart_y = one["y"] >= other["y"] + other["height"] or other["y"] >= one["y"] + one["height"]
            assert apart_x or apart_y


def test_a_view_is_kept_in_its_address(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address + VIEW)
    assert np.allclose(drawn(page, "map-0")["z"], slice_of(cube, "FMR1", 8.0, "peak_displacement") * 1e3)
    assert "period 1.2 s, stiffness ratio 8, pretension 210 kN" in page.locator(
        "#history-0 h2"
    ).inner_text().replace("\xa0", " ")
    assert page.locator("#map-1").count() == 1


VIEW = "#record=FMR1&index=displacement&compare=FSR1&stiffness_ratio=8&period=1.2&pretension=210"


def test_a_link_pasted_into_an_open_page_and_the_back_button(wide: Watched, address: str) -> None:
    page = wide.open(address)
    first = page.evaluate("location.hash")
    page.evaluate(f"location.hash = '{VIEW}'")
    page.wait_for_function("document.querySelector('#record').selectedOptions[0].text === 'FMR1'")
    wide.settled()
    assert "FMR1, stiffness ratio 8" in page.locator("#map-0 h2").inner_text()
    assert page.locator("#index").evaluate("(one) => one.selectedOptions[0].text") == "Peak displacement"
    page.go_back()
    page.wait_for_function("document.querySelector('#record').selectedOptions[0].text === 'FSR1'")
    wide.settled()
    assert page.evaluate("location.hash") == first
    page.select_option("#record", label="FMR1")
    wide.settled()
    page.go_back()
    page.wait_for_function("document.querySelector('#record').selectedOptions[0].text === 'FSR1'")
    wide.settled()


def test_a_history_at_any_numbers(wide: Watched, address: str) -> None:
    page = wide.open(address)
    page.locator("#anywhere summary").click()
    typed = {
        "period": 0.43,
        "stiffness_ratio": 5.5,
        "pretension": 77.0,
        "floor_mass": 35.0,
        "damping_ratio": 0.03,
    }
    for name, value in typed.items():
        page.locator(f"#field-{name}").fill(f"{value:g}")
        page.locator(f"#field-{name}").press("Tab")
        wide.settled()
    frame = fdspec.Building.single_storey(0.43, 5.5, 0.5 * 77e3, floor_mass=35e3, damping_ratio=0.03)
    history = fdspec.simulate(frame, fdspec.load_record("FSR1"))
    assert f"{history['peak_acceleration'].item() / G:.4g} g" in words(page, "history-0")
    title = page.locator("#history-0 h2").inner_text().replace("\xa0", " ")
    assert (
        "period 0.43 s, stiffness ratio 5.5, pretension 77 kN, floor mass 35 t, damping ratio 0.03" in title
    )
    assert drawn(page, "map-0", 2)["x"] == [0.43]
    energy = drawn(page, "energy-0")["y"]
    assert energy[-1] == pytest.approx(history["dissipated_energy"].item() / 1e3, rel=1e-9)
    kept = page.evaluate("location.href")
    page.goto("about:blank")
    wide.open(kept)
    assert page.locator("#history-0 h2").inner_text().replace("\xa0", " ") == title
    page.locator("#field-period").evaluate("(one) => one.closest('details').open = true")
    page.locator("#field-period").fill("0")
    page.locator("#field-period").press("Tab")
    wide.settled()
    assert "period must be from 0.01 s to 100 s, got 0" in page.locator("#status").inner_text()
    assert [text for text in wide.complaints if "422" not in text] == []
    wide.complaints.clear()


def test_the_best_that_was_searched_has_its_history(wide: Watched, address: str) -> None:
    page = wide.open(address)
    best = fdspec.best_pretension(fdspec.load_record("FSR1"), period=0.5, stiffness_ratio=4.0)
    page.locator("#best").click()
    wide.settled()
    wide.page.wait_for_function("document.querySelector('#history-0 h2').textContent.includes('kN')")
    assert f"pretension {best['pretension'].item() / 1e3:.4g} kN" in page.locator(
        "#history-0 h2"
    ).inner_text().replace("\xa0", " ")
    assert f"{best['peak_acceleration'].item() / G:.4g} g" in words(page, "history-0")


def test_all_records_at_once(wide: Watched, address: str, cube: xr.Dataset) -> None:
    page = wide.open(address)
    over = cube["peak_acceleration"].sel(stiffness_ratio=4.0, period=0.5) / G
    count = cube.sizes["record"]
    lines = [drawn(page, "all-records", k) for k in range(count + 3)]
    for k in range(count):
        assert lines[k]["y"] == pytest.approx(over.isel(record=k).values, rel=1e-12)
    told = fdspec.measures.ensemble(over)["peak_acceleration"]
    for line, name in zip(lines[count:], ("median", "p84", "worst"), strict=True):
        assert line["y"] == pytest.approx(told.sel(statistic=name).values, rel=1e-12), name


def test_maps_and_surfaces_of_two_records_go_together(wide: Watched, address: str) -> None:
    page = wide.open(address)
    page.select_option("#compare", label="FMR1")
    wide.settled()
    zoom = "{'xaxis.range[0]': 0.3, 'xaxis.range[1]': 0.9}"
    page.evaluate(f"Plotly.relayout(document.querySelector('#map-0 .plot'), {zoom})")
    other = "document.querySelector('#map-1 .plot')._fullLayout.xaxis.range"
    page.wait_for_function(f"Math.abs({other}[1] - 0.9) < 1e-9")
    assert page.evaluate(other) == pytest.approx([0.3, 0.9])
    eye = "{eye: {x: 1, y: 1, z: 1}, up: {x: 0, y: 0, z: 1}, center: {x: 0, y: 0, z: 0}}"
    page.evaluate(f"Plotly.relayout(document.querySelector('#surface-0 .plot'), {{'scene.camera': {eye}}})")
    page.wait_for_function("document.querySelector('#turn').value === '45'")
    assert page.evaluate("document.querySelector('#surface-1 .plot')._fullLayout.scene.camera.eye.x") == 1


def test_turning_the_surface_moves_no_point(wide: Watched, address: str) -> None:
    page = wide.open(address)
    box = page.locator("#surface-0 .plot").bounding_box()
    assert box is not None
    before, asked = page.evaluate("location.hash"), len(wide.requests)
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 80, y, steps=8)
    page.wait_for_timeout(300)
    page.mouse.up()
    page.wait_for_timeout(500)
    wide.settled()
    assert page.evaluate("location.hash") == before
    assert not [url for url in wide.requests[asked:] if "history" in url]


def test_what_a_mark_says_can_be_read(wide: Watched, address: str) -> None:
    page = wide.open(address)
    for dark in (False, True):
        for card in CARDS:
            label = page.evaluate(f"document.querySelector('#{card} .plot').layout.hoverlabel")
            ground = luminance(np.array(channels(label["bgcolor"])))
            letters = luminance(np.array(channels(label["font"]["color"])))
            light, low = max(letters, ground), min(letters, ground)
            assert (light + 0.05) / (low + 0.05) >= 4.5, (card, dark)
        page.locator("#theme").click()
        page.wait_for_timeout(1500)
    units = [drawn(page, "history-0", k)["hovertemplate"] for k in range(6)]
    assert all(any(f" {unit}" in text for unit in ("mm", "kN", "g")) for text in units)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1440, 2560])
def test_the_layout_at_three_widths_light_and_dark(
    browser: Browser, address: str, width: int, scheme: str
) -> None:
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)  # type: ignore[arg-type]
    context.set_default_timeout(PATIENCE)
    page = context.new_page()
    page.goto(address)
    page.wait_for_function(SETTLED, timeout=PATIENCE)
    page.locator("#help summary").click()
    page.locator("#anywhere summary").click()
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    assert page.evaluate("document.documentElement.scrollWidth") == width
    boxes = [locator.bounding_box() for locator in page.locator("figure, #controls, header").all()]
    right = max(box["x"] + box["width"] for box in boxes if box)
    assert width - 40 <= right <= width  # nothing sticks out, and nothing stays empty
    ends: dict[float, float] = {}
    for figure in page.locator("main figure").all():
        box = figure.bounding_box()
        assert box is not None
        ends[box["y"]] = max(ends.get(box["y"], 0.0), box["x"] + box["width"])
    if width != 1440:  # there two stand in a row, and the last of an odd number alone
        assert min(ends.values()) >= width - 40
    slider, surface = page.locator("#turn").bounding_box(), page.locator("#surface-0").bounding_box()
    assert slider is not None
    assert surface is not None
    assert surface["y"] < slider["y"] < surface["y"] + surface["height"]
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    context.close()


def test_pictures_fill_their_cards_when_others_come_and_go(wide: Watched, address: str) -> None:
    page = wide.open(address)
    page.set_viewport_size({"width": 2560, "height": 1200})
    for other in ("FMR1", "no other"):
        page.select_option("#compare", label=other)
        wide.settled()
        widths = page.evaluate(
            "[...document.querySelectorAll('#curves .plot')]"
            ".map((plot) => [plot.clientWidth, plot.querySelector('.main-svg').clientWidth])"
        )
        assert len(widths) == (5 if other == "FMR1" else 4)
        for card, picture in widths:
            assert picture == pytest.approx(card, abs=1)


def test_the_page_prints_whole_on_a4(wide: Watched, address: str, tmp_path: Path) -> None:
    page = wide.open(address)
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 690, "height": 1000})
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.wait_for_timeout(1000)
    for card in CARDS:
        box = (
            page.locator(f"#{card} .main-svg").first.bounding_box()
            if not card.startswith("surface")
            else None
        )
        if box is not None:
            assert box["x"] + box["width"] <= 690, card
    assert page.locator("#controls").is_hidden()


def test_the_file_needs_no_server(wide: Watched, folder: Path, cube: xr.Dataset, tmp_path: Path) -> None:
    page = wide.open((folder / "cube.html").as_uri())
    assert {url.split(":")[0] for url in wide.requests} <= {"file", "data", "blob"}
    assert sum(url.startswith("file:") for url in wide.requests) == 1
    page.locator("#ratio").press("Home")
    wide.settled()
    assert np.allclose(drawn(page, "surface-0")["z"], slice_of(cube, "FSR1", 1.0) / G, rtol=1e-15)
    page.select_option("#record", label="mine")
    wide.settled()
    assert np.allclose(drawn(page, "map-0")["z"], slice_of(cube, "mine", 1.0) / G, rtol=1e-15)
    page.mouse.click(*at_cell(page, "map-0", 0.8, 110.0))
    wide.settled()
    assert "fdspec explore cube.nc" in page.locator("#histories").inner_text()
    page.locator("#cell summary").click()
    cell = cube.sel(record="mine", stiffness_ratio=1.0, period=0.8, pretension=110e3)
    assert f"{cell['peak_acceleration'].item() / G:.4g} g" in page.locator("#cell").inner_text().replace(
        "\xa0", " "
    )
    rows = rows_of(saved(page, "map-0", "CSV", tmp_path))
    assert len(rows) == len(PERIOD) * len(PRETENSION)
    assert saved(page, "surface-0", "PNG", tmp_path).read_bytes().startswith(b"\x89PNG")


def test_names_from_files_are_text_and_no_markup(wide: Watched, tmp_path: Path) -> None:
    evil = "<img src=x onerror=alert(1)> <b>& 'q\" %{y}"
    made = small_cube(own_motion(evil), own_motion("</script><script>document.title = 'gone'</script>"))
    store.save(made, tmp_path / "cube.nc")
    assert main(["export", str(tmp_path / "cube.nc"), "-o", str(tmp_path / "cube.html")]) == 0
    page = wide.open((tmp_path / "cube.html").as_uri())
    page.select_option("#compare", index=2)
    wide.settled()
    assert page.title() == "cube.nc - fdspec explore"
    assert page.locator("img:not(#sketch)").count() == 0
    assert evil in page.locator("#map-0 h2").inner_text()
    assert evil in (page.locator("#best-pretension .legend").text_content() or "")
    name = saved(page, "map-0", "CSV", tmp_path).name
    assert re.fullmatch(r"[\w.-]+", name)


def test_colours_are_even_and_told_apart_by_colour_blind_eyes(wide: Watched, address: str) -> None:
    page = wide.open(address)
    page.select_option("#compare", label="FMR1")
    wide.settled()
    stops = page.evaluate("document.querySelector('#map-0 .plot')._fullData[0].colorscale")
    places = np.array([place for place, _ in stops])
    assert (places[0], places[-1]) == (0.0, 1.0)
    for sight in SIGHTS:
        scale = lab(np.array([channels(colour) for _, colour in stops]), sight)
        rise = np.diff(scale[:, 0]) / np.diff(places)
        # Lighter all the way, nowhere half or twice as fast as on the whole: it reads without any colour.
        assert (rise > 0.5 * rise.mean()).all(), sight
        assert (rise < 2.0 * rise.mean()).all(), sight
    together = [("best-pretension", 0, 2), ("history-0", 0, 1), ("history-0", 3, 4)]  # on the same axes
    for card, one, other in together:
        pair = np.array([channels(drawn(page, card, k)["line"]["color"]) for k in (one, other)])
        for sight in SIGHTS:
            assert np.linalg.norm(np.subtract(*lab(pair, sight))) > 30.0, (card, sight)
        for colour in pair:  # WCAG 2.2, 1.4.11: graphics on white
            assert 1.05 / (luminance(colour) + 0.05) >= 3.0, (card, colour)


SIGHTS = {
    "usual": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
"""Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB."""


def channels(colour: str) -> list[float]:
    """Return red, green and blue from 0 to 1 of #rrggbb or rgb(r, g, b)."""
    if colour.startswith("#"):
        return [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    return [float(part) / 255 for part in re.findall(r"[\d.]+", colour)[:3]]


def linear_of(srgb: np.ndarray) -> np.ndarray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def luminance(srgb: np.ndarray) -> float:
    """Return WCAG's relative luminance of a colour (3,)."""
    return float(linear_of(srgb) @ [0.2126, 0.7152, 0.0722])


def lab(srgb: np.ndarray, sight: str) -> np.ndarray:
    """Return CIELAB (D65) of sRGB colours (n, 3) as such eyes see them."""
    linear = np.clip(linear_of(srgb) @ SIGHTS[sight].T, 0.0, 1.0)
    to_xyz = np.array(
        [
            [0.4124564, 0.3575761, 0.1804375],
            [0.2126729, 0.7151522, 0.0721750],
            [0.0193339, 0.1191920, 0.9503041],
        ]
    )
    x, y, z = (linear @ to_xyz.T / [0.95047, 1.0, 1.08883]).T
    fx, fy, fz = (np.where(v > 0.008856, np.cbrt(v), 7.787 * v + 16 / 116) for v in (x, y, z))
    return np.column_stack([116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)])
