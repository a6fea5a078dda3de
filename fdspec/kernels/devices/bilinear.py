"""A slider without mass at the end of its brace: columns that yield, massless dampers, flag-shaped joints.

The brace's force is the slider's at all times.  While it slips, the offset follows the deformation, and it
stops where the deformation's rate comes to zero.
"""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.guard import (
    NOTHING,
    PASS,
    SLIP,
    STOP,
    clear_leading,
    first_pass,
    first_slip,
    forces_at_stake,
    root_of,
    snap,
)
from fdspec.kernels.devices.law import (
    bound_ahead,
    constant_across,
    deformation,
    enter_region,
    force_across,
    friction_limit,
    meets_bearing,
    slides_freely,
    stiffness_across,
    stored_across,
)
from fdspec.kernels.devices.layout import (
    ANCHOR,
    CONTACTS,
    KINETIC,
    KINKED,
    LOWER,
    PHASE,
    REGION,
    STATIC,
    STIFFNESS,
    TOUCHING,
    TRAVEL,
    UPPER,
    VANISHING,
    WORK,
    O,
    V,
    Z,
)
from fdspec.kernels.devices.tally import close_travel
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT
from fdspec.kernels.types import STICK


@inner
def bilinear_guard(frame, law, state, series, j, n, signs, events):
    """Fraction of the step at which the link's mode ends; what ends it goes to events[j]."""
    events[j] = NOTHING
    if state.mode[PHASE, j] == STICK:
        x = first_slip(frame, state, series, j, n, forces_at_stake(frame, law, state, j), signs)
        if x < NO_ROOT:
            events[j] = SLIP
        return x
    c = series.c
    sign = state.mode[PHASE, j]
    for k in range(n + 1):
        c[k] = sign * series.sliders[Z, j, k]
    snap(c, abs(state.floors[V, frame.places[UPPER, j]]) + abs(state.floors[V, frame.places[LOWER, j]]))
    clear_leading(c, state.mode[VANISHING, j])
    x = root_of(c, n)
    if x < NO_ROOT:
        events[j] = STOP
    passing = first_pass(frame, state, series, j, n)
    if passing < x:
        x = passing
        events[j] = PASS
    return x


@inner
def yield_from_rest(frame, state, j, sign):
    """Let the slider give way in this direction.  Returns whether the brace's force jumps.

    Where friction falls the brace springs back at once, across corners if need be, and friction takes what it
    loses.
    """
    touched = state.mode[TOUCHING, j] != 0
    state.mode[PHASE, j] = sign
    state.mode[VANISHING, j] = 1 if touched else 0
    state.mode[TOUCHING, j] = 0
    if frame.places[KINKED, j] != 0 and state.mode[REGION, j] == 0:
        state.mode[REGION, j] = sign
    state.tally[ANCHOR, j] = state.sliders[O, j]
    if frame.links[KINETIC, j] == frame.links[STATIC, j]:
        return False
    spring_back(frame, state, j, sign)
    state.mode[VANISHING, j] = 0
    return True


@inner
def spring_back(frame, state, j, sign):
    """Move the offset at once to where kinetic friction holds the brace."""
    stiffness = frame.links[STIFFNESS, j]
    drift = deformation(frame, state, j)
    start = state.sliders[O, j]
    before = 0.5 * stiffness * (drift - start) * (drift - start)
    before += stored_across(frame, j, state.mode[REGION, j], start)
    offset = start
    for _ in range(4):
        region = state.mode[REGION, j]
        across = stiffness_across(frame, j, region, sign)
        offset = (stiffness * drift - constant_across(frame, j, region, sign)) / (stiffness + across)
        bound = bound_ahead(frame, j, region, sign)
        if sign * (bound - offset) >= 0.0:
            break
        offset = bound
        resting = enter_region(frame, state, j, sign)
        if meets_bearing(region, state.mode[REGION, j]):
            state.tally[CONTACTS, j] += 1.0
        if resting:
            break
    if sign * (offset - start) < 0.0:
        offset = start
    after = 0.5 * stiffness * (drift - offset) * (drift - offset)
    after += stored_across(frame, j, state.mode[REGION, j], offset)
    state.sliders[O, j] = offset
    state.tally[WORK, j] += before - after
    state.tally[TRAVEL, j] += abs(offset - start)
    state.tally[ANCHOR, j] = offset


@inner
def stop_yielding(frame, state, j):
    """Stop where the deformation turns; a slider without friction turns with it."""
    close_travel(frame, state, j)
    state.sliders[Z, j] = 0.0
    sign = state.mode[PHASE, j]
    if slides_freely(frame, j):
        state.mode[PHASE, j] = -sign
        state.mode[VANISHING, j] = 1
        return
    state.mode[PHASE, j] = STICK
    state.mode[VANISHING, j] = 0
    if frame.links[KINETIC, j] == frame.links[STATIC, j]:
        state.mode[TOUCHING, j] = sign
        state.mode[VANISHING, j] = 2


@inner
def pass_corner(frame, state, j):
    """Go on to the next line of the law; rest at the corner that a preload makes.

    Returns whether it rests there.
    """
    close_travel(frame, state, j)
    sign = state.mode[PHASE, j]
    before = state.mode[REGION, j]
    bound = bound_ahead(frame, j, before, sign)
    state.sliders[O, j] = bound
    state.tally[ANCHOR, j] = bound
    resting = enter_region(frame, state, j, sign)
    state.mode[VANISHING, j] = 0
    state.mode[TOUCHING, j] = 0
    if resting:
        state.sliders[Z, j] = 0.0
    if meets_bearing(before, state.mode[REGION, j]):
        state.tally[CONTACTS, j] += 1.0
    return resting


@inner
def begin_bilinear(frame, state, j):
    """Set the mode that the state at the start asks for.  Returns the direction in which the link gives way
    at once, 0 where it does not."""
    drift = deformation(frame, state, j)
    state.sliders[Z, j] = 0.0
    region = state.mode[REGION, j]
    offset = state.sliders[O, j]
    reaction = frame.links[STIFFNESS, j] * (drift - offset) - force_across(frame, j, region, offset)
    sign = 1 if reaction >= 0.0 else -1
    if slides_freely(frame, j):
        state.mode[PHASE, j] = sign
        if frame.places[KINKED, j] != 0 and region == 0:
            state.mode[REGION, j] = sign
        spring_back(frame, state, j, sign)
        rate = state.floors[V, frame.places[UPPER, j]] - state.floors[V, frame.places[LOWER, j]]
        state.mode[PHASE, j] = 1 if rate >= 0.0 else -1
        return 0
    return sign if abs(reaction) > friction_limit(frame, state, j) else 0
