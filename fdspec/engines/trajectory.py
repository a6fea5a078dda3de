"""What an engine returns of one history, before it is a Dataset: plain arrays, one form for every engine."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Trajectory:
    """One history: at m output instants, for N storeys, with n changes of phase; SI units.

    Arrays over time are (m, N) unless said otherwise, arrays of peaks (N,).
    """

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    brace_displacement: FloatArray
    brace_velocity: FloatArray
    friction_force: FloatArray
    phase: IntArray
    slip_travel: FloatArray
    storey_friction_energy: FloatArray
    storey_shear: FloatArray
    input_energy: FloatArray
    """(m,)"""
    viscous_energy: FloatArray
    """(m,)"""
    transition_time: FloatArray
    """(n,)"""
    transition_storey: IntArray
    """(n,), from 0"""
    transition_phase: IntArray
    """(n,)"""
    peak_acceleration: FloatArray
    peak_displacement: FloatArray
    peak_velocity: FloatArray
    peak_drift: FloatArray
    peak_storey_shear: FloatArray
    peak_base_shear: float
    residual_displacement: FloatArray
    peak_slip: FloatArray
    residual_slip: FloatArray
    peak_brace_force: FloatArray
    peak_column_shear: FloatArray
    dissipated_energy: float
    energy_error: float
    status: int
    end: FloatArray | None = None
    """The engine's own state at the end, (k,), from which it goes on; None where a method keeps none."""


@dataclass(frozen=True)
class DeviceTrajectory:
    """What devices add to a history; over time (m,), (m, N) and (m, L), else (N,) and (L,)."""

    brace_force: FloatArray
    column_shear: FloatArray
    plastic_deformation: FloatArray
    kinetic_energy: FloatArray
    strain_energy: FloatArray
    bearing_energy: FloatArray
    gravity_energy: FloatArray
    column_work: FloatArray
    """(m, N) J dissipated in the columns so far."""
    link_slip: FloatArray
    link_force: FloatArray
    link_phase: IntArray
    link_work: FloatArray
    storeys: dict[str, FloatArray]
    """What each storey has of its own at the end, by name: `fdspec.variables.device_variables`."""
    peak_link_slip: FloatArray
    residual_link_slip: FloatArray
    peak_link_force: FloatArray
    link_energy: FloatArray
    link_events: IntArray
    link_contacts: IntArray
    collapse_storey: int
    """Storey whose drift reached its limit, counted from 1; 0: none."""
    collapse_time: float
    """s"""
    collapse_drift: float
    """That limit, m."""


@dataclass(frozen=True)
class TrajectoryWithDevices(Trajectory):
    """One history of a building with devices."""

    devices: DeviceTrajectory = field(kw_only=True)


@dataclass(frozen=True)
class Span:
    """How long a history runs, and how often its state is written out."""

    free_steps: int
    """Steps of the record's dt with the ground at rest that follow the record."""
    dt_out: float
    """Time between outputs, s."""
    outputs: int
    """Number of outputs, the first at t = 0."""


@dataclass(frozen=True)
class Rest:
    """How a building comes to rest once its dampers can slip no more."""

    steps: int
    """Steps of the record's dt, the ground at rest, until nothing can slip any more."""
    displacement: FloatArray
    """(N,) m, in the end"""
    slip: FloatArray
    """(N,) m"""
    status: int = 0
