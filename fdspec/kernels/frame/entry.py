"""Entry point for one history of a frame of N storeys, with all its results."""

from __future__ import annotations

from numba import types

from fdspec.compiler.options import entry, float1d, float2d, float3d, given1d, given2d, int1d
from fdspec.kernels.frame.arrays import Log, Traces
from fdspec.kernels.frame.groups_of_four import LANES
from fdspec.kernels.frame.history import history
from fdspec.kernels.frame.room import matrices_of, results_of, room_for


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
