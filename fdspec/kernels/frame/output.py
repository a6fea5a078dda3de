"""The motion of a frame at an output instant."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.compiler.positions import positions
from fdspec.kernels.frame.energy import kinetic_energy, strain_energy
from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE
from fdspec.kernels.frame.peaks import storey_shear
from fdspec.kernels.frame.reset import RELEASE, travel_so_far
from fdspec.kernels.frame.taylor import (
    DISPLACEMENT,
    INERTIA,
    OFFSET,
    REACTION,
    SLIDING,
    VELOCITY,
    end_of_step,
)
from fdspec.kernels.friction import friction_work, sliding_force
from fdspec.kernels.mathematics.polynomial_roots import value
from fdspec.kernels.types import STICK

STOREY_TRACES = (
    "displacement",
    "velocity",
    "acceleration",
    "storey_shear",
    "brace_displacement",
    "brace_velocity",
    "friction_force",
    "phase",
    "slip_travel",
    "storey_friction_energy",
)
"""Columns of ``traces`` (m, 10, N)."""
TRACE = positions(STOREY_TRACES)

TOTAL_TRACES = ("input_energy", "viscous_energy", "kinetic_energy", "strain_energy")
"""Columns of ``energies`` (m, 4)."""
ENERGY = positions(TOTAL_TRACES)


@inner
def write_traces(frame, dense_stiffness, phase, series, n, h, y, tally, motion, c, traces, energies, row):
    """Write the motion at the fraction y of a step, before what happens at its end.

    motion (4, N) is room for the state at that instant; the works of ground and dashpots are not
    written here.
    """
    size = frame.shape[1]
    end_of_step(series, n, y, motion)
    for i in range(size):
        traces[row, TRACE.displacement, i] = motion[DISPLACEMENT, i]
        traces[row, TRACE.velocity, i] = motion[VELOCITY, i]
        traces[row, TRACE.acceleration, i] = value(series[INERTIA, i + 1], n - 1, y)
        storey_shear(frame, series, n, h, i, c)
        traces[row, TRACE.storey_shear, i] = value(c, n - 1, y)
        traces[row, TRACE.brace_displacement, i] = motion[DISPLACEMENT, i] - motion[OFFSET, i]
        traces[row, TRACE.brace_velocity, i] = motion[VELOCITY, i] - motion[SLIDING, i]
        force = sliding_force(phase[i], frame[KINETIC_SLIP_FORCE, i])
        if phase[i] == STICK:
            force = value(series[REACTION, i + 1], n - 1, y)
        traces[row, TRACE.friction_force, i] = force
        traces[row, TRACE.phase, i] = phase[i]
        travel = travel_so_far(phase, motion[OFFSET, i], tally, i)
        traces[row, TRACE.slip_travel, i] = travel
        work = tally[RELEASE, i]
        if travel > 0.0:
            work += friction_work(frame[KINETIC_SLIP_FORCE, i], travel)
        traces[row, TRACE.storey_friction_energy, i] = work
    energies[row, ENERGY.kinetic_energy] = kinetic_energy(frame, motion)
    energies[row, ENERGY.strain_energy] = strain_energy(frame, dense_stiffness, motion)
