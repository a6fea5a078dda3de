"""Two cubes beside each other: linked controls, one scale of colours, histories of each cube's own frames."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec import store
from fdspec.units import G
from tests.browser.conftest import Watched, served
from tests.browser.test_page import drawn, slice_of, words
from tests.explored import small_cube, unpack

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def heavy() -> xr.Dataset:
    """Give the cube of FSR1 and FMR1 with ten times the brace mass and less damping."""
    return small_cube(brace_mass=500.0, damping_ratio=0.02)


@pytest.fixture(scope="module")
def both(folder: Path, heavy: xr.Dataset, address: str) -> Iterator[str]:
    """Serve the cube with the heavy one beside it; `address` has made the kernels."""
    store.save(heavy, folder / "heavy.nc")
    with served(folder, "cube.nc", "heavy.nc") as found:
        yield found


def test_maps_of_both_cubes_share_controls_and_colours(
    wide: Watched, both: str, cube: xr.Dataset, heavy: xr.Dataset
) -> None:
    page = wide.open(both)
    assert "brace mass 50" in page.locator("#frame").inner_text().replace("\xa0", " ")
    assert "heavy.nc: floor mass 20 t, brace mass 500" in page.locator("#frame").inner_text().replace(
        "\xa0", " "
    )
    for ratio, key in ((4.0, ""), (8.0, "ArrowRight")):
        if key:
            page.locator("#ratio").press(key)
            wide.settled()
        maps = [drawn(page, f"map-{n}") for n in (0, 1)]
        for shown, of in zip(maps, (cube, heavy), strict=True):
            np.testing.assert_allclose(shown["z"], slice_of(of, "FSR1", ratio) / G, rtol=1e-14)
        assert [maps[0][end] for end in ("zmin", "zmax")] == [maps[1][end] for end in ("zmin", "zmax")]
    page.select_option("#record", label="FMR1 (cube.nc)")
    wide.settled()
    assert "FMR1 (heavy.nc)" in page.locator("#map-1 h2").inner_text()
    np.testing.assert_allclose(
        drawn(page, "map-1")["z"], slice_of(heavy, "FMR1", 8.0) / G, rtol=1e-14
    )  # the same earthquake in the other cube
    assert "all 3 records, from FSR1 (cube.nc)" in page.locator("#all-records h2").inner_text()


def test_each_history_is_of_its_own_cubes_frame(
    wide: Watched, both: str, cube: xr.Dataset, heavy: xr.Dataset
) -> None:
    page = wide.open(f"{both}#stiffness_ratio=4&period=0.5&pretension=60")
    for n, of in ((0, cube), (1, heavy)):
        peak = of["peak_acceleration"].sel(record="FSR1", stiffness_ratio=4.0, period=0.5, pretension=60e3)
        assert f"{peak.item() / G:.4g} g" in words(page, f"history-{n}")
        assert "The cube's cell says the same." in words(page, f"history-{n}")
    page.evaluate("document.getElementById('anywhere').open = true")
    motion = fdspec.load_record("FSR1")
    page.fill("#field-period", "0.55")
    page.press("#field-period", "Enter")
    wide.settled()
    for n, mass, damping in ((0, 50.0, 0.05), (1, 500.0, 0.02)):
        frame = fdspec.Building.single_storey(
            period=0.55,
            stiffness_ratio=4.0,
            slip_force=30e3,
            brace_mass=mass,
            damping_ratio=damping,
        )
        peak = fdspec.simulate(frame, motion)["peak_acceleration"].item()
        assert f"{peak / G:.4g} g" in words(page, f"history-{n}")
    # What is typed of the frame holds for both.
    with page.expect_response(re.compile(r"/point\?record=3")) as coming:
        page.fill("#field-brace_mass", "200")
        page.press("#field-brace_mass", "Enter")
    assert "brace_mass=200&damping_ratio=0.02" in coming.value.url
    assert unpack(coming.value.body())[0]["record"] == "FSR1"
    wide.settled()
    link = page.url
    page.goto("about:blank")
    wide.open(link)
    assert page.url == link
    assert page.locator("#field-brace_mass").input_value() == "200"


def test_no_other_is_kept_in_the_address(wide: Watched, both: str) -> None:
    page = wide.open(both)
    assert page.locator("#map-1").count() == 1
    page.select_option("#compare", label="no other")
    wide.settled()
    assert page.locator("#map-1").count() == 0
    assert "compare=none" in page.url
    page.reload()
    wide.settled()
    assert page.locator("#map-1").count() == 0
