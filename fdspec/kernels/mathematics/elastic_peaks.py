"""Peaks of many linear oscillators under one ground motion: the exact piecewise-linear recurrence.

Nigam and Jennings (1969): under an acceleration that is linear between samples, displacement and velocity
at a sample are linear in those at the sample before and in the two ground accelerations, without error.
Oscillators run in lanes, side by side. A second pass looks between the samples, only in those blocks of the
record where the continuous motion may exceed the largest sample; a bound on its curvature says which.
"""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, inlined, inner
from fdspec.kernels.mathematics.oscillator import TERMS, expand, rate_bound, series_order, step_map
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude

LANES = 8
"""Oscillators side by side: one register of AVX-512, two of AVX2."""

BLOCK = 128
"""Steps between stored states, from which the second pass starts again."""

# Rows of the flat array that holds the lanes.
X, V, XX, XV, XA, XB, VX, VV, VA, VB, G, W2, MOST_X, MOST_V, MOST_Y, ROWS = range(16)


@inlined
def step_lanes(p, start, end):
    """Take all lanes over one step, from ground acceleration ``start`` to ``end``, and keep their maxima.

    Not with max(): it looks for NaN, which keeps the compiler from the vector instruction.
    """
    for lane in range(LANES):
        x = p[X * LANES + lane]
        v = p[V * LANES + lane]
        xn = p[XX * LANES + lane] * x + p[XV * LANES + lane] * v
        xn += p[XA * LANES + lane] * start + p[XB * LANES + lane] * end
        vn = p[VX * LANES + lane] * x + p[VV * LANES + lane] * v
        vn += p[VA * LANES + lane] * start + p[VB * LANES + lane] * end
        y = p[G * LANES + lane] * vn + p[W2 * LANES + lane] * xn
        p[X * LANES + lane] = xn
        p[V * LANES + lane] = vn
        most = p[MOST_X * LANES + lane]
        p[MOST_X * LANES + lane] = most if most > abs(xn) else abs(xn)
        most = p[MOST_V * LANES + lane]
        p[MOST_V * LANES + lane] = most if most > abs(vn) else abs(vn)
        most = p[MOST_Y * LANES + lane]
        p[MOST_Y * LANES + lane] = most if most > abs(y) else abs(y)


@inner
def put_oscillator(p, lane, g, w2, h):
    """Set a lane to rest, with the coefficients of its step: on state, and on both ground accelerations."""
    m = step_map(g, w2, h)
    p[X * LANES + lane] = 0.0
    p[V * LANES + lane] = 0.0
    p[XX * LANES + lane] = m.xx
    p[XV * LANES + lane] = m.xv
    p[XA * LANES + lane] = m.x1 / h - m.x0
    p[XB * LANES + lane] = -m.x1 / h
    p[VX * LANES + lane] = m.vx
    p[VV * LANES + lane] = m.vv
    p[VA * LANES + lane] = m.v1 / h - m.v0
    p[VB * LANES + lane] = -m.v1 / h
    p[G * LANES + lane] = g
    p[W2 * LANES + lane] = w2


@inner
def run_blocks(p, ground, blocks):
    """Take all lanes through the motion; keep their states before, and their maxima in, each block."""
    n = ground.size - 1
    for b in range(blocks.shape[0]):
        for k in range(2 * LANES):
            blocks[b, k] = p[k]
        for lane in range(LANES):
            x = p[X * LANES + lane]
            v = p[V * LANES + lane]
            p[MOST_X * LANES + lane] = abs(x)
            p[MOST_V * LANES + lane] = abs(v)
            p[MOST_Y * LANES + lane] = abs(p[G * LANES + lane] * v + p[W2 * LANES + lane] * x)
        for i in range(b * BLOCK, min((b + 1) * BLOCK, n)):
            step_lanes(p, ground[i], ground[i + 1])
        for k in range(3 * LANES):
            blocks[b, 2 * LANES + k] = p[MOST_X * LANES + k]


