"""What a guard is, and the helpers that all devices' guards share.

A guard is a polynomial of the fraction of a step, positive while the present mode lasts.  Where it starts at
zero because of the event that has just happened, its leading coefficients are zero by construction and are
set so: the first that is not tells where it goes.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.law import bound_ahead, friction_limit
from fdspec.kernels.devices.layout import (
    DAMPING,
    LOWER,
    PHASE,
    REACTION,
    REGION,
    STIFFNESS,
    TOUCHING,
    UPPER,
    VANISHING,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, first_root

NOTHING = 0
SLIP = 1
"""Slip, yield or contact begins; its direction is ``signs``."""
STOP = 2
"""The sliding velocity has come to zero, or a one-sided brace has let go."""
PASS = 3
"""The offset reaches the end of its region."""

ROUNDING = 16.0 * 2.0**-53
"""What a guard may be off by at its start, relative to the terms it is the difference of."""


@inner
def root_of(c, n):
    """First root of the guard in ``c``, without a search where its coefficients leave no room for one."""
    rest = 0.0
    for k in range(1, n + 1):
        rest += abs(c[k])
    if c[0] > rest:
        return NO_ROOT
    return first_root(c, 0, n, 1.0)


@inner
def clear_leading(c, vanishing):
    """Set the coefficients that vanish by construction to zero."""
    for k in range(vanishing):
        c[k] = 0.0


@inner
def snap(c, scale):
    """Take a guard that starts at zero, to rounding, to start there."""
    if abs(c[0]) <= ROUNDING * scale:
        c[0] = 0.0


@inner
def forces_at_stake(frame, law, state, j):
    """Sum of the magnitudes (N) of all that the reaction of a slider at rest is the difference of.

    Displacements may be far larger than the deformation that they leave, and their rounding with them.
    """
    upper = frame.places[UPPER, j]
    lower = frame.places[LOWER, j]
    floors = state.floors
    offset = abs(state.sliders[O, j])
    scale = frame.links[STIFFNESS, j] * (abs(floors[U, upper]) + abs(floors[U, lower]) + offset)
    scale += frame.links[DAMPING, j] * (abs(floors[V, upper]) + abs(floors[V, lower]))
    return scale + abs(law.constant[j]) + abs(law.across[j]) * offset


@inner
def first_slip(frame, state, series, j, n, scale, signs):
    """Where the reaction of a stuck slider reaches its limit; the direction goes to signs[j].

    scale: size of the forces of which the reaction is the difference, N.
    """
    limit = friction_limit(frame, state, j)
    if limit == math.inf:
        return NO_ROOT
    first = NO_ROOT
    c = series.c
    touching = state.mode[TOUCHING, j]
    reaction = series.sliders[REACTION, j, 0]
    rest = 0.0
    for k in range(1, n):
        rest += abs(series.sliders[REACTION, j, k])
    if touching == 0 and abs(reaction) + rest + ROUNDING * (scale + limit) < limit:
        return NO_ROOT
    for sign in (1, -1):
        for k in range(n):
            c[k] = -sign * series.sliders[REACTION, j, k]
        c[0] += limit
        snap(c, scale + limit)
        if touching == sign:
            clear_leading(c, state.mode[VANISHING, j])
        x = root_of(c, n - 1)
        if x < first:
            first = x
            signs[j] = sign
    return first


@inner
def first_stop(state, series, j, n):
    """Where the sliding velocity comes to zero."""
    c = series.c
    sign = state.mode[PHASE, j]
    for k in range(n + 1):
        c[k] = sign * series.sliders[Z, j, k]
    clear_leading(c, state.mode[VANISHING, j])
    return root_of(c, n)


@inner
def first_pass(frame, state, series, j, n):
    """Where the offset reaches the bound ahead of it."""
    sign = state.mode[PHASE, j]
    bound = bound_ahead(frame, j, state.mode[REGION, j], sign)
    if abs(bound) == math.inf:
        return NO_ROOT
    c = series.c
    for k in range(n + 1):
        c[k] = -sign * series.sliders[O, j, k]
    c[0] += sign * bound
    if state.mode[VANISHING, j] > 0:
        c[1] = 0.0
    return root_of(c, n)
