"""Work done over a step: Gauss-Legendre quadrature, exact to rounding over about 2 radians."""

from __future__ import annotations

import numpy as np

from fdspec.compiler.options import fma, inner, seldom
from fdspec.kernels.mathematics.oscillator import INVERSE, SquareForm, step_map
from fdspec.kernels.mathematics.polynomial_roots import value_slope

_points, _weights = np.polynomial.legendre.leggauss(10)
NODES = 0.5 * (1.0 + _points)
WEIGHTS = 0.5 * _weights

_points, _weights = np.polynomial.legendre.leggauss(5)
FEW_NODES = 0.5 * (1.0 + _points)
FEW_WEIGHTS = 0.5 * _weights

SHORT = 0.3
"""Phase (rad) over which the few nodes are exact to rounding."""


@inner
def square_form(g, w2, h, of_velocity):
    """The quadratic form of the integral of v^2 over a step of length h, or else of x^2."""
    xx = xv = x0 = x1 = vv = v0 = v1 = p00 = p01 = p11 = 0.0
    for j in range(len(NODES)):
        to = step_map(g, w2, NODES[j] * h)
        x, v, p, q = to.xx, to.xv, to.x0, to.x1
        if of_velocity:
            x, v, p, q = to.vx, to.vv, to.v0, to.v1
        weight = WEIGHTS[j] * h
        xx += weight * x * x
        xv += weight * x * v
        x0 += weight * x * p
        x1 += weight * x * q
        vv += weight * v * v
        v0 += weight * v * p
        v1 += weight * v * q
        p00 += weight * p * p
        p01 += weight * p * q
        p11 += weight * q * q
    return SquareForm(xx, xv, x0, x1, vv, v0, v1, p00, p01, p11)


@inner
def series_area(c, n, h, x):
    """Integral of the displacement series c over the first part x of a step of length h."""
    total = 0.0
    for k in range(n, -1, -1):
        total = fma(total, x, c[k] * INVERSE[k + 1])
    return total * x * h


@inner
def series_square(c, n, h, x):
    """Integral of velocity squared over the first part x of a step of length h; c as above."""
    seldom()
    total = 0.0
    for j in range(len(NODES)):
        rise = value_slope(c, 0, n, x * NODES[j])[1]
        total = fma(WEIGHTS[j] * rise, rise, total)
    return total * x / h


@inner
def short_square(c, n, h):
    """Integral of velocity squared over a whole step of at most SHORT radians; arguments as above."""
    total = 0.0
    for j in range(len(FEW_NODES)):
        rise = value_slope(c, 0, n, FEW_NODES[j])[1]
        total = fma(FEW_WEIGHTS[j] * rise, rise, total)
    return total / h
