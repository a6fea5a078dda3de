"""Every slip force for each of many single storeys under one ground motion, by a method beside the exact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fdspec.engines.trajectory import Span, Trajectory
from fdspec.kernels.storey.history import RESULTS
from fdspec.methods import Method
from fdspec.model.building import Building, DampingMatrix
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]


def integrate_by_method(
    method: Method,
    frames: FloatArray,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    motion: GroundMotion,
    free_steps: int = 0,
) -> FloatArray:
    """Return results (m, p, len(RESULTS)) of frames (m, 6) under each of the slip forces (p,).

    A frame's row: floor mass, damping, stiffness, brace mass, damping, stiffness, SI units.
    """
    results = np.empty((frames.shape[0], slip_force.size, len(RESULTS)))
    span = Span(free_steps, motion.duration + free_steps * motion.dt, 2)
    for row, frame in enumerate(frames):
        for column, forces in enumerate(zip(slip_force, kinetic_slip_force, strict=True)):
            building = _building(frame, *forces)
            start = np.zeros((2, 2, 1))
            results[row, column] = _results(method.integrate(building, motion, span, start))
    return results


def _building(frame: FloatArray, slip_force: float, kinetic_slip_force: float) -> Building:
    m_f, c_f, k_f, m_d, c_d, k_d = frame.tolist()
    damping = DampingMatrix([[c_f]])
    if k_d == 0.0:  # no brace, and so nothing to slip on
        return Building(m_f, k_f, 0.0, 0.0, 0.0, damping=damping)
    return Building(m_f, k_f, m_d, k_d, slip_force, kinetic_slip_force, damping, c_d)


def _results(trajectory: Trajectory) -> tuple[float, ...]:
    """Return a row in the order of RESULTS."""
    values = {
        "peak_acceleration": trajectory.peak_acceleration[0],
        "peak_displacement": trajectory.peak_displacement[0],
        "peak_velocity": trajectory.peak_velocity[0],
        "peak_base_shear": trajectory.peak_base_shear,
        "residual_displacement": trajectory.residual_displacement[0],
        "slip_travel": trajectory.slip_travel[-1, 0],
        "transitions": trajectory.transition_time.size,
        "dissipated_energy": trajectory.dissipated_energy,
        "input_energy": trajectory.input_energy[-1],
        "energy_error": trajectory.energy_error,
        "status": trajectory.status,
        "peak_slip": trajectory.peak_slip[0],
        "residual_slip": trajectory.residual_slip[0],
        "peak_brace_force": trajectory.peak_brace_force[0],
        "peak_column_shear": trajectory.peak_column_shear[0],
    }
    return tuple(float(values[name]) for name in RESULTS)
