"""The fan-out: same bits whatever the split, outputs as asked for, mistakes named."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.errors import InvalidInput

AXES: dict[str, Any] = {
    "period": [0.05, 0.2, 0.5, 1.0],
    "pretension": [0.0, 20e3, 110e3, 400e3, np.inf],
    "stiffness_ratio": [0.5, 4.0, 10.0],
}


def record(name: str, seed: int = 1, samples: int = 400) -> fdspec.GroundMotion:
    rng = np.random.default_rng(seed)
    shake = np.convolve(rng.standard_normal(samples), np.ones(9) / 9.0, mode="same")
    return fdspec.GroundMotion(4.0 * shake / np.abs(shake).max(), 0.01, name=name)


@pytest.fixture(scope="module")
def motions() -> list[fdspec.GroundMotion]:
    return [record("a"), record("b", 2, 250)]


@pytest.fixture(scope="module")
def cube(motions: list[fdspec.GroundMotion]) -> xr.Dataset:
    return fdspec.sweep(motions, **AXES)


@pytest.mark.parametrize(
    "how",
    [
        {"workers": 1},
        {"workers": 2, "columns_per_task": 1},
        {"columns_per_task": 5},
        {"scheduler": "synchronous", "columns_per_task": 12},
    ],
)
def test_no_split_moves_a_bit(
    cube: xr.Dataset, motions: list[fdspec.GroundMotion], how: dict[str, Any]
) -> None:
    other = fdspec.sweep(motions, **AXES, **how)
    for name in cube.data_vars:
        np.testing.assert_array_equal(cube[name], other[name], err_msg=str(name))


def test_no_neighbour_moves_a_bit(cube: xr.Dataset, motions: list[fdspec.GroundMotion]) -> None:
    """One cell alone, in a lane of its own, gives the numbers it gives among the others."""
    for ratio, force, period in ((4.0, 20e3, 0.5), (10.0, 110e3, 0.05), (0.5, 0.0, 1.0)):
        alone = fdspec.sweep(motions[1], period=[period], pretension=[force], stiffness_ratio=[ratio])
        among = cube.sel(record=["b"], stiffness_ratio=[ratio], pretension=[force], period=[period])
        for name in alone.data_vars:
            np.testing.assert_array_equal(alone[name], among[name], err_msg=str(name))


def test_certificate_moves_no_bit(cube: xr.Dataset, motions: list[fdspec.GroundMotion]) -> None:
    plain = fdspec.sweep(motions, **AXES, certify=False)
    assert "energy_error" not in plain
    for name in plain.data_vars:
        np.testing.assert_array_equal(cube[name], plain[name], err_msg=str(name))


def test_agrees_with_simulate(cube: xr.Dataset, motions: list[fdspec.GroundMotion]) -> None:
    for ratio in AXES["stiffness_ratio"]:
        for force in AXES["pretension"]:
            for period in AXES["period"]:
                frame = fdspec.Building.single_storey(period, ratio, 0.5 * force)
                history = fdspec.simulate(frame, motions[0])
                cell = cube.sel(record="a", stiffness_ratio=ratio, pretension=force, period=period)
                assert int(cell.transitions) == int(history.transitions)
                for name in ("peak_acceleration", "peak_displacement", "peak_velocity"):
                    np.testing.assert_allclose(cell[name], history[name][0], rtol=1e-11)
                np.testing.assert_allclose(
                    cell.slip_travel, history.slip_travel[-1, 0], rtol=1e-8, atol=1e-15
                )
                np.testing.assert_allclose(cell.input_energy, history.input_energy[-1], rtol=1e-10)


def test_certified(cube: xr.Dataset) -> None:
    assert int(cube.status.sum()) == 0
    assert float(np.abs(cube.energy_error).max()) < 1e-9


def test_limits(cube: xr.Dataset) -> None:
    np.testing.assert_allclose(
        cube.peak_acceleration.sel(pretension=np.inf), cube.braced_acceleration, rtol=1e-14
    )
    free = cube.peak_acceleration.sel(pretension=0.0)
    np.testing.assert_allclose(free, cube.elastic_acceleration.broadcast_like(free), rtol=1e-12)
    assert int(cube.transitions.sel(pretension=[0.0, np.inf]).sum()) == 0


def test_outputs(motions: list[fdspec.GroundMotion]) -> None:
    few = fdspec.sweep(motions, **AXES, outputs=["peak_acceleration", "braced_acceleration"])
    assert set(few.data_vars) == {"peak_acceleration", "braced_acceleration", "status"}


def test_massless_and_damped_braces_sweep(motions: list[fdspec.GroundMotion]) -> None:
    for extra in ({"brace_mass": 0.0}, {"brace_damping_ratio": 0.2}, {"kinetic_friction_coefficient": 0.4}):
        cube = fdspec.sweep(motions, **AXES, **extra)
        assert int(cube.status.sum()) == 0
        assert float(np.abs(cube.energy_error).max()) < 1e-9
        assert int(cube.transitions.sum()) > 0


def test_a_motion_at_rest_leaves_everything_at_rest() -> None:
    still = fdspec.sweep(fdspec.GroundMotion(np.zeros(50), 0.01, name="still"), **AXES)
    assert float(still.peak_acceleration.max()) == 0.0
    assert float(np.abs(still.energy_error).max()) == 0.0
    assert int(still.status.sum()) == 0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"period": [-0.5]}, "period"),
        ({"period": []}, "period"),
        ({"pretension": [2.0, 1.0]}, "pretension"),
        ({"workers": 0}, "workers"),
        ({"columns_per_task": 0}, "columns_per_task"),
        ({"outputs": ["peak_acc"]}, "peak_acc"),
    ],
)
def test_mistakes_are_named(change: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        fdspec.sweep(record("a"), **{**AXES, **change})


def test_motions_must_be_motions_of_different_names() -> None:
    with pytest.raises(InvalidInput, match="'a' stands twice"):
        fdspec.sweep([record("a"), record("a", 2)], **AXES)
    with pytest.raises(InvalidInput, match="at least one"):
        fdspec.sweep([], **AXES)
    with pytest.raises(InvalidInput, match=r"motions\[0\] must be a GroundMotion"):
        fdspec.sweep([np.zeros(5)], **AXES)  # type: ignore[list-item]


def test_the_cost_is_measured_with_the_braces_there_are() -> None:
    from fdspec.model.grid import Grid
    from fdspec.runs.pilot import wall_seconds

    motion = fdspec.load_record("FSR1")
    heavy = Grid(stiffness_ratio=[4.0], pretension=[10e3, 50e3], period=[0.05, 0.5])  # type: ignore[arg-type]
    light = replace(heavy, brace_mass=1e-4)
    # Its frequency is 700 times as high, and so are the changes of phase that it can make.
    assert wall_seconds([motion], light) > 20 * wall_seconds([motion], heavy)
    assert wall_seconds([motion] * 3, light) > wall_seconds([motion], light)
