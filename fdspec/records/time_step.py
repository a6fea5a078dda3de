"""The step of a column of printed times, and whether it is one step at all."""

from __future__ import annotations

from decimal import Decimal
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.textfile import TextFile

STEP_IN_UNITS: Final = 5.0
"""A step that times show only after rounding must span this many units of their last digit.

Then rounding explains no more than 0.3 of a step, while a lost row shifts a time by half a step or more.
"""


def uniform_step(text: TextFile, first: int, words: list[str], given: float | None = None) -> float:
    """Return the step of times printed as `words` (the first one in line `first`), or refuse unequal steps.

    Times that step equally as printed are taken as they are. Others may be rounded: each may be off by half a
    unit of its last digit, no more; the step is then the shortest decimal that the first and the last time
    allow, so that 0.00976 comes back as 0.00976. A `given` step is checked against the times and returned.
    """
    decimals = [Decimal(word.upper().replace("D", "E")) for word in words]
    times = np.array([float(value) for value in decimals])
    _refuse_backward_steps(text, first, words, times)
    count = len(words) - 1
    if given is None:
        exact = decimals[1] - decimals[0]
        if all(after - before == exact for before, after in pairwise(decimals)):
            return float(exact)
    step = float(times[-1] - times[0]) / count if given is None else given
    slack = _half_units(decimals, times) + 8 * np.finfo(float).eps * float(np.abs(times).max())
    allowed = slack + slack[0] + (slack[-1] if given is None else 0.0)
    off = np.abs(times - (times[0] + np.arange(len(words)) * step))
    coarse = given is None and step < 2.0 * STEP_IN_UNITS * float(slack.max())
    if coarse or (off > allowed).any():
        raise _unequal(text, first, times, given)
    return _shortest(step, times, slack) if given is None else given


def _refuse_backward_steps(text: TextFile, first: int, words: list[str], times: NDArray[np.float64]) -> None:
    backward = np.flatnonzero(np.diff(times) < 0.0)
    if times[-1] <= times[0] or backward.size:
        k = int(backward[0]) + 1 if backward.size else len(words) - 1
        raise text.refusal(first + k, f"expected times that grow, found {words[k][:40]}")


def _unequal(text: TextFile, first: int, times: NDArray[np.float64], given: float | None) -> Exception:
    steps = np.diff(times)
    usual = float(np.median(steps)) if given is None else given
    odd = int(np.argmax(np.abs(steps - usual))) + 1
    problem = f"expected equal time steps of about {usual:.6g} s, found {steps[odd - 1]:.6g} s"
    hint = "; if the times have too few digits to show it, give dt" if given is None else ""
    return text.refusal(first + odd, problem + hint)


def _half_units(decimals: list[Decimal], times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return half a unit of the last digit of each time, s.

    A printer uses a fixed number of decimals or of significant digits and may drop zeros at the end, so that
    one time alone does not show its precision: the most of either among all times counts.
    """
    shapes = [value.as_tuple() for value in decimals]
    finest = 10.0 ** max(min(int(shape.exponent) for shape in shapes), -300)
    most_digits = max(len(shape.digits) for shape in shapes)
    magnitude = np.floor(np.log10(np.maximum(np.abs(times), finest)))
    return np.asarray(0.5 * np.maximum(finest, 10.0 ** (magnitude + 1 - most_digits)))


def _shortest(step: float, times: NDArray[np.float64], slack: NDArray[np.float64]) -> float:
    """Return the shortest decimal near `step` that explains all times, each within its slack."""
    for digits in range(1, 17):
        candidate = float(f"{step:.{digits}g}")
        off = np.abs(times - (times[0] + np.arange(times.size) * candidate))
        if (off <= slack + slack[0]).all():
            return candidate
    return step
