"""The oscillator between two changes of mode: a linear equation, whatever the signs of its constants.

    u'' + c u' + k u = -(a - b)        a linear in time, b constant

Elastic: k is the spring's stiffness and b the pull of the plastic offset; yielding: k is the hardening
stiffness, which may be zero or negative, and b the strength.  A step of at most RADIANS of the fastest
rate is a Taylor series complete to rounding.  Over a whole step of fixed length the series of the four
unit states (u, v, a at both ends) are summed once, and the motion is four products (Nigam and Jennings,
1969); so are the integral of u, and that of v^2 as a quadratic form.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.mathematics.oscillator import series_order
from fdspec.kernels.mathematics.quadrature import series_area

RADIANS = 1.0
"""Longest step in radians of the fastest rate: 20 terms then end below rounding."""

TERMS = 22
"""Coefficients of a series of u, at the most."""

BEYOND_ORDER = 4
"""Coefficients beyond the order of free motion: one, for they count from 0; the ground's begin later."""

U_ROW = 0
V_ROW = 4
INTEGRAL_ROW = 8
SQUARE_ROW = 12
BOUND_ROW = 22
MODE_SIZE = 25
"""Layout of a mode's constants: rows of u, v and the integral of u over (u, v, a0, a1); the ten products of
the quadratic form of the integral of v^2; three factors of the bounds."""


@inner
def rate_of(c, k):
    """Fastest rate of the equation, 1/s."""
    return 0.5 * (c + math.sqrt(c * c + 4.0 * abs(k)))


@inner
def terms_for(theta):
    """Coefficients that a step of this phase (rad) needs to be complete to rounding."""
    return min(TERMS, series_order(theta) + BEYOND_ORDER)


@inner
def expand(c, k, h, u, v, a0, rise, series, n):
    """Fill series[j], j < n, with the coefficients of u over x = t/h; a = a0 + rise x, less b, m/s2."""
    series[0] = u
    series[1] = v * h
    square = h * h
    series[2] = -0.5 * (square * (a0 + k * u) + c * h * series[1])
    series[3] = -(square * (rise + k * series[1]) + 2.0 * c * h * series[2]) / 6.0
    for j in range(2, n - 2):
        series[j + 2] = -(c * h * (j + 1) * series[j + 1] + k * square * series[j]) / ((j + 1) * (j + 2))


@inner
def sum_at(series, n, x):
    """Value of the series at x."""
    total = 0.0
    for j in range(n - 1, -1, -1):
        total = total * x + series[j]
    return total


@inner
def slope_at(series, n, x):
    """Derivative of the series by x."""
    total = 0.0
    for j in range(n - 1, 0, -1):
        total = total * x + j * series[j]
    return total


@inner
def product_of_slopes(one, other):
    """Integral over a whole step of the product of the slopes of two series of TERMS coefficients."""
    total = 0.0
    for n in range(2 * TERMS - 3):
        term = 0.0
        for j in range(max(0, n - TERMS + 2), min(n, TERMS - 2) + 1):
            term += (j + 1) * one[j + 1] * (n - j + 1) * other[n - j + 1]
        total += term / (n + 1)
    return total


@inner
def fill_mode(c, k, h, units, mode):
    """Fill the constants of whole steps of length h; units (4, TERMS): room for the unit states' series."""
    expand(c, k, h, 1.0, 0.0, 0.0, 0.0, units[0], TERMS)
    expand(c, k, h, 0.0, 1.0, 0.0, 0.0, units[1], TERMS)
    expand(c, k, h, 0.0, 0.0, 1.0, -1.0, units[2], TERMS)
    expand(c, k, h, 0.0, 0.0, 0.0, 1.0, units[3], TERMS)
    at = SQUARE_ROW
    for i in range(4):
        mode[U_ROW + i] = sum_at(units[i], TERMS, 1.0)
        mode[V_ROW + i] = slope_at(units[i], TERMS, 1.0) / h
        mode[INTEGRAL_ROW + i] = series_area(units[i], TERMS - 1, h, 1.0)
        for j in range(i, 4):
            weight = 1.0 if i == j else 2.0
            mode[at] = weight * product_of_slopes(units[i], units[j]) / h
            at += 1
    # Bounds on |u''| and |u'''| of a step by its two ends, see `reach`.
    sixth = h * h / 8.0
    first = 1.0 / (1.0 - sixth * abs(k))
    second = 1.0 / (1.0 - sixth * abs(k) - sixth * c * c * first)
    mode[BOUND_ROW] = first
    mode[BOUND_ROW + 1] = second
    mode[BOUND_ROW + 2] = sixth * c * first


@inner
def row_times(mode, row, u, v, a0, a1):
    """One row of the constants times the state."""
    return mode[row] * u + mode[row + 1] * v + mode[row + 2] * a0 + mode[row + 3] * a1


@inner
def squared_velocity(mode, u, v, a0, a1):
    """Integral of v^2 over a whole step."""
    q = mode[SQUARE_ROW:]
    return (
        u * (q[0] * u + q[1] * v + q[2] * a0 + q[3] * a1)
        + v * (q[4] * v + q[5] * a0 + q[6] * a1)
        + a0 * (q[7] * a0 + q[8] * a1)
        + q[9] * a1 * a1
    )


@inner
def reach(c, k, mode, v0, w0, v1, w1, slope):
    """Bounds on |u''| and |u'''| over a step with velocities v and accelerations w at its ends.

    A quantity differs from the straight line between its ends by at most h^2/8 times its largest second
    derivative; the equation gives that of u'' and of u' by u''' and u'', and the two are solved for.
    """
    drive = abs(slope) + abs(k) * max(abs(v0), abs(v1))
    second = mode[BOUND_ROW + 1] * (max(abs(w0), abs(w1)) + mode[BOUND_ROW + 2] * drive)
    third = mode[BOUND_ROW] * (drive + c * second)
    return second, third
