"""The page of a cube of buildings: profiles over the height, and the factors that change them."""

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.units import G
from tests.browser.conftest import PATIENCE, SETTLED, Watched, served
from tests.browser.test_page import drawn, words
from tests.explored import own_motion

pytestmark = pytest.mark.browser

NAMES = ("weak", "strong")


@pytest.fixture(scope="module")
def buildings() -> xr.Dataset:
    """Sweep two buildings of three storeys under three motions."""
    made = {
        name: fdspec.Building(
            floor_mass=[30e3] * 3,
            storey_stiffness=[factor * 40e6, factor * 30e6, factor * 20e6],
            brace_mass=[100.0] * 3,
            brace_stiffness=[60e6] * 3,
            slip_force=[80e3, 60e3, 40e3],
            storey_height=3.2,
        )
        for name, factor in zip(NAMES, (1.0, 2.0), strict=True)
    }
    motions = [fdspec.load_record("FSR1"), fdspec.load_record("FMR1"), own_motion("mine")]
    return fdspec.sweep_buildings(motions, made, slip_scale=[0.5, 1.0, 2.0], stiffness_scale=[0.5, 1.0])


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory, buildings: xr.Dataset) -> Path:
    folder = tmp_path_factory.mktemp("buildings")
    store.save(buildings, folder / "b.nc")
    assert main(["export", str(folder / "b.nc"), "-o", str(folder / "b.html")]) == 0
    return folder


@pytest.fixture(scope="module")
def of_buildings(place: Path) -> Iterator[str]:
    """Serve the cube."""
    with served(place, "b.nc") as found:
        yield found


def profile(cube: xr.Dataset, name: str, building: str, slip: float, stiffness: float) -> np.ndarray:
    """Return a quantity over (record, storey)."""
    one = cube[name].sel(building=building, slip_scale=slip, stiffness_scale=stiffness)
    return np.abs(one.transpose("record", "storey").values)


def test_profiles_are_the_cubes_and_their_statistics(
    wide: Watched, of_buildings: str, buildings: xr.Dataset
) -> None:
    page = wide.open(of_buildings)
    for name, factor, height in (
        ("peak_drift", 1e3, [0.5, 1.5, 2.5]),
        ("peak_acceleration", 1.0 / G, [1, 2, 3]),
        ("peak_storey_shear", 1e-3, [0.5, 1.5, 2.5]),
    ):
        each = factor * profile(buildings, name, "weak", 1.0, 1.0)
        card = f"profile-{name}"
        for k in range(3):
            np.testing.assert_allclose(drawn(page, card, k)["x"], each[k], rtol=1e-13)
            assert drawn(page, card, k)["y"] == height
        for k, share in ((3, 0.16), (4, 0.84), (5, 0.5)):
            np.testing.assert_allclose(
                drawn(page, card, k)["x"], np.quantile(each, share, axis=0), rtol=1e-12
            )
        assert drawn(page, card, 4)["fill"] == "tonextx"
        medians = np.median(each, axis=0)
        assert f"largest in storey {medians.argmax() + 1}: {medians.max():.4g}" in words(page, card)
    assert len({url.split("/")[2] for url in wide.requests if url.startswith("http")}) == 1


def test_sliders_building_record_and_units(
    wide: Watched, of_buildings: str, buildings: xr.Dataset, tmp_path: Path
) -> None:
    page = wide.open(of_buildings)
    page.select_option("#building", label="strong")
    page.locator("#slip").press("ArrowRight")
    page.locator("#stiffness").press("Home")
    page.select_option("#record", label="FMR1")
    page.evaluate("document.getElementById('units').open = true")
    page.select_option("#unit-length", "m")
    wide.settled()
    each = profile(buildings, "peak_drift", "strong", 2.0, 0.5)
    np.testing.assert_allclose(drawn(page, "profile-peak_drift", 0)["x"], each[0], rtol=1e-13)
    chosen = drawn(page, "profile-peak_drift", 6)
    assert chosen["name"] == "FMR1"
    np.testing.assert_allclose(chosen["x"], each[1], rtol=1e-13)
    assert (
        "Peak drift, m: strong, brace stiffness times 0.5, slip forces times 2"
        in page.locator("#profile-peak_drift h2").inner_text()
    )
    link = page.url
    assert "building=strong" in link
    assert "stiffness_scale=0.5&slip_scale=2&length=m" in link
    page.goto("about:blank")
    wide.open(link)
    np.testing.assert_allclose(drawn(page, "profile-peak_drift", 6)["x"], each[1], rtol=1e-13)
    with page.expect_download() as coming:
        page.locator("#profile-peak_drift .save button", has_text="CSV").click()
    coming.value.save_as(tmp_path / "drift.csv")
    lines = [line for line in (tmp_path / "drift.csv").read_text().splitlines() if line[0] != "#"]
    rows = list(csv.DictReader(lines))
    assert [float(row["mine_peak_drift_m"]) for row in rows] == pytest.approx(each[2].tolist(), rel=1e-13)
    assert [float(row["median"]) for row in rows] == pytest.approx(np.median(each, axis=0).tolist())


