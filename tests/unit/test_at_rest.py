"""Free vibration in sweeps, and the position in which a frame comes to rest."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec

MOTION = fdspec.GroundMotion(
    4.0 * np.sin(np.linspace(0.0, 18.0, 181)) * np.linspace(0.2, 1.0, 181), 0.02, name="sine"
)
FRAME = fdspec.Building.single_storey(period=0.6, stiffness_ratio=4.0, slip_force=20e3)
TOWER = fdspec.Building(
    floor_mass=[20e3, 20e3, 15e3],
    storey_stiffness=[2e7, 1.6e7, 1.2e7],
    brace_mass=[60.0, 60.0, 60.0],
    brace_stiffness=[6e7, 5e7, 4e7],
    slip_force=[40e3, 30e3, 20e3],
    damping=fdspec.ModalDamping(0.03),
)


def grid(**more: Any) -> xr.Dataset:
    return fdspec.sweep(
        MOTION, period=[0.3, 0.6], pretension=[0.0, 40e3, 1e9], stiffness_ratio=4.0, progress=False, **more
    )


def test_free_vibration_in_a_sweep_is_that_of_a_history() -> None:
    cube = grid(free_vibration=1.5)
    history = fdspec.simulate(FRAME, MOTION, free_vibration=1.5)
    cell = cube.sel(pretension=40e3, period=0.6).squeeze()
    for name in ("peak_displacement", "residual_displacement", "residual_slip", "peak_brace_force"):
        assert float(cell[name]) == pytest.approx(float(history[name][0]), rel=1e-10), name
    assert cell.transitions == history.transitions
    assert '"free_vibration": 1.5' in cube.attrs["parameters"]


def test_without_either_a_cube_says_nothing_of_them() -> None:
    assert "free_vibration" not in grid().attrs["parameters"]


def balance(building: fdspec.Building, history: xr.Dataset) -> None:
    """At rest the springs' forces add up to nothing on every floor, and each damper holds its own."""
    u, slip = history.residual_displacement.values, history.residual_slip.values
    stretch = np.diff(u, prepend=0.0) - slip
    brace = building.brace_stiffness * stretch
    floor = building.stiffness_matrix @ u + brace - np.append(brace[1:], 0.0)
    assert np.abs(floor).max() < 1e-9 * building.slip_force.max()
    assert (np.abs(brace) < building.slip_force).all()


@pytest.mark.parametrize("building", [FRAME, TOWER], ids=["one storey", "three storeys"])
def test_position_of_rest(building: fdspec.Building) -> None:
    rested = fdspec.simulate(building, MOTION, at_rest=True)
    balance(building, rested)
    assert np.abs(rested.residual_slip.values).max() > 1e-4
    assert rested.time[-1] >= MOTION.duration
    far = fdspec.simulate(building, MOTION, free_vibration=120.0, dt_out=1.0)
    scale = float(np.abs(far.residual_slip).max())
    assert int(far.transitions) == int(rested.transitions)
    for name in ("residual_displacement", "residual_slip", "residual_drift"):
        np.testing.assert_allclose(rested[name].values, far[name].values, rtol=0.0, atol=1e-9 * scale)


def test_at_rest_in_a_sweep_is_that_of_a_history() -> None:
    cube = grid(at_rest=True)
    history = fdspec.simulate(FRAME, MOTION, at_rest=True)
    cell = cube.sel(pretension=40e3, period=0.6).squeeze()
    for name in ("residual_displacement", "residual_slip"):
        assert float(cell[name]) == pytest.approx(float(history[name][0]), rel=1e-9), name
    never = cube.sel(pretension=1e9)
    assert float(abs(never.residual_displacement).max()) == 0.0
    assert float(abs(cube.sel(pretension=0.0).residual_slip).max()) == 0.0


def test_at_rest_in_a_sweep_of_buildings() -> None:
    cube = fdspec.sweep_buildings(MOTION, {"tower": TOWER}, slip_scale=1.0, stiffness_scale=1.0, at_rest=True)
    history = fdspec.simulate(TOWER, MOTION, at_rest=True)
    for name in ("residual_displacement", "residual_slip", "residual_drift", "peak_brace_force"):
        np.testing.assert_allclose(cube[name].values.ravel(), history[name].values, rtol=1e-12, err_msg=name)


def test_what_has_no_rest_is_refused() -> None:
    free = TOWER.with_changes(slip_force=[40e3, 0.0, 20e3], kinetic_slip_force=[40e3, 0.0, 20e3])
    with pytest.raises(fdspec.InvalidInput, match="friction in every damper, got slip_force 0 in storey 2"):
        fdspec.simulate(free, MOTION, at_rest=True)
    with pytest.raises(fdspec.InvalidInput, match="at_rest is for the exact method"):
        fdspec.simulate(FRAME, MOTION, at_rest=True, method="newmark")
    with pytest.raises(
        fdspec.InvalidInput, match="free_vibration must be zero or a positive time in s, got -1"
    ):
        grid(free_vibration=-1.0)


def test_drift_ratio_where_heights_are_known() -> None:
    tall = TOWER.with_changes(storey_height=[4.0, 3.5, 3.5])
    history = fdspec.simulate(tall, MOTION)
    np.testing.assert_array_equal(history.peak_drift_ratio, history.peak_drift.values / [4.0, 3.5, 3.5])
    assert "peak_drift_ratio" not in fdspec.simulate(TOWER, MOTION)
    cube = fdspec.sweep_buildings(MOTION, {"tall": tall}, slip_scale=[0.5, 1.0], stiffness_scale=1.0)
    np.testing.assert_allclose(
        cube.peak_drift_ratio.values[0, 0, 0, 1], history.peak_drift_ratio.values, rtol=1e-12
    )
    cube = grid(storey_height=3.2)
    np.testing.assert_array_equal(cube.peak_drift_ratio.values, cube.peak_displacement.values / 3.2)
