"""Strain energy of a frame of N storeys: its area under the history and its maximum.

The energy is that of Filiatrault and Cherry's index, elastic and in every member, frame and braces alike.
On a step of `history.py` U is a polynomial: its integral is a Gauss quadrature, exact to rounding, and its
maximum is searched only where the reach of all drifts and stretches leaves room for one.
"""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.energy import strain_energy
from fdspec.kernels.frame.model import (
    BRACE_STIFFNESS,
    GROUND_STIFFNESS,
    STOREY_STIFFNESS,
)
from fdspec.kernels.frame.taylor import (
    DISPLACEMENT,
    OFFSET,
    TERMS,
    end_of_step,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude
from fdspec.kernels.mathematics.quadrature import NODES, WEIGHTS


@inner
def stretch_term(series, i, k):
    """Coefficient k of the stretch of the brace of storey i, counted from 1."""
    return series[DISPLACEMENT, i, k] - series[DISPLACEMENT, i - 1, k] - series[OFFSET, i, k]


@inner
def bound_on_strain(frame, dense_stiffness, series, n, c):
    """A strain energy (J) that is not exceeded on the step; c is room for N numbers."""
    total = 0.0
    for i in range(1, frame.shape[1] + 1):
        floor = 0.0
        drift = 0.0
        stretch = 0.0
        for k in range(n + 1):
            floor += abs(series[DISPLACEMENT, i, k])
            drift += abs(series[DISPLACEMENT, i, k] - series[DISPLACEMENT, i - 1, k])
            stretch += abs(stretch_term(series, i, k))
        total += frame[GROUND_STIFFNESS, i - 1] * floor * floor
        total += frame[STOREY_STIFFNESS, i - 1] * drift * drift
        total += frame[BRACE_STIFFNESS, i - 1] * stretch * stretch
        if dense_stiffness.shape[0] > 0:
            c[i - 1] = floor
    for i in range(dense_stiffness.shape[0]):
        for j in range(dense_stiffness.shape[0]):
            total += abs(dense_stiffness[i, j]) * c[i] * c[j]
    return 0.5 * total


@inner
def strain_series(frame, dense_stiffness, series, n, out):
    """Make out, of the full order, the series of U from those of displacements and slip offsets."""
    for k in range(TERMS):
        total = 0.0
        for j in range(max(0, k - n), min(k, n) + 1):
            m = k - j
            for i in range(1, frame.shape[1] + 1):
                x, y = series[DISPLACEMENT, i, j], series[DISPLACEMENT, i, m]
                total += frame[GROUND_STIFFNESS, i - 1] * x * y
                x, y = x - series[DISPLACEMENT, i - 1, j], y - series[DISPLACEMENT, i - 1, m]
                total += frame[STOREY_STIFFNESS, i - 1] * x * y
                x, y = stretch_term(series, i, j), stretch_term(series, i, m)
                total += frame[BRACE_STIFFNESS, i - 1] * x * y
            for i in range(dense_stiffness.shape[0]):
                force = 0.0
                for q in range(dense_stiffness.shape[0]):
                    force += dense_stiffness[i, q] * series[DISPLACEMENT, q + 1, m]
                total += force * series[DISPLACEMENT, i + 1, j]
        out[k] = 0.5 * total


@inner
def strain_of_step(frame, dense_stiffness, series, n, h, x, motion, c, most):
    """The integral of U over the first part x of a step, and the greater of its maximum and ``most``."""
    total = 0.0
    for node in range(len(NODES)):
        end_of_step(series, n, x * NODES[node], motion)
        total += WEIGHTS[node] * strain_energy(frame, dense_stiffness, motion)
    if bound_on_strain(frame, dense_stiffness, series, n, c) > most:
        strain_series(frame, dense_stiffness, series, n, c)
        power = 1.0
        for k in range(TERMS):
            c[k] *= power
            power *= x
        most = largest_magnitude(c, TERMS - 1, most)
    return total * x * h, most
