"""One linear oscillator x'' + g x' + w2 x = p0 + p1 t: closed form over a step, series within it.

g is damping over mass (2 zeta omega, 1/s), w2 stiffness over mass (omega^2, 1/s2), p0 and p1 force
over mass at the step's start and its rate.  The closed form carries whole steps; the Taylor series
about the step's start, complete to rounding, is what roots and extrema are searched in.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fdspec.compiler.options import fma, inlined, inner

SERIES_RADIANS = 1.0
"""Below this phase the closed form loses digits to cancellation, and the series is short."""

SIXTH = 1.0 / 6.0

TERMS = 30
"""Length of coefficient arrays: order 28 is rounding at 2 radians, the largest step searched."""

INVERSE = np.array([0.0, *(1.0 / k for k in range(1, TERMS + 1))])
"""1/k: a division costs as much as four products; an array, for a tuple would be taken apart by jumps."""


S_3, S_5, S_7, S_9, S_11, S_13, S_15 = ((-1.0) ** k / math.factorial(2 * k + 1) for k in range(1, 8))
C_2, C_4, C_6, C_8, C_10, C_12, C_14 = ((-1.0) ** k / math.factorial(2 * k) for k in range(1, 8))
"""Coefficients of sine and cosine."""

LAST_TERM = 1e-17
"""A series ends with a term below this, relative to the motion; what it leaves out is far below rounding."""

SHORT_ANGLE = 0.55
"""Angle (rad) up to which sine and cosine are summed by their series."""


class StepMap(NamedTuple):
    """x, velocity v and the integral of x at a step's end, linear in x, v, p0, p1 at its start."""

    xx: float
    xv: float
    x0: float
    x1: float
    vx: float
    vv: float
    v0: float
    v1: float
    ix: float
    iv: float
    i0: float
    i1: float


class SquareForm(NamedTuple):
    """Integral of v^2 or x^2 over a step: upper triangle of a quadratic form in x, v, p0, p1 at its start."""

    xx: float
    xv: float
    x0: float
    x1: float
    vv: float
    v0: float
    v1: float
    p00: float
    p01: float
    p11: float


@inlined
def dot4(a, x, b, y, c, z, d, w):
    """Sum of four products; the first waits for the others."""
    return fma(a, x, fma(b, y, fma(c, z, d * w)))


@inlined
def acceleration(x, v, g, w2, p):
    """x'' under force over mass p."""
    return fma(-g, v, fma(-w2, x, p))


@inner
def rate_bound(g, w2):
    """Bound r (1/s) on growth of derivatives: |d^k z/dt^k| <= r^k (|z| + |z'|/omega) in free motion.

    The norm of the map (z, z'/omega) -> (z', z''/omega), with zeta = g / (2 omega).
    """
    return 0.5 * g + math.sqrt(0.25 * g * g + w2)


@inner
def series_order(theta):
    """Order at which a Taylor series over the phase theta (rad) is complete to rounding."""
    term = 1.0
    order = 3
    for k in range(1, TERMS - 1):
        term *= theta / k
        order = k
        if term < LAST_TERM and k >= 5:
            break
    return order


@inner
def expand(c, n, x, v, g, w2, p0, p1, h):
    """Fill c[0..n]: x(s h) = sum c[k] s^k for s in [0, 1]."""
    gh = g * h
    wh = w2 * h * h
    c[0] = x
    c[1] = v * h
    c[2] = 0.5 * fma(-wh, x, fma(-gh, c[1], p0 * h * h))
    c[3] = SIXTH * fma(-2.0 * gh, c[2], fma(-wh, c[1], p1 * h * h * h))
    older = c[2]
    old = c[3]
    for k in range(4, n + 1):
        term = term_of(k, gh, wh, old, older)
        c[k] = term
        older = old
        old = term


@inlined
def term_of(k, gh, wh, old, older):
    """Term of order k of a series, from the two before it."""
    return fma(-gh * INVERSE[k], old, -wh * (INVERSE[k] * INVERSE[k - 1]) * older)


@inner
def series_column(x, v, g, w2, p0, p1, h, n):
    """Displacement, velocity and integral of displacement after h, by a series of order n."""
    gh = g * h
    wh = w2 * h * h
    older = x
    old = v * h
    end = older + old
    slope = old
    area = older + 0.5 * old
    for k in range(2, n + 1):
        drive = 0.0
        if k == 2:
            drive = 0.5 * p0 * h * h
        elif k == 3:
            drive = SIXTH * p1 * h * h * h
        term = drive + term_of(k, gh, wh, old, older)
        end += term
        slope += k * term
        area += term * INVERSE[k + 1]
        older = old
        old = term
    return end, slope / h, area * h


