"""The motion of a frame at an output instant."""

from __future__ import annotations

from fdspec.compiler.options import inner
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

TOTAL_TRACES = ("input_energy", "viscous_energy", "kinetic_energy", "strain_energy")
"""Columns of ``energies`` (m, 4)."""


@inner
def write_traces(frame, dense_stiffness, phase, series, n, h, y, tally, motion, c, traces, energies, row):
    """Write the motion at the fraction y of a step, before what happens at its end.

    motion (4, N) is room for the state at that instant; the works of ground and dashpots are not
    written here.
    """
    size = frame.shape[1]
    end_of_step(series, n, y, motion)
    for i in range(size):
        traces[row, 0, i] = motion[DISPLACEMENT, i]
        traces[row, 1, i] = motion[VELOCITY, i]
        traces[row, 2, i] = value(series[INERTIA, i + 1], n - 1, y)
        storey_shear(frame, series, n, h, i, c)
        traces[row, 3, i] = value(c, n - 1, y)
        traces[row, 4, i] = motion[DISPLACEMENT, i] - motion[OFFSET, i]
        traces[row, 5, i] = motion[VELOCITY, i] - motion[SLIDING, i]
        force = phase[i] * frame[KINETIC_SLIP_FORCE, i]
        if phase[i] == STICK:
            force = value(series[REACTION, i + 1], n - 1, y)
        traces[row, 6, i] = force
        traces[row, 7, i] = phase[i]
        travel = travel_so_far(phase, motion[OFFSET, i], tally, i)
        traces[row, 8, i] = travel
        traces[row, 9, i] = tally[RELEASE, i]
        if travel > 0.0:
            traces[row, 9, i] += frame[KINETIC_SLIP_FORCE, i] * travel
    energies[row, 2] = kinetic_energy(frame, motion)
    energies[row, 3] = strain_energy(frame, dense_stiffness, motion)
