"""The step of a column of printed times, and whether it is one step at all."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.textfile import TextFile

STEP_IN_UNITS: Final = 5.0
"""A step that times show only after rounding must span this many units of their last digit.

Then rounding explains no more than 0.3 of a step, while a lost row shifts a time by half a step or more.
"""

_EXACT: Final = 2.0**52
"""Up to here a float holds every whole number."""


@dataclass
class PrintedTimes:
    """Times as a file prints them, and how exactly: with up to so many decimals or significant digits.

    A printer uses a fixed number of either and may drop zeros at the end, so that one time alone does not
    show its precision: the most among all times counts.
    """

    values: NDArray[np.float64]
    decimals: int
    digits: int
    first: int = 1
    skipped: tuple[int, ...] = ()

    def line(self, row: int) -> int:
        """Return the number of the line that a time stands in, past lines that are no rows."""
        number = self.first + row
        for line in self.skipped:
            number += line <= number
        return number

    @classmethod
    def of(cls, words: list[str], first: int = 1) -> PrintedTimes:
        """Return the times that words print, Fortran's exponents included."""
        decimals, digits = precision(words)
        values = np.array([float(word.replace("D", "E").replace("d", "e")) for word in words])
        return cls(values, decimals, digits, first)


def precision(words: list[str]) -> tuple[int, int]:
    """Return the most decimals and the most significant digits among printed numbers."""
    decimals, digits = -400, 0
    for word in words:
        whole, point, part = word.partition(".")
        if part.isdigit() or (not part and not point and word.isdigit()):
            decimals = max(decimals, len(part))
            digits = max(digits, len((whole + part).lstrip("+-0")), 1)
        else:
            shape = Decimal(word.upper().replace("D", "E")).as_tuple()
            decimals = max(decimals, -int(shape.exponent))
            digits = max(digits, len(shape.digits))
    return decimals, digits


def uniform_step(
    text: TextFile,
    times: PrintedTimes,
    given: float | None = None,
    unit: Fraction = Fraction(1),
) -> float:
    """Return the step, s, of printed times, or refuse unequal steps.

    Times that step equally as printed are taken as they are. Others may be rounded: each may be off by half a
    unit of its last digit, no more; the step is then the shortest decimal that the first and the last time
    allow, so that 0.00976 comes back as 0.00976. A `given` step, s, is checked against the times and
    returned. `unit` is that of the times, s.
    """
    values = times.values
    refuse_backward_steps(text, times)
    count = len(values) - 1
    size = float(unit)
    if given is None:
        exact = _exact_step(times)
        if exact is not None:
            return float(exact * unit)
    own = None if given is None else given / size
    step = float(values[-1] - values[0]) / count if own is None else own
    slack = _half_units(times) + 8 * np.finfo(float).eps * float(np.abs(values).max())
    allowed = slack + slack[0] + (slack[-1] if own is None else 0.0)
    off = np.abs(values - (values[0] + np.arange(len(values)) * step))
    coarse = own is None and step < 2.0 * STEP_IN_UNITS * float(slack.max())
    if coarse or (off > allowed).any():
        raise text.refusal(*unequal(times, size, given))
    return _shortest(step * size, values * size, slack * size) if given is None else given


def refuse_backward_steps(text: TextFile, times: PrintedTimes) -> None:
    """Refuse times that go backward, or nowhere."""
    values = times.values
    backward = np.flatnonzero(np.diff(values) < 0.0)
    if values[-1] <= values[0] or backward.size:
        k = int(backward[0]) + 1 if backward.size else len(values) - 1
        raise text.refusal(
            times.line(k), f"expected times that grow, found {values[k]:.10g} after {values[k - 1]:.10g}"
        )


def unequal(times: PrintedTimes, size: float = 1.0, given: float | None = None) -> tuple[int, str]:
    """Return the line of the oddest step, and what is wrong with it; times in units of `size`, s."""
    steps = np.diff(times.values) * size
    usual = float(np.median(steps)) if given is None else given
    odd = int(np.argmax(np.abs(steps - usual))) + 1
    problem = f"expected equal time steps of about {usual:.6g} s, found {steps[odd - 1]:.6g} s"
    hint = "; if the times have too few digits to show it, give dt; to interpolate between them, resample_to"
    return times.line(odd), problem + (hint if given is None else "")


def _exact_step(times: PrintedTimes) -> Fraction | None:
    """Return the step when all are equal as printed, to the last digit."""
    scale = 10.0**times.decimals if 0 <= times.decimals <= 15 else 0.0
    if not scale or float(np.abs(times.values).max()) * scale > _EXACT:
        return None
    scaled = np.rint(times.values * scale)
    steps = np.diff(scaled)
    return Fraction(int(steps[0]), 10**times.decimals) if (steps == steps[0]).all() else None


def _half_units(times: PrintedTimes) -> NDArray[np.float64]:
    """Return half a unit of the last digit of each time."""
    finest = 10.0 ** max(-times.decimals, -300)
    magnitude = np.floor(np.log10(np.maximum(np.abs(times.values), finest)))
    return np.asarray(0.5 * np.maximum(finest, 10.0 ** (magnitude + 1 - times.digits)))


def _shortest(step: float, times: NDArray[np.float64], slack: NDArray[np.float64]) -> float:
    """Return the shortest decimal near `step` that explains all times, each within its slack."""
    for digits in range(1, 17):
        candidate = float(f"{step:.{digits}g}")
        off = np.abs(times - (times[0] + np.arange(times.size) * candidate))
        if (off <= slack + slack[0]).all():
            return candidate
    return step
