"""Taylor series of a frame with devices over a step."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.layout import (
    BRACE,
    DAMPING,
    DIRECTION,
    GRAVITY,
    KIND,
    LOWER,
    MASS,
    ONE_SIDED,
    PHASE,
    REACTION,
    SPRING_DAMPING,
    SPRING_STIFFNESS,
    STATIC,
    STIFFNESS,
    UPPER,
    WITH_DASHPOT,
    WITH_MASS,
    WITHOUT_MASS,
    A,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.types import STICK


@inner
def expand(frame, law, state, n, h, ground, rise, series):
    """Fill the series of order n over the step h (s) that starts at ``state``.

    ground: the ground's acceleration at the start, m/s2; rise: its change over the step.
    """
    floors = series.floors
    sliders = series.sliders
    for i in range(1, frame.mass.size):
        floors[U, i, 0] = state.floors[U, i]
        floors[V, i, 0] = state.floors[V, i]
    for j in range(frame.places.shape[1]):
        sliders[O, j, 0] = state.sliders[O, j]
        sliders[Z, j, 0] = state.sliders[Z, j]
    for k in range(n):
        factor = h / (k + 1)
        pull_of_springs(frame, floors, k)
        for j in range(frame.places.shape[1]):
            pull_of_link(frame, law, state, floors, sliders, j, k)
        shake = ground if k == 0 else (rise if k == 1 else 0.0)
        momentum = 0.0
        for i in range(1, frame.mass.size):
            momentum += frame.mass[i] * floors[V, i, k]
            inertia = floors[A, i, k] * law.compliance[i]
            floors[A, i, k] = inertia
            floors[V, i, k + 1] = factor * (inertia - shake)
            floors[U, i, k + 1] = factor * floors[V, i, k]
        for j in range(frame.places.shape[1]):
            if frame.places[KIND, j] == WITH_MASS:
                momentum += frame.links[MASS, j] * (floors[V, frame.places[UPPER, j], k] - sliders[Z, j, k])
            advance_slider(frame, law, state, floors, sliders, j, k, factor)
        series.momentum[k] = momentum
    momentum = 0.0
    for i in range(1, frame.mass.size):
        momentum += frame.mass[i] * floors[V, i, n]
    for j in range(frame.places.shape[1]):
        if frame.places[KIND, j] == WITH_MASS:
            momentum += frame.links[MASS, j] * (floors[V, frame.places[UPPER, j], n] - sliders[Z, j, n])
        elif frame.places[KIND, j] == WITHOUT_MASS:
            follow(frame, law, state, floors, sliders, j, n)
        elif state.mode[PHASE, j] != STICK:
            if frame.places[KIND, j] == WITH_DASHPOT:
                upper = frame.places[UPPER, j]
                lower = frame.places[LOWER, j]
                drift = floors[U, upper, n] - floors[U, lower, n]
                drift_rate = floors[V, upper, n] - floors[V, lower, n]
                lag_behind(frame, sliders, j, n, drift, drift_rate, law.across[j] * sliders[O, j, n])
            elif state.mode[PHASE, j] > 0:
                yield_along(frame, floors, sliders, j, n)
    series.momentum[n] = momentum


@inner
def pull_of_springs(frame, floors, k):
    """Start the sums of forces on the floors, coefficient k, with those of springs, dashpots and gravity."""
    size = frame.mass.size - 1
    for i in range(size + 1):
        floors[A, i, k] = 0.0
    for e in range(frame.ends.shape[1]):
        upper = frame.ends[0, e]
        lower = frame.ends[1, e]
        force = (frame.springs[SPRING_STIFFNESS, e] - frame.springs[GRAVITY, e]) * (
            floors[U, upper, k] - floors[U, lower, k]
        ) + frame.springs[SPRING_DAMPING, e] * (floors[V, upper, k] - floors[V, lower, k])
        floors[A, upper, k] -= force
        floors[A, lower, k] += force
    for i in range(frame.dense_stiffness.shape[0]):
        force = 0.0
        for m in range(size):
            force += frame.dense_stiffness[i, m] * floors[U, m + 1, k]
        floors[A, i + 1, k] -= force
    for i in range(frame.dense_damping.shape[0]):
        force = 0.0
        for m in range(size):
            force += frame.dense_damping[i, m] * floors[V, m + 1, k]
        floors[A, i + 1, k] -= force


@inner
def pull_of_link(frame, law, state, floors, sliders, j, k):
    """Add the forces of one link to the sums; its brace's force is known then."""
    upper = frame.places[UPPER, j]
    lower = frame.places[LOWER, j]
    kind = frame.places[KIND, j]
    phase = state.mode[PHASE, j]
    stiffness = frame.links[STIFFNESS, j]
    drift = floors[U, upper, k] - floors[U, lower, k]
    drift_rate = floors[V, upper, k] - floors[V, lower, k]
    if kind == WITHOUT_MASS:
        follow(frame, law, state, floors, sliders, j, k)
        force = stiffness * (drift - sliders[O, j, k])
    elif kind == WITH_MASS:
        force = stiffness * (drift - sliders[O, j, k]) + frame.links[DAMPING, j] * (
            drift_rate - sliders[Z, j, k]
        )
    elif kind == ONE_SIDED:
        direction = frame.links[DIRECTION, j]
        force = 0.0
        if phase == STICK:
            force = stiffness * (drift - direction * sliders[O, j, k])
        elif phase > 0:
            yield_along(frame, floors, sliders, j, k)
            force = direction * frame.links[STATIC, j] if k == 0 else 0.0
    elif phase == STICK:
        force = stiffness * (drift - sliders[O, j, k]) + frame.links[DAMPING, j] * drift_rate
    else:
        force = law.across[j] * sliders[O, j, k]
        if k == 0:
            force += law.constant[j]
        lag_behind(frame, sliders, j, k, drift, drift_rate, force)
    sliders[BRACE, j, k] = force
    floors[A, lower, k] += force
    if kind == WITH_MASS and phase != STICK:
        force = law.across[j] * sliders[O, j, k]
        if k == 0:
            force += law.constant[j]
    floors[A, upper, k] -= force


