"""Which floor each storey stands on: a single chain from the ground up, or frames beside each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


def chain(size: int) -> IntArray:
    """Return (N,) what the storeys of a single frame stand on: the ground, 0, floor 1, floor 2 and so on."""
    return _kept(np.arange(size))


def checked_stands_on(given: ArrayLike | None, size: int) -> IntArray:
    """Return (N,) the floor below each storey, 0 for the ground; raise InvalidInput for what is none."""
    if given is None:
        return chain(size)
    array = np.asarray(given)
    if array.shape != (size,) or array.dtype.kind not in "iu":
        raise InvalidInput(
            f"stands_on must be {size} whole numbers, one a storey: the floor that each stands on, counted "
            f"from 1, or 0 for the ground; not {given!r}"
        )
    wrong = np.flatnonzero((array < 0) | (array > np.arange(size)))
    if wrong.size:
        storey = int(wrong[0]) + 1
        raise InvalidInput(
            f"stands_on must name the ground, 0, or a floor counted before the storey's own, but storey "
            f"{storey} stands on {int(array[storey - 1])}"
        )
    return _kept(array)


def is_chain(stands_on: IntArray) -> bool:
    """Whether every storey stands on the one counted before it."""
    return bool((stands_on == np.arange(stands_on.size)).all())


def below(motion: Array, stands_on: IntArray) -> Array:
    """Return (..., N) the motion of what each storey stands on, from that of the floors; the ground is 0."""
    ground = np.zeros((*motion.shape[:-1], 1))
    return np.asarray(np.concatenate([ground, motion], axis=-1)[..., stands_on])


def drifts(displacement: Array, stands_on: IntArray) -> Array:
    """Return the drift of each storey (..., N) from displacements of floors (..., N), m."""
    return np.asarray(displacement - below(displacement, stands_on))


def spring_matrix(springs: Array, stands_on: IntArray) -> Array:
    """Return the matrix (N, N) of springs (N,) between each floor and the one it stands on."""
    matrix = np.diag(springs)
    for floor, below in enumerate(stands_on - 1):
        if below >= 0:
            matrix[below, below] += springs[floor]
            matrix[floor, below] -= springs[floor]
            matrix[below, floor] -= springs[floor]
    return matrix


def carried(stands_on: IntArray) -> NDArray[np.bool_]:
    """Return which nodes are carried, (S, N + 1), by each storey; the ground, node 0, never is.

    With several frames on the ground one more row holds all floors: what the ground carries.
    """
    size = stands_on.size
    rows = np.zeros((size, size + 1), np.bool_)
    for floor in range(size, 0, -1):
        rows[floor - 1, floor] = True
        if stands_on[floor - 1] > 0:
            rows[stands_on[floor - 1] - 1] |= rows[floor - 1]
    if np.count_nonzero(stands_on == 0) > 1:
        rows = np.vstack([rows, np.arange(size + 1) > 0])
    rows.flags.writeable = False
    return rows


def elevations(height: Array, stands_on: IntArray) -> Array:
    """Return the height of each floor above the ground (N,), m, from those of the storeys."""
    above = np.zeros(height.size + 1)
    for floor, below in enumerate(stands_on, start=1):
        above[floor] = above[below] + height[floor - 1]
    return above[1:]


def _kept(array: NDArray[np.integer]) -> IntArray:
    kept = array.astype(np.int64)
    kept.flags.writeable = False
    return kept
