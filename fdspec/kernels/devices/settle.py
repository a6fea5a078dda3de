"""What a floor decides where the plates that hang on it have come to rest, or a force on it has jumped.

A plate on its floor sticks while the friction R = m_d A + B - S that this needs stays within its limit, and
the floor's absolute acceleration A depends on which of its plates stick.  With P the other forces on the
floor,

    m_f A + sum over plates at rest of [S + clip(m_d A + B - S, -F, F)] = P - (forces of moving plates)

The left side rises with A, so that one A solves it and every plate has its answer: those within the limits
stick, the others slip in the direction of their reaction.  The order of the plates plays no part.  Where
friction falls as slip begins, those that slip pull with the lower force, and the rest decide again: as
many rounds as there are plates, at the most.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.guard import ROUNDING, forces_at_stake
from fdspec.kernels.devices.law import force_across, friction_limit
from fdspec.kernels.devices.layout import (
    BRACE,
    KIND,
    KINETIC,
    MASS,
    PHASE,
    REGION,
    STATIC,
    TOUCHING,
    UPPER,
    VANISHING,
    WITH_MASS,
    A,
    O,
)
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.types import STICK

FIXED = 0
DECIDES = 1
"""What `roles` says of a plate: its mode is given, or to be decided."""


@inner
def settle(frame, law, state, series, node, roles):
    """Decide the modes of all plates on a floor that roles (L,) lets decide.

    series holds the forces of this instant as its coefficients 0.
    """
    balance = series.floors[A, node, 0] / law.compliance[node]
    deciding = 0
    for j in range(frame.places.shape[1]):
        if frame.places[KIND, j] == WITH_MASS and frame.places[UPPER, j] == node:
            if state.mode[PHASE, j] == STICK:
                balance += series.sliders[BRACE, j, 0]
            else:
                balance += law.across[j] * state.sliders[O, j] + law.constant[j]
            deciding += roles[j]
    for _ in range(deciding + 1):
        acceleration = common_acceleration(frame, state, series, node, roles, balance)
        again = False
        for j in range(frame.places.shape[1]):
            if roles[j] != DECIDES or frame.places[UPPER, j] != node:
                continue
            held = held_force(frame, state, series, j)
            reaction = frame.links[MASS, j] * acceleration + held
            limit = friction_limit(frame, state, j)
            stake = limit + abs(held) + abs(reaction) + forces_at_stake(frame, law, state, j)
            near = ROUNDING * stake if limit < math.inf else 0.0
            state.mode[TOUCHING, j] = 0
            state.mode[VANISHING, j] = 0
            if abs(reaction) <= limit + near:
                state.mode[PHASE, j] = STICK
                if abs(reaction) >= limit - near:
                    state.mode[TOUCHING, j] = 1 if reaction > 0.0 else -1
                    state.mode[VANISHING, j] = 1
                continue
            state.mode[PHASE, j] = 1 if reaction > 0.0 else -1
            state.mode[VANISHING, j] = 1
            if frame.links[KINETIC, j] < frame.links[STATIC, j]:
                roles[j] = FIXED
                again = True
        if not again:
            break
    for j in range(frame.places.shape[1]):
        if frame.places[UPPER, j] == node:
            roles[j] = FIXED


@inner
def held_force(frame, state, series, j):
    """Friction (N) that holds a plate on a floor without acceleration."""
    return series.sliders[BRACE, j, 0] - force_across(frame, j, state.mode[REGION, j], state.sliders[O, j])


@inner
def pull(frame, state, series, j, acceleration):
    """Friction (N) of a plate that decides, on a floor with this acceleration, and its slope over it."""
    mass = frame.links[MASS, j]
    limit = friction_limit(frame, state, j)
    reaction = mass * acceleration + held_force(frame, state, series, j)
    if reaction > limit:
        return limit, 0.0
    if reaction < -limit:
        return -limit, 0.0
    return reaction, mass


@inner
def excess_of(frame, state, series, node, roles, balance, acceleration):
    """Left side less right side of the floor's equation, and its slope."""
    total = frame.mass[node] * acceleration - balance
    slope = frame.mass[node]
    for j in range(frame.places.shape[1]):
        if frame.places[KIND, j] != WITH_MASS or frame.places[UPPER, j] != node:
            continue
        total += force_across(frame, j, state.mode[REGION, j], state.sliders[O, j])
        if roles[j] == DECIDES:
            force, mass = pull(frame, state, series, j, acceleration)
            total += force
            slope += mass
        elif state.mode[PHASE, j] == STICK:
            mass = frame.links[MASS, j]
            total += mass * acceleration + held_force(frame, state, series, j)
            slope += mass
        else:
            total += across_moving(frame, state, j)
    return total, slope


@inner
def across_moving(frame, state, j):
    """Friction (N) of a plate in motion."""
    return sliding_force(state.mode[PHASE, j], frame.links[KINETIC, j])


@inner
def common_acceleration(frame, state, series, node, roles, balance):
    """The one absolute acceleration (m/s2) that solves the floor's equation."""
    low = -math.inf
    high = math.inf
    for j in range(frame.places.shape[1]):
        if roles[j] != DECIDES or frame.places[UPPER, j] != node:
            continue
        limit = friction_limit(frame, state, j)
        if limit == math.inf:
            continue
        held = held_force(frame, state, series, j)
        for sign in (-1.0, 1.0):
            corner = (sign * limit - held) / frame.links[MASS, j]
            excess, _ = excess_of(frame, state, series, node, roles, balance, corner)
            if excess <= 0.0:
                low = max(low, corner)
            else:
                high = min(high, corner)
    middle = 0.0
    if low > -math.inf and high < math.inf:
        middle = 0.5 * (low + high)
    elif low > -math.inf:
        middle = low + 1.0 + abs(low)
    elif high < math.inf:
        middle = high - 1.0 - abs(high)
    excess, slope = excess_of(frame, state, series, node, roles, balance, middle)
    return middle - excess / slope
