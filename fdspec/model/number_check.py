"""Numbers that callers hand over: turned into floats, or refused by name."""

from __future__ import annotations

import math

from fdspec.errors import InvalidInput


def finite_number(argument: str, value: float) -> float:
    """Return `value` as a float, or say which argument is no finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InvalidInput(f"{argument} must be a number, not {value!r}") from None
    if not math.isfinite(number):
        raise InvalidInput(f"{argument} must be finite, not {value!r}")
    return number


def positive_number(argument: str, value: float, unit: str) -> float:
    """Return `value` as a float, or say which argument is not positive."""
    number = finite_number(argument, value)
    if number <= 0.0:
        raise InvalidInput(f"{argument} must be positive, in {unit}, not {value!r}")
    return number


def not_negative_number(argument: str, value: float) -> float:
    """Return `value` as a float, or say which argument is below 0."""
    number = finite_number(argument, value)
    if number < 0.0:
        raise InvalidInput(f"{argument} must be 0 or more, not {value!r}")
    return number