@inner
def follow(frame, law, state, floors, sliders, j, k):
    """Coefficient k of the offset of a slider without mass: its brace's force is on the law's line."""
    if state.mode[PHASE, j] == STICK:
        if k > 0:
            sliders[O, j, k] = 0.0
        sliders[Z, j, k] = 0.0
        return
    upper = frame.places[UPPER, j]
    lower = frame.places[LOWER, j]
    stiffness = frame.links[STIFFNESS, j]
    share = stiffness / (stiffness + law.across[j])
    offset = share * (floors[U, upper, k] - floors[U, lower, k])
    if k == 0:
        offset -= law.constant[j] / (stiffness + law.across[j])
    sliders[O, j, k] = offset
    sliders[Z, j, k] = share * (floors[V, upper, k] - floors[V, lower, k])


@inner
def lag_behind(frame, sliders, j, k, drift, drift_rate, force):
    """Coefficient k of the sliding velocity where a dashpot stands beside the brace's spring."""
    spring = frame.links[STIFFNESS, j] * (drift - sliders[O, j, k])
    sliders[Z, j, k] = drift_rate - (force - spring) / frame.links[DAMPING, j]


@inner
def yield_along(frame, floors, sliders, j, k):
    """Coefficient k of the slack of a one-sided brace that yields."""
    direction = frame.links[DIRECTION, j]
    upper = frame.places[UPPER, j]
    lower = frame.places[LOWER, j]
    sliders[O, j, k] = direction * (floors[U, upper, k] - floors[U, lower, k])
    if k == 0:
        sliders[O, j, k] -= frame.links[STATIC, j] / frame.links[STIFFNESS, j]
    sliders[Z, j, k] = direction * (floors[V, upper, k] - floors[V, lower, k])


@inner
def advance_slider(frame, law, state, floors, sliders, j, k, factor):
    """Coefficients k + 1 of offset and sliding velocity; coefficient k of the reaction."""
    upper = frame.places[UPPER, j]
    kind = frame.places[KIND, j]
    phase = state.mode[PHASE, j]
    if kind == ONE_SIDED:
        if phase <= 0:
            sliders[O, j, k + 1] = 0.0
            sliders[Z, j, k] = 0.0
            sliders[Z, j, k + 1] = 0.0
        return
    across = law.across[j] * sliders[O, j, k]
    if k == 0:
        across += law.constant[j]
    brace = sliders[BRACE, j, k]
    if kind == WITH_MASS:
        mass = frame.links[MASS, j]
        sliders[REACTION, j, k] = mass * floors[A, upper, k] + brace - across
        if phase == STICK:
            sliders[O, j, k + 1] = 0.0
            sliders[Z, j, k + 1] = 0.0
        else:
            sliders[O, j, k + 1] = factor * sliders[Z, j, k]
            sliders[Z, j, k + 1] = factor * (floors[A, upper, k] - (across - brace) / mass)
        return
    sliders[REACTION, j, k] = brace - across
    if kind == WITHOUT_MASS:
        return
    if phase == STICK:
        sliders[O, j, k + 1] = 0.0
        sliders[Z, j, k] = 0.0
        sliders[Z, j, k + 1] = 0.0
    else:
        sliders[O, j, k + 1] = factor * sliders[Z, j, k]
