"""Indices, reductions, ensembles, residuals and slip-load spectra of cubes, against numbers on paper."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.errors import InvalidInput
from fdspec.measures import (
    best_for_all,
    best_on_grid,
    ensemble,
    index_of,
    indices,
    needs_of,
    reduction,
    residual,
    slip_load_spectrum,
)
from fdspec.measures.indices import INDICES, name_of, weights_of
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.sweep import ON_REQUEST, OUTPUTS

DIMS = ("record", "stiffness_ratio", "pretension", "period")
AXES: dict[str, Any] = {
    "period": [0.3, 0.5],
    "pretension": [0.0, 40e3, 120e3, np.inf],
    "stiffness_ratio": [4.0],
}


@pytest.fixture(scope="module")
def motions() -> list[GroundMotion]:
    records = [fdspec.load_record(name) for name in ("FSR1", "FMR2")]
    return [GroundMotion(r.acceleration[:800], r.dt, name=r.name) for r in records]


@pytest.fixture(scope="module")
def cube(motions: list[GroundMotion]) -> xr.Dataset:
    return fdspec.sweep(motions, **AXES, outputs=(*OUTPUTS, *ON_REQUEST))


def toy(index: list[list[float]]) -> xr.DataArray:
    coords = {"record": ["a", "b", "c"][: len(index)], "pretension": 10e3 * np.arange(len(index[0]))}
    return xr.DataArray(np.array(index), coords, ("record", "pretension"))


def test_every_index_is_what_its_formula_says_of_plain_histories(
    cube: xr.Dataset, motions: list[GroundMotion]
) -> None:
    """The must-hold line: within 1e-9 of a plain recomputation from time histories."""
    from scipy.integrate import simpson

    motion, fine = motions[0], 256
    frames = [Building.single_storey(0.5, 4.0, 20e3), Building.single_storey(0.5, 0.0, 0.0, brace_mass=0.0)]
    damped, bare = (fdspec.simulate(frame, motion, dt_out=motion.dt / fine) for frame in frames)

    def area(history: xr.Dataset) -> float:
        return float(simpson(history["strain_energy"].values, dx=motion.dt / fine))

    def top(history: xr.Dataset) -> float:
        energy = history["strain_energy"].values
        at = int(energy.argmax())
        left, middle, right = energy[at - 1 : at + 2]
        return float(middle + (right - left) ** 2 / (8.0 * (2.0 * middle - left - right)))

    plain = {
        name: damped[f"peak_{name}"].item() / bare[f"peak_{name}"].item()
        for name in ("acceleration", "displacement", "base_shear")
    }
    plain["rpi"] = 0.5 * (area(damped) / area(bare) + top(damped) / top(bare))
    plain["dissipated_energy"] = (
        1.0 - damped["friction_energy"].values[-1] / damped["input_energy"].values[-1]
    )
    plain["weighted"] = 0.5 * (plain["acceleration"] + plain["displacement"])
    found = indices(cube).sel(record="FSR1", stiffness_ratio=4.0, pretension=40e3, period=0.5)
    assert set(found.data_vars) == set(plain)
    for name, value in plain.items():
        assert found[name].item() == pytest.approx(value, rel=1e-9), name


def test_the_bare_frame_has_1_in_every_index(motions: list[GroundMotion]) -> None:
    """A brace of next to no stiffness and no friction leaves the bare frame."""
    every = (*OUTPUTS, *ON_REQUEST)
    axes: dict[str, Any] = {"period": [0.3, 0.5], "pretension": [0.0], "stiffness_ratio": [1e-12]}
    none = fdspec.sweep(motions, **axes, brace_mass=0.0, outputs=every)
    for name, values in indices(none).items():
        assert values.values == pytest.approx(1.0, abs=1e-9), name


def test_the_relative_performance_index_of_the_bare_values_is_1_exactly(cube: xr.Dataset) -> None:
    bare = cube.copy()
    for name in ("strain_energy_area", "peak_strain_energy"):
        bare[name] = (0.0 * cube[name] + cube[f"bare_{name}"]).transpose(*DIMS)
    assert (index_of(bare, "rpi") == 1.0).all()


def test_failed_histories_have_no_index(cube: xr.Dataset) -> None:
    broken = cube.copy(deep=True)
    broken["status"][0, 0, 1, 0] = 1
    missing = index_of(broken).isnull()
    assert missing.sum() == 1
    assert bool(missing[0, 0, 1, 0])


def test_weights_add_up_to_1() -> None:
    assert weights_of({"rpi": 3, "acceleration": 1}) == {"rpi": 0.75, "acceleration": 0.25}
    assert weights_of("weighted") == {"acceleration": 0.5, "displacement": 0.5}
    assert name_of({"rpi": 3, "acceleration": 1}) == "0.75 rpi + 0.25 acceleration"
    assert needs_of({"rpi": 1, "displacement": 1})[-2:] == ("peak_displacement", "bare_peak_displacement")


@pytest.mark.parametrize(
    ("index", "said"),
    [
        (
            "drift",
            "'drift' is none of acceleration, displacement, base_shear, rpi, dissipated_energy, weighted",
        ),
        ({}, "must weigh at least one"),
        ({"rpi": -1.0}, "weight of rpi must be positive and finite, got -1.0"),
        ({"rpi": "1"}, "weight of rpi must be positive"),
    ],
)
def test_an_index_that_is_none_is_refused(index: Any, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        weights_of(index)


def test_a_cube_without_what_an_index_needs_says_which(cube: xr.Dataset) -> None:
    with pytest.raises(InvalidInput, match="the cube has no bare_peak_displacement"):
        index_of(cube.drop_vars("bare_peak_displacement"), "displacement")
    assert "rpi" not in indices(cube.drop_vars("strain_energy_area"))
    assert set(INDICES) < set(indices(cube).data_vars)


def test_reduction_is_against_both_limits(cube: xr.Dataset) -> None:
    for response in ("peak_acceleration", "peak_displacement", "peak_base_shear"):
        found = reduction(cube, response)
        assert found["against_braced"].sel(pretension=np.inf).values == pytest.approx(0.0, abs=1e-12)
        assert found["against_bare"].dims == DIMS
    found = reduction(cube).isel(record=1, stiffness_ratio=0, pretension=1, period=0)
    peak = cube["peak_acceleration"][1, 0, 1, 0].item()
    assert found["against_bare"].item() == 1.0 - peak / cube["elastic_acceleration"][1, 0].item()
    with pytest.raises(InvalidInput, match="response must be one of peak_acceleration"):
        reduction(cube, "peak_velocity")


def test_an_ensemble_has_four_statistics() -> None:
    found = ensemble(toy([[1.0, 4.0], [2.0, 5.0], [6.0, 6.0]]))["index"]
    assert found.sel(statistic="mean").values == pytest.approx([3.0, 5.0])
    assert found.sel(statistic="median").values == pytest.approx([2.0, 5.0])
    assert found.sel(statistic="worst").values == pytest.approx([6.0, 6.0])
    # 0.84 of the way over two gaps is 0.68 into the second.
    assert found.sel(statistic="p84").values == pytest.approx([2.0 + 0.68 * 4.0, 5.0 + 0.68])
    with pytest.raises(InvalidInput, match="needs the dimension record"):
        ensemble(toy([[1.0, 2.0]]).isel(record=0))


def test_one_record_missing_is_no_ensemble() -> None:
    found = ensemble(toy([[1.0, np.nan], [2.0, 5.0]]))["index"]
    assert np.isnan(found[:, 1]).all()
    assert np.isfinite(found[:, 0]).all()


def test_the_best_for_all_and_what_each_loses_by_it() -> None:
    found = best_for_all(toy([[1.0, 0.5, 0.9], [1.0, 0.8, 0.4], [1.0, 0.9, 0.9]]))
    assert found["pretension"].item() == 10e3  # means 1, 0.7333, 0.7333: the lower of two equals
    assert found["index"].item() == pytest.approx(2.2 / 3)
    assert found["regret"].values == pytest.approx([0.0, 1.0, 0.0])
    worst = best_for_all(toy([[1.0, 0.5, 0.9], [1.0, 0.95, 0.4]]), "worst")
    assert worst["pretension"].item() == 20e3
    with pytest.raises(InvalidInput, match="statistic must be one of mean, median, p84, worst, got 'best'"):
        best_for_all(toy([[1.0]]), "best")
    with pytest.raises(InvalidInput, match="no dimension record"):
        best_for_all(toy([[1.0]]).isel(record=0))


def test_the_best_of_a_grid_and_its_band() -> None:
    found = best_on_grid(toy([[1.0, 0.52, 0.6, 0.5, 0.9], [0.3, 0.3, 0.3, 0.3, 0.4]]), band=0.05)
    assert found["pretension"].values.tolist() == [30e3, 0.0]
    assert found["band_start"].values.tolist() == [10e3, 0.0]
    assert found["band_end"].values.tolist() == [30e3, 30e3]
    assert np.isnan(best_on_grid(toy([[np.nan, np.nan]]))["pretension"].item())
    with pytest.raises(InvalidInput, match="band must be"):
        best_on_grid(toy([[1.0]]), band=-1)
    with pytest.raises(InvalidInput, match="no dimension pretension"):
        best_on_grid(toy([[1.0]]).isel(pretension=0))


def test_residual_is_compared_with_what_can_stay(cube: xr.Dataset) -> None:
    found = residual(cube).isel(record=0, stiffness_ratio=0, period=1)
    row = cube.isel(record=0, stiffness_ratio=0, period=1, pretension=1)
    stays, stiffness = abs(row["residual_displacement"].item()), 20e3 * (2 * np.pi / 0.5) ** 2
    at = found.isel(pretension=1)
    assert at["residual_displacement"].item() == stays
    assert at["share_of_peak"].item() == pytest.approx(stays / row["peak_displacement"].item())
    assert at["share_of_possible"].item() == pytest.approx(stays * stiffness / 20e3)
    assert np.isnan(found["share_of_possible"].values[[0, 3]]).all()
    with pytest.raises(InvalidInput, match="does not tell its floor_mass"):
        residual(cube.drop_attrs())


def test_a_slip_load_spectrum_has_no_dimension() -> None:
    best = xr.Dataset(
        {"slip_force": (("record", "period"), [[20e3, 40e3]])},
        {"record": ["a"], "period": [0.2, 0.5], "pga": ("record", [4.0])},
    )
    found = slip_load_spectrum(best, 20e3, {"a": 0.4})
    assert found["slip_coefficient"].values.tolist() == [[0.25, 0.5]]
    assert found["period_ratio"].values.tolist() == [[0.5, 1.25]]
    with pytest.raises(InvalidInput, match="motion_period has no 'a'"):
        slip_load_spectrum(best, 20e3, {})
    with pytest.raises(InvalidInput, match="floor_mass must be positive"):
        slip_load_spectrum(best, 0.0)
    with pytest.raises(InvalidInput, match="have no pga"):
        slip_load_spectrum(best.drop_vars("pga"), 20e3)
    with pytest.raises(InvalidInput, match="no dimension record"):
        slip_load_spectrum(best.isel(record=0), 20e3)
