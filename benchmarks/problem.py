"""The one history on which everything is compared, and the cells on which failures are counted.

T = 0.5 s, SR 4, slip force 100 kN, floor 20 000 kg, brace 50 kg, damping ratio 0.05, under the motion of
tests/reference made twice as strong (PGA 0.69 g): 20 s at 0.01 s, 2001 samples.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

import fdspec
from tests.oracle import sdof_events
from tests.reference import numbers

STUDY_ELEVEN = [5e3 + 50e3 * k for k in range(11)]
"""Slip forces of the study's eleven pretensions; the last six are never reached in this problem."""

SLIPPING_ELEVEN = [20e3 + 15e3 * k for k in range(11)]
"""Eleven that all slip."""


@dataclass(frozen=True)
class Problem:
    """SI units."""

    period: float = 0.5
    stiffness_ratio: float = 4.0
    slip_force: float = 100e3
    strength: float = 2.0

    @property
    def motion(self) -> tuple[NDArray[np.float64], float]:
        """Ground acceleration (m/s2) and its time step (s)."""
        acceleration, dt = numbers.motion()
        return self.strength * acceleration, dt

    @property
    def storey(self) -> sdof_events.Storey:
        """Masses, dampings and stiffnesses."""
        return sdof_events.Storey.from_period(self.period, self.stiffness_ratio, self.slip_force)

    @property
    def building(self) -> fdspec.Building:
        """The same for fdspec."""
        return fdspec.Building.single_storey(
            period=self.period, stiffness_ratio=self.stiffness_ratio, slip_force=self.slip_force
        )

    @property
    def ground_motion(self) -> fdspec.GroundMotion:
        """The motion for fdspec."""
        return fdspec.GroundMotion(*self.motion, name="benchmark")


@cache
def answer(problem: Problem) -> sdof_events.History:
    """Exact history, by the slow integrator of the tests."""
    return sdof_events.integrate(problem.storey, *problem.motion)


def slipping_cells() -> list[Problem]:
    """Twelve histories over the study's ranges that slip."""
    base = Problem()
    return [
        replace(base, period=period, stiffness_ratio=ratio, slip_force=force)
        for period in (0.2, 0.5, 1.0, 2.0)
        for ratio, force in ((1.0, 20e3), (4.0, 60e3), (10.0, 40e3))
    ]
