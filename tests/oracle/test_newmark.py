"""The study's scheme against a second program of it, whose steps are solved instead of iterated."""

from __future__ import annotations

import numpy as np
import pytest

import fdspec
from fdspec.methods import Newmark
from tests.oracle import newmark_steps


@pytest.mark.parametrize("beta", [1 / 4, 1 / 6], ids=["average", "linear"])
@pytest.mark.parametrize("kinetic", [1.0, 0.7])
@pytest.mark.parametrize("storeys", [1, 3])
def test_the_published_loops_solve_the_step(storeys: int, kinetic: float, beta: float) -> None:
    """Iterated to 1e-10, steps are what their linear systems say: the same changes at the same steps."""
    rng = np.random.default_rng(storeys)
    ground, dt, divisions = 6.0 * rng.standard_normal(61), 0.02, 100
    force = np.array([50e3, 40e3, 25e3][:storeys])
    building = fdspec.Building(
        [20e3, 19e3, 15e3][:storeys],
        [9e6, 8e6, 6e6][:storeys],
        60.0,
        [25e6, 20e6, 15e6][:storeys],
        force,
        kinetic * force,
        fdspec.ModalDamping(0.03),
    )
    expected = newmark_steps.integrate(
        building.floor_mass,
        building.brace_mass,
        building.stiffness_matrix,
        building.damping_matrix,
        building.brace_stiffness,
        building.slip_force,
        building.kinetic_slip_force,
        ground,
        dt,
        divisions,
        beta,
    )
    method = Newmark(dt=dt / divisions, beta=beta, tolerance=1e-10)
    history = fdspec.simulate(building, fdspec.GroundMotion(ground, dt), method=method)
    changes = zip(
        history.transition_time.values,
        history.transition_storey.values - 1,
        history.transition_phase.values,
        strict=True,
    )
    assert len(expected.transitions) > 20
    assert [(s, p) for _, s, p in changes] == [(s, p) for _, s, p in expected.transitions]
    times = [time for time, _, _ in expected.transitions]
    np.testing.assert_allclose(history.transition_time, times, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(history.peak_acceleration, expected.peak_acceleration, rtol=1e-9)
    scale = float(history.peak_displacement.max())
    final = history.residual_displacement
    np.testing.assert_allclose(final, expected.final_displacement, rtol=0.0, atol=1e-9 * scale)


def test_the_iteration_that_the_study_stops_at_1e_6_is_no_source_of_error() -> None:
    """Its tolerance moves a peak by far less than its step does."""
    motion = fdspec.GroundMotion(6.0 * np.random.default_rng(4).standard_normal(61), 0.02)
    frame = fdspec.Building.single_storey(period=0.4, stiffness_ratio=4.0, slip_force=50e3)
    exact = fdspec.simulate(frame, motion)
    loose, tight = (
        fdspec.simulate(frame, motion, method=Newmark(dt=1e-5, tolerance=tolerance))
        for tolerance in (1e-6, 1e-10)
    )
    step = abs(tight.peak_acceleration / exact.peak_acceleration - 1.0).item()
    moved = abs(loose.peak_acceleration / tight.peak_acceleration - 1.0).item()
    assert 0.0 < step < 1e-4
    assert moved < 0.1 * step
