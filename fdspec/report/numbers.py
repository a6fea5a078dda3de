"""How the report writes numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np


def kilonewtons(forces: Any) -> str:
    """Write forces (N) of one or of many storeys in kN, the lowest first; one number where all are equal."""
    values = np.atleast_1d(forces) / 1e3
    return listed(values, lambda value: "no limit" if np.isinf(value) else rounded(value))


def rounded(value: float) -> str:
    """Write a number with three digits, and all of those before the point, long ones in groups: 12 600."""
    if abs(value) < 999.5:
        return f"{value:.3g}"
    return f"{value:.0f}" if abs(value) < 9999.5 else f"{value:,.0f}".replace(",", " ")


def listed(values: Any, write: Callable[[float], str]) -> str:
    """Write one number or many, and many that are equal once."""
    given = values[:1] if (values == values[0]).all() else values
    return ", ".join(write(float(value)) for value in given)


def percent(share: float) -> str:
    """Write a share as whole per cents, with the sign that a reduction has."""
    return f"{100.0 * share:.0f} %"
