"""Strain energy of single-storey histories, its area and its maximum, for Filiatrault and Cherry's index."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fdspec.kernels.storey.constants import RADIANS
from fdspec.kernels.storey.strain import STRAIN_RESULTS
from fdspec.kernels.storey.strain_entry import integrate_strain
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]

ROOM = 256
"""Changes of phase on one step for which there is room at first."""


def strain_of_storeys(storeys: FloatArray, motion: GroundMotion, radians: float = RADIANS) -> FloatArray:
    """Integrate storeys (m, 8), rows of `fdspec.kernels.types.Storey`; return (m, len(STRAIN_RESULTS)).

    radians: longest phase of a segment that is searched for roots; it moves no result.
    """
    results = np.empty((storeys.shape[0], len(STRAIN_RESULTS)))
    rows = np.ascontiguousarray(storeys, dtype=np.float64)
    room = ROOM
    while True:
        times, phases = np.empty(room), np.empty(room, np.int64)
        busiest = integrate_strain(rows, motion.acceleration, motion.dt, radians, phases, times, results)
        if busiest <= room:
            return results
        room = 2 * int(busiest)


def strain_of_columns(
    frames: FloatArray, slip_force: FloatArray, kinetic_slip_force: FloatArray, motion: GroundMotion
) -> FloatArray:
    """Integrate frames (m, 6) under each of the slip forces (p,); return areas and maxima (m, p, 2).

    Arguments as in `fdspec.engines.batch.integrate_columns`, whose status is that of these histories too.
    """
    m, p = frames.shape[0], slip_force.size
    storeys = np.column_stack(
        [np.repeat(frames, p, axis=0), np.tile(slip_force, m), np.tile(kinetic_slip_force, m)]
    )
    return strain_of_storeys(storeys, motion)[:, :2].reshape(m, p, 2)
