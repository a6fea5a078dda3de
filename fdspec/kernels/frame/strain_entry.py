"""Entry point for the strain energy of a frame's history alone; compiled where an index asks for it."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, given1d, given2d
from fdspec.kernels.frame.arrays import Log, Strain, Traces
from fdspec.kernels.frame.groups_of_four import LANES
from fdspec.kernels.frame.history import history
from fdspec.kernels.frame.results import END, END_ROWS, TOTALS
from fdspec.kernels.frame.room import matrices_of, results_of, room_for
from fdspec.kernels.frame.taylor import TERMS


@entry(types.void(given2d, given2d, given2d, given1d, types.float64, types.float64, float1d))
def integrate_frame_strain(frame, dense_stiffness, dense_damping, ground, dt, radians, result):
    """Integrate the strain energy of a frame of N storeys from rest.

    Arguments as in :func:`fdspec.kernels.frame.entry.integrate`.  Filled: result (3,), as in
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
