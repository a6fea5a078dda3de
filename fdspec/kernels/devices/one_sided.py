"""A brace that pulls in one direction only, beyond its slack, and yields: tension-only braces.

Its stretch beyond the slack o is e = d g - o, d the direction; slack while e < 0, then taut with the force
k e, then yielding, which adds to the slack.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.guard import NOTHING, SLIP, STOP, clear_leading, root_of, snap
from fdspec.kernels.devices.law import deformation
from fdspec.kernels.devices.layout import (
    ANCHOR,
    CONTACTS,
    DIRECTION,
    LOWER,
    PHASE,
    STATIC,
    STIFFNESS,
    TOUCHING,
    TRAVEL,
    UPPER,
    VANISHING,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.devices.tally import close_travel
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT

SLACK = -1
TAUT = 0
YIELDING = 1


@inner
def stretch_guard(frame, state, series, j, n, factor, constant, vanishing):
    """First root of factor e + constant, e the stretch beyond the slack."""
    upper = frame.places[UPPER, j]
    lower = frame.places[LOWER, j]
    direction = factor * frame.links[DIRECTION, j]
    c = series.c
    for k in range(n + 1):
        c[k] = direction * (series.floors[U, upper, k] - series.floors[U, lower, k])
    offset = state.sliders[O, j]
    c[0] += constant - factor * offset
    snap(c, abs(state.floors[U, upper]) + abs(state.floors[U, lower]) + abs(offset) + abs(constant))
    clear_leading(c, vanishing)
    return root_of(c, n)


@inner
def one_sided_guard(frame, state, series, j, n, events):
    """Fraction of the step at which the brace's mode ends; what ends it goes to events[j]."""
    events[j] = NOTHING
    phase = state.mode[PHASE, j]
    vanishing = state.mode[VANISHING, j]
    touching = state.mode[TOUCHING, j]
    if phase == SLACK:
        x = stretch_guard(frame, state, series, j, n, -1.0, 0.0, vanishing)
        if x < NO_ROOT:
            events[j] = SLIP
        return x
    if phase == YIELDING:
        c = series.c
        for k in range(n + 1):
            c[k] = series.sliders[Z, j, k]
        snap(c, abs(state.floors[V, frame.places[UPPER, j]]) + abs(state.floors[V, frame.places[LOWER, j]]))
        clear_leading(c, vanishing)
        x = root_of(c, n)
        if x < NO_ROOT:
            events[j] = STOP
        return x
    x = stretch_guard(frame, state, series, j, n, 1.0, 0.0, vanishing if touching < 0 else 0)
    if x < NO_ROOT:
        events[j] = STOP
    strength = frame.links[STATIC, j]
    if strength < math.inf:
        longest = strength / frame.links[STIFFNESS, j]
        yields = stretch_guard(frame, state, series, j, n, -1.0, longest, vanishing if touching > 0 else 0)
        if yields < x:
            x = yields
            events[j] = SLIP
    return x


@inner
def change_one_sided(frame, state, j, event):
    """Let the brace become taut, yield, stop yielding or become slack."""
    close_travel(frame, state, j)
    phase = state.mode[PHASE, j]
    touched = state.mode[TOUCHING, j]
    state.mode[TOUCHING, j] = 0
    state.sliders[Z, j] = 0.0
    if phase == SLACK:
        state.mode[PHASE, j] = TAUT
        state.mode[TOUCHING, j] = -1
        state.mode[VANISHING, j] = 1
        state.tally[CONTACTS, j] += 1.0
    elif phase == YIELDING:
        state.mode[PHASE, j] = TAUT
        state.mode[TOUCHING, j] = 1
        state.mode[VANISHING, j] = 2
    elif event == SLIP:
        state.mode[PHASE, j] = YIELDING
        state.mode[VANISHING, j] = 1 if touched > 0 else 0
        state.tally[ANCHOR, j] = state.sliders[O, j]
    else:
        state.mode[PHASE, j] = SLACK
        state.mode[VANISHING, j] = 1
        state.tally[CONTACTS, j] += 1.0


@inner
def begin_one_sided(frame, state, j):
    """Set the mode that the state at the start asks for; one stretched beyond its strength has yielded."""
    stretch = frame.links[DIRECTION, j] * deformation(frame, state, j) - state.sliders[O, j]
    excess = stretch - frame.links[STATIC, j] / frame.links[STIFFNESS, j]
    state.mode[PHASE, j] = SLACK if stretch < 0.0 else TAUT
    if excess > 0.0:
        state.mode[TOUCHING, j] = 1
        state.mode[VANISHING, j] = 1
        state.sliders[O, j] += excess
        state.tally[TRAVEL, j] += excess
