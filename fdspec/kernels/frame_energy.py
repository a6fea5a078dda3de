"""Energies of a frame, relative to the ground: each by its own formula or quadrature."""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.frame import (
    BRACE_DAMPING,
    BRACE_MASS,
    BRACE_STIFFNESS,
    FLOOR_MASS,
    GROUND_DAMPING,
    GROUND_STIFFNESS,
    STOREY_DAMPING,
    STOREY_STIFFNESS,
)
from fdspec.kernels.quadrature import NODES, WEIGHTS
from fdspec.kernels.taylor import DISPLACEMENT, FLOOR, OFFSET, SLIDING_VELOCITY, SLIP_OFFSET, VELOCITY


@inner
def input_work(frame, series, n, ground, rise, x):
    """Work (J) of the ground acceleration on the first part x of the step: - a_g sum m u', integrated."""
    total = 0.0
    for i in range(1, frame.shape[1] + 1):
        floor = 0.0
        brace = 0.0
        for k in range(n, 0, -1):
            weight = ground + rise * x * k / (k + 1)
            floor = (floor + series[FLOOR, k, i] * weight) * x
            brace = (brace + series[OFFSET, k, i] * weight) * x
        mass = frame[BRACE_MASS, i - 1]
        total -= (frame[FLOOR_MASS, i - 1] + mass) * floor - mass * brace
    return total


@inner
def viscous_work(frame, dense_damping, series, n, h, x, velocity, sliding):
    """Work (J) into all dashpots on the first part x of the step; velocity, sliding (N + 1) are work room."""
    size = frame.shape[1]
    total = 0.0
    for node in range(len(NODES)):
        y = x * NODES[node]
        for i in range(size + 1):
            velocity[i] = 0.0
            sliding[i] = 0.0
        for k in range(n, 0, -1):
            for i in range(1, size + 1):
                velocity[i] = velocity[i] * y + k * series[FLOOR, k, i]
                sliding[i] = sliding[i] * y + k * series[OFFSET, k, i]
        power = 0.0
        for i in range(1, size + 1):
            drift = velocity[i] - velocity[i - 1]
            brace = drift - sliding[i]
            power += frame[STOREY_DAMPING, i - 1] * drift * drift
            power += frame[GROUND_DAMPING, i - 1] * velocity[i] * velocity[i]
            power += frame[BRACE_DAMPING, i - 1] * brace * brace
        for i in range(dense_damping.shape[0]):
            force = 0.0
            for j in range(size):
                force += dense_damping[i, j] * velocity[j + 1]
            power += force * velocity[i + 1]
        total += WEIGHTS[node] * power
    return total * x / h


@inner
def kinetic_energy(frame, velocity, sliding):
    """Energy (J) of floors and braces that move so, relative to the ground."""
    total = 0.0
    for i in range(frame.shape[1]):
        brace = velocity[i] - sliding[i]
        total += frame[FLOOR_MASS, i] * velocity[i] * velocity[i] + frame[BRACE_MASS, i] * brace * brace
    return 0.5 * total


@inner
def strain_energy(frame, dense_stiffness, u, offset):
    """Energy (J) in frame and braces."""
    total = 0.0
    below = 0.0
    for i in range(frame.shape[1]):
        drift = u[i] - below
        stretch = drift - offset[i]
        below = u[i]
        total += frame[STOREY_STIFFNESS, i] * drift * drift + frame[GROUND_STIFFNESS, i] * u[i] * u[i]
        total += frame[BRACE_STIFFNESS, i] * stretch * stretch
    for i in range(dense_stiffness.shape[0]):
        force = 0.0
        for j in range(dense_stiffness.shape[0]):
            force += dense_stiffness[i, j] * u[j]
        total += force * u[i]
    return 0.5 * total


@inner
def stored_energy(frame, dense_stiffness, state):
    """Kinetic and strain energy (J) of a state."""
    return kinetic_energy(frame, state[VELOCITY], state[SLIDING_VELOCITY]) + strain_energy(
        frame, dense_stiffness, state[DISPLACEMENT], state[SLIP_OFFSET]
    )
