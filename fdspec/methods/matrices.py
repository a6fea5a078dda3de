"""Matrices of a frame with braces, and what a step of constant length makes of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.model.building import Building


class System(NamedTuple):
    """M, C and K over some degrees of freedom: the floors, then what else moves; SI units."""

    mass: FloatArray
    """(n,), the diagonal"""
    damping: FloatArray
    """(n, n)"""
    stiffness: FloatArray
    """(n, n)"""


def drifts(size: int) -> FloatArray:
    """D (N, N): what floors' displacements make of each storey's drift."""
    return np.eye(size) - np.eye(size, k=-1)


def braced(building: Building) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Storeys that have a brace, counted from 0."""
    return np.flatnonzero(building.brace_stiffness > 0.0)


def with_braces(building: Building) -> System:
    """Floors and braces, each brace standing on the floor below: the study's (15) to (21)."""
    size, storeys = building.n_storeys, braced(building)
    n = size + storeys.size
    stretch = np.zeros((storeys.size, n))  # of each brace, from floors and braces
    stretch[np.arange(storeys.size), size + np.arange(storeys.size)] = 1.0
    for row, storey in enumerate(storeys):
        if storey > 0:
            stretch[row, storey - 1] = -1.0
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    stiffness[:size, :size] = building.stiffness_matrix
    damping[:size, :size] = building.damping_matrix
    stiffness += stretch.T @ (building.brace_stiffness[storeys, np.newaxis] * stretch)
    damping += stretch.T @ (building.brace_damping[storeys, np.newaxis] * stretch)
    return System(np.concatenate([building.floor_mass, building.brace_mass[storeys]]), damping, stiffness)


def with_elements(building: Building, stiffness: FloatArray, damping: FloatArray) -> System:
    """Floors alone, a spring and a dashpot (N,) over each storey beside the frame's own."""
    D = drifts(building.n_storeys)
    return System(
        building.floor_mass,
        building.damping_matrix + D.T @ (damping[:, np.newaxis] * D),
        building.stiffness_matrix + D.T @ (stiffness[:, np.newaxis] * D),
    )


def state_matrix(system: System) -> FloatArray:
    """A of z' = A z, z = [u, u'], (2n, 2n)."""
    n = system.mass.size
    A = np.zeros((2 * n, 2 * n))
    A[:n, n:] = np.eye(n)
    A[n:, :n] = -system.stiffness / system.mass[:, np.newaxis]
    A[n:, n:] = -system.damping / system.mass[:, np.newaxis]
    return A


class Step(NamedTuple):
    """z+ = A z + held w, or A z + first w + last w+, for an input that is constant or linear in the step."""

    A: FloatArray
    held: FloatArray
    first: FloatArray
    last: FloatArray


def discretised(A: FloatArray, inputs: FloatArray, h: float) -> Step:
    """Make z' = A z + inputs w (2n, m) a step of h seconds, exactly: the blocks of one matrix exponential."""
    from scipy.linalg import expm

    n, m = inputs.shape
    block = np.zeros((n + 2 * m, n + 2 * m))
    block[:n, :n] = A * h
    block[:n, n : n + m] = inputs * h
    block[n : n + m, n + m :] = np.eye(m)
    power = expm(block)
    held, ramp = power[:n, n : n + m], power[:n, n + m :]
    return Step(power[:n, :n], held, held - ramp, ramp)
