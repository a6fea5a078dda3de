"""Histories that would take days are refused before they start, by what makes them so long."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec.engines.step_count import MAX_STEPS, steps_of_storeys
from fdspec.errors import InvalidInput
from fdspec.kernels.storey.constants import RADIANS, plan, steps_per_sample
from fdspec.kernels.types import Storey

MOTION = fdspec.GroundMotion(np.sin(0.3 * np.arange(101)), 0.01, name="m")


def frame(**change: Any) -> fdspec.Building:
    given = {"brace_mass": 50.0, "brace_damping": 0.0, "slip_force": 5e4, **change}
    return fdspec.Building([20e3], [3e6], brace_stiffness=12e6, **given)


@pytest.mark.parametrize(
    "storey",
    [
        Storey(20e3, 2.5e4, 3.2e6, 50.0, 0.0, 12.6e6, 5e3, 5e3),
        Storey(20e3, 2.5e4, 3.2e6, 1.0, 300.0, 12.6e7, 5e3, 5e3),
        Storey(20e3, 0.0, 3.2e9, 0.0, 0.0, 12.6e6, 5e3, 5e3),
        Storey(20e3, 2.5e4, 3.2e6, 0.0, 1e4, 12.6e6, 5e3, 5e3),
        Storey(20e3, 2.5e4, 3.2e6, 50.0, 0.0, 12.6e6, np.inf, 0.0),
    ],
)
@pytest.mark.parametrize("dt", [0.001, 0.02, 0.5])
def test_the_steps_are_those_of_the_kernels(storey: Storey, dt: float) -> None:
    parts = steps_per_sample(storey, dt, RADIANS)
    segments = plan(storey, dt / parts, RADIANS).slip_steps if np.isfinite(storey.slip_force) else 1
    assert steps_of_storeys(np.array(storey), dt, 7) == 7 * parts * segments


def test_many_storeys_at_once() -> None:
    rows = np.array([[20e3, 0.0, 3e6, 50.0, 0.0, k, 1e3, 1e3] for k in (1e6, 1e9, 1e12)])
    steps = steps_of_storeys(rows, 0.01, 100)
    assert steps.shape == (3,)
    assert (np.diff(steps) > 0).all()


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"brace_mass": 1e-12, "brace_damping": 0.0}, "brace_mass 1e-12 kg"),
        ({"brace_mass": 0.0, "brace_damping": 1e-4}, "brace_damping"),
    ],
)
def test_a_brace_that_is_too_fast_is_named(change: dict[str, float], named: str) -> None:
    with pytest.raises(InvalidInput, match=f"{named}.*would take about .* steps; at most 1e.09"):
        fdspec.simulate(frame(**change), MOTION)


def test_of_several_storeys_a_plate_that_is_too_light_is_named_and_a_weak_dashpot_costs_nothing() -> None:
    def two(**change: float) -> fdspec.Building:
        return fdspec.Building([20e3] * 2, 3e6, brace_stiffness=12e6, slip_force=5e4, **change)

    with pytest.raises(InvalidInput, match="brace_mass 1e-12 kg"):
        fdspec.simulate(two(brace_mass=1e-12), MOTION)
    # What decays faster than rounding can tell asks for no short steps.
    assert fdspec.simulate(two(brace_mass=0.0, brace_damping=1e-4), MOTION).status == 0


def test_a_step_that_is_too_long_and_a_wait_that_never_ends() -> None:
    slow = fdspec.GroundMotion(MOTION.acceleration, 1e6, name="slow")
    with pytest.raises(InvalidInput, match=r"floors of 20000 kg .* with dt 1e\+06 s, would take"):
        fdspec.simulate(frame(slip_force=np.inf), slow)
    with pytest.raises(InvalidInput, match="a history of .* samples would take|free_vibration included"):
        fdspec.simulate(frame(), MOTION, free_vibration=1e9, dt_out=1e3)


def test_the_limit_can_be_set(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InvalidInput, match="at most 50 are taken, set max_steps or FDSPEC_MAX_STEPS"):
        fdspec.simulate(frame(), MOTION, max_steps=50)
    monkeypatch.setenv("FDSPEC_MAX_STEPS", "60")
    with pytest.raises(InvalidInput, match="at most 60 are taken"):
        fdspec.simulate(frame(), MOTION)
    fdspec.simulate(frame(), MOTION, max_steps=MAX_STEPS)
    monkeypatch.setenv("FDSPEC_MAX_STEPS", "many")
    with pytest.raises(InvalidInput, match="FDSPEC_MAX_STEPS must be a positive number of steps, got 'many'"):
        fdspec.simulate(frame(), MOTION)
