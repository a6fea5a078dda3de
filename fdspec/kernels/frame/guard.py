"""The first change of phase on a step of a frame, storey by storey."""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import (
    BRACE_DAMPING,
    BRACE_MASS,
    BRACE_STIFFNESS,
    FRICTION,
    KINETIC_SLIP_FORCE,
    MASSLESS,
    NO_BRACE,
    PLAIN,
    SLIP_FORCE,
    SLOWNESS,
)
from fdspec.kernels.frame.reset import LAST, patience
from fdspec.kernels.frame.taylor import (
    ACCELERATION_REACH,
    DISPLACEMENT,
    INERTIA,
    JERK_REACH,
    OFFSET,
    REACTION,
    REACTION_REACH,
    SLIDING,
    VELOCITY,
)
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, first_root
from fdspec.kernels.types import STICK

SAME_INSTANT = 1e-12
"""Fraction of a step (of at most a few radians) that counts as no time: far below what rounding leaves
of a root's place, so storeys that change within it change together."""


@inner
def search(
    frame,
    model,
    kind,
    phase,
    vanishing,
    touching,
    tally,
    series,
    reach,
    state,
    n,
    h,
    at,
    radian,
    ground,
    rise,
    c,
    instants,
    signs,
):
    """Fill instants[i], the fraction of the step at which storey i changes, and signs[i], its direction.

    Return the smallest instant (NO_ROOT where there is none).  A storey that has just begun to slip has
    vanishing[i] leading terms of its sliding velocity that vanish; one that has just stuck at its limit, in
    direction touching[i], as many of its distance to the limit.  A massless brace that has just stuck is
    known to carry kinetic friction, so the first of them is the difference to static friction.

    at: time at the start, s; radian: time (s) in which a storey makes no more than a few changes, see
    :func:`fdspec.kernels.frame.reset.patience`.
    """
    first = NO_ROOT
    for i in range(phase.size):
        instants[i] = NO_ROOT
        if kind[i] == NO_BRACE:
            continue
        held = 0.0
        gap = 0.0
        if kind[i] == MASSLESS or frame[SLIP_FORCE, i] == 0.0:
            held = max(0.0, tally[LAST, i] + patience(tally, i, radian) - at) / h
            gap = frame[SLIP_FORCE, i] - frame[KINETIC_SLIP_FORCE, i]
            if held >= 1.0:
                continue
        if phase[i] == STICK:
            room = frame[SLIP_FORCE, i] - reach[REACTION_REACH, i]
            if touching[i] != 0 or not abs(series[REACTION, i + 1, 0]) < room:
                instants[i] = search_stick(
                    series,
                    n - 1,
                    frame[SLIP_FORCE, i],
                    room,
                    touching[i],
                    gap,
                    vanishing[i],
                    held,
                    c,
                    signs,
                    i,
                )
        else:
            signs[i] = phase[i]
            easy = vanishing[i] == 0 and kind[i] == PLAIN
            if easy and slips_on(frame, model, phase[i], series, reach, state, h, ground, rise, i):
                continue
            if vanishing[i] > 1:
                series[SLIDING, i + 1, 1] = 0.0
            for k in range(n + 1):
                c[k] = series[SLIDING, i + 1, k]
            instants[i] = first_root_after(c, n, float(phase[i]), held)
        first = min(first, instants[i])
    return first


@inner
def slips_on(frame, model, sign, series, reach, state, h, ground, rise, i):
    """Whether the sliding velocity surely keeps its sign on the step.

    The brace swings about the floor below with an amplitude that grows by no more than that floor's
    jerk makes it; the floor itself changes its velocity by no more than its acceleration makes it.
    """
    mass = frame[BRACE_MASS, i]
    stiffness = frame[BRACE_STIFFNESS, i]
    drift = state[DISPLACEMENT, i]
    drift_rate = state[VELOCITY, i]
    pull = abs(series[INERTIA, i + 1, 0]) + reach[ACCELERATION_REACH, i]
    if i > 0:
        drift -= state[DISPLACEMENT, i - 1]
        drift_rate -= state[VELOCITY, i - 1]
        below = series[INERTIA, i, 0]
        jerk = reach[JERK_REACH, i - 1]
        pull += abs(below) + reach[ACCELERATION_REACH, i - 1]
    else:
        below = ground
        jerk = abs(rise)
        pull += abs(ground) + jerk
    swing = drift_rate - state[SLIDING, i]
    stretch = drift - state[OFFSET, i]
    lag = (model[FRICTION, i] - stiffness * stretch - frame[BRACE_DAMPING, i] * swing) / mass - below
    slowness = model[SLOWNESS, i]
    lag *= slowness
    ring = math.sqrt(swing * swing + lag * lag) + jerk * slowness
    return sign * drift_rate - h * pull > ring


@inner
def first_root_after(c, n, sign, held):
    """First root from the fraction ``held`` on; ``held`` itself where the polynomial is below zero there.

    The coefficients are used up.
    """
    x = first_root(c, 0, n, sign)
    if x >= held:
        return x
    # The polynomial of y in x = held + (1 - held) y.
    for j in range(n):
        for k in range(n - 1, j - 1, -1):
            c[k] += held * c[k + 1]
    power = 1.0
    for k in range(n + 1):
        c[k] *= power
        power *= 1.0 - held
    x = first_root(c, 0, n, sign)
    return x if x > 1.0 else held + (1.0 - held) * x


@inner
def search_stick(series, n, limit, room, touching, gap, vanishing, held, c, signs, i):
    """Where |reaction| reaches the limit; its direction goes to signs[i]."""
    first = NO_ROOT
    for sign in (1, -1):
        if sign * series[REACTION, i + 1, 0] < room and touching != sign:
            continue
        for k in range(n + 1):
            c[k] = -sign * series[REACTION, i + 1, k]
        c[0] += limit
        if touching == sign:
            for k in range(vanishing):
                c[k] = 0.0
            c[0] += gap
        x = first_root_after(c, n, 1.0, held)
        if x < first:
            first = x
            signs[i] = sign
    return first
