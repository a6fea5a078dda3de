"""What the modes of all links make of a frame: masses that move together, lines of the sliders, rates."""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.law import constant_across, stiffness_across
from fdspec.kernels.devices.layout import (
    DAMPING,
    GRAVITY,
    KIND,
    LOWER,
    MASS,
    ONE_SIDED,
    PHASE,
    REGION,
    SPRING_DAMPING,
    SPRING_STIFFNESS,
    STIFFNESS,
    UPPER,
    WITH_DASHPOT,
    WITH_MASS,
    WITHOUT_MASS,
)
from fdspec.kernels.frame.model import rate_of
from fdspec.kernels.types import STICK


@inner
def set_law(frame, law, state):
    """Bring the law in line with the modes."""
    mode = state.mode
    for i in range(1, frame.mass.size):
        law.compliance[i] = frame.mass[i]
    for j in range(frame.places.shape[1]):
        phase = mode[PHASE, j]
        law.across[j] = stiffness_across(frame, j, mode[REGION, j], phase)
        law.constant[j] = constant_across(frame, j, mode[REGION, j], phase)
        if frame.places[KIND, j] == WITH_MASS and phase == STICK:
            law.compliance[frame.places[UPPER, j]] += frame.links[MASS, j]
    for i in range(1, frame.mass.size):
        law.compliance[i] = 1.0 / law.compliance[i]


@inner
def fastest_rate(frame, law, state, load):
    """Bound on the rates (1/s) of the frame in its present modes; ``load`` (2, N + 1) is room.

    Gershgorin's circles of M^-1/2 K M^-1/2, and of C alike.
    """
    load[:] = 0.0
    size = frame.mass.size - 1
    for e in range(frame.ends.shape[1]):
        k = abs(frame.springs[SPRING_STIFFNESS, e] - frame.springs[GRAVITY, e])
        join(law, load, frame.ends[0, e], frame.ends[1, e], k, abs(frame.springs[SPRING_DAMPING, e]))
    stiffness = 0.0
    damping = 0.0
    lag = 0.0
    for j in range(frame.places.shape[1]):
        upper = frame.places[UPPER, j]
        lower = frame.places[LOWER, j]
        kind = frame.places[KIND, j]
        slips = state.mode[PHASE, j] != STICK
        k = frame.links[STIFFNESS, j]
        c = frame.links[DAMPING, j]
        across = abs(law.across[j])
        if kind == WITH_MASS and slips:
            mass = frame.links[MASS, j]
            share_lower = math.sqrt(mass * law.compliance[lower])
            share_upper = math.sqrt(mass * law.compliance[upper])
            stiffness = max(stiffness, (k * (1.0 + share_lower) + across * (1.0 + share_upper)) / mass)
            damping = max(damping, c / mass * (1.0 + share_lower))
            hang(law, load, lower, k, c, mass)
            hang(law, load, upper, across, 0.0, mass)
        elif kind == WITHOUT_MASS and slips:
            join(law, load, upper, lower, k * across / (k + across) if k + across > 0.0 else 0.0, 0.0)
        elif kind == WITH_DASHPOT and slips:
            join(law, load, upper, lower, k + across, 0.0)
            lag = max(lag, (k + across) / c)
        elif kind != ONE_SIDED or state.mode[PHASE, j] == STICK:
            join(law, load, upper, lower, k, c)
    for i in range(size):
        k = load[0, i + 1]
        c = load[1, i + 1]
        for m in range(frame.dense_stiffness.shape[0]):
            k += abs(frame.dense_stiffness[i, m]) * math.sqrt(law.compliance[i + 1] * law.compliance[m + 1])
        for m in range(frame.dense_damping.shape[0]):
            c += abs(frame.dense_damping[i, m]) * math.sqrt(law.compliance[i + 1] * law.compliance[m + 1])
        stiffness = max(stiffness, k)
        damping = max(damping, c)
    return max(rate_of(stiffness, damping), lag)


@inner
def join(law, load, upper, lower, k, c):
    """Add a spring and a dashpot between two nodes to their circles."""
    share = law.compliance[upper] + math.sqrt(law.compliance[upper] * law.compliance[lower])
    load[0, upper] += k * share
    load[1, upper] += c * share
    share += law.compliance[lower] - law.compliance[upper]
    load[0, lower] += k * share
    load[1, lower] += c * share


@inner
def hang(law, load, node, k, c, mass):
    """The same for one between a node and a plate of this mass."""
    share = law.compliance[node] + math.sqrt(law.compliance[node] / mass)
    load[0, node] += k * share
    load[1, node] += c * share
