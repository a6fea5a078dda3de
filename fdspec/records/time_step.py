"""The step of a column of printed times, and whether it is one step at all."""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from fdspec.records.textfile import TextFile


def uniform_step(text: TextFile, first: int, words: list[str]) -> float:
    """Return the step of times printed as `words` (the first one in line `first`), or refuse unequal steps.

    Times are rounded by whoever printed them. Each may be off by half a unit of its last digit, no more; the
    step is then the shortest decimal that the first and the last time allow, so that 0.01 comes back as 0.01.
    """
    decimals = [Decimal(word.upper().replace("D", "E")) for word in words]
    times = np.array([float(value) for value in decimals])
    backwards = np.flatnonzero(np.diff(times) < 0.0)
    if backwards.size:
        number = first + int(backwards[0]) + 1
        raise text.refusal(number, f"expected times that grow, found {words[number - first]}")
    slack = _half_units(decimals, times) + 8 * np.finfo(float).eps * float(np.abs(times).max())
    span = float(times[-1] - times[0])
    count = len(words) - 1
    step = span / count
    if step <= 2.0 * float(slack.max()):
        raise text.refusal(first, "the times of the first column have too few digits to tell dt")
    ideal = times[0] + np.arange(len(words)) * step
    wrong = np.flatnonzero(np.abs(times - ideal) > slack + slack[0] + slack[-1])
    if wrong.size:
        steps = np.diff(times)
        odd = int(np.argmax(np.abs(steps - np.median(steps)))) + 1
        problem = f"expected equal time steps of about {np.median(steps):.6g} s, found {steps[odd - 1]:.6g} s"
        raise text.refusal(first + odd, problem)
    return _shortest(step, float(slack[0] + slack[-1]) / count)


def _half_units(decimals: list[Decimal], times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return half a unit of the last digit of each time, s.

    A printer uses a fixed number of decimals or of significant digits and may drop zeros at the end, so that
    one time alone does not show its precision: the most of either among all times counts.
    """
    shapes = [value.as_tuple() for value in decimals]
    exponents = [int(shape.exponent) for shape in shapes]
    most_decimals = min(exponents)
    most_digits = max(len(shape.digits) for shape in shapes)
    magnitude = np.floor(np.log10(np.maximum(np.abs(times), 10.0 ** max(most_decimals, -300))))
    units = np.maximum(10.0 ** max(most_decimals, -300), 10.0 ** (magnitude + 1 - most_digits))
    return np.asarray(0.5 * units)


def _shortest(value: float, allowed: float) -> float:
    """Return the shortest decimal within `allowed` of `value`."""
    for digits in range(1, 17):
        candidate = float(f"{value:.{digits}g}")
        if math.isclose(candidate, value, rel_tol=0.0, abs_tol=allowed):
            return candidate
    return value
