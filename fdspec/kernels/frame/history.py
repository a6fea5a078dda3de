"""One history of a frame of N storeys, event by event.

Between two changes of phase the frame is linear and its forcing linear in time.  Its motion over a
step of a few radians of its fastest part is a Taylor series complete to rounding, in which every
storey's reaction and sliding velocity is a polynomial: the first root of any of them ends the step,
that storey changes its phase, and the next step starts there.  Only storeys that slip have their
brace in the motion, so a frame that sticks is stepped as slowly as its record.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, float3d, inner, int1d
from fdspec.kernels.frame.demands import (
    finish_demands,
    has_only_columns,
    raise_column_shears,
    raise_demands,
)
from fdspec.kernels.frame.energy import (
    input_work,
    stored_energy,
    viscous_work,
)
from fdspec.kernels.frame.finish import fill_storeys, fill_totals
from fdspec.kernels.frame.groups_of_four import LANES
from fdspec.kernels.frame.model import (
    MASSLESS,
    MODEL_ROWS,
    NO_BRACE,
    PLAIN,
    SLIP_FORCE,
    fastest_rate,
    held_rates,
    is_damped,
    is_grounded,
    kind_of,
    prepare,
    rate_of,
    set_phase,
)
from fdspec.kernels.frame.output import ENERGY, write_traces
from fdspec.kernels.frame.peaks import PEAK_ROWS, raise_peaks
from fdspec.kernels.frame.reset import (
    TALLY_ROWS,
    begin_free,
    begin_slip,
    returns_at_once,
    stay_sprung,
)
from fdspec.kernels.frame.results import COUNTS, DEMAND_ROWS, DEMANDS, END, END_ROWS, NO_TIME
from fdspec.kernels.frame.step import change_phases, look_ahead
from fdspec.kernels.frame.taylor import (
    DISPLACEMENT,
    OFFSET,
    QUANTITIES,
    REACH_ROWS,
    SLIDING,
    TERMS,
    VELOCITY,
    end_of_step,
    order_for,
    reaction_now,
    relax,
)
from fdspec.kernels.types import (
    ENERGY_NOT_CLOSED,
    ENERGY_TOLERANCE,
    NON_FINITE_STATE,
    OK,
    TRANSITION_CAP,
    TRANSITION_CAP_REACHED,
)

given1d = types.Array(types.float64, 1, "C", readonly=True)
given2d = types.Array(types.float64, 2, "C", readonly=True)


@inner
def history(
    frame,
    dense_stiffness,
    dense_damping,
    stiffness_lanes,
    damping_lanes,
    ground,
    dt,
    free_steps,
    certify,
    start,
    radians,
    extra,
    model,
    state,
    motion,
    tally,
    series,
    momentum,
    reach,
    speeds,
    c,
    instants,
    signs,
    kind,
    phase,
    vanishing,
    touching,
    times,
    storeys,
    phases,
    dt_out,
    traces,
    energies,
    peaks,
    counts,
    demands,
    by_storey,
    totals,
):
    """Integrate one history: arguments as in :func:`integrate`, and zeroed room to work in.

    The matrices in lanes have zeros up to a multiple of four.
    """
    size = frame.shape[1]
    damped = is_damped(frame)
    grounded = is_grounded(frame)
    only_columns = has_only_columns(frame, dense_stiffness)
    held = held_rates(frame, dense_stiffness, dense_damping)
    held_rate = rate_of(held[0], held[1])
    prepare(frame, model, held)
    massless = False
    for i in range(size):
        kind[i] = kind_of(frame, i)
        massless = massless or kind[i] == MASSLESS
        state[DISPLACEMENT, i] = start[0, i]
        state[VELOCITY, i] = start[1, i]
        state[OFFSET, i] = start[0, i] - start[2, i]
        state[SLIDING, i] = start[1, i] - start[3, i] if kind[i] == PLAIN else 0.0
        if kind[i] == NO_BRACE:
            state[OFFSET, i] = 0.0
        tally[0, i] = state[OFFSET, i]
        set_phase(frame, model, phase, i)
    resumes = start.shape[0] == END_ROWS
    if resumes:
        for i in range(size):
            for k in range(4):
                state[k, i] = start[k, i]
            tally[0, i] = state[OFFSET, i]
            phase[i] = int(start[4, i])
            vanishing[i] = int(start[5, i])
            touching[i] = int(start[6, i])
    stored = stored_energy(frame, dense_stiffness, state)
    transitions = 0
    # Massless braces first: what they do at once is felt in the storeys below, and not the other way.
    for turn in range(2):
        for i in range(size):
            if resumes or kind[i] == NO_BRACE or (kind[i] == MASSLESS) != (turn == 0):
                continue
            reaction = reaction_now(frame, model, stiffness_lanes, damping_lanes, state, i)
            changes = 0
            if frame[SLIP_FORCE, i] == 0.0:
                if kind[i] == MASSLESS:
                    begin_free(frame, phase, vanishing, state, tally, i)
                else:
                    speed = state[SLIDING, i]
                    begin_slip(
                        frame, kind, phase, vanishing, state, tally, i, 1 if speed >= 0.0 else -1, False
                    )
                    state[SLIDING, i] = speed
                    vanishing[i] = 0
            elif state[SLIDING, i] != 0.0:
                phase[i] = 1 if state[SLIDING, i] > 0.0 else -1
            elif abs(reaction) > frame[SLIP_FORCE, i]:
                begin_slip(frame, kind, phase, vanishing, state, tally, i, 1 if reaction > 0.0 else -1, False)
                # The reaction is beyond the limit, not at it: sliding accelerates, or a dashpot lets it begin
                # with (|R| - F) / c_d.
                vanishing[i] = 1 if kind[i] == PLAIN else 0
                changes = 2 if returns_at_once(frame, kind, phase, state, i) else 1
            for change in range(changes):
                if change > 0:
                    stay_sprung(phase, vanishing, touching, state, tally, i)
                if transitions < times.size:
                    times[transitions] = 0.0
                    storeys[transitions] = i
                    phases[transitions] = phase[i]
                transitions += 1
                counts[i] += 1.0
            if turn == 0:
                set_phase(frame, model, phase, i)
    for i in range(size):
        set_phase(frame, model, phase, i)
    rate = fastest_rate(model, phase, held_rate)

    tracing = traces.shape[0] > 0
    status = OK
    work_in = 0.0
    most_in = 0.0
    viscous = 0.0
    written = 0
    events = 0
    steps = ground.size - 1
    for step in range(steps + free_steps):
        a0 = 0.0
        slope = 0.0
        if step < steps:
            a0 = ground[step]
            slope = (ground[step + 1] - a0) / dt
        tau = 0.0
        while True:
            if massless:
                relax(frame, model, kind, phase, vanishing, state)
                rate = fastest_rate(model, phase, held_rate)
            radian = min(dt, 1.0 / rate)
            parts = max(1, math.ceil((dt - tau) * rate / radians - 1e-9))
            h = (dt - tau) / parts
            n = order_for(rate * h, extra)
            acceleration = a0 + slope * tau
            rise = slope * h
            x = look_ahead(
                frame,
                model,
                stiffness_lanes,
                damping_lanes,
                damped,
                grounded,
                massless,
                kind,
                phase,
                vanishing,
                touching,
                state,
                tally,
                series,
                momentum,
                reach,
                n,
                h,
                step * dt + tau,
                radian,
                acceleration,
                rise,
                c,
                instants,
                signs,
            )
            happens = x <= 1.0
            done = x if happens else 1.0
            if tracing:
                reached = tau + h * done
                final = step == steps + free_steps - 1 and not happens and parts == 1
                while written < traces.shape[0]:
                    at = written * dt_out - step * dt
                    if at > reached and not (final and at <= reached + 1e-6 * dt):
                        break
                    y = min(max((at - tau) / h, 0.0), done)
                    energies[written, ENERGY.input_energy] = work_in + input_work(
                        momentum, n, h, acceleration, rise, y
                    )
                    energies[written, ENERGY.viscous_energy] = viscous + viscous_work(
                        frame, dense_damping, damped, series, n, h, y, speeds
                    )
                    write_traces(
                        frame,
                        dense_stiffness,
                        phase,
                        series,
                        n,
                        h,
                        y,
                        tally,
                        motion,
                        c,
                        traces,
                        energies,
                        written,
                    )
                    written += 1
            if done > 0.0:
                work_in += input_work(momentum, n, h, acceleration, rise, done)
                most_in = max(most_in, abs(work_in))
                if certify or tracing:
                    viscous += viscous_work(frame, dense_damping, damped, series, n, h, done, speeds)
                end_of_step(series, n, done, state)
                raise_peaks(frame, model, series, reach, state, n, h, done, acceleration, rise, c, peaks)
                raise_demands(model, series, reach, state, n, h, done, acceleration, rise, c, demands)
                if not only_columns:
                    raise_column_shears(dense_stiffness, model, series, n, done, c, demands)
                for i in range(size):
                    vanishing[i] = 0
                    touching[i] = 0
                tau += h * done
            if not happens:
                if parts == 1:
                    break
                continue
            events_now, transitions = change_phases(
                frame,
                model,
                stiffness_lanes,
                damping_lanes,
                kind,
                phase,
                vanishing,
                touching,
                state,
                tally,
                instants,
                signs,
                x,
                step * dt + tau,
                radian,
                times,
                storeys,
                phases,
                transitions,
                counts,
            )
            events += events_now
            rate = fastest_rate(model, phase, held_rate)
            if events > TRANSITION_CAP:
                status = TRANSITION_CAP_REACHED
                break
            if dt - tau <= NO_TIME * dt:
                break
        for i in range(size):
            if not math.isfinite(state[DISPLACEMENT, i] + state[VELOCITY, i]):
                status = NON_FINITE_STATE
        if status != OK:
            break

    friction = fill_storeys(frame, phase, state, tally, by_storey)
    finish_demands(frame, only_columns, peaks, demands)
    for i in range(size):
        for k in range(4):
            by_storey[END + k, i] = state[k, i]
        by_storey[END + 4, i] = phase[i]
        by_storey[END + 5, i] = vanishing[i]
        by_storey[END + 6, i] = touching[i]
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
    fill_totals(transitions, friction, viscous, work_in, error, status, totals)


@inner
def widen(matrix, wide):
    """Copy the matrix (N, N) into a wider one of zeros."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            wide[i, j] = matrix[i, j]


