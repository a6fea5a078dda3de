"""What a history of N storeys leaves behind at its end, whether it ran alone or beside others."""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.frame.demands import finish_demands
from fdspec.kernels.frame.energy import stored_energy
from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE
from fdspec.kernels.frame.reset import RELEASE, travel_so_far
from fdspec.kernels.frame.results import END, RESULT, TOTAL
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET
from fdspec.kernels.friction import friction_work
from fdspec.kernels.types import ENERGY_NOT_CLOSED, ENERGY_TOLERANCE, NON_FINITE_STATE, OK


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


@inner
def finish(
    frame,
    dense_stiffness,
    only_columns,
    certify,
    phase,
    vanishing,
    touching,
    state,
    tally,
    balance,
    transitions,
    status,
    results,
):
    """Fill all results from the state at the end; ``balance``: see `fdspec.kernels.frame.arrays.Balance`."""
    friction = fill_storeys(frame, phase, state, tally, results.by_storey)
    finish_demands(frame, only_columns, results.peaks, results.demands)
    for i in range(phase.size):
        for k in range(4):
            results.by_storey[END + k, i] = state[k, i]
        results.by_storey[END + 4, i] = phase[i]
        results.by_storey[END + 5, i] = vanishing[i]
        results.by_storey[END + 6, i] = touching[i]
    work_in, most_in, viscous, stored = balance
    error = 0.0
    if certify:
        # Net input may be zero, as over whole periods of a frame without damping; what the balance has to
        # resolve is the most that was ever put in.
        scale = max(most_in + stored, viscous + friction)
        if scale > 0.0:
            now = stored_energy(frame, dense_stiffness, state)
            error = abs(work_in + stored - now - viscous - friction) / scale
    if status == OK:
        if not math.isfinite(friction + viscous + work_in + error):
            status = NON_FINITE_STATE
        elif error > ENERGY_TOLERANCE:
            status = ENERGY_NOT_CLOSED
    fill_totals(transitions, friction, viscous, work_in, error, status, results.totals)
