"""Springs between the floors of a building, and the matrices they make: one from the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.model.standing import IntArray, is_chain, spring_matrix

Array = NDArray[np.float64]


class Frame(NamedTuple):
    """A building for the kernel of N storeys: see `kernels/frame/model.py` for the rows of `properties`."""

    properties: Array
    dense_stiffness: Array
    dense_damping: Array


class Linkage(NamedTuple):
    """A symmetric matrix as springs between neighbours and to the ground, or whole where it is none of these.

    A matrix of zeros stands beside a dense one, and an empty one beside springs.
    """

    storey: Array
    ground: Array
    dense: Array

    @classmethod
    def of(cls, matrix: Array, stands_on: IntArray | None = None) -> Linkage:
        """Take a matrix (N, N) apart; stands_on: the floor below each storey, by default the one before."""
        size = matrix.shape[0]
        if stands_on is not None and not is_chain(stands_on):
            return cls._of_frames(matrix, stands_on)
        if np.triu(matrix, 2).any():
            return cls(np.zeros(size), np.zeros(size), matrix)
        storey = np.append(0.0, -np.diag(matrix, -1))
        ground = np.diag(matrix) - storey - np.append(storey[1:], 0.0)
        storey[0], ground[0] = ground[0], 0.0
        return cls(storey, ground, np.zeros((0, 0)))

    @classmethod
    def _of_frames(cls, matrix: Array, stands_on: IntArray) -> Linkage:
        size = matrix.shape[0]
        storey = np.zeros(size)
        on_floors = np.flatnonzero(stands_on > 0)
        storey[on_floors] = -matrix[on_floors, stands_on[on_floors] - 1]
        ground = np.diag(matrix - spring_matrix(storey, stands_on)).copy()
        storey[stands_on == 0], ground[stands_on == 0] = ground[stands_on == 0], 0.0
        if (np.diag(ground) + spring_matrix(storey, stands_on) - matrix)[~np.eye(size, dtype=bool)].any():
            return cls(np.zeros(size), np.zeros(size), matrix)
        return cls(storey, ground, np.zeros((0, 0)))


def shear_matrix(springs: Array) -> Array:
    """Return the matrix (N, N) of springs between each floor and the one below."""
    above = np.append(springs[1:], 0.0)
    return np.diag(springs + above) - np.diag(springs[1:], 1) - np.diag(springs[1:], -1)
