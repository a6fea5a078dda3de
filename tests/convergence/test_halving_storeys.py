"""N storeys: neither the length of the Taylor steps nor their order stands in the answer."""

from __future__ import annotations

import numpy as np
import pytest

import fdspec
from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.trajectory import Span, Trajectory
from tests.buildings import CASES, Case
from tests.reference import numbers


def run(building: fdspec.Building, acceleration: np.ndarray, dt: float, **scheme: float) -> Trajectory:
    motion = fdspec.GroundMotion(acceleration, dt)
    start = np.zeros((2, 2, building.n_storeys))
    trajectory = integrate_many_storeys(building, motion, Span(0, motion.duration, 2), start, **scheme)
    assert trajectory.status == 0
    assert trajectory.energy_error < 1e-9
    return trajectory


def same(one: Trajectory, other: Trajectory) -> None:
    assert one.transition_phase.tolist() == other.transition_phase.tolist()
    assert one.transition_storey.tolist() == other.transition_storey.tolist()
    for name in (
        "peak_acceleration",
        "peak_displacement",
        "peak_velocity",
        "peak_drift",
        "peak_storey_shear",
    ):
        np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=1e-10, err_msg=name)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_half_the_step_and_more_terms(case: Case) -> None:
    acceleration, dt = numbers.motion()
    part = acceleration[250:451]
    once = run(case.building, part, dt)
    same(once, run(case.building, part, dt, radians=0.5))
    same(once, run(case.building, part, dt, extra_terms=4))


@pytest.mark.parametrize("case", CASES, ids=str)
def test_halving_the_steps_of_the_motion(case: Case) -> None:
    acceleration, dt = numbers.motion()
    part = acceleration[250:451]
    fine = np.empty(2 * len(part) - 1)
    fine[::2], fine[1::2] = part, 0.5 * (part[:-1] + part[1:])
    same(run(case.building, part, dt), run(case.building, fine, 0.5 * dt))