@entry(
    types.void(
        given2d,
        given2d,
        given2d,
        given1d,
        types.float64,
        types.int64,
        types.boolean,
        given2d,
        types.float64,
        types.int64,
        float1d,
        int1d,
        int1d,
        types.float64,
        float3d,
        float2d,
        float2d,
        float1d,
    )
)
def integrate(
    frame,
    dense_stiffness,
    dense_damping,
    ground,
    dt,
    free_steps,
    certify,
    start,
    radians,
    extra,
    times,
    storeys,
    phases,
    dt_out,
    traces,
    energies,
    by_storey,
    totals,
):
    """Integrate one history of a frame of N storeys.

    frame (FRAME_ROWS, N), dense_stiffness and dense_damping (N, N), or (0, 0) where there is nothing
    beside the springs and dashpots of ``frame``: see :mod:`fdspec.kernels.frame.model`.  ground: acceleration
    at the samples dt apart, m/s2, (n,); free_steps: steps of dt with the ground at rest that follow.
    start (4, N): displacement and velocity of floors, then of braces, at t = 0; or (7, N): the rows of the
    end of another history, from which this one goes on.  radians: longest phase of a step; extra: terms
    beyond those the series needs.

    times, storeys, phases (as many as there is room for): changes of phase in the order of time.
    traces (m, len(STOREY_TRACES), N), energies (m, len(TOTAL_TRACES)): filled at k dt_out for k < m.
    by_storey (END + END_ROWS, N), totals (len(TOTALS),): results.  viscous_energy and energy_error
    are worked out where ``certify`` says so; traces need the first and cost it.
    """
    size = frame.shape[1]
    lanes = LANES * ((size + LANES - 1) // LANES)
    by_storey[:] = 0.0
    wide = lanes if dense_stiffness.shape[0] > 0 else 0
    stiffness_lanes = np.zeros((wide, wide))
    widen(dense_stiffness, stiffness_lanes)
    wide = lanes if dense_damping.shape[0] > 0 else 0
    damping_lanes = np.zeros((wide, wide))
    widen(dense_damping, damping_lanes)
    history(
        frame,
        dense_stiffness,
        dense_damping,
        stiffness_lanes,
        damping_lanes,
        ground,
        dt,
        free_steps,
        certify,
        start,
        radians,
        extra,
        np.zeros((MODEL_ROWS, lanes)),
        np.zeros((4, size)),
        np.zeros((4, size)),
        np.zeros((TALLY_ROWS, size)),
        np.zeros((QUANTITIES, lanes + 1, TERMS)),
        np.zeros(TERMS),
        np.zeros((REACH_ROWS, lanes)),
        np.zeros((2, lanes + 1)),
        np.zeros(TERMS),
        np.zeros(size),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        times,
        storeys,
        phases,
        dt_out,
        traces,
        energies,
        by_storey[:PEAK_ROWS],
        by_storey[COUNTS],
        by_storey[DEMANDS : DEMANDS + DEMAND_ROWS],
        by_storey,
        totals,
    )
