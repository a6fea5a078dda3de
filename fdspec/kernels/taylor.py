"""Taylor series of a frame's motion over a step, and what is read from it.

Series are arrays (terms, N) of coefficients of powers of the fraction of the step: c[k] multiplies
x^k, x in [0, 1].  Four of them lie in one array ``series`` (4, TERMS, N + 1); column 0 is the ground,
which stands still, so that the storey below the first needs no case of its own.
"""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.frame import (
    BRACE_DAMPING,
    BRACE_STIFFNESS,
    COMPLIANCE,
    DASHPOT,
    FLOOR_SHARE,
    FRICTION,
    GIVEN_FORCE,
    GROUND_DAMPING,
    GROUND_STIFFNESS,
    HELD,
    KINETIC_SLIP_FORCE,
    MASSLESS,
    SLIDING_COMPLIANCE,
    SPRING,
    STOREY_DAMPING,
    STOREY_STIFFNESS,
)
from fdspec.kernels.types import STICK

TERMS = 40
"""Room for coefficients: enough for steps of five radians."""

FLOOR = 0
"""Displacement of the floors, m."""
OFFSET = 1
"""Slip offset, m."""
REACTION = 2
"""Reaction that keeps the sliding velocity constant, N."""
INERTIA = 3
"""Absolute acceleration of the floors, m/s2."""

DISPLACEMENT = 0
VELOCITY = 1
SLIP_OFFSET = 2
SLIDING_VELOCITY = 3
"""Rows of the ``state`` array (4, N)."""


@inner
def order_for(theta, extra):
    """Order at which the series over the phase theta (rad) is complete to rounding, and ``extra`` more.

    Accelerations lose two orders to the displacement.
    """
    term = 1.0
    order = 2
    while order < TERMS - 1 - extra:
        term *= theta / (order - 1)
        if term < 1e-17 and order >= 5:
            break
        order += 1
    return order + extra


@inner
def expand(
    frame, model, kind, dense_stiffness, dense_damping, state, fresh, phase, n, h, ground, rise, series
):
    """Fill the series of order n over the step h (s) that starts at ``state``.

    ground: the ground's acceleration at the start, m/s2; rise: its change over the step.  fresh[i]:
    how many leading terms of the sliding velocity vanish because a slip begins here.
    """
    size = frame.shape[1]
    u = series[FLOOR]
    o = series[OFFSET]
    reaction = series[REACTION]
    inertia = series[INERTIA]
    for i in range(size):
        u[0, i + 1] = state[DISPLACEMENT, i]
        u[1, i + 1] = state[VELOCITY, i] * h
        o[0, i + 1] = state[SLIP_OFFSET, i]
        o[1, i + 1] = state[SLIDING_VELOCITY, i] * h
    has_stiffness = dense_stiffness.shape[0] > 0
    has_damping = dense_damping.shape[0] > 0
    for k in range(n - 1):
        rate = (k + 1) / h
        factor = h * h / ((k + 1) * (k + 2))
        above = 0.0
        for i in range(size - 1, -1, -1):
            g = u[k, i + 1] - u[k, i]
            g_rate = (u[k + 1, i + 1] - u[k + 1, i]) * rate
            spring = frame[STOREY_STIFFNESS, i] * g + frame[STOREY_DAMPING, i] * g_rate
            brace = model[SPRING, i] * (g - o[k, i + 1]) + model[DASHPOT, i] * (
                g_rate - o[k + 1, i + 1] * rate
            )
            if k == 0:
                brace += model[GIVEN_FORCE, i]
            floor = (
                above
                - spring
                - frame[GROUND_STIFFNESS, i] * u[k, i + 1]
                - frame[GROUND_DAMPING, i] * u[k + 1, i + 1] * rate
            )
            if has_stiffness:
                for j in range(size):
                    floor -= dense_stiffness[i, j] * u[k, j + 1]
            if has_damping:
                total = 0.0
                for j in range(size):
                    total += dense_damping[i, j] * u[k + 1, j + 1]
                floor -= total * rate
            share = model[FLOOR_SHARE, i]
            r = share * floor + (1.0 - share) * brace
            a = floor - model[HELD, i] * brace
            slide = r
            if k == 0:
                a -= model[FRICTION, i]
                slide -= model[FRICTION, i]
            a *= model[COMPLIANCE, i]
            reaction[k, i + 1] = r
            inertia[k, i + 1] = a
            if k == 0:
                a -= ground
            elif k == 1:
                a -= rise
            u[k + 2, i + 1] = factor * a
            slide *= factor * model[SLIDING_COMPLIANCE, i]
            if fresh[i] > 1 and k == 0:
                slide = 0.0
            o[k + 2, i + 1] = slide
            above = spring + brace
    for i in range(size):
        if kind[i] == MASSLESS and phase[i] != STICK:
            follow_drift(frame, state, fresh, phase, n, h, u, o, i)