def test_the_worst_storey_over_the_slip_forces(
    wide: Watched, of_buildings: str, buildings: xr.Dataset
) -> None:
    page = wide.open(f"{of_buildings}#quantity=peak_acceleration")
    worst = np.stack(
        [profile(buildings, "peak_acceleration", "weak", slip, 1.0).max(axis=1) for slip in (0.5, 1.0, 2.0)]
    )
    for k in range(3):
        np.testing.assert_allclose(drawn(page, "over-slip", k)["y"], worst[:, k] / G, rtol=1e-13)
    np.testing.assert_allclose(drawn(page, "over-slip", 3)["y"], np.median(worst, axis=1) / G, rtol=1e-13)
    assert drawn(page, "over-slip", 3)["name"] == "median"
    x, y = page.evaluate(
        """() => {
            const plot = document.querySelector("#over-slip .plot");
            plot.scrollIntoView({ block: "center" });
            const { xaxis, yaxis } = plot._fullLayout, box = plot.getBoundingClientRect();
            const across = xaxis._offset + xaxis.d2p(2), down = yaxis._offset + yaxis.d2p(plot.data[3].y[2]);
            return [box.x + across, box.y + down];
        }"""
    )
    page.mouse.move(x - 3, y)
    page.mouse.move(x, y)
    page.mouse.click(x, y)
    wide.page.wait_for_function("document.getElementById('slip-value').textContent === '2'", timeout=PATIENCE)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [390, 1440, 2560])
def test_the_layout_at_three_widths_light_and_dark(
    browser: Browser, place: Path, width: int, scheme: str
) -> None:
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)  # type: ignore[arg-type]
    page = context.new_page()
    page.goto((place / "b.html").as_uri())
    page.wait_for_function(SETTLED, timeout=PATIENCE)
    for summary in page.locator("details > summary").all():
        summary.click()
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    assert page.evaluate("document.documentElement.scrollWidth") == width
    boxes = [locator.bounding_box() for locator in page.locator("figure, #controls, header").all()]
    assert width - 40 <= max(box["x"] + box["width"] for box in boxes if box) <= width
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    context.close()


def test_no_line_runs_from_one_frame_into_the_next(wide: Watched, tmp_path: Path) -> None:
    """Two storeys beside three, joined by a link: of each statistic a line for either frame."""
    low = fdspec.Building(30e3, [40e6, 30e6], 100.0, 60e6, 60e3)
    high = fdspec.Building(30e3, [30e6] * 3, 100.0, 60e6, 40e3)
    joined = fdspec.side_by_side(low, high, links=[fdspec.Link(2, 4, 50e6, 30e3)])
    motions = [fdspec.load_record("FSR1"), fdspec.load_record("FMR1")]
    cube = fdspec.sweep_buildings(motions, {"joined": joined}, slip_scale=[1.0], stiffness_scale=[1.0])
    store.save(cube, tmp_path / "joined.nc")
    each = 1e3 * profile(cube, "peak_drift", "joined", 1.0, 1.0)
    card = "profile-peak_drift"
    with served(tmp_path, "joined.nc") as at:
        page = wide.open(at)
        page.select_option("#record", label="FMR1")
        wide.settled()
        lines = [drawn(page, card, k) for k in range(12)]
        legend = page.locator(f"#{card} .legend .traces").count()
    frames = [slice(0, 2), slice(2, 5)]
    for k, frame in enumerate(frames):
        for record in range(2):
            np.testing.assert_allclose(lines[2 * k + record]["x"], each[record, frame], rtol=1e-13)
        low_line, high_line, median, chosen = lines[4 + 4 * k : 8 + 4 * k]
        assert high_line["fill"] == "tonextx"
        for line, share in ((low_line, 0.16), (high_line, 0.84), (median, 0.5)):
            np.testing.assert_allclose(line["x"], np.quantile(each[:, frame], share, axis=0), rtol=1e-12)
        np.testing.assert_allclose(chosen["x"], each[1, frame], rtol=1e-13)
        assert median["y"] == [[0.5, 1.5], [2.5, 3.5, 4.5]][k]
    assert legend == 3
