"""What all devices make of the events of one instant."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.bilinear import (
    begin_bilinear,
    pass_corner,
    spring_back,
    stop_yielding,
    yield_from_rest,
)
from fdspec.kernels.devices.dashpot_brace import begin_dashpot, slip_from_rest, stop_slipping
from fdspec.kernels.devices.expand import expand
from fdspec.kernels.devices.guard import PASS, SLIP, STOP
from fdspec.kernels.devices.law import region_of, slides_freely
from fdspec.kernels.devices.layout import (
    ANCHOR,
    EVENTS,
    KIND,
    LOWER,
    ONE_SIDED,
    ORIGIN,
    PEAK_SLIP,
    PHASE,
    REGION,
    TOUCHING,
    UPPER,
    VANISHING,
    WITH_DASHPOT,
    WITH_MASS,
    WITHOUT_MASS,
    O,
    Z,
)
from fdspec.kernels.devices.model import set_law
from fdspec.kernels.devices.one_sided import begin_one_sided, change_one_sided
from fdspec.kernels.devices.plate import begin_slip, come_to_rest, drops, pass_bound
from fdspec.kernels.devices.settle import DECIDES, FIXED, settle
from fdspec.kernels.types import STICK

SAME_INSTANT = 1e-12
"""Fraction of a step (of at most a few radians) that counts as no time: far below what rounding leaves
of a root's place, so links that change within it change together."""


@inner
def change_modes(frame, law, state, series, x, instants, signs, events, roles, uneasy, was):
    """Make the changes of all links whose instant is the fraction x of the step.

    roles (L,), uneasy (N + 1,), was (L,): room.  was is the phase of each link before.  The law is that of
    the new modes.
    """
    for i in range(uneasy.size):
        uneasy[i] = 0
    for j in range(instants.size):
        was[j] = state.mode[PHASE, j]
        roles[j] = FIXED
        if instants[j] > x + SAME_INSTANT:
            continue
        kind = frame.places[KIND, j]
        upper = frame.places[UPPER, j]
        event = events[j]
        if kind == WITH_MASS:
            if event == STOP:
                if come_to_rest(frame, state, j):
                    roles[j] = DECIDES
                    uneasy[upper] = 1
            elif event == PASS:
                pass_bound(frame, state, j)
            elif drops(frame, j):
                uneasy[upper] = 1
        elif kind == WITHOUT_MASS:
            if event == STOP:
                stop_yielding(frame, state, j)
            elif event == PASS:
                if pass_corner(frame, state, j):
                    uneasy[upper] = 1
                    uneasy[frame.places[LOWER, j]] = 1
            elif yield_from_rest(frame, state, j, signs[j]):
                uneasy[upper] = 1
                uneasy[frame.places[LOWER, j]] = 1
        elif kind == WITH_DASHPOT:
            if event == STOP:
                stop_slipping(frame, state, j)
            elif event == PASS:
                pass_corner(frame, state, j)
            else:
                slip_from_rest(frame, state, j, signs[j])
        else:
            change_one_sided(frame, state, j, event)
    for j in range(instants.size):
        if frame.places[KIND, j] != WITH_MASS or roles[j] == DECIDES:
            continue
        at_rest = state.mode[PHASE, j] == STICK
        begins = at_rest and events[j] == SLIP and instants[j] <= x + SAME_INSTANT
        if begins and (drops(frame, j) or uneasy[frame.places[UPPER, j]] == 0):
            begin_slip(state, j, signs[j], 1 if drops(frame, j) else 2)
        elif at_rest and uneasy[frame.places[UPPER, j]] == 1:
            roles[j] = DECIDES
    settle_floors(frame, law, state, series, roles, uneasy)
    for j in range(instants.size):
        if state.mode[PHASE, j] != was[j] and not slides_freely(frame, j):
            state.tally[EVENTS, j] += 1.0


@inner
def settle_floors(frame, law, state, series, roles, uneasy):
    """Let every uneasy floor decide, and bring the law in line."""
    set_law(frame, law, state)
    unsettled = False
    for i in range(1, uneasy.size):
        unsettled = unsettled or uneasy[i] == 1
    if not unsettled:
        return
    expand(frame, law, state, 1, 1.0, 0.0, 0.0, series)
    for i in range(1, uneasy.size):
        if uneasy[i] == 1:
            settle(frame, law, state, series, i, roles)
    set_law(frame, law, state)


@inner
def begin(frame, law, state, series, roles, uneasy, was, resumes):
    """Set the modes that the state at the start asks for, unless they are given."""
    for j in range(frame.places.shape[1]):
        offset = state.sliders[O, j]
        state.tally[ANCHOR, j] = offset
        if frame.places[KIND, j] == ONE_SIDED:
            state.tally[ORIGIN, j] = offset
        state.tally[PEAK_SLIP, j] = abs(offset - state.tally[ORIGIN, j])
    if resumes:
        set_law(frame, law, state)
        return
    for i in range(uneasy.size):
        uneasy[i] = 1
    for j in range(frame.places.shape[1]):
        kind = frame.places[KIND, j]
        state.mode[REGION, j] = region_of(frame, j, state.sliders[O, j]) if kind <= WITH_DASHPOT else 0
        state.mode[PHASE, j] = STICK
        state.mode[VANISHING, j] = 0
        state.mode[TOUCHING, j] = 0
        roles[j] = FIXED
        was[j] = STICK
        gives_way = 0
        if kind == WITH_MASS:
            speed = state.sliders[Z, j]
            if speed != 0.0 or slides_freely(frame, j):
                state.mode[PHASE, j] = 1 if speed >= 0.0 else -1
                was[j] = state.mode[PHASE, j]
            else:
                roles[j] = DECIDES
        elif kind == WITHOUT_MASS:
            gives_way = begin_bilinear(frame, state, j)
            if gives_way != 0:
                # Not at its limit but beyond: it springs back whether or not friction falls.
                if not yield_from_rest(frame, state, j, gives_way):
                    spring_back(frame, state, j, gives_way)
        elif kind == WITH_DASHPOT:
            gives_way = begin_dashpot(frame, state, j)
            if gives_way != 0:
                slip_from_rest(frame, state, j, gives_way)
                state.mode[VANISHING, j] = 0
        else:
            begin_one_sided(frame, state, j)
            was[j] = state.mode[PHASE, j]
        if slides_freely(frame, j):
            was[j] = state.mode[PHASE, j]
    settle_floors(frame, law, state, series, roles, uneasy)
    for j in range(frame.places.shape[1]):
        if state.mode[PHASE, j] != was[j] and not slides_freely(frame, j):
            state.tally[EVENTS, j] += 1.0
