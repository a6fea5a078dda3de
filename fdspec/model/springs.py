"""Springs between the floors of a building, and the matrices they make: one from the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
    def of(cls, matrix: Array) -> Linkage:
        """Take a matrix (N, N) apart."""
        size = matrix.shape[0]
        if np.triu(matrix, 2).any():
            return cls(np.zeros(size), np.zeros(size), matrix)
        storey = np.append(0.0, -np.diag(matrix, -1))
        ground = np.diag(matrix) - storey - np.append(storey[1:], 0.0)
        storey[0], ground[0] = ground[0], 0.0
        return cls(storey, ground, np.zeros((0, 0)))


def shear_matrix(springs: Array) -> Array:
    """Return the matrix (N, N) of springs between each floor and the one below."""
    above = np.append(springs[1:], 0.0)
    return np.diag(springs + above) - np.diag(springs[1:], 1) - np.diag(springs[1:], -1)
