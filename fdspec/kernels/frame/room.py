"""Making of the arrays in which one history of a frame works, in their bundles."""

from __future__ import annotations

import numpy as np

from fdspec.compiler.options import inner, maker
from fdspec.kernels.frame.arrays import Matrices, Results, Room
from fdspec.kernels.frame.model import MODEL_ROWS
from fdspec.kernels.frame.peaks import PEAK_ROWS
from fdspec.kernels.frame.reset import TALLY_ROWS
from fdspec.kernels.frame.results import COUNTS, DEMAND_ROWS, DEMANDS
from fdspec.kernels.frame.taylor import QUANTITIES, REACH_ROWS, TERMS


@inner
def widen(matrix, wide):
    """Copy the matrix (N, N) into a wider one of zeros."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            wide[i, j] = matrix[i, j]


@maker
def matrices_of(dense_stiffness, dense_damping, lanes):
    """Bundle dense matrices with wider copies of them."""
    wide = lanes if dense_stiffness.shape[0] > 0 else 0
    stiffness_lanes = np.zeros((wide, wide))
    widen(dense_stiffness, stiffness_lanes)
    wide = lanes if dense_damping.shape[0] > 0 else 0
    damping_lanes = np.zeros((wide, wide))
    widen(dense_damping, damping_lanes)
    return Matrices(dense_stiffness, dense_damping, stiffness_lanes, damping_lanes)


@maker
def room_for(size, lanes):
    """Make the arrays in which a history of so many storeys works."""
    return Room(
        np.zeros((MODEL_ROWS, lanes)),
        np.zeros((4, size)),
        np.zeros((4, size)),
        np.zeros((TALLY_ROWS, size)),
        np.zeros((QUANTITIES, lanes + 1, TERMS)),
        np.zeros(TERMS),
        np.zeros((REACH_ROWS, lanes)),
        np.zeros((2, lanes + 1)),
        np.zeros(TERMS),
        np.zeros(size),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
    )


@maker
def results_of(by_storey, totals):
    """Bundle the arrays of the results with the parts that the time loop fills."""
    demands = by_storey[DEMANDS : DEMANDS + DEMAND_ROWS]
    return Results(by_storey[:PEAK_ROWS], by_storey[COUNTS], demands, by_storey, totals)
