"""Work done over a step: Gauss-Legendre quadrature, exact to rounding over about 2 radians."""

from __future__ import annotations

import numpy as np

from fdspec.jit import inner
from fdspec.kernels.oscillator import INVERSE, StepLoss, step_map
from fdspec.kernels.roots import value_slope

_points, _weights = np.polynomial.legendre.leggauss(10)
NODES = tuple(float(x) for x in 0.5 * (1.0 + _points))
WEIGHTS = tuple(float(w) for w in 0.5 * _weights)

_points, _weights = np.polynomial.legendre.leggauss(5)
FEW_NODES = tuple(float(x) for x in 0.5 * (1.0 + _points))
FEW_WEIGHTS = tuple(float(w) for w in 0.5 * _weights)

SHORT = 0.3
"""Phase (rad) over which the few nodes are exact to rounding."""


@inner
def step_loss(g, w2, h):
    """The quadratic form of the integral of v^2 over a step of length h."""
    xx = xv = x0 = x1 = vv = v0 = v1 = p00 = p01 = p11 = 0.0
    for j in range(len(NODES)):
        to = step_map(g, w2, NODES[j] * h)
        weight = WEIGHTS[j] * h
        xx += weight * to.vx * to.vx
        xv += weight * to.vx * to.vv
        x0 += weight * to.vx * to.v0
        x1 += weight * to.vx * to.v1
        vv += weight * to.vv * to.vv
        v0 += weight * to.vv * to.v0
        v1 += weight * to.vv * to.v1
        p00 += weight * to.v0 * to.v0
        p01 += weight * to.v0 * to.v1
        p11 += weight * to.v1 * to.v1
    return StepLoss(xx, xv, x0, x1, vv, v0, v1, p00, p01, p11)


@inner
def series_area(c, n, h, x):
    """Integral of the displacement series c over the first part x of a step of length h."""
    total = 0.0
    for k in range(n, -1, -1):
        total = total * x + c[k] * INVERSE[k + 1]
    return total * x * h


@inner
def series_square(c, n, h, x):
    """Integral of velocity squared over the first part x of a step of length h; c as above."""
    total = 0.0
    for j in range(len(NODES)):
        rise = value_slope(c, 0, n, x * NODES[j])[1]
        total += WEIGHTS[j] * rise * rise
    return total * x / h


@inner
def short_square(c, n, h):
    """Integral of velocity squared over a whole step of at most SHORT radians; arguments as above."""
    total = 0.0
    for j in range(len(FEW_NODES)):
        rise = value_slope(c, 0, n, FEW_NODES[j])[1]
        total += FEW_WEIGHTS[j] * rise * rise
    return total / h