@inner
def between_samples(g, w2, h, most_v, most_y, pga, rate):
    """How much the continuous |x| and |y| can exceed the larger of two neighbouring samples.

    An extremum lies within h/2 of a sample, and is flat: it exceeds that sample by at most h^2/8 times the
    largest second derivative. Those of x and of y = g x' + w2 x (minus the absolute acceleration) follow
    from x'' = -a_g - y, with the largest x' and y at samples; the phase of a step is at most 1, so that
    ``part`` is below 0.4.
    """
    e = h * h / 8.0
    part = e * (g * g + w2 + 0.5 * h * g * w2)
    bend = (pga + most_y + e * g * (rate + w2 * most_v)) / (1.0 - part)
    return e * bend, e * (g * (rate + g * bend + w2 * (most_v + 0.5 * h * bend)) + w2 * bend)


@inner
def look_between(p, lane, ground, h, x, v, first, last, more, best, c, d):
    """Walk through steps ``first`` to ``last`` from x, v; raise ``best`` to the continuous peaks."""
    g = p[G * LANES + lane]
    w2 = p[W2 * LANES + lane]
    order = 3 + series_order(rate_bound(g, w2) * h)  # at rest the motion begins with the forces' terms
    for i in range(first, last):
        start = ground[i]
        end = ground[i + 1]
        xn = p[XX * LANES + lane] * x + p[XV * LANES + lane] * v
        xn += p[XA * LANES + lane] * start + p[XB * LANES + lane] * end
        vn = p[VX * LANES + lane] * x + p[VV * LANES + lane] * v
        vn += p[VA * LANES + lane] * start + p[VB * LANES + lane] * end
        high = max(abs(x), abs(xn)) + more[0]
        y = max(abs(g * v + w2 * x), abs(g * vn + w2 * xn)) + more[1]
        if high > best[0] or y > best[1]:
            expand(c, order, x, v, g, w2, -start, (start - end) / h, h)
            best[0] = largest_magnitude(c, order, best[0])
            for k in range(order):
                d[k] = w2 * c[k] + g * (k + 1) * c[k + 1] / h
            best[1] = largest_magnitude(d, order - 1, best[1])
        x = xn
        v = vn


@entry(types.void(float1d, float1d, given1d, types.float64, float2d))
def elastic_peaks(omega, zeta, ground, h, out):
    """Fill out[0] with the largest |x|, m, and out[1] with the largest |x'' + a_g|, m/s2, of each oscillator.

    omega (rad/s) and zeta have one value an oscillator; ground (m/s2) is linear between samples h (s) apart.
    Starts at rest. Assumes rate_bound * h <= 1 for each: the caller subdivides the steps.
    """
    p = np.zeros(ROWS * LANES)
    blocks = np.empty((-(-(ground.size - 1) // BLOCK), 5 * LANES))
    c = np.empty(TERMS)
    d = np.empty(TERMS)
    best = np.empty(2)
    more = np.empty(2)
    pga = 0.0
    rate = 0.0
    for i in range(ground.size):
        pga = max(pga, abs(ground[i]))
        if i > 0:
            rate = max(rate, abs(ground[i] - ground[i - 1]) / h)
    for first in range(0, omega.size, LANES):
        count = min(LANES, omega.size - first)
        for lane in range(count):
            j = first + lane
            put_oscillator(p, lane, 2.0 * zeta[j] * omega[j], omega[j] * omega[j], h)
        run_blocks(p, ground, blocks)
        for lane in range(count):
            best[:] = 0.0
            most_v = 0.0
            for b in range(blocks.shape[0]):
                best[0] = max(best[0], blocks[b, 2 * LANES + lane])
                most_v = max(most_v, blocks[b, 3 * LANES + lane])
                best[1] = max(best[1], blocks[b, 4 * LANES + lane])
            g = p[G * LANES + lane]
            w2 = p[W2 * LANES + lane]
            more[0], more[1] = between_samples(g, w2, h, most_v, best[1], pga, rate)
            for b in range(blocks.shape[0]):
                x_may = blocks[b, 2 * LANES + lane] + more[0] > best[0]
                y_may = blocks[b, 4 * LANES + lane] + more[1] > best[1]
                if x_may or y_may:
                    last = min((b + 1) * BLOCK, ground.size - 1)
                    x = blocks[b, lane]
                    v = blocks[b, LANES + lane]
                    look_between(p, lane, ground, h, x, v, b * BLOCK, last, more, best, c, d)
            out[0, first + lane] = best[0]
            out[1, first + lane] = best[1]