@inner
def step_map(g, w2, h):
    """The map of one step of length h, by the series for short steps, in closed form for long ones."""
    theta = rate_bound(g, w2) * h
    if theta <= SERIES_RADIANS:
        n = 3 + series_order(theta)  # the forces' terms begin that much later
        xx, vx, ix = series_column(1.0, 0.0, g, w2, 0.0, 0.0, h, n)
        xv, vv, iv = series_column(0.0, 1.0, g, w2, 0.0, 0.0, h, n)
        x0, v0, i0 = series_column(0.0, 0.0, g, w2, 1.0, 0.0, h, n)
        x1, v1, i1 = series_column(0.0, 0.0, g, w2, 0.0, 1.0, h, n)
        return StepMap(xx, xv, x0, x1, vx, vv, v0, v1, ix, iv, i0, i1)
    a = 0.5 * g
    square = w2 - a * a
    if square > 0.0:
        wd = math.sqrt(square)
        decay = math.exp(-a * h)
        sine = decay * math.sin(wd * h) / wd
        cosine = decay * math.cos(wd * h)
    elif square < 0.0:
        b = math.sqrt(-square)
        slow = math.exp(-w2 / (a + b) * h)
        fast = math.exp(-(a + b) * h)
        sine = 0.5 * (slow - fast) / b
        cosine = 0.5 * (slow + fast)
    else:
        decay = math.exp(-a * h)
        sine = decay * h
        cosine = decay
    xx = cosine + a * sine
    i_x = sine
    if w2 > 0.0:
        x0 = (1.0 - xx) / w2
        i_x = sine + g * x0
        x1 = (h - i_x) / w2
        i1 = (0.5 * h * h - x0 - g * x1) / w2
    else:  # no spring: x'' + g x' = p0 + p1 t
        x0 = (h - sine) / g
        i_x = h
        x1 = (0.5 * h * h - x0) / g
        i1 = (h * h * h / 6.0 - x1) / g
    return StepMap(xx, sine, x0, x1, -w2 * sine, cosine - a * sine, sine, x0, i_x, x0, x1, i1)


@inlined
def advance(step, x, v, p0, p1):
    """Displacement and velocity at the end of a step."""
    return (
        dot4(step.xx, x, step.xv, v, step.x0, p0, step.x1, p1),
        dot4(step.vx, x, step.vv, v, step.v0, p0, step.v1, p1),
    )


@inlined
def area(step, x, v, p0, p1):
    """Integral of displacement over a step."""
    return dot4(step.ix, x, step.iv, v, step.i0, p0, step.i1, p1)


@inlined
def opening(x, v, p0, p1, g, w2, h):
    """Terms of second and third order of a series over h, over h, and the sums of all up to there.

    Sums: rise of displacement over h; velocity; what `closing` makes the integral of displacement from.
    """
    second = 0.5 * h * acceleration(x, v, g, w2, p0)
    third = SIXTH * h * fma(-2.0 * g, second, h * fma(-w2, v, p1))
    rise = v + (second + third)
    slope = fma(3.0, third, fma(2.0, second, v))
    area = fma(0.25, third, fma(INVERSE[3], second, 0.5 * v))
    return second, third, rise, slope, area


@inlined
def closing(x, h, rise, slope, area):
    """Displacement, velocity and the integral of displacement from a series' sums."""
    return fma(h, rise, x), slope, h * fma(h, area, x)


@inner
def ahead(x, v, g, w2, p0, p1, h, n):
    """Displacement and velocity after h, and the integral of displacement, by a series of order n."""
    gh = g * h
    wh = w2 * h * h
    older, old, rise, slope, area = opening(x, v, p0, p1, g, w2, h)
    for k in range(4, n + 1):
        term = term_of(k, gh, wh, old, older)
        rise += term
        slope = fma(float(k), term, slope)
        area = fma(INVERSE[k + 1], term, area)
        older = old
        old = term
    return closing(x, h, rise, slope, area)


@inlined
def sine_cosine(x):
    """Sine and cosine of an angle of at most SHORT_ANGLE, to rounding, without a call."""
    y = x * x
    s = fma(y, fma(y, fma(y, fma(y, fma(y, fma(y, S_15, S_13), S_11), S_9), S_7), S_5), S_3)
    c = fma(y, fma(y, fma(y, fma(y, fma(y, fma(y, C_14, C_12), C_10), C_8), C_6), C_4), C_2)
    return fma(x * y, s, x), fma(y, c, 1.0)


@inlined
def undamped_ahead(x, v, omega, slowness, p0, p1, h):
    """The same for g = 0 in closed form; half angles leave no cancellation beyond that of p1's share.

    slowness: 1 / omega, s; h: at most 2 SHORT_ANGLE of phase, which holds a whole segment.
    """
    sine, cosine = sine_cosine(0.5 * omega * h)
    w2 = omega * omega
    drift = slowness * slowness
    rise = 2.0 * sine * sine * drift
    sine *= 2.0 * cosine * slowness
    late = (h - sine) * drift
    pull = fma(-w2, x, p0)
    end = fma(p1, late, fma(pull, rise, fma(v, sine, x)))
    slope = fma(fma(-w2, v, p1), rise, fma(pull, sine, v))
    area = fma(p1 * drift, fma(0.5 * h, h, -rise), fma(pull, late, fma(v, rise, x * h)))
    return end, slope, area


@inlined
def square_integral(loss, x, v, p0, p1):
    """Integral of velocity squared over a step."""
    of_x = fma(loss.xx, x, 2.0 * fma(loss.xv, v, fma(loss.x0, p0, loss.x1 * p1)))
    of_v = fma(loss.vv, v, 2.0 * fma(loss.v0, p0, loss.v1 * p1))
    of_p = fma(loss.p00, p0, 2.0 * loss.p01 * p1)
    return fma(x, of_x, fma(v, of_v, fma(p0, of_p, loss.p11 * p1 * p1)))
