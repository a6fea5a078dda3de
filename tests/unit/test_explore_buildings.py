"""What the page shows of a cube of buildings: numbers over the height, and which cubes it refuses."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fdspec import store
from fdspec.cli import main
from fdspec.errors import InvalidInput
from fdspec.explore.building_content import QUANTITIES, BuildingContent
from fdspec.explore.page import served_page, written_page
from fdspec.units import G
from tests.cubes import synthetic_building_cube
from tests.explored import record_numbers

SHAPE = (2, 3, 3, 1, 3)
"""Buildings, factors on stiffness, finite factors on slip forces, intensities, storeys."""


@pytest.fixture
def cube() -> xr.Dataset:
    made = synthetic_building_cube()
    made["status"].values[:] = 0
    return made


def test_numbers_are_the_cubes_in_the_units_of_the_page(cube: xr.Dataset) -> None:
    content = BuildingContent(cube, "b.nc")
    assert content.about["axes"]["slip_scale"] == [0.0, 0.5, 1.0]  # no slider has a place for infinity
    json.dumps(content.about, allow_nan=False)
    found = record_numbers(content.record(1))
    assert set(found) == {one["name"] for one in content.about["quantities"]}
    one = cube.isel(record=1, slip_scale=slice(3))
    for name, values in found.items():
        factor = {"peak_drift": 1e3, "peak_acceleration": 1.0 / G, "peak_storey_shear": 1e-3}.get(name)
        factor = factor or QUANTITIES[name].factor
        wanted = np.abs(one[name].transpose("building", "stiffness_scale", "slip_scale", "storey").values)
        np.testing.assert_allclose(values.reshape(SHAPE)[:, :, :, 0], factor * wanted, rtol=1e-14)


def test_histories_that_did_not_end_well_are_no_numbers(cube: xr.Dataset) -> None:
    cube["status"].values[0, 1, 2, 1] = 2
    found = record_numbers(BuildingContent(cube, "b.nc").record(0))
    for values in found.values():
        missing = np.isnan(values.reshape(SHAPE))
        assert missing[1, 2, 1].all()
        assert missing.sum() == SHAPE[-1]


def test_intensities_have_a_slider(cube: xr.Dataset) -> None:
    one = cube[["peak_drift", "status"]]
    twice = one.assign(peak_drift=2.0 * one["peak_drift"])
    two = xr.concat([one, twice], "intensity", coords="minimal", compat="override")
    two = two.assign_coords(intensity=[1.0, 2.0])
    content = BuildingContent(two, "b.nc")
    assert content.about["axes"]["intensity"] == [1.0, 2.0]
    drift = record_numbers(content.record(0))["peak_drift"].reshape(2, 3, 3, 2, 3)
    np.testing.assert_allclose(drift[:, :, :, 1], 2.0 * drift[:, :, :, 0], rtol=1e-14)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (lambda cube: cube.isel(record=[]), r"b\.nc has no record; there is nothing to show"),
        (lambda cube: cube.isel(slip_scale=[3]), r"b\.nc has no finite slip_scale"),
        (lambda cube: cube[["status", "storey_transitions"]], r"none of the results over the height"),
    ],
)
def test_what_cannot_be_shown_is_refused(cube: xr.Dataset, changed, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        BuildingContent(changed(cube), "b.nc")


def test_the_page_holds_controls_of_buildings_alone(cube: xr.Dataset) -> None:
    page = written_page(BuildingContent(cube, "b.nc"))
    for name in ("building", "slip", "stiffness", "intensity", "quantity"):
        assert f'id="{name}"' in page
    assert 'id="ratio"' not in page
    assert "bestLine" not in page
    assert '"served": true' in served_page(BuildingContent(cube, "b.nc"))


def test_export_writes_it(cube: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    store.save(cube, "b.nc")
    assert main(["export", "b.nc", "--html"]) == 0
    assert 'id="record-2"' in Path("b.html").read_text(encoding="utf-8")
    assert main(["export", "b.nc", "-o", "one.html", "--record", "FMR2"]) == 0
    assert 'id="record-1"' not in Path("one.html").read_text(encoding="utf-8")
