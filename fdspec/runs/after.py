"""What follows a ground motion in a sweep: free vibration, and the way to rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True)
class After:
    """How a history goes on after its motion's end, the ground at rest."""

    free_vibration: float = 0.0
    """s"""
    at_rest: bool = False
    """Whether it goes on until nothing can slip any more."""

    def free_steps(self, motion: GroundMotion) -> int:
        """Return the steps of the motion's dt that the free vibration takes."""
        return math.ceil(self.free_vibration / motion.dt - 1e-9)

    @property
    def parameters(self) -> dict[str, object]:
        """What a cube says of it; nothing where it ends with the motion."""
        there = {"free_vibration": self.free_vibration, "at_rest": self.at_rest}
        return {name: value for name, value in there.items() if value}

    def times(self, motions: Sequence[GroundMotion]) -> float:
        """Return how many times the work of the motions alone it takes, roughly."""
        samples = sum(motion.n for motion in motions)
        longer = (samples + sum(self.free_steps(motion) for motion in motions)) / samples
        return longer * (2.0 if self.at_rest else 1.0)


NOTHING = After()
"""A history that ends with its motion."""


def zero_or_positive(name: str, value: object) -> float:
    """Return a time in s, or raise InvalidInput by this name."""
    if isinstance(value, bool) or not (isinstance(value, int | float) and 0.0 <= value < math.inf):
        raise InvalidInput(f"{name} must be zero or a positive time in s, got {value!r}")
    return float(value)
