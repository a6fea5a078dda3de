"""What a history of N storeys leaves behind at its end, whether it ran alone or beside others."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE
from fdspec.kernels.frame.reset import RELEASE, travel_so_far
from fdspec.kernels.frame.results import RESULT, TOTAL
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET
from fdspec.kernels.friction import friction_work


@inner
def fill_storeys(frame, phase, state, tally, by_storey):
    """Fill what each storey has at the end; return the energy (J) that all dampers dissipated."""
    friction = 0.0
    for i in range(phase.size):
        travel = travel_so_far(phase, state[OFFSET, i], tally, i)
        work = tally[RELEASE, i]
        if travel > 0.0:
            work += friction_work(frame[KINETIC_SLIP_FORCE, i], travel)
        friction += work
        by_storey[RESULT.residual_displacement, i] = state[DISPLACEMENT, i]
        by_storey[RESULT.residual_brace_displacement, i] = state[DISPLACEMENT, i] - state[OFFSET, i]
        by_storey[RESULT.residual_slip, i] = state[OFFSET, i]
        by_storey[RESULT.slip_travel, i] = travel
        by_storey[RESULT.storey_friction_energy, i] = work
    return friction


@inner
def fill_totals(transitions, friction, viscous, work_in, error, status, totals):
    """Fill what the whole building has: energies in J, the error of their balance, a status code."""
    totals[TOTAL.transitions] = transitions
    totals[TOTAL.dissipated_energy] = friction
    totals[TOTAL.viscous_energy] = viscous
    totals[TOTAL.input_energy] = work_in
    totals[TOTAL.energy_error] = error
    totals[TOTAL.status] = status
