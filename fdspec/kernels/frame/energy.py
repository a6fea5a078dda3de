"""Energies of a frame, relative to the ground: each by its own formula or quadrature."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.groups_of_four import LANES, load, plus, scaled, store_row
from fdspec.kernels.frame.model import (
    BRACE_DAMPING,
    BRACE_MASS,
    BRACE_STIFFNESS,
    FLOOR_MASS,
    GROUND_DAMPING,
    GROUND_STIFFNESS,
    STOREY_DAMPING,
    STOREY_STIFFNESS,
)
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.mathematics.quadrature import NODES, WEIGHTS


@inner
def input_work(momentum, n, h, ground, rise, x):
    """Work (J) of the ground acceleration on the first part x of the step: - a_g sum m u', integrated."""
    total = 0.0
    for k in range(n, -1, -1):
        total = total * x + momentum[k] * (ground / (k + 1) + rise * x / (k + 2))
    return -total * h * x


@inner
def viscous_work(frame, dense_damping, damped, series, n, h, x, speeds):
    """Work (J) into all dashpots on the first part x of the step.

    speeds (2, 1 + lanes) is room for velocities of floors and sliding velocities, zero in its first column.
    """
    size = frame.shape[1]
    total = 0.0
    for node in range(len(NODES)):
        y = x * NODES[node]
        speeds_at(series, VELOCITY, size, n, y, speeds, 0)
        if damped:
            speeds_at(series, SLIDING, size, n, y, speeds, 1)
        power = 0.0
        for i in range(1, size + 1):
            speed = speeds[0, i]
            drift = speed - speeds[0, i - 1]
            brace = drift - speeds[1, i]
            power += frame[STOREY_DAMPING, i - 1] * drift * drift
            power += frame[GROUND_DAMPING, i - 1] * speed * speed
            power += frame[BRACE_DAMPING, i - 1] * brace * brace
        for i in range(dense_damping.shape[0]):
            force = 0.0
            for j in range(size):
                force += dense_damping[i, j] * speeds[0, j + 1]
            power += force * speeds[0, i + 1]
        total += WEIGHTS[node] * power
    return total * x * h


@inner
def speeds_at(series, quantity, size, n, y, speeds, to):
    """Put the values of a quantity's rows at the fraction y into row ``to`` of speeds."""
    for i in range(1, size + 1, LANES):
        x = load(series, quantity, i, n)
        for k in range(n - 1, -1, -1):
            x = plus(scaled(x, y), load(series, quantity, i, k))
        store_row(speeds, to, i, x)


@inner
def kinetic_energy(frame, state):
    """Energy (J) of floors and braces that move so, relative to the ground."""
    total = 0.0
    for i in range(frame.shape[1]):
        floor = state[VELOCITY, i]
        brace = floor - state[SLIDING, i]
        total += frame[FLOOR_MASS, i] * floor * floor + frame[BRACE_MASS, i] * brace * brace
    return 0.5 * total


@inner
def strain_energy(frame, dense_stiffness, state):
    """Energy (J) in frame and braces."""
    total = 0.0
    below = 0.0
    for i in range(frame.shape[1]):
        u = state[DISPLACEMENT, i]
        drift = u - below
        stretch = drift - state[OFFSET, i]
        below = u
        total += frame[STOREY_STIFFNESS, i] * drift * drift + frame[GROUND_STIFFNESS, i] * u * u
        total += frame[BRACE_STIFFNESS, i] * stretch * stretch
    for i in range(dense_stiffness.shape[0]):
        force = 0.0
        for j in range(dense_stiffness.shape[0]):
            force += dense_stiffness[i, j] * state[DISPLACEMENT, j]
        total += force * state[DISPLACEMENT, i]
    return 0.5 * total


@inner
def stored_energy(frame, dense_stiffness, state):
    """Kinetic and strain energy (J) of a state."""
    return kinetic_energy(frame, state) + strain_energy(frame, dense_stiffness, state)
