"""The best damper of a cube."""

import numpy as np
import pytest
import xarray as xr

from fdspec.errors import InvalidInput
from fdspec.measures import best_damper


@pytest.fixture
def cube() -> xr.Dataset:
    """Give a cube of ratios 2 everywhere but where a test writes; elastic limits 1, 2 and 4."""
    elastic = np.array([[1.0, 2.0, 4.0], [1.0, 2.0, 4.0]])
    dims = ("record", "stiffness_ratio", "pretension", "period")
    peak = np.full((2, 2, 3, 3), 2.0) * elastic[:, None, None, :]
    return xr.Dataset(
        {
            "peak_acceleration": (dims, peak),
            "elastic_acceleration": (("record", "period"), elastic),
            "status": (dims, np.zeros(peak.shape, dtype=np.int8)),
        },
        coords={
            "record": ["a", "b"],
            "stiffness_ratio": [1.0, 4.0],
            "pretension": [0.0, 50e3, 100e3],
            "period": [0.2, 0.5, 1.0],
        },
    )


def test_the_mean_ratio_to_the_elastic_limit_decides(cube: xr.Dataset) -> None:
    peak = cube["peak_acceleration"].values
    peak[0, 0, 1] = [0.8, 1.6, 3.2]  # 0.8 of the limit everywhere
    peak[0, 1, 2] = [1.0, 2.0, 2.0]  # the smallest sum, but a mean ratio of 0.83
    peak[1, 1, 0] = [0.5, 1.0, 2.0]
    best = best_damper(cube)
    assert best["acceleration_ratio"].values == pytest.approx([0.8, 0.5])
    assert best["pretension"].values.tolist() == [50e3, 0.0]
    assert best["stiffness_ratio"].values.tolist() == [1.0, 4.0]


def test_a_band_of_periods_is_selected_first(cube: xr.Dataset) -> None:
    cube["peak_acceleration"].values[0, 0, 1] = [0.1, 20.0, 40.0]
    assert best_damper(cube.sel(period=slice(0, 0.3)))["acceleration_ratio"].values[0] == pytest.approx(0.1)
    assert best_damper(cube)["acceleration_ratio"].values[0] == pytest.approx(2.0)


def test_a_history_that_failed_rules_its_pair_out(cube: xr.Dataset) -> None:
    cube["peak_acceleration"].values[0, 0, 1] = 0.1
    cube["peak_acceleration"].values[0, 1, 2] = 0.5
    cube["status"].values[0, 0, 1, 2] = 1
    assert best_damper(cube)["pretension"].values[0] == 100e3


def test_where_nothing_can_be_told_nothing_is(cube: xr.Dataset) -> None:
    cube["elastic_acceleration"].values[1] = 0.0
    cube["peak_acceleration"].values[1] = 0.0
    best = best_damper(cube)
    assert np.isfinite(best["acceleration_ratio"].values).tolist() == [True, False]


@pytest.mark.parametrize("name", ["peak_acceleration", "elastic_acceleration"])
def test_a_variable_that_is_missing_is_named(cube: xr.Dataset, name: str) -> None:
    with pytest.raises(InvalidInput, match=f"the cube has no {name}"):
        best_damper(cube.drop_vars(name))


def test_an_empty_band_is_refused(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="no period left"):
        best_damper(cube.sel(period=slice(5, 6)))


def test_a_cube_of_buildings_is_refused() -> None:
    dims = ("record", "building", "stiffness_scale", "slip_scale")
    peak = (dims, np.ones((1, 1, 1, 1)))
    cube = xr.Dataset({"peak_acceleration": peak, "elastic_acceleration": peak})
    with pytest.raises(InvalidInput, match="no dimension stiffness_ratio, pretension, period"):
        best_damper(cube)


def test_a_plane_of_the_cube_is_refused(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match=r"no dimension period.*select with lists"):
        best_damper(cube.sel(period=0.5))
