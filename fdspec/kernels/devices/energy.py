"""Energies of a frame with devices, relative to the ground: each by its own formula or quadrature."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.law import bearing_energy, deformation, stored_across
from fdspec.kernels.devices.layout import (
    DAMPING,
    DIRECTION,
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
    WITH_MASS,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.mathematics.polynomial_roots import value
from fdspec.kernels.mathematics.quadrature import NODES, WEIGHTS


@inner
def input_work(momentum, n, h, ground, rise, x):
    """Work (J) of the ground acceleration on the first part x of the step: - a_g sum m u', integrated."""
    total = 0.0
    for k in range(n, -1, -1):
        total = total * x + momentum[k] * (ground / (k + 1) + rise * x / (k + 2))
    return -total * h * x


@inner
def viscous_work(frame, series, n, h, x, speeds):
    """Work (J) into all dashpots on the first part x of the step; ``speeds`` (N + 1,) is room."""
    size = frame.mass.size - 1
    total = 0.0
    for node in range(len(NODES)):
        y = x * NODES[node]
        for i in range(1, size + 1):
            speeds[i] = value(series.floors[V, i], n, y)
        power = 0.0
        for e in range(frame.ends.shape[1]):
            c = frame.springs[SPRING_DAMPING, e]
            if c != 0.0:
                rate = speeds[frame.ends[0, e]] - speeds[frame.ends[1, e]]
                power += c * rate * rate
        for j in range(frame.places.shape[1]):
            c = frame.links[DAMPING, j]
            if c > 0.0:
                rate = speeds[frame.places[UPPER, j]] - speeds[frame.places[LOWER, j]]
                rate -= value(series.sliders[Z, j], n, y)
                power += c * rate * rate
        for i in range(frame.dense_damping.shape[0]):
            force = 0.0
            for m in range(size):
                force += frame.dense_damping[i, m] * speeds[m + 1]
            power += force * speeds[i + 1]
        total += WEIGHTS[node] * power
    return total * x * h


@inner
def kinetic_energy(frame, state):
    """Energy (J) of floors and plates that move so, relative to the ground."""
    total = 0.0
    for i in range(1, frame.mass.size):
        total += frame.mass[i] * state.floors[V, i] * state.floors[V, i]
    for j in range(frame.places.shape[1]):
        if frame.places[KIND, j] == WITH_MASS:
            speed = state.floors[V, frame.places[UPPER, j]] - state.sliders[Z, j]
            total += frame.links[MASS, j] * speed * speed
    return 0.5 * total


@inner
def strain_energy(frame, state):
    """Energy (J) in frame, braces and re-centring springs, without bearing and gravity."""
    total = 0.0
    for e in range(frame.ends.shape[1]):
        drift = state.floors[U, frame.ends[0, e]] - state.floors[U, frame.ends[1, e]]
        total += 0.5 * frame.springs[SPRING_STIFFNESS, e] * drift * drift
    for i in range(frame.dense_stiffness.shape[0]):
        force = 0.0
        for m in range(frame.dense_stiffness.shape[0]):
            force += frame.dense_stiffness[i, m] * state.floors[U, m + 1]
        total += 0.5 * force * state.floors[U, i + 1]
    for j in range(frame.places.shape[1]):
        offset = state.sliders[O, j]
        stretch = deformation(frame, state, j) - offset
        if frame.places[KIND, j] == ONE_SIDED:
            stretch = frame.links[DIRECTION, j] * deformation(frame, state, j) - offset
            if state.mode[PHASE, j] < 0:
                stretch = 0.0
        else:
            region = state.mode[REGION, j]
            total += stored_across(frame, j, region, offset) - bearing_energy(frame, j, region, offset)
        total += 0.5 * frame.links[STIFFNESS, j] * stretch * stretch
    return total


@inner
def energy_in_bearing(frame, state):
    """Energy (J) in the ends of all slots."""
    total = 0.0
    for j in range(frame.places.shape[1]):
        if frame.places[KIND, j] != ONE_SIDED:
            total += bearing_energy(frame, j, state.mode[REGION, j], state.sliders[O, j])
    return total


@inner
def work_of_gravity(frame, state):
    """Work (J) that gravity has done on the way to this state from the upright one."""
    total = 0.0
    for e in range(frame.ends.shape[1]):
        drift = state.floors[U, frame.ends[0, e]] - state.floors[U, frame.ends[1, e]]
        total += 0.5 * frame.springs[GRAVITY, e] * drift * drift
    return total


@inner
def stored_energy(frame, state):
    """All energy (J) of a state but gravity's."""
    return kinetic_energy(frame, state) + strain_energy(frame, state) + energy_in_bearing(frame, state)
