"""Units of acceleration that record files are written in."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.units import G

UNITS: Final = MappingProxyType(
    {
        "g": "g",
        "g0": "g",
        "gravity": "g",
        "m/s2": "m/s2",
        "m/s^2": "m/s2",
        "m/s/s": "m/s2",
        "m/sec2": "m/s2",
        "m/sec^2": "m/s2",
        "m/sec/sec": "m/s2",
        "cm/s2": "cm/s2",
        "cm/s^2": "cm/s2",
        "cm/s/s": "cm/s2",
        "cm/sec2": "cm/s2",
        "cm/sec^2": "cm/s2",
        "cm/sec/sec": "cm/s2",
        "gal": "cm/s2",
        "gals": "cm/s2",
        "mm/s2": "mm/s2",
        "mm/s^2": "mm/s2",
        "mm/s/s": "mm/s2",
        "mm/sec/sec": "mm/s2",
    }
)
"""How units are spelt, in lower case, and what they are called here."""


def unit_named(spelling: str) -> str:
    """Return our name of a unit, or say which are known."""
    name = UNITS.get(spelling.strip().lower())
    if name is None:
        raise InvalidInput(f"units must be g, m/s2, cm/s2 (gal) or mm/s2, not {spelling!r}")
    return name


def to_si(values: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Return values given in `unit` (one of our names) in m/s2."""
    if unit == "g":
        return values * G
    # Divided, not multiplied by 0.01: one rounding, of the number that the file shows.
    return values / {"m/s2": 1.0, "cm/s2": 100.0, "mm/s2": 1000.0}[unit]
