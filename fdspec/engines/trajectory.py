"""What an engine returns of one history, before it is a Dataset: plain arrays, one form for every engine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Course:
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
    dissipated_energy: float
    energy_error: float
    status: int


@dataclass(frozen=True)
class Span:
    """How long a history runs and how often it is told."""

    free_steps: int
    """Steps of the record's dt with the ground at rest that follow the record."""
    dt_out: float
    """Time between outputs, s."""
    outputs: int
    """Number of outputs, the first at t = 0."""
