"""Units of the page: one set of numbers, shown as the reader wants it; and colours that part at zero."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fdspec.units import G
from tests.browser.conftest import Watched
from tests.browser.test_page import drawn, slice_of, words
from tests.explored import PRETENSION, unpack

pytestmark = pytest.mark.browser

UNITS = {
    "acceleration": {"g": G, "m/s²": 1.0, "%\u00a0g": 0.01 * G},
    "force": {"kN": 1e3, "MN": 1e6, "N": 1.0},
}


def choose(watched: Watched, kind: str, unit: str) -> None:
    watched.page.evaluate("document.getElementById('units').open = true")
    watched.page.focus(f"#unit-{kind}")
    watched.page.select_option(f"#unit-{kind}", unit)
    watched.settled()


@pytest.mark.parametrize(
    ("acceleration", "force", "length"), [("m/s²", "MN", "m"), ("%\u00a0g", "N", "mm"), ("g", "kN", "m")]
)
def test_every_number_follows_the_units(
    wide: Watched, address: str, cube: xr.Dataset, acceleration: str, force: str, length: str, tmp_path: Path
) -> None:
    page = wide.open(address)
    for kind, unit in (("acceleration", acceleration), ("force", force), ("length", length)):
        choose(wide, kind, unit)
    wanted = slice_of(cube, "FSR1", 4.0)
    of_force = UNITS["force"][force]
    for card in ("map-0", "surface-0"):
        shown = drawn(page, card)
        np.testing.assert_allclose(shown["z"], wanted / UNITS["acceleration"][acceleration], rtol=1e-12)
        np.testing.assert_allclose(shown["y"], np.array(PRETENSION) / of_force, rtol=1e-14)
        assert f"y}} {force}" in shown["hovertemplate"]
    for card in ("map-0", "over-pretension", "all-records", "history-0"):
        assert acceleration in page.locator(f"#{card} .plot").text_content(), card
    for card in ("map-0", "over-pretension", "best-pretension", "history-0"):
        assert re.search(rf"(pretension,|friction,) ?{force}", page.locator(f"#{card} .plot").text_content())
    assert f"{length}." in words(page, "history-0")
    # The curve's mark, the history's slip force and the searched star stand in one unit.
    slip_force = max(np.abs(drawn(page, "history-0", 2)["y"]))
    at = page.locator("#over-pretension .plot").evaluate("plot => plot.layout.shapes.at(-1).x0")
    assert slip_force == pytest.approx(0.5 * at, rel=1e-6)
    with page.expect_download() as coming:
        page.locator("#map-0 .save button", has_text="CSV").click()
    coming.value.save_as(tmp_path / "map.csv")
    lines = [line for line in (tmp_path / "map.csv").read_text().splitlines() if not line.startswith("#")]
    row = next(csv.DictReader(lines))
    spelt = {"m/s²": "m_per_s2", "%\u00a0g": "percent_g", "g": "g"}[acceleration]
    assert float(row[f"pretension_{force}"]) == pytest.approx(PRETENSION[0] / of_force)
    assert float(row[f"acceleration_{spelt}"]) == pytest.approx(
        wanted[0, 0] / UNITS["acceleration"][acceleration]
    )


def test_units_are_kept_in_the_address_and_the_point_stays(wide: Watched, address: str) -> None:
    page = wide.open(f"{address}#record=FSR1&stiffness_ratio=4&period=0.5&pretension=110&index=acceleration")
    choose(wide, "force", "MN")
    choose(wide, "acceleration", "m/s²")
    assert "pretension=110&acceleration=m%2Fs2&force=MN" in page.url
    assert page.locator("#force-value").inner_text().replace("\xa0", " ") == "0.11 MN"
    link = page.url
    page.goto("about:blank")
    wide.open(link)
    assert page.locator("#unit-force").input_value() == "MN"
    assert "pretension 0.11 MN" in page.locator("#history-0 h2").inner_text().replace("\xa0", " ")
    page.go_back()
    wide.open(link.replace("&acceleration=m%2Fs2&force=MN", ""))
    assert page.locator("#unit-force").input_value() == "kN"
    assert "pretension 110 kN" in page.locator("#history-0 h2").inner_text().replace("\xa0", " ")


def test_a_number_that_is_typed_is_in_the_units_shown(wide: Watched, address: str) -> None:
    page = wide.open(f"{address}#force=MN")
    page.evaluate("document.getElementById('anywhere').open = true")
    assert page.locator("#label-pretension").inner_text() == "Pretension, MN"
    with page.expect_response(re.compile(r"/point\?")) as coming:
        page.fill("#field-pretension", "0.0905")
        page.press("#field-pretension", "Enter")
    assert "pretension=90.5&" in coming.value.url + "&"
    about, _ = unpack(coming.value.body())
    assert about["slip_force"] == pytest.approx(0.5 * 90.5)
    wide.settled()
    assert "pretension 0.0905 MN" in page.locator("#history-0 h2").inner_text().replace("\xa0", " ")
    choose(wide, "force", "N")
    assert page.locator("#field-pretension").input_value() == "90500"


@pytest.mark.parametrize("index", ["reduction_to_bare", "displacement_index"])
def test_colours_part_where_the_damper_neither_helps_nor_harms(
    wide: Watched, address: str, index: str
) -> None:
    page = wide.open(f"{address}#index={index}&stiffness_ratio=4")
    neutral, help_side = {"reduction_to_bare": (0.0, "zmax"), "displacement_index": (1.0, "zmin")}[index]
    shown = drawn(page, "map-0")
    assert 0.5 * (shown["zmin"] + shown["zmax"]) == pytest.approx(neutral, abs=1e-12)
    low, high = shown["colorscale"][0][1], shown["colorscale"][-1][1]
    assert (high if help_side == "zmax" else low) == "#053061"  # blue
    assert (low if help_side == "zmax" else high) == "#67001f"  # red
    assert shown["colorscale"][5] == [0.5, "#f7f7f7"]
    line = drawn(page, "map-0", 1)
    assert line["name"] == "neutral"
    assert line["contours"]["start"] == line["contours"]["end"] == neutral
    assert line["contours"]["coloring"] == "none"
    assert f"<b>{neutral:g}</b>" in shown["colorbar"]["ticktext"]
    # The line is on the screen, where the values pass it.
    assert page.locator("#map-0 .contourlayer .contourlevel path").count() > 0
    levels = page.locator("#over-pretension .plot").evaluate("p => p.layout.shapes.map((s) => s.y0)")
    assert neutral in levels
    assert "neither helps nor harms" in words(page, "map-0")
    surface = drawn(page, "surface-0")
    assert (surface["cmin"], surface["cmax"]) == (shown["zmin"], shown["zmax"])
    assert surface["colorscale"] == shown["colorscale"]


def test_an_index_without_a_sign_keeps_the_even_colours(wide: Watched, address: str) -> None:
    page = wide.open(address)
    assert drawn(page, "map-0")["colorscale"] == "Viridis"
    assert drawn(page, "map-0", 1)["type"] == "scatter"


OVERLAPS = """() => [...document.querySelectorAll(".plot")].flatMap((plot) => {
    const box = (one) => one.getBoundingClientRect();
    const ticks = [..."ytick y2tick y3tick y4tick".split(" ")]
        .flatMap((name) => [...plot.querySelectorAll(`.${name} text`)].map(box));
    const apart = (a, b) => a.right - 1 <= b.left || b.right - 1 <= a.left
        || a.bottom - 1 <= b.top || b.bottom - 1 <= a.top;
    return [...plot.querySelectorAll(".infolayer [class*=title]")]
        .filter((title) => box(title).width && ticks.some((tick) => !apart(box(title), tick)))
        .map((title) => `${plot.parentElement.id}: ${title.textContent}`);
})"""
"""Names of axes that stand over numbers of the axes."""


@pytest.mark.parametrize("size", ["wide", "narrow"])
def test_long_numbers_leave_the_names_of_axes_alone(
    request: pytest.FixtureRequest, address: str, size: str
) -> None:
    watched = request.getfixturevalue(size)
    page = watched.open(f"{address}#force=N&length=m&acceleration=%25g&index=reduction_to_bare")
    assert page.evaluate(OVERLAPS) == []
    assert page.locator("#force-value").inner_text() == "110\u202f000\xa0N"


@pytest.mark.parametrize("force", ["kN", "N"])
def test_surface_and_map_carry_the_same_numbers(wide: Watched, address: str, force: str) -> None:
    page = wide.open(f"{address}#force={force}")
    told = """([card, of]) => {
        const layout = document.querySelector(`#${card} .plot`)._fullLayout;
        const scene = of ? layout[of]._scene.fullSceneLayout : layout;
        return [scene.xaxis, scene.yaxis].map((one) => ({
            step: one.dtick, first: one.tick0, range: one.range,
            form: [one.exponentformat, one.separatethousands],
        }));
    }"""
    on_map = page.evaluate(told, ["map-0", ""])
    in_space = page.evaluate(told, ["surface-0", "scene"])
    for one, other in zip(in_space, on_map, strict=True):
        assert one == {**other, "range": pytest.approx(other["range"])}
    assert on_map[1]["form"] == ["none", True]
