"""One line of the verification table."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A quantity, what it should be, what came out, and how far apart they may be."""

    case: str
    quantity: str
    """with its unit"""
    reference: float
    computed: float
    error: float
    limit: float

    @property
    def passed(self) -> bool:
        """Whether the error is within the limit; an error that is no number is not."""
        return self.error <= self.limit


def relative(case: str, quantity: str, reference: float, computed: float, limit: float) -> Row:
    """Compare by the error relative to the reference."""
    scale = abs(reference) if reference != 0.0 else 1.0
    return Row(case, quantity, reference, computed, abs(computed - reference) / scale, limit)


def absolute(case: str, quantity: str, reference: float, computed: float, limit: float) -> Row:
    """Compare by the difference."""
    return Row(case, quantity, reference, computed, abs(computed - reference), limit)


def same_count(case: str, quantity: str, reference: int, computed: int) -> Row:
    """Demand the same whole number."""
    return Row(case, quantity, reference, computed, abs(computed - reference), 0.0)


def at_most(case: str, quantity: str, computed: float, limit: float) -> Row:
    """Demand something that should be zero to be small."""
    return Row(case, quantity, 0.0, computed, abs(computed), limit)


def at_least(case: str, quantity: str, reference: float, computed: float) -> Row:
    """Demand no less than the reference; the error is what is missing, relative to it."""
    missing = max(0.0, 1.0 - computed / reference) if math.isfinite(computed) else math.nan
    return Row(case, quantity, reference, computed, missing, 0.0)
