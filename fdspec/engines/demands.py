"""Demands over time, from the trajectory at output instants."""

from __future__ import annotations

import numpy as np

from fdspec.engines.trajectory import FloatArray, Trajectory, TrajectoryWithDevices
from fdspec.model.building import Building


def column_shear_of(building: Building, trajectory: Trajectory) -> FloatArray:
    """Shear force (m, N) in the columns of each storey, N: what the bare frame's springs carry."""
    if isinstance(trajectory, TrajectoryWithDevices):
        return trajectory.devices.column_shear
    if building.storey_stiffness.ndim == 1:
        return np.asarray(building.storey_stiffness * np.diff(trajectory.displacement, axis=1, prepend=0.0))
    force = trajectory.displacement @ building.stiffness_matrix
    return np.ascontiguousarray(np.cumsum(force[:, ::-1], axis=1)[:, ::-1])


def brace_force_of(building: Building, trajectory: Trajectory) -> FloatArray:
    """Force (m, N) in the spring and dashpot of each brace, N, positive with the brace's stretch.

    A massless brace that slips carries friction alone, whatever rounding leaves of its velocity.
    """
    below, below_rate = (
        np.hstack([np.zeros((x.shape[0], 1)), x[:, :-1]])
        for x in (trajectory.displacement, trajectory.velocity)
    )
    if isinstance(trajectory, TrajectoryWithDevices):
        return trajectory.devices.brace_force
    force = building.brace_stiffness * (trajectory.brace_displacement - below)
    force += building.brace_damping * (trajectory.brace_velocity - below_rate)
    slips = (trajectory.phase != 0) & (building.brace_mass == 0.0) & (building.brace_stiffness > 0.0)
    return np.where(slips, trajectory.friction_force, force)
