"""Many strengths of one oscillator under one ground motion."""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, inner
from fdspec.kernels.bilinear.history import history
from fdspec.kernels.bilinear.mode import MODE_SIZE, RADIANS, TERMS, fill_mode, rate_of, terms_for
from fdspec.kernels.bilinear.rigid import slide


@inner
def fastest(c, k, alpha):
    """Rate of the faster of the two modes, 1/s."""
    return max(rate_of(c, k), rate_of(c, alpha * k))


@inner
def parts_of(dt, c, k, alpha):
    """Steps a sample: each at most RADIANS of the faster of the two modes."""
    return max(1, int(math.ceil(dt * fastest(c, k, alpha) / RADIANS - 1e-9)))


@entry(
    types.void(
        given1d,
        types.float64,
        types.float64,
        types.float64,
        types.float64,
        float1d,
        float1d,
        types.boolean,
        types.boolean,
        types.int64,
        float2d,
    )
)
def bilinear_histories(ground, dt, c, k, alpha, strength, collapse, certify, rest, halvings, out):
    """Integrate the oscillator c, k (1/s, 1/s2) with hardening ratio alpha under each strength (m,), m/s2.

    collapse (m,): displacement at which collapse is called, m.  certify: close the energy balance; rest: go
    on after the record until nothing yields any more and the largest displacement is known.  halvings: of
    the steps; no result depends on it.  out (m, len(RESULTS)).
    """
    parts = parts_of(dt, c, k, alpha) << halvings
    n = terms_for(fastest(c, k, alpha) * dt / parts)
    series = np.zeros(TERMS)
    room = np.zeros(TERMS)
    units = np.zeros((4, TERMS))
    elastic = np.zeros(MODE_SIZE)
    hardening = np.zeros(MODE_SIZE)
    fill_mode(c, k, dt / parts, units, elastic)
    fill_mode(c, alpha * k, dt / parts, units, hardening)
    for i in range(strength.size):
        history(
            ground,
            dt,
            parts,
            c,
            k,
            alpha,
            strength[i],
            collapse[i],
            certify,
            rest,
            elastic,
            hardening,
            n,
            series,
            room,
            out[i],
        )


@entry(types.void(given1d, types.float64, float1d, float2d))
def rigid_histories(ground, dt, strength, out):
    """Slide a rigid block of each strength (m,), m/s2; out (m, len(RESULTS)) as above."""
    for i in range(strength.size):
        slide(ground, dt, strength[i], out[i])