@inner
def follow_drift(frame, state, fresh, phase, n, h, u, o, i):
    """Series of the offset of a slipping massless brace: the drift less the brace's own stretch.

    The stretch is s F / k_d, towards which it relaxes at the rate k_d / c_d where there is a dashpot.
    """
    stiffness = frame[BRACE_STIFFNESS, i]
    damping = frame[BRACE_DAMPING, i]
    stretch = phase[i] * frame[KINETIC_SLIP_FORCE, i] / stiffness
    excess = 0.0
    decay = 0.0
    if damping > 0.0:
        decay = -stiffness / damping * h
        excess = u[0, i + 1] - u[0, i] - state[SLIP_OFFSET, i] - stretch
    else:
        o[0, i + 1] = u[0, i + 1] - u[0, i] - stretch
    for k in range(1, n + 1):
        excess *= decay / k
        o[k, i + 1] = u[k, i + 1] - u[k, i] - excess
    if fresh[i] > 0:
        o[1, i + 1] = 0.0


@inner
def shorten(series, n, x):
    """Rescale the series of a step to its first part x."""
    power = 1.0
    for k in range(1, n + 1):
        power *= x
        for which in range(series.shape[0]):
            for i in range(1, series.shape[2]):
                series[which, k, i] *= power


@inner
def end_of_step(series, phase, n, h, state):
    """Set the state to the end of the step."""
    u = series[FLOOR]
    o = series[OFFSET]
    for i in range(state.shape[1]):
        x = 0.0
        v = 0.0
        for k in range(n, 0, -1):
            x += u[k, i + 1]
            v += k * u[k, i + 1]
        state[DISPLACEMENT, i] = x + u[0, i + 1]
        state[VELOCITY, i] = v / h
        if phase[i] != STICK:
            x = 0.0
            v = 0.0
            for k in range(n, 0, -1):
                x += o[k, i + 1]
                v += k * o[k, i + 1]
            state[SLIP_OFFSET, i] = x + o[0, i + 1]
            state[SLIDING_VELOCITY, i] = v / h


@inner
def reaction_now(frame, model, dense_stiffness, dense_damping, state, i):
    """Reaction (N) that storey i would need to stick, its sliding velocity taken as zero."""
    size = frame.shape[1]
    u = state[DISPLACEMENT]
    v = state[VELOCITY]
    drift = u[i] - (u[i - 1] if i > 0 else 0.0)
    drift_rate = v[i] - (v[i - 1] if i > 0 else 0.0)
    brace = frame[BRACE_STIFFNESS, i] * (drift - state[SLIP_OFFSET, i]) + frame[BRACE_DAMPING, i] * drift_rate
    floor = (
        -frame[STOREY_STIFFNESS, i] * drift
        - frame[STOREY_DAMPING, i] * drift_rate
        - frame[GROUND_STIFFNESS, i] * u[i]
        - frame[GROUND_DAMPING, i] * v[i]
    )
    if i + 1 < size:
        j = i + 1
        drift = u[j] - u[i]
        drift_rate = v[j] - v[i]
        floor += (
            frame[STOREY_STIFFNESS, j] * drift
            + frame[STOREY_DAMPING, j] * drift_rate
            + model[SPRING, j] * (drift - state[SLIP_OFFSET, j])
            + model[DASHPOT, j] * (drift_rate - state[SLIDING_VELOCITY, j])
            + model[GIVEN_FORCE, j]
        )
    for j in range(dense_stiffness.shape[0]):
        floor -= dense_stiffness[i, j] * u[j]
    for j in range(dense_damping.shape[0]):
        floor -= dense_damping[i, j] * v[j]
    share = model[FLOOR_SHARE, i]
    return share * floor + (1.0 - share) * brace
