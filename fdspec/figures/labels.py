"""Names of variables and units as they stand at an axis."""

from __future__ import annotations

from typing import Final

from fdspec.printable import in_words

MEASURES: Final = {
    "pga": "peak ground acceleration",
    "pgv": "peak ground velocity",
    "pgd": "peak ground displacement",
    "sa": "spectral acceleration",
    "arias": "Arias intensity",
    "cav": "cumulative absolute velocity",
}
"""Measures of intensity that go by their letters in files."""

POWERS: Final = {"^2": "²", "^3": "³"}


SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def plain(value: float) -> str:
    """Return a number in two digits as people write it.

    Examples
    --------
    >>> plain(0.57), plain(9.33e-05), plain(7020.0)
    ('0.57', '9.3 × 10⁻⁵', '7000')
    """
    number, _, power = f"{value:.2g}".partition("e")
    if not power:
        return number
    whole = int(power)
    return (
        f"{float(number) * 10**whole:.0f}"
        if whole > 0
        else f"{number} × 10{str(whole).translate(SUPERSCRIPTS)}"
    )


def axis_label(name: str, unit: str = "1") -> str:
    """Return what stands at an axis: words, and the unit where there is one.

    Examples
    --------
    >>> axis_label("pga", "m/s^2")
    'peak ground acceleration, m/s²'
    >>> axis_label("peak_drift_ratio", "1")
    'peak drift ratio'
    """
    for power, sign in POWERS.items():
        unit = unit.replace(power, sign)
    words = MEASURES.get(name.lower(), in_words(name))
    return words if unit in ("", "1") else f"{words}, {unit}"
