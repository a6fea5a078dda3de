"""The least value of a piecewise smooth function of one variable, and all places nearly as good.

The response of a damped frame over its slip force has kinks, where another peak of the history becomes the
largest, and several local minima; it is the same for all forces at which the damper never slips. So it is
scanned, intervals that by the slopes beside them may hold the least value are divided again, and so are
those in which it leaves the band about the least. A dip narrower than the scan can be missed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Function = Callable[[FloatArray], FloatArray]

POINTS: Final = 64
"""Of the scan."""

FINEST: Final = 2.0**-12
"""Share of the range below which an interval is not divided further, unless the caller says otherwise."""

PARTS: Final = 8
"""Points that a divided interval is given."""

MOST_DIVIDED: Final = 12
"""Intervals divided at once for the least value, the most promising first."""

NEAR: Final = 0.01
"""Share above the least value up to which narrow dips are looked for between places."""

NARROW: Final = 8.0
"""Width of such a dip, in the finest intervals."""

GAIN: Final = 1e-5
"""What dividing an interval must promise, as a share of the least value."""


@dataclass(frozen=True)
class Scan:
    """A function at many places: x (n,), ascending; y (n,), inf where there is no value."""

    x: FloatArray
    y: FloatArray

    @property
    def least(self) -> float:
        """The least value found."""
        return float(self.y.min())

    @property
    def best(self) -> float:
        """The lowest place of the least value; NaN where there is no value at all."""
        return float(self.x[self.y.argmin()]) if np.isfinite(self.least) else np.nan

    def inside(self, share: float) -> NDArray[np.bool_]:
        """Whether each place is within this share of the least value."""
        return self.y <= (1.0 + share) * self.least

    def bands(self, share: float) -> FloatArray:
        """(m, 2): first and last place of each stretch within this share of the least value.

        A stretch that holds the end of the range goes on for ever.
        """
        if not np.isfinite(self.least):
            return np.empty((0, 2))
        steps = np.diff(self.inside(share).astype(np.int8), prepend=0, append=0)
        first, last = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1) - 1
        ends = np.where(last == self.x.size - 1, np.inf, self.x[last])
        return np.column_stack([self.x[first], ends])


def scan(
    function: Function, top: float, *, points: int = POINTS, finest: float = FINEST, share: float = 0.05
) -> Scan:
    """Scan a function from 0 to `top`, beyond which it is constant.

    function: values at many places at once, which it is handed in ascending order.  finest: share of the
    range below which an interval is not divided.  share: that of the band whose ends are located as well.
    """
    # Denser near zero, where what is good for a weak motion is found; the last is the constant's.
    x = top * np.linspace(0.0, 1.0, points) ** 1.5
    y = _values(function, x)
    while True:
        known, wide = Scan(x, y), np.diff(x) / top
        divided = (_promising(known, finest) | _edges(known, share)) & (wide > finest)
        divided |= _near(known) & (wide > NARROW * finest)
        if not divided.any():
            return known
        more = _within(x, divided)
        x = np.concatenate([x, more])
        order = np.argsort(x, kind="stable")
        x, y = x[order], np.concatenate([y, _values(function, more)])[order]


def _values(function: Function, x: FloatArray) -> FloatArray:
    y = np.asarray(function(x), dtype=np.float64)
    return np.where(np.isnan(y), np.inf, y)


def _within(x: FloatArray, divided: NDArray[np.bool_]) -> FloatArray:
    """Give PARTS places within each of these intervals."""
    first = np.flatnonzero(divided)
    shares = np.arange(1, PARTS + 1) / (PARTS + 1)
    return np.asarray((x[first, np.newaxis] + shares * (x[first + 1] - x[first])[:, np.newaxis]).ravel())


def _near(known: Scan) -> NDArray[np.bool_]:
    """Which intervals have an end next to the least value, and are not flat."""
    near = known.inside(NEAR)
    return np.asarray((near[:-1] | near[1:]) & (known.y[:-1] != known.y[1:]))


def _promising(known: Scan, finest: float) -> NDArray[np.bool_]:
    """Which intervals may hide a value below the least: they fall, or rise, from a local minimum.

    What an interval may hide is told from its neighbours: where the lines through them meet in a valley, that
    is its floor; and it may dip by as much as the function changes there or beside it.
    """
    x, y = known.x, known.y
    value = np.where(np.isfinite(y), y, 2.0 * np.max(y, initial=0.0, where=np.isfinite(y)) + 1.0)
    low = np.concatenate([[True], value[1:] <= value[:-1]]) & np.concatenate(
        [value[:-1] <= value[1:], [True]]
    )
    change = np.abs(np.diff(value))
    beside = np.maximum(np.concatenate([[0.0], change[:-1]]), np.concatenate([change[1:], [0.0]]))
    deepest = np.minimum(value[:-1], value[1:]) - np.maximum(change, beside)
    deepest = np.minimum(deepest, _valley(x, value))
    beside_low = low[:-1] | low[1:]
    flat = (change == 0.0) & (beside == 0.0)
    divisible = np.diff(x) > finest * x[-1]
    may = beside_low & ~flat & divisible & (deepest < (1.0 - GAIN) * value.min())
    if np.count_nonzero(may) > MOST_DIVIDED:
        may &= deepest <= np.sort(deepest[may])[MOST_DIVIDED - 1]
    return np.asarray(may)


def _valley(x: FloatArray, y: FloatArray) -> FloatArray:
    """Where, above each inner interval, the lines through the two beside it meet below both its ends."""
    found = np.full(x.size - 1, np.inf)
    if x.size < 4:
        return found
    slope = np.diff(y) / np.diff(x)
    left, right = slope[:-2], slope[2:]
    width = x[2:-1] - x[1:-2]
    meets = (left < 0.0) & (right > 0.0)
    steepness = np.where(meets, right - left, 1.0)
    reach = (y[1:-2] - y[2:-1] + right * width) / steepness
    inner = meets & (reach > 0.0) & (reach < width)
    found[1:-1] = np.where(inner, y[1:-2] + left * reach, np.inf)
    return found


def _edges(known: Scan, share: float) -> NDArray[np.bool_]:
    """Which intervals the function leaves the band in."""
    inside = known.inside(share)
    return np.asarray(inside[:-1] != inside[1:])
