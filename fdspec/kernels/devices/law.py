"""The slider's law: force over offset, straight between its corners.

    Q(o) = s (F + k_f |o|)  +  k_r o + sgn(o) P  +  k_s (o -+ g_s) beyond +-g_s

friction against the direction s of sliding, re-centring spring with preload, bearing.  The corners part the
offsets into regions, numbered from the middle outwards:

    -2 | -1 | 1 | 2      with a corner at o = 0 (P or k_f); 0 is then the point o = 0 itself
    -2 |    0   | 2      without

A slider with preload that comes to o = 0 sticks there: its force may be anything between the two lines.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.layout import (
    FRICTION_GROWTH,
    KINETIC,
    KINKED,
    LOWER,
    PHASE,
    PRELOAD,
    RECENTRING,
    REGION,
    SLOT_LENGTH,
    SLOT_STIFFNESS,
    STATIC,
    UPPER,
    U,
)
from fdspec.kernels.friction import friction_work, sliding_force

BEARING = 2
"""Magnitude of the regions beyond the slot's ends."""


@inner
def deformation(frame, state, j):
    """Difference of the displacements of the link's two nodes, m."""
    return state.floors[U, frame.places[UPPER, j]] - state.floors[U, frame.places[LOWER, j]]


@inner
def side(region):
    """Sign of the offset in a region."""
    return 1.0 if region > 0 else (-1.0 if region < 0 else 0.0)


@inner
def region_of(frame, j, offset):
    """Region in which an offset lies."""
    if abs(offset) > frame.links[SLOT_LENGTH, j]:
        return 2 if offset > 0.0 else -2
    if frame.places[KINKED, j] == 0 or offset == 0.0:
        return 0
    return 1 if offset > 0.0 else -1


@inner
def bound_ahead(frame, j, region, sign):
    """Offset at which a slider that slips in direction ``sign`` leaves its region; infinite where never."""
    place = region * sign
    if place == BEARING:
        return sign * math.inf
    slot = frame.links[SLOT_LENGTH, j]
    if place == -BEARING:
        return -sign * slot
    if place == -1:
        return 0.0
    return sign * slot


@inner
def region_ahead(frame, j, region, sign):
    """Region that follows in direction ``sign``."""
    place = region * sign
    kinked = frame.places[KINKED, j] != 0
    if place == -2:
        after = -1 if kinked else 0
    elif place == -1 or (place == 0 and kinked):
        after = 1
    else:
        after = 2
    return sign * after


@inner
def stiffness_across(frame, j, region, sign):
    """Slope of the law (N/m) in a region; ``sign`` is the direction of sliding, 0 at rest."""
    slope = frame.links[RECENTRING, j] + sign * side(region) * frame.links[FRICTION_GROWTH, j]
    if abs(region) == BEARING:
        slope += frame.links[SLOT_STIFFNESS, j]
    return slope


@inner
def constant_across(frame, j, region, sign):
    """Force (N) on the region's line at offset 0, friction in motion included."""
    force = side(region) * frame.links[PRELOAD, j]
    if abs(region) == BEARING:
        force -= side(region) * frame.links[SLOT_STIFFNESS, j] * frame.links[SLOT_LENGTH, j]
    if sign != 0:
        force += sliding_force(sign, frame.links[KINETIC, j])
    return force


@inner
def force_across(frame, j, region, offset):
    """Force (N) across the slider at rest, without friction."""
    return stiffness_across(frame, j, region, 0) * offset + constant_across(frame, j, region, 0)


@inner
def friction_limit(frame, state, j):
    """Friction (N) that holds the slider at rest; at the corner the preload holds it too."""
    limit = frame.links[STATIC, j] + frame.links[FRICTION_GROWTH, j] * abs(state.sliders[0, j])
    if state.mode[REGION, j] == 0:
        limit += frame.links[PRELOAD, j]
    return limit


@inner
def slides_freely(frame, j):
    """Whether there is no friction at all: nothing ever sticks."""
    return frame.links[STATIC, j] == 0.0 and frame.links[FRICTION_GROWTH, j] == 0.0


@inner
def stored_across(frame, j, region, offset):
    """Energy (J) in bearing and re-centring spring."""
    energy = 0.5 * frame.links[RECENTRING, j] * offset * offset + frame.links[PRELOAD, j] * abs(offset)
    return energy + bearing_energy(frame, j, region, offset)


@inner
def bearing_energy(frame, j, region, offset):
    """Energy (J) in the slot's end."""
    if abs(region) != BEARING:
        return 0.0
    beyond = abs(offset) - frame.links[SLOT_LENGTH, j]
    return 0.5 * frame.links[SLOT_STIFFNESS, j] * beyond * beyond


@inner
def work_of_friction(frame, j, start, end):
    """Energy (J) that friction in motion takes on the way between two offsets of one region."""
    work = friction_work(frame.links[KINETIC, j], abs(end - start))
    growth = frame.links[FRICTION_GROWTH, j]
    if growth > 0.0:
        work += 0.5 * growth * abs(end * end - start * start)
    return work


@inner
def enter_region(frame, state, j, sign):
    """Let a slider that slips in this direction pass the bound ahead of it.

    Returns whether it came to rest at the corner that a preload makes.
    """
    before = state.mode[REGION, j]
    after = region_ahead(frame, j, before, sign)
    if before * after < 0 and frame.links[PRELOAD, j] > 0.0:
        state.mode[REGION, j] = 0
        state.mode[PHASE, j] = 0
        return True
    state.mode[REGION, j] = after
    return False


@inner
def meets_bearing(before, after):
    """Whether two regions are parted by an end of the slot."""
    return (abs(before) == BEARING) != (abs(after) == BEARING)
