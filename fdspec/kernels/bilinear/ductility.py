"""The strengths at which a ductility is reached: scanned, bracketed and located.

Ductility is a continuous function of strength but not a monotonic one.  So the strengths below the elastic
one are scanned on a logarithmic grid; every change of sign of (ductility - target) brackets a root; a dip
or hump of the scan that comes near the target is followed to its bottom, where two more may hide.
"""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, inner, int1d
from fdspec.kernels.bilinear.entry import fastest, parts_of
from fdspec.kernels.bilinear.history import RESULTS, history
from fdspec.kernels.bilinear.mode import MODE_SIZE, TERMS, fill_mode, terms_for

PER_OCTAVE = 24
"""Strengths of the scan in each octave."""

MOST_OCTAVES = 24
"""An oscillator a millionth as strong as the elastic one has never been asked for."""

ALL_ABOVE = 2.0
"""The scan ends with an octave in which every ductility exceeds the largest target this many times."""

STEPS = 200
"""A bracket that shrinks by half in every other step is exhausted long before."""

GOLDEN = 0.3819660112501051
"""Share of a bracket at which golden section places its next point."""

DIP_STEPS = 24
"""Golden sections of a dip: its bottom to a hundred-thousandth of the scan's spacing."""


@inner
def peak(problem, ground, elastic, hardening, series, room, out, strength):
    """Peak displacement times stiffness, m/s2; infinite where the oscillator collapses."""
    dt, parts, n, c, k, alpha, collapse = problem
    history(
        ground,
        dt,
        parts,
        c,
        k,
        alpha,
        strength,
        collapse * strength / k,
        False,
        True,
        elastic,
        hardening,
        n,
        series,
        room,
        out,
    )
    return out[0] * k if out[8] != 1.0 else np.inf


@inner
def locate(problem, ground, elastic, hardening, series, room, out, target, low, high, at_low, at_high):
    """The strength between low and high at which peak - target strength changes its sign (Illinois)."""
    side = 0
    for step in range(STEPS):
        if step % 3 == 2 or not (np.isfinite(at_low) and np.isfinite(at_high)):
            middle = 0.5 * (low + high)
        else:
            middle = low - at_low * (high - low) / (at_high - at_low)
        if not low < middle < high:
            break
        now = peak(problem, ground, elastic, hardening, series, room, out, middle) - target * middle
        if now == 0.0:
            return middle
        if (now > 0.0) == (at_low > 0.0):
            low = middle
            at_low = now
            if side == 1:
                at_high *= 0.5
            side = 1
        else:
            high = middle
            at_high = now
            if side == -1:
                at_low *= 0.5
            side = -1
        if high - low <= 2e-15 * high:
            break
    return high if abs(at_high) < abs(at_low) else low


@inner
def follow_dip(problem, ground, elastic, hardening, series, room, out, target, low, high, sign):
    """A strength in [low, high] where sign (peak/strength - target) < 0, or 0 where the dip ends above."""
    a = low
    b = high
    x = a + GOLDEN * (b - a)
    y = b - GOLDEN * (b - a)
    at_x = sign * (peak(problem, ground, elastic, hardening, series, room, out, x) / x - target)
    at_y = sign * (peak(problem, ground, elastic, hardening, series, room, out, y) / y - target)
    for _ in range(DIP_STEPS):
        if at_x < 0.0:
            return x
        if at_y < 0.0:
            return y
        if at_x < at_y:
            b = y
            y = x
            at_y = at_x
            x = a + GOLDEN * (b - a)
            at_x = sign * (peak(problem, ground, elastic, hardening, series, room, out, x) / x - target)
        else:
            a = x
            x = y
            at_x = at_y
            y = b - GOLDEN * (b - a)
            at_y = sign * (peak(problem, ground, elastic, hardening, series, room, out, y) / y - target)
    return 0.0


@entry(
    types.float64(
        given1d,
        types.float64,
        types.float64,
        types.float64,
        types.float64,
        types.float64,
        float1d,
        float2d,
        int1d,
    )
)
def strengths_for(ground, dt, c, k, alpha, collapse, targets, roots, counts):
    """Fill roots[i, :counts[i]] with every strength, m/s2, at which the ductility targets[i] is reached.

    The largest comes first.  collapse: the ductility at which collapse is called.  Roots beyond the room
    are counted and not kept.  Returns the elastic strength; it is 0 where the ground is at rest.
    """
    parts = parts_of(dt, c, k, alpha)
    n = terms_for(fastest(c, k, alpha) * dt / parts)
    series = np.zeros(TERMS)
    room = np.zeros(TERMS)
    units = np.zeros((4, TERMS))
    out = np.zeros(len(RESULTS))
    elastic = np.zeros(MODE_SIZE)
    hardening = np.zeros(MODE_SIZE)
    fill_mode(c, k, dt / parts, units, elastic)
    fill_mode(c, alpha * k, dt / parts, units, hardening)
    problem = (dt, parts, n, c, k, alpha, collapse)
    strong = peak((dt, parts, n, c, k, alpha, np.inf), ground, elastic, hardening, series, room, out, 1e300)
    counts[:] = 0
    if strong == 0.0:
        return 0.0
    most = np.max(targets)
    points = np.zeros(PER_OCTAVE * MOST_OCTAVES + 1)
    found = np.zeros(PER_OCTAVE * MOST_OCTAVES + 1)
    points[0] = strong
    found[0] = 1.0
    size = 1
    below = 0
    while size < points.size:
        points[size] = strong * 2.0 ** (-size / PER_OCTAVE)
        found[size] = (
            peak(problem, ground, elastic, hardening, series, room, out, points[size]) / points[size]
        )
        below = below + 1 if found[size] > ALL_ABOVE * most else 0
        size += 1
        if below >= PER_OCTAVE:
            break
    for i in range(targets.size):
        target = targets[i]
        if target <= 1.0:
            roots[i, 0] = strong / target
            counts[i] = 1
            continue
        for j in range(size - 1):
            here = found[j] - target
            there = found[j + 1] - target
            cuts = 0
            middle = 0.0
            if (here > 0.0) != (there > 0.0):
                cuts = 1
            elif 0 < j:
                # points[j] is the middle of a dip or hump between its neighbours
                before = found[j - 1] - target
                sign = 1.0 if here > 0.0 else -1.0
                turns = sign * here <= sign * before and sign * here < sign * there
                near = abs(here) <= max(abs(before - here), abs(there - here))
                if turns and near and (before > 0.0) == (here > 0.0):
                    middle = follow_dip(
                        problem,
                        ground,
                        elastic,
                        hardening,
                        series,
                        room,
                        out,
                        target,
                        points[j + 1],
                        points[j - 1],
                        sign,
                    )
                    cuts = 2 if middle > 0.0 else 0
            for cut in range(cuts):
                high = points[j]
                low = points[j + 1]
                if cuts == 2:
                    high = points[j - 1] if cut == 0 else middle
                    low = middle if cut == 0 else points[j + 1]
                at_low = peak(problem, ground, elastic, hardening, series, room, out, low) - target * low
                at_high = peak(problem, ground, elastic, hardening, series, room, out, high) - target * high
                if counts[i] < roots.shape[1]:
                    roots[i, counts[i]] = locate(
                        problem,
                        ground,
                        elastic,
                        hardening,
                        series,
                        room,
                        out,
                        target,
                        low,
                        high,
                        at_low,
                        at_high,
                    )
                counts[i] += 1
    return strong
