"""One single-storey history from its start to its result.

Between two changes of phase the storey is one linear oscillator (stick) or two uncoupled ones
(slip) under a ground acceleration that is linear in time, so its motion is known; what is left is
to find every instant at which the phase changes, and every peak.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.compiler.positions import positions
from fdspec.kernels.friction import friction_work, reaction
from fdspec.kernels.storey.energy import stored_energy
from fdspec.kernels.storey.rest import rest_displacement
from fdspec.kernels.storey.state import motion_of, peaks_of
from fdspec.kernels.storey.step import begin, come_to_rest, resume, take_step
from fdspec.kernels.types import (
    ENERGY_NOT_CLOSED,
    ENERGY_TOLERANCE,
    NON_FINITE_STATE,
    OK,
    STATE,
    STICK,
)

RESULTS = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_base_shear",
    "residual_displacement",
    "slip_travel",
    "transitions",
    "dissipated_energy",
    "input_energy",
    "energy_error",
    "status",
    "peak_slip",
    "residual_slip",
    "peak_brace_force",
    "peak_column_shear",
)
"""What a history leaves behind, in the order of its result row."""
RESULT = positions(RESULTS)

BEYOND = 1e-6
"""Share of a step by which the last output may lie past the last step's end, by rounding of times."""


@inner
def energy_in_play(storey, s, friction):
    """What an error of the balance is measured by, J: the largest of the energies that a history has seen.

    The net input alone may be zero, as over whole periods of a frame without damping.
    """
    peaks = peaks_of(s)
    moved = storey.floor_mass * peaks.velocity * peaks.velocity
    bent = storey.floor_stiffness * peaks.displacement * peaks.displacement
    worked = max(abs(s[STATE.input]) + s[STATE.stored], s[STATE.viscous] + friction)
    return max(worked, 0.5 * max(moved, bent))


@inner
def finish(storey, s, certify, result):
    """Fill ``result`` (see RESULTS) from the state at the end."""
    motion = motion_of(s)
    travel = s[STATE.travel]
    if s[STATE.phase] != STICK:
        travel += s[STATE.phase] * (motion.u - motion.d - s[STATE.anchor])
    friction = s[STATE.release]
    if travel > 0.0:
        friction += friction_work(storey.kinetic_slip_force, travel)
    error = 0.0
    if certify:
        given = s[STATE.input] + s[STATE.stored]
        missing = given - stored_energy(storey, motion) - s[STATE.viscous] - friction
        scale = energy_in_play(storey, s, friction)
        error = abs(missing) / scale if scale > 0.0 else 0.0
    result[RESULT.peak_acceleration] = s[STATE.peak_acceleration]
    result[RESULT.peak_displacement] = s[STATE.peak_displacement]
    result[RESULT.peak_velocity] = s[STATE.peak_velocity]
    result[RESULT.peak_base_shear] = s[STATE.peak_shear]
    result[RESULT.residual_displacement] = motion.u
    result[RESULT.slip_travel] = travel
    result[RESULT.transitions] = s[STATE.transitions]
    result[RESULT.dissipated_energy] = friction
    result[RESULT.input_energy] = s[STATE.input]
    result[RESULT.energy_error] = error
    result[RESULT.status] = s[STATE.status]
    slip = s[STATE.offset] if s[STATE.phase] == STICK else motion.u - motion.d
    result[RESULT.peak_slip] = max(s[STATE.peak_slip], abs(slip))
    result[RESULT.residual_slip] = slip
    result[RESULT.peak_brace_force] = s[STATE.peak_brace]
    result[RESULT.peak_column_shear] = storey.floor_stiffness * s[STATE.peak_displacement]
    size = 0.0
    for k in range(RESULT.status):
        size += abs(result[k])
    if s[STATE.status] == OK:
        if not size < math.inf:
            result[RESULT.status] = NON_FINITE_STATE
        elif error > ENERGY_TOLERANCE:
            result[RESULT.status] = ENERGY_NOT_CLOSED


@inner
def settle_at_rest(storey, s, result):
    """Put the position of rest in the place of that at the end."""
    slip = 0.0 if storey.slip_force == 0.0 else s[STATE.offset]
    result[RESULT.residual_displacement] = rest_displacement(storey, slip)
    result[RESULT.residual_slip] = slip


@inner
def history(
    plan,
    forms,
    ground,
    dt,
    parts,
    free_steps,
    at_rest,
    start,
    resumes,
    s,
    floor,
    brace,
    search,
    times,
    phases,
    dt_out,
    traces,
    result,
):
    """Integrate one history, with its energies, and fill ``result`` (see RESULTS).

    ground: acceleration at the samples, m/s2, (n,); parts: steps of the plan in each dt;
    free_steps: record steps with the ground at rest that follow; at_rest: whether it goes on from there until
    nothing can slip any more, without room for traces.  Returns the record steps that this took.
    start: Motion at t = 0, the brace locked where it stands, unless its velocity differs; resumes: whether
    ``s`` is given in its place, the state in which another history ended.  times, phases: changes of phase as
    far as they have room.  traces (m, len(TRACES)): filled at k dt_out for k < m.
    """
    if resumes:
        resume(plan, s)
    else:
        begin(plan, start, s)
    begun = int(s[STATE.transitions])
    for k in range(min(begun, times.size)):
        times[k] = 0.0
        phases[k] = int(s[STATE.phase])
    if begun == 2 and times.size > 0:
        phases[0] = 1 if reaction(plan.storey, start.u, start.v, start.d) > 0.0 else -1
    written = 0
    steps = ground.size - 1
    total = (steps + free_steps) * parts
    for k in range(total):
        i = k // parts
        j = k - i * parts
        rate = 0.0
        a0 = 0.0
        if i < steps:
            rate = (ground[i + 1] - ground[i]) / dt
            a0 = ground[i] + rate * (j * plan.step)
        reach = BEYOND * plan.step if k + 1 == total else 0.0
        at = i * dt + j * plan.step
        written = take_step(
            plan,
            forms,
            s,
            at,
            a0,
            rate,
            True,
            False,
            False,
            floor,
            brace,
            search,
            times,
            phases,
            traces,
            dt_out,
            written,
            reach,
        )
        if s[STATE.status] != OK:
            break
    taken = (
        come_to_rest(plan, forms, s, parts, True, floor, brace, search, times, phases, traces)
        if at_rest
        else 0
    )
    finish(plan.storey, s, True, result)
    if at_rest and s[STATE.status] == OK:
        settle_at_rest(plan.storey, s, result)
    return taken
