"""A quantity's first zero on a segment, from its values and derivatives at both ends.

Most segments need no series: bounds clear them, or its curvature keeps one sign and values at the ends
tell that the quantity crosses zero once.  One that dips between its ends is judged at the bottom of the
cubic through both of them: above zero by more than that may be off, it stays positive; below, it crosses
once on its way there.  Newton's method on the cubic then lands next to the crossing, and the motion's own
derivatives there lead to it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fdspec.compiler.options import fma, inlined
from fdspec.kernels.mathematics.oscillator import acceleration
from fdspec.kernels.mathematics.polynomial_roots import clears

CLEAR, CROSSES, UNCLEAR = 0, 1, 2
"""Verdicts: stays positive; crosses zero just once; needs a search."""

HALF, SIXTH, R_24, R_120 = 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0
"""One over a factorial; a division costs as much as four products."""

BEND_OFF, SLOPE_OFF, CUBIC_OFF = 1.0 / 8.0, math.sqrt(3.0) / 216.0, 1.0 / 384.0
"""Share of the bound on the fourth derivative by which the curvature leaves its end values, and slope and
value leave those of the cubic."""

NEAR = 4e-3
"""Phase (rad) within which five terms of a series are complete to rounding."""

SETTLED = 1e-9
"""A Newton step this short (rad) leaves an error of its square."""

ATTEMPTS = 6
"""Places from which the crossing is looked for before the search takes over."""


class Course(NamedTuple):
    """A quantity on a segment of length h: its value, slope times h, curvature times h^2 at both ends."""

    start: float
    start_rise: float
    start_bend: float
    end: float
    end_rise: float
    end_bend: float
    fourth: float
    """Bound on h^4 times its fourth derivative."""
    fifth: float
    """Bound on h^5 times its fifth."""


class Fall(NamedTuple):
    """The first part of a segment, where a quantity falls through zero: its value and rise at both ends."""

    start: float
    start_rise: float
    end: float
    end_rise: float
    share: float
    """Of the segment: all of it, or up to the bottom of a dip."""


class Rates(NamedTuple):
    """Derivatives of displacement by time at one instant: displacement itself first."""

    x: float
    v: float
    a: float
    j: float
    s: float
    c: float


@inlined
def is_clear(course):
    """Whether bounds alone keep the quantity positive: the usual case, worth asking first."""
    return clears(course.start, course.start_rise, course.end, course.end_rise, course.fourth)


@inlined
def cubic(start, start_rise, end, end_rise):
    """Coefficients of square and cube of the polynomial through values and rises at both ends."""
    drop = end - start
    return fma(3.0, drop, fma(-2.0, start_rise, -end_rise)), fma(-2.0, drop, start_rise + end_rise)


@inlined
def lowest(start, start_rise, end, end_rise):
    """Fraction of a segment at which a cubic that falls at the start and rises at the end is lowest."""
    square, cube = cubic(start, start_rise, end, end_rise)
    spread = fma(square, square, -3.0 * cube * start_rise)
    x = -start_rise / (square + math.sqrt(max(spread, 0.0)))
    return min(max(x, 0.0), 1.0)


@inlined
def verdict(course):
    """Whether the quantity stays positive on the segment, crosses zero once, or neither is sure."""
    margin = BEND_OFF * course.fourth
    bends_down = max(course.start_bend, course.end_bend) + margin < 0.0
    bends_up = min(course.start_bend, course.end_bend) - margin > 0.0
    sinks = clears(-course.start_rise, -course.start_bend, -course.end_rise, -course.end_bend, course.fifth)
    turns_outside = (course.start_rise >= 0.0) | (course.end_rise <= 0.0)
    ends_above = course.end > 0.0
    # One that bends up and ends at zero, rising, has crossed it once before.
    comes_back = (course.end == 0.0) & (course.end_rise > 0.0)
    stays = is_clear(course) | (ends_above & (bends_down | (bends_up & turns_outside)))
    crosses = (not ends_above) & (bends_down | (bends_up & (not comes_back)) | sinks)
    sure = CROSSES if crosses else CLEAR
    return sure if (course.start > 0.0) & (stays | crosses) else UNCLEAR


@inlined
def fall_of(course):
    """The `Fall` of a quantity that crosses zero once on the segment."""
    return Fall(course.start, course.start_rise, course.end, course.end_rise, 1.0)


@inlined
def dip_verdict(course):
    """The verdict on a quantity that may dip below zero between ends above it, and its `Fall`.

    It falls at the start, rises at the end and curves up all the way, so it crosses zero once on its way to
    any place where it is below.
    """
    square, cube = cubic(course.start, course.start_rise, course.end, course.end_rise)
    x = lowest(course.start, course.start_rise, course.end, course.end_rise)
    height = fma(x, fma(x, fma(x, cube, square), course.start_rise), course.start)
    slope = fma(x, fma(3.0 * x, cube, 2.0 * square), course.start_rise)
    # With at least this bend, nowhere is it further below than slope^2 / (2 bend).
    bend = min(course.start_bend, course.end_bend) - BEND_OFF * course.fourth
    tilt = fma(SLOPE_OFF, course.fourth, abs(slope))
    off = CUBIC_OFF * course.fourth
    dips = (course.start > 0.0) & (course.end > 0.0) & (course.start_rise < 0.0) & (course.end_rise > 0.0)
    stays = (height > off) & (2.0 * bend * (height - off) > tilt * tilt)
    sure = CLEAR if stays else CROSSES
    found = sure if dips & (bend > 0.0) & (stays | (height < -off)) else UNCLEAR
    return found, Fall(course.start, x * course.start_rise, height, 0.0, x)


@inlined
def judged(course):
    """The verdict on a quantity, by its ends or by the bottom of its dip, and its `Fall`."""
    found = verdict(course)
    if found != UNCLEAR:
        return found, fall_of(course)
    return dip_verdict(course)


@inlined
def leaves_zero(rise, bend, twist, fourth, noise):
    """Whether a quantity that is zero at the start surely is positive from there on.

    rise (at least 0), bend, twist: its first three derivatives there times h, h^2, h^3; noise: what
    bend may be off by.
    """
    rest = SIXTH * min(0.0, twist) - R_24 * fourth
    return (0.5 * (bend - noise) + rest > 0.0) | (rise + 0.5 * min(0.0, bend - noise) + rest > 0.0)


@inlined
def guess(fall):
    """Fraction of the segment at which the quantity crosses zero, nearly: where the cubic does."""
    square, cube = cubic(fall.start, fall.start_rise, fall.end, fall.end_rise)
    # From the chord, or in a dip from the parabola, which is level at its end.
    x = fall.start / (fall.start - fall.end)
    x = x if fall.share == 1.0 else 1.0 - math.sqrt(max(1.0 - x, 0.0))
    inside = True
    for _ in range(2):
        height = fma(x, fma(x, fma(x, cube, square), fall.start_rise), fall.start)
        slope = fma(x, fma(3.0 * x, cube, 2.0 * square), fall.start_rise)
        step = x - height / slope
        inside &= (step >= 0.0) & (step <= 1.0)
        x = step if inside else x
    return x * fall.share


@inlined
def rates_of(x, v, g, w2, p, p1):
    """Derivatives of an oscillator under force over mass p, which grows by p1."""
    a = acceleration(x, v, g, w2, p)
    j = acceleration(v, a, g, w2, p1)
    s = fma(-g, j, -w2 * a)
    return Rates(x, v, a, j, s, fma(-g, s, -w2 * j))


@inlined
def nearby(r, t):
    """Displacement and velocity a short time later, and the integral of displacement until then."""
    a, j, s = HALF * r.a, SIXTH * r.j, R_24 * r.s
    x = fma(t, fma(t, fma(t, fma(t, fma(t, R_120 * r.c, s), j), a), r.v), r.x)
    v = fma(t, fma(t, fma(t, fma(t, R_24 * r.c, SIXTH * r.s), HALF * r.j), r.a), r.v)
    area = fma(t, fma(t, fma(t, fma(t, R_120 * r.s, R_24 * r.j), SIXTH * r.a), HALF * r.v), r.x)
    return x, v, t * area


@inlined
def falls(t, y1, y2, y3):
    """Whether a quantity falls through its zero a short time t away.

    One that starts above zero and rises there crosses it for the second time: at a segment's end that may
    be all that rounding shows of the first.
    """
    return fma(t, fma(t, HALF * y3, y2), y1) < 0.0


@inlined
def step_to_zero(y, y1, y2, y3, y4):
    """Time to the zero near by, from a value and its derivatives; and Newton's last step."""
    t = -y / y1
    step = 0.0
    for _ in range(2):
        height = fma(t, fma(t, fma(t, fma(t, R_24 * y4, SIXTH * y3), HALF * y2), y1), y)
        step = height / fma(t, fma(t, fma(t, SIXTH * y4, HALF * y3), y2), y1)
        t -= step
    return t, abs(step)
