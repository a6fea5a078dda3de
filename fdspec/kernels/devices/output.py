"""The motion of a frame with devices at an output instant."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.compiler.positions import positions
from fdspec.kernels.devices.energy import energy_in_bearing, kinetic_energy, strain_energy, work_of_gravity
from fdspec.kernels.devices.layout import (
    BRACE,
    FRICTION_GROWTH,
    KIND,
    KINETIC,
    ONE_SIDED,
    PHASE,
    REACTION,
    TRAVEL,
    WORK,
    A,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.devices.peaks import shear_below
from fdspec.kernels.devices.tally import travel_since, work_since
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.polynomial_roots import value
from fdspec.kernels.types import STICK

FLOOR_TRACES = ("displacement", "velocity", "acceleration", "storey_shear")
"""Columns of ``floor_traces`` (m, 4, N)."""
FLOOR = positions(FLOOR_TRACES)

LINK_TRACES = ("offset", "sliding_velocity", "friction_force", "force", "phase", "travel", "work")
"""Columns of ``link_traces`` (m, 7, L)."""
LINK = positions(LINK_TRACES)

TOTAL_TRACES = (
    "input_energy",
    "viscous_energy",
    "kinetic_energy",
    "strain_energy",
    "bearing_energy",
    "gravity_energy",
)
"""Columns of ``energies`` (m, 6)."""
ENERGY = positions(TOTAL_TRACES)


@inner
def state_at(series, n, x, floors, sliders):
    """Set floors and sliders to the motion at the fraction x of the step."""
    for i in range(1, floors.shape[1]):
        floors[U, i] = value(series.floors[U, i], n, x)
        floors[V, i] = value(series.floors[V, i], n, x)
    for j in range(sliders.shape[1]):
        sliders[O, j] = value(series.sliders[O, j], n, x)
        sliders[Z, j] = value(series.sliders[Z, j], n, x)


@inner
def write_traces(frame, state, then, series, n, h, y, floor_traces, link_traces, energies, row):
    """Write the motion at the fraction y of a step, before what happens at its end.

    then: room for the state at that instant; the works of ground and dashpots are not written here.
    """
    state_at(series, n, y, then.floors, then.sliders)
    for i in range(1, frame.mass.size):
        floor_traces[row, FLOOR.displacement, i - 1] = then.floors[U, i]
        floor_traces[row, FLOOR.velocity, i - 1] = then.floors[V, i]
        floor_traces[row, FLOOR.acceleration, i - 1] = value(series.floors[A, i], n - 1, y)
        shear_below(frame, series, n, h, frame.carried[i - 1], series.c)
        floor_traces[row, FLOOR.storey_shear, i - 1] = value(series.c, n - 1, y)
    for j in range(frame.places.shape[1]):
        offset = then.sliders[O, j]
        phase = state.mode[PHASE, j]
        force = value(series.sliders[BRACE, j], n - 1, y)
        friction = force
        if frame.places[KIND, j] != ONE_SIDED:
            if phase == STICK:
                friction = value(series.sliders[REACTION, j], n - 1, y)
            else:
                friction = sliding_force(
                    phase, frame.links[KINETIC, j] + frame.links[FRICTION_GROWTH, j] * abs(offset)
                )
        link_traces[row, LINK.offset, j] = offset
        link_traces[row, LINK.sliding_velocity, j] = then.sliders[Z, j]
        link_traces[row, LINK.friction_force, j] = friction
        link_traces[row, LINK.force, j] = force
        link_traces[row, LINK.phase, j] = phase
        link_traces[row, LINK.travel, j] = state.tally[TRAVEL, j] + travel_since(frame, state, j, offset)
        link_traces[row, LINK.work, j] = state.tally[WORK, j] + work_since(frame, state, j, offset)
    energies[row, ENERGY.kinetic_energy] = kinetic_energy(frame, then)
    energies[row, ENERGY.strain_energy] = strain_energy(frame, then)
    energies[row, ENERGY.bearing_energy] = energy_in_bearing(frame, then)
    energies[row, ENERGY.gravity_energy] = work_of_gravity(frame, then)
