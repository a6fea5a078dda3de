"""A slider without mass on a brace with a dashpot: the offset lags behind what friction asks of the spring.

Its reaction is the force of spring and dashpot; where slip begins with less friction than held it, the
sliding velocity jumps, and no force does.
"""

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
from fdspec.kernels.devices.law import (
    constant_across,
    deformation,
    force_across,
    friction_limit,
    slides_freely,
    stiffness_across,
)
from fdspec.kernels.devices.layout import (
    DAMPING,
    KINETIC,
    KINKED,
    LOWER,
    PHASE,
    REGION,
    STATIC,
    STIFFNESS,
    TOUCHING,
    UPPER,
    VANISHING,
    O,
    V,
    Z,
)
from fdspec.kernels.devices.tally import close_travel
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT
from fdspec.kernels.types import STICK


@inner
def dashpot_guard(frame, law, state, series, j, n, signs, events):
    """Fraction of the step at which the link's mode ends; what ends it goes to events[j]."""
    events[j] = NOTHING
    if state.mode[PHASE, j] == STICK:
        x = first_slip(frame, state, series, j, n, forces_at_stake(frame, law, state, j), signs)
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
def slip_from_rest(frame, state, j, sign):
    """Let the slider give way in this direction."""
    state.mode[PHASE, j] = sign
    state.mode[TOUCHING, j] = 0
    state.mode[VANISHING, j] = 1 if frame.links[KINETIC, j] == frame.links[STATIC, j] else 0
    if frame.places[KINKED, j] != 0 and state.mode[REGION, j] == 0:
        state.mode[REGION, j] = sign
    close_travel(frame, state, j)


@inner
def stop_slipping(frame, state, j):
    """Stop where the sliding velocity is zero; without friction there is no stopping."""
    close_travel(frame, state, j)
    sign = state.mode[PHASE, j]
    state.sliders[Z, j] = 0.0
    if slides_freely(frame, j):
        state.mode[PHASE, j] = -sign
        state.mode[VANISHING, j] = 1
        return
    state.mode[PHASE, j] = STICK
    state.mode[VANISHING, j] = 0
    if frame.links[KINETIC, j] == frame.links[STATIC, j]:
        state.mode[TOUCHING, j] = sign
        state.mode[VANISHING, j] = 1


@inner
def begin_dashpot(frame, state, j):
    """Set the mode that the state at the start asks for.  Returns the direction in which the link gives way
    at once, 0 where it does not."""
    region = state.mode[REGION, j]
    offset = state.sliders[O, j]
    rate = state.floors[V, frame.places[UPPER, j]] - state.floors[V, frame.places[LOWER, j]]
    spring = frame.links[STIFFNESS, j] * (deformation(frame, state, j) - offset)
    state.sliders[Z, j] = 0.0
    if slides_freely(frame, j):
        force = stiffness_across(frame, j, region, 0) * offset + constant_across(frame, j, region, 0)
        speed = rate - (force - spring) / frame.links[DAMPING, j]
        sign = 1 if speed >= 0.0 else -1
        state.mode[PHASE, j] = sign
        if frame.places[KINKED, j] != 0 and region == 0:
            state.mode[REGION, j] = sign
        return 0
    reaction = spring + frame.links[DAMPING, j] * rate - force_across(frame, j, region, offset)
    if abs(reaction) <= friction_limit(frame, state, j):
        return 0
    return 1 if reaction > 0.0 else -1
