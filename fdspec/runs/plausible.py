"""Numbers that are possible, but more often a slip of units: told once, and computed all the same."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from fdspec.model.motion import GroundMotion
from fdspec.units import G

LONGEST_PERIOD: Final = 100.0
"""s; beyond, periods are taken for milliseconds."""

WEAKEST_FORCE: Final = 1e-3
"""Of the weight above; below, slip forces are taken for kilonewtons."""

HEAVY: Final = 1000.0
"""kg from which that is asked: models on a shaking table are light and their forces small."""

WEAK_MOTIONS: Final = (0.02, 0.5)
"""m/s2; peaks that records have in g, and that damp nothing in m/s2."""


def warn_of_units(
    motions: Sequence[GroundMotion], *, period: ArrayLike, slip_force: ArrayLike, floor_mass: ArrayLike
) -> None:
    """Warn where periods (s), slip forces (N), masses (kg) or motions look like another unit's numbers.

    Motions that were read from a file, whose unit is known, or scaled on purpose are not asked.
    """
    longest = float(np.max(period))
    if longest > LONGEST_PERIOD:
        _warn(f"a period of {longest:g} s is very long: periods are in s, not in ms")
    forces = np.ravel(slip_force)
    forces = forces[np.isfinite(forces) & (forces > 0.0)]
    mass = float(np.min(floor_mass))
    if forces.size and mass >= HEAVY and forces.max() < WEAKEST_FORCE * mass * G:
        _warn(
            f"slip forces of at most {forces.max():.4g} N under floors of {mass:.4g} kg hold nothing: "
            "forces are in N, not in kN"
        )
    weak = [m for m in motions if not m.source and m.scale_factor == 1.0 and _weak(m.pga)]
    if weak and len(weak) == len(motions):
        _warn(
            f"{weak[0].name or 'the motion'} has a peak of {weak[0].pga:.3g} m/s2 only: "
            "acceleration is in m/s2, not in g"
        )


def _weak(pga: float) -> bool:
    return WEAK_MOTIONS[0] <= pga <= WEAK_MOTIONS[1]


def _warn(text: str) -> None:
    warnings.warn(text, UserWarning, stacklevel=4)
