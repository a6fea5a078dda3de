"""Entry points for one history of a frame of N storeys: all its results, or its strain energy alone."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, float3d, inner, int1d, maker
from fdspec.kernels.frame.arrays import Log, Matrices, Results, Room, Strain, Traces
from fdspec.kernels.frame.groups_of_four import LANES
from fdspec.kernels.frame.history import history
from fdspec.kernels.frame.model import MODEL_ROWS
from fdspec.kernels.frame.peaks import PEAK_ROWS
from fdspec.kernels.frame.reset import TALLY_ROWS
from fdspec.kernels.frame.results import COUNTS, DEMAND_ROWS, DEMANDS, END, END_ROWS, TOTALS
from fdspec.kernels.frame.taylor import QUANTITIES, REACH_ROWS, TERMS

given1d = types.Array(types.float64, 1, "C", readonly=True)
given2d = types.Array(types.float64, 2, "C", readonly=True)


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


@entry(
    types.void(
        given2d,
        given2d,
        given2d,
        given1d,
        types.float64,
        types.int64,
        types.boolean,
        given2d,
        types.float64,
        types.int64,
        float1d,
        int1d,
        int1d,
        types.float64,
        float3d,
        float2d,
        float2d,
        float1d,
    )
)
def integrate(
    frame,
    dense_stiffness,
    dense_damping,
    ground,
    dt,
    free_steps,
    certify,
    start,
    radians,
    extra,
    times,
    storeys,
    phases,
    dt_out,
    traces,
    energies,
    by_storey,
    totals,
):
    """Integrate one history of a frame of N storeys.

    frame (FRAME_ROWS, N), dense_stiffness and dense_damping (N, N), or (0, 0) where there is nothing
    beside the springs and dashpots of ``frame``: see :mod:`fdspec.kernels.frame.model`.  ground: acceleration
    at the samples dt apart, m/s2, (n,); free_steps: steps of dt with the ground at rest that follow.
    start (4, N): displacement and velocity of floors, then of braces, at t = 0; or (7, N): the rows of the
    end of another history, from which this one goes on.  radians: longest phase of a step; extra: terms
    beyond those the series needs.

    times, storeys, phases (as many as there is room for): changes of phase in the order of time.
    traces (m, len(STOREY_TRACES), N), energies (m, len(TOTAL_TRACES)): filled at k dt_out for k < m.
    by_storey (END + END_ROWS, N), totals (len(TOTALS),): results.  viscous_energy and energy_error
    are worked out where ``certify`` says so; traces need the first and cost it.
    """
    size = frame.shape[1]
    lanes = LANES * ((size + LANES - 1) // LANES)
    by_storey[:] = 0.0
    history(
        frame,
        matrices_of(dense_stiffness, dense_damping, lanes),
        ground,
        dt,
        free_steps,
        certify,
        start,
        radians,
        extra,
        room_for(size, lanes),
        Log(times, storeys, phases),
        dt_out,
        Traces(traces, energies),
        results_of(by_storey, totals),
        None,
    )


@entry(types.void(given2d, given2d, given2d, given1d, types.float64, types.float64, float1d))
def integrate_frame_strain(frame, dense_stiffness, dense_damping, ground, dt, radians, result):
    """Integrate the strain energy of a frame of N storeys from rest.

    Arguments as in :func:`integrate`.  Filled: result (3,), as in
    :data:`fdspec.kernels.storey.strain.STRAIN_RESULTS`.
    """
    size = frame.shape[1]
    lanes = LANES * ((size + LANES - 1) // LANES)
    history(
        frame,
        matrices_of(dense_stiffness, dense_damping, lanes),
        ground,
        dt,
        0,
        False,
        np.zeros((4, size)),
        radians,
        0,
        room_for(size, lanes),
        Log(np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64)),
        0.0,
        Traces(np.empty((0, 0, 0)), np.empty((0, 0))),
        results_of(np.zeros((END + END_ROWS, size)), np.zeros(len(TOTALS))),
        Strain(np.zeros(max(TERMS, size)), result),
    )
