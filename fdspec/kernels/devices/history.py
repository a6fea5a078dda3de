"""One history of a frame with devices, event by event.

Between two events the frame is linear and its forcing linear in time.  Its motion over a step of a few
radians of its fastest part is a Taylor series complete to rounding, in which every guard is a polynomial:
the first root of any of them ends the step, the devices whose it is change their modes, floors on which
forces have jumped settle, and the next step starts there.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, float3d, given1d, given2d, inner
from fdspec.compiler.positions import positions
from fdspec.kernels.devices.energy import input_work, stored_energy, viscous_work, work_of_gravity
from fdspec.kernels.devices.expand import expand
from fdspec.kernels.devices.guards import first_collapse, first_event
from fdspec.kernels.devices.layout import (
    PHASE,
    TOUCHING,
    VANISHING,
    WORK,
    Frame,
    Law,
    Series,
    State,
    U,
    V,
)
from fdspec.kernels.devices.model import fastest_rate
from fdspec.kernels.devices.output import ENERGY, state_at, write_traces
from fdspec.kernels.devices.peaks import raise_peaks
from fdspec.kernels.devices.resets import begin, change_modes
from fdspec.kernels.devices.tally import close_travel
from fdspec.kernels.frame.taylor import TERMS, order_for
from fdspec.kernels.types import (
    COLLAPSED,
    ENERGY_NOT_CLOSED,
    ENERGY_TOLERANCE,
    NON_FINITE_STATE,
    OK,
    TRANSITION_CAP,
    TRANSITION_CAP_REACHED,
)

nodes1d = types.Array(types.int64, 1, "C", readonly=True)
places2d = types.Array(types.int64, 2, "C", readonly=True)
flags2d = types.Array(types.boolean, 2, "C", readonly=True)
int2d = types.Array(types.int64, 2, "C")

RADIANS = 2.5
"""Longest phase of a step; no result depends on it."""

NO_TIME = 1e-13
"""Fraction of a record step that counts as its end."""

STALLED = 200
"""Events at one instant, for each link, after which the frame is moved on by the smallest of steps."""

NUDGE = 1e-9
"""That step, as a fraction of the step planned."""

TOTALS = (
    "events",
    "viscous_energy",
    "input_energy",
    "gravity_energy",
    "energy_error",
    "status",
    "collapse_storey",
    "collapse_time",
)
"""Entries of ``totals`` (8,)."""
TOTAL = positions(TOTALS)


@inner
def log_events(state, was, at, log_times, log, logged):
    """Write the changes of phase of one instant down, as far as there is room; return how many there are."""
    for j in range(was.size):
        if state.mode[PHASE, j] != was[j]:
            if logged < log_times.size:
                log_times[logged] = at
                log[0, logged] = j
                log[1, logged] = state.mode[PHASE, j]
            logged += 1
    return logged


@inner
def history(
    frame,
    law,
    state,
    then,
    series,
    load,
    speeds,
    ground,
    dt,
    free_steps,
    radians,
    extra,
    resumes,
    instants,
    signs,
    events,
    roles,
    uneasy,
    was,
    log_times,
    log,
    dt_out,
    floor_traces,
    link_traces,
    energies,
    peaks,
    totals,
):
    """Integrate one history: arguments as in :func:`integrate`, and zeroed room to work in."""
    links = frame.places.shape[1]
    logged = 0
    begin(frame, law, state, series, roles, uneasy, was, resumes)
    stored = stored_energy(frame, state) - work_of_gravity(frame, state)
    for j in range(links):
        stored += state.tally[WORK, j]  # what gave way at once was stored before
    if not resumes:
        logged = log_events(state, was, 0.0, log_times, log, logged)
    rate = fastest_rate(frame, law, state, load)
    status = OK
    work_in = 0.0
    largest_work = 0.0
    viscous = 0.0
    written = 0
    happened = 0
    still = 0
    steps = ground.size - 1
    totals[TOTAL.collapse_storey] = -1.0
    for step in range(steps + free_steps):
        a0 = 0.0
        slope = 0.0
        if step < steps:
            a0 = ground[step]
            slope = (ground[step + 1] - a0) / dt
        tau = 0.0
        while True:
            parts = max(1, math.ceil((dt - tau) * rate / radians - 1e-9))
            h = (dt - tau) / parts
            n = order_for(rate * h, extra)
            acceleration = a0 + slope * tau
            rise = slope * h
            expand(frame, law, state, n, h, acceleration, rise, series)
            x = first_event(frame, law, state, series, n, instants, signs, events)
            falls, storey = first_collapse(frame, series, n)
            collapses = falls <= min(x, 1.0)
            happens = x <= 1.0 and not collapses
            done = falls if collapses else (x if happens else 1.0)
            if happens and still > STALLED * (links + 1) and x < NUDGE:
                # Rounding keeps them from agreeing: a step that nobody feels breaks the tie.
                done = NUDGE
                happens = False
                parts = 2
            if floor_traces.shape[0] > 0:
                reached = tau + h * done
                final = step == steps + free_steps - 1 and not happens and parts == 1
                while written < floor_traces.shape[0]:
                    at = written * dt_out - step * dt
                    if at > reached and not (final and at <= reached + 1e-6 * dt):
                        break
                    y = min(max((at - tau) / h, 0.0), done)
                    energies[written, ENERGY.input_energy] = work_in + input_work(
                        series.momentum, n, h, acceleration, rise, y
                    )
                    energies[written, ENERGY.viscous_energy] = viscous + viscous_work(
                        frame, series, n, h, y, speeds
                    )
                    write_traces(
                        frame, state, then, series, n, h, y, floor_traces, link_traces, energies, written
                    )
                    written += 1
            if done > 0.0:
                work_in += input_work(series.momentum, n, h, acceleration, rise, done)
                largest_work = max(largest_work, abs(work_in))
                viscous += viscous_work(frame, series, n, h, done, speeds)
                raise_peaks(frame, state, series, n, h, done, peaks)
                state_at(series, n, done, state.floors, state.sliders)
                for j in range(links):
                    state.mode[VANISHING, j] = 0
                    state.mode[TOUCHING, j] = 0
                if h * done > NO_TIME * dt:
                    still = 0
                tau += h * done
            if collapses:
                status = COLLAPSED
                totals[TOTAL.collapse_storey] = storey
                totals[TOTAL.collapse_time] = step * dt + tau
                break
            if not happens:
                if parts == 1:
                    break
                continue
            change_modes(frame, law, state, series, x, instants, signs, events, roles, uneasy, was)
            logged = log_events(state, was, step * dt + tau, log_times, log, logged)
            happened += 1
            still += 1
            rate = fastest_rate(frame, law, state, load)
            if happened > TRANSITION_CAP:
                status = TRANSITION_CAP_REACHED
                break
            if dt - tau <= NO_TIME * dt:
                break
        for i in range(1, frame.mass.size):
            if not math.isfinite(state.floors[U, i] + state.floors[V, i]):
                status = NON_FINITE_STATE
        if status != OK:
            break

    dissipated = 0.0
    for j in range(links):
        close_travel(frame, state, j)
        dissipated += state.tally[WORK, j]
    gravity = work_of_gravity(frame, state)
    balance = work_in + stored + gravity - stored_energy(frame, state) - viscous - dissipated
    scale = max(largest_work + abs(stored), viscous + dissipated)
    error = abs(balance) / scale if scale > 0.0 else 0.0
    if not math.isfinite(dissipated + viscous + work_in + error):
        status = NON_FINITE_STATE
    elif status == OK and error > ENERGY_TOLERANCE:
        status = ENERGY_NOT_CLOSED
    totals[TOTAL.events] = logged
    totals[TOTAL.viscous_energy] = viscous
    totals[TOTAL.input_energy] = work_in
    totals[TOTAL.gravity_energy] = gravity
    totals[TOTAL.energy_error] = error
    totals[TOTAL.status] = status


@entry(
    types.void(
        given1d,
        places2d,
        given2d,
        given2d,
        given2d,
        places2d,
        given2d,
        given1d,
        nodes1d,
        flags2d,
        given1d,
        types.float64,
        types.int64,
        types.float64,
        types.int64,
        types.boolean,
        float2d,
        float2d,
        int2d,
        float1d,
        int2d,
        types.float64,
        float3d,
        float3d,
        float2d,
        float2d,
        float2d,
        float1d,
    )
)
def integrate(
    mass,
    ends,
    springs,
    dense_stiffness,
    dense_damping,
    places,
    links,
    drift_limit,
    below,
    carried,
    ground,
    dt,
    free_steps,
    radians,
    extra,
    resumes,
    floors,
    sliders,
    mode,
    log_times,
    log,
    dt_out,
    floor_traces,
    link_traces,
    energies,
    tally,
    peaks,
    totals,
):
    """Integrate one history of a frame with devices.

    mass to carried: the fields of `layout.Frame`.  ground: acceleration at the samples dt apart, m/s2,
    (n,); free_steps: steps of dt with the ground at rest that follow.  radians: longest phase of a step;
    extra: terms beyond those the series needs.

    floors (2, N + 1), sliders (2, L), mode (MODE_ROWS, L): the state at the start, and at the end
    afterwards.  resumes: whether mode is given; else the state asks for it.  log_times (k,), log (2, k):
    changes of phase in the order of time, link and new phase, as far as there is room.  floor_traces
    (m, 4, N), link_traces (m, 7, L), energies (m, 6): filled at i dt_out for i < m.  tally (TALLY_ROWS, L),
    peaks (PEAK_ROWS, S), totals (len(TOTALS),): results, zeroed here.
    """
    count = places.shape[1]
    nodes = mass.size
    tally[:] = 0.0
    peaks[:] = 0.0
    totals[:] = 0.0
    frame = Frame(
        mass, ends, springs, dense_stiffness, dense_damping, places, links, drift_limit, below, carried
    )
    history(
        frame,
        Law(np.zeros(nodes), np.zeros(count), np.zeros(count)),
        State(floors, sliders, mode, tally),
        State(np.zeros((2, nodes)), np.zeros((2, count)), mode, tally),
        Series(np.zeros((3, nodes, TERMS)), np.zeros((4, count, TERMS)), np.zeros(TERMS), np.zeros(TERMS)),
        np.zeros((2, nodes)),
        np.zeros(nodes),
        ground,
        dt,
        free_steps,
        radians,
        extra,
        resumes,
        np.zeros(count),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.zeros(nodes, np.int64),
        np.zeros(count, np.int64),
        log_times,
        log,
        dt_out,
        floor_traces,
        link_traces,
        energies,
        peaks,
        totals,
    )
