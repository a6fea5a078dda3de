"""What a single-storey history writes down at an output instant."""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner
from fdspec.compiler.positions import positions
from fdspec.kernels.friction import friction_work, sliding_force
from fdspec.kernels.mathematics.polynomial_roots import value_slope
from fdspec.kernels.storey.energy import series_work
from fdspec.kernels.storey.stick import held_force
from fdspec.kernels.types import STICK, Motion

TRACES = (
    "displacement",
    "velocity",
    "acceleration",
    "brace_displacement",
    "brace_velocity",
    "friction_force",
    "phase",
    "slip_travel",
    "input_energy",
    "viscous_energy",
    "friction_energy",
)
"""What is written at each output instant, in the order of the columns."""
TRACE = positions(TRACES)


@inlined
def floor_acceleration(plan, phase, offset, motion):
    """Absolute acceleration of the floor, m/s2."""
    if phase == STICK:
        b = plan.stick
        return plan.lift * offset - b.g * motion.v - b.w2 * motion.u
    b = plan.floor
    push = sliding_force(phase, plan.storey.kinetic_slip_force) / plan.storey.floor_mass
    return -push - b.g * motion.v - b.w2 * motion.u


@inner
def write_trace(plan, floor, brace, n, phase, offset, anchor, travel, so_far, acceleration, rate, h, x, row):
    """Fill one row (see TRACES) at the fraction x of an expanded segment of length h."""
    storey = plan.storey
    u, rise = value_slope(floor, 0, n, x)
    v = rise / h
    done, lost = series_work(plan, phase, floor, brace, n, acceleration, rate, h, x, True)
    if phase == STICK:
        d = u - offset
        e = v
        friction = held_force(plan, u, v, offset)
    else:
        d, rise = value_slope(brace, 0, n, x)
        e = rise / h
        friction = sliding_force(phase, storey.kinetic_slip_force)
        travel += phase * (u - d - anchor)
    row[TRACE.displacement] = u
    row[TRACE.velocity] = v
    row[TRACE.acceleration] = floor_acceleration(plan, phase, offset, Motion(u, v, d, e))
    row[TRACE.brace_displacement] = d
    row[TRACE.brace_velocity] = e
    row[TRACE.friction_force] = friction
    row[TRACE.phase] = phase
    row[TRACE.slip_travel] = travel
    row[TRACE.input_energy] = so_far.input + done
    row[TRACE.viscous_energy] = so_far.viscous + lost
    work = friction_work(storey.kinetic_slip_force, travel) if travel > 0.0 else 0.0
    row[TRACE.friction_energy] = so_far.release + work
