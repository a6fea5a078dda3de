"""A friction damper whose plate has mass: its guard, and its reset but for what its floor decides."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.guard import (
    NOTHING,
    PASS,
    SLIP,
    STOP,
    first_pass,
    first_slip,
    first_stop,
    forces_at_stake,
)
from fdspec.kernels.devices.law import bound_ahead, enter_region, meets_bearing, slides_freely
from fdspec.kernels.devices.layout import (
    CONTACTS,
    KINETIC,
    MASS,
    PHASE,
    REGION,
    STATIC,
    TOUCHING,
    UPPER,
    VANISHING,
    A,
    O,
    Z,
)
from fdspec.kernels.devices.tally import close_travel
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT
from fdspec.kernels.types import STICK


@inner
def plate_guard(frame, law, state, series, j, n, signs, events):
    """Fraction of the step at which the plate's mode ends; what ends it goes to events[j]."""
    events[j] = NOTHING
    if state.mode[PHASE, j] == STICK:
        scale = forces_at_stake(frame, law, state, j)
        scale += frame.links[MASS, j] * abs(series.floors[A, frame.places[UPPER, j], 0])
        x = first_slip(frame, state, series, j, n, scale, signs)
        if x < NO_ROOT:
            events[j] = SLIP
        return x
    x = first_stop(state, series, j, n)
    if x < NO_ROOT:
        events[j] = STOP
    passing = first_pass(frame, state, series, j, n)
    if passing < x:
        x = passing
        events[j] = PASS
    return x


@inner
def drops(frame, j):
    """Whether friction falls when slip begins."""
    return frame.links[KINETIC, j] < frame.links[STATIC, j]


@inner
def begin_slip(state, j, sign, vanishing):
    """Let the plate slip in this direction, from rest."""
    state.mode[PHASE, j] = sign
    state.mode[VANISHING, j] = vanishing
    state.mode[TOUCHING, j] = 0
    state.sliders[Z, j] = 0.0


@inner
def come_to_rest(frame, state, j):
    """Take note of a sliding velocity of zero.  Returns whether the floor has to decide what follows."""
    close_travel(frame, state, j)
    state.sliders[Z, j] = 0.0
    if slides_freely(frame, j):
        state.mode[PHASE, j] = -state.mode[PHASE, j]
        state.mode[VANISHING, j] = 1
        return False
    return True


@inner
def pass_bound(frame, state, j):
    """Go on beyond an end of the slot, or come back from it."""
    close_travel(frame, state, j)
    sign = state.mode[PHASE, j]
    before = state.mode[REGION, j]
    state.sliders[O, j] = bound_ahead(frame, j, before, sign)
    enter_region(frame, state, j, sign)
    if meets_bearing(before, state.mode[REGION, j]):
        state.tally[CONTACTS, j] += 1.0
