"""The options `--limit` and `--level` of `fdspec choose`, and what they come to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.table import table
from fdspec.units import G

if TYPE_CHECKING:
    from fdspec.choice.targets import Target

UNITS: Final = {"g": G, "kN": 1e3, "MN": 1e6, "mm": 1e-3, "cm": 1e-2, "%": 1e-2}
"""What may stand behind a number -> SI."""

LEVELS: Final = {"DE": 1.0, "MCE": 1.5}
"""Name of a design level -> factor on the records: the design earthquake is two thirds of the maximum
considered (ASCE/SEI 7-22, 11.4)."""


def limits_of(given: Sequence[str]) -> dict[str, float]:
    """Read `acceleration=0.5g`, SI units where none stands."""
    found = {}
    for text in given:
        name, _, value = text.partition("=")
        number, factor = value.strip(), 1.0
        for unit, of_unit in UNITS.items():
            if number.endswith(unit):
                number, factor = number.removesuffix(unit).strip(), of_unit
                break
        try:
            found[name.strip()] = float(number) * factor
        except ValueError:
            raise click.UsageError(
                f"--limit {text}: give NAME=VALUE, such as drift_ratio=0.01 or acceleration=0.5g"
            ) from None
    return found


def levels_of(given: Sequence[str]) -> list[float]:
    """Read factors, or names of `LEVELS`."""
    found = []
    for text in given:
        try:
            found.append(LEVELS.get(text.upper()) or float(text))
        except ValueError:
            raise click.UsageError(f"--level {text}: give a factor, or {' or '.join(LEVELS)}") from None
    return found or [1.0]


def told(target: Target, per_pretension: float) -> str:
    """Say what meets the limits, or which cannot be met and by how much."""
    from fdspec.report.numbers import kilonewtons
    from fdspec.report.targets import HEAD, limit_rows, missed, stretches

    shown = table(list(HEAD), limit_rows(target), left=("demand",))
    force = target.slip_force
    at = f"slip force {kilonewtons(force)} kN (pretension {kilonewtons(force / per_pretension)} kN)"
    if not target.met:
        return f"No slip force meets all limits: {missed(target)}, with a {at}.\n\n{shown}"
    return f"Least {at}.\nAll limits are met at slip forces of {stretches(target)}.\n\n{shown}"
