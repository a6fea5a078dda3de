"""What the page shows of a cube: indices, best pretensions, words; and which cubes it refuses."""

import json

import numpy as np
import pytest
import xarray as xr

from fdspec.errors import InvalidInput
from fdspec.explore.content import Content, embedded
from fdspec.explore.indices import INDICES
from fdspec.explore.packing import pack
from fdspec.runs.sweep import ON_REQUEST, OUTPUTS
from fdspec.units import G
from tests.cubes import synthetic_building_cube, synthetic_cube, synthetic_history
from tests.explored import PRETENSION, record_numbers, small_cube, unpack

SHAPE = (3, 5, 6)


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return small_cube()


def test_packing_there_and_back_to_the_bit() -> None:
    random = np.random.default_rng(1)
    arrays = {"a": random.normal(size=(3, 4)), "b ü": np.array([np.nan, np.inf, -0.0]), "none": np.empty(0)}
    for text in ("", "x", "xy", "xyz", "ünïcode"):
        packed = pack({"text": text}, arrays)
        assert (4 + int.from_bytes(packed[:4], "little")) % 8 == 0
        about, found = unpack(packed)
        assert about == {"text": text}
        assert {name: values.tobytes() for name, values in found.items()} == {
            name: values.ravel().tobytes() for name, values in arrays.items()
        }


def test_indices_are_plain_ratios_and_units_of_the_cube(cube: xr.Dataset) -> None:
    one = cube.isel(record=1)
    found = record_numbers(Content(cube, "c.nc").record(1))
    peak = one["peak_acceleration"].values
    wanted = {
        "acceleration": peak / G,
        "reduction_to_bare": 100 * (1 - peak / one["elastic_acceleration"].values),
        "reduction_to_braced": 100 * (1 - peak / one["braced_acceleration"].values[:, np.newaxis, :]),
        "displacement": 1e3 * one["peak_displacement"].values,
        "velocity": one["peak_velocity"].values,
        "base_shear": one["peak_base_shear"].values / 1e3,
        "residual": 1e3 * np.abs(one["residual_displacement"].values),
        "dissipated": one["dissipated_energy"].values / 1e3,
        "dissipated_share": 100 * one["dissipated_energy"].values / one["input_energy"].values,
        "travel": one["slip_travel"].values,
        "transitions": one["transitions"].values,
    }
    assert set(wanted) <= {index.name for index in INDICES}
    for name, values in wanted.items():
        np.testing.assert_allclose(found[name].reshape(SHAPE), values, rtol=1e-13, atol=1e-12, err_msg=name)
    np.testing.assert_allclose(found["bare"], one["elastic_acceleration"].values / G, rtol=1e-15)
    np.testing.assert_allclose(
        found["braced"].reshape(3, 6), one["braced_acceleration"].values / G, rtol=1e-15
    )


def test_the_best_pretension_is_the_least_or_the_most(cube: xr.Dataset) -> None:
    found = record_numbers(Content(cube, "c.nc").record(0))
    place = found["best acceleration"].reshape(3, 6).astype(int)
    least = cube["peak_acceleration"].isel(record=0).idxmin("pretension")
    assert np.array_equal(np.array(PRETENSION)[place], least.values)
    place = found["best dissipated"].reshape(3, 6).astype(int)
    assert np.array_equal(
        np.array(PRETENSION)[place], cube["dissipated_energy"].isel(record=0).idxmax("pretension").values
    )
    assert "best travel" not in found


def test_histories_that_did_not_end_well_are_no_numbers_and_never_best(cube: xr.Dataset) -> None:
    broken = cube.copy(deep=True)
    best = int(np.argmin(broken["peak_acceleration"].values[0, 1, :, 2]))
    broken["status"].values[0, 1, best, 2] = 1
    broken["status"].values[0, 2, :, 3] = 2
    found = record_numbers(Content(broken, "c.nc").record(0))
    values, place = found["acceleration"].reshape(SHAPE), found["best acceleration"].reshape(3, 6)
    assert np.isnan(values[1, best, 2])
    assert np.isnan(values[2, :, 3]).all()
    assert np.isnan(values).sum() == 1 + SHAPE[1]
    assert np.isfinite(place[1, 2])
    assert place[1, 2] != best
    assert np.isnan(place[2, 3])


def test_a_cube_of_few_outputs_offers_what_it_has() -> None:
    content = Content(small_cube(outputs=["peak_displacement"]), "c.nc")
    assert [index["name"] for index in content.about["indices"]] == ["displacement"]
    assert set(record_numbers(content.record(0))) == {"displacement", "best displacement"}


def test_every_index_comes_from_a_cube_that_has_all_outputs() -> None:
    cube = small_cube(outputs=[*OUTPUTS, *ON_REQUEST])
    found = record_numbers(Content(cube, "c.nc").record(1))
    assert {index.name for index in INDICES} <= set(found)
    one = cube.isel(record=1)
    strain = [one[name].values for name in ("strain_energy_area", "peak_strain_energy")]
    bare = [one[f"bare_{name}"].values for name in ("strain_energy_area", "peak_strain_energy")]
    np.testing.assert_allclose(
        found["rpi_index"].reshape(SHAPE), (strain[0] / bare[0] + strain[1] / bare[1]) / 2, rtol=1e-14
    )


def test_an_infinite_pretension_is_left_out_of_the_map(cube: xr.Dataset) -> None:
    content = Content(small_cube(pretension=[20e3, 60e3, np.inf]), "c.nc")
    assert content.about["axes"]["pretension"] == [20.0, 60.0]
    json.dumps(content.about, allow_nan=False)


def test_words_from_files_cannot_leave_their_place() -> None:
    evil = "</script><script>alert(1)</script>&<!--"
    text = embedded({"name": evil})
    assert not set("<>&") & set(text)
    assert json.loads(text) == {"name": evil}


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (
            synthetic_building_cube,
            r"c\.nc is a cube of buildings, over record, building, .*; BuildingContent",
        ),
        (synthetic_history, r"c\.nc is a history; the page shows cubes"),
        (lambda: synthetic_cube().isel(record=0), "lacks the dimension record"),
        (lambda: synthetic_cube().isel(period=[0]), "over period needs at least 2 finite values, .* has 1"),
        (lambda: synthetic_cube().isel(stiffness_ratio=[]), "has no stiffness_ratio; there is nothing"),
        (lambda: synthetic_cube()[["status"]], "none of the variables that can be shown"),
        (lambda: synthetic_cube().drop_vars("slip_force"), "lacks slip_force"),
    ],
)
def test_what_cannot_be_shown_is_refused(made, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        Content(made(), "c.nc")
