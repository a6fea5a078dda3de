"""Entry points for many single-storey histories under one ground motion.

`prepare` works out the constants of each; `run_lanes` takes up to WIDTH of them, which take as many
steps a sample, through the motion side by side.  Whose neighbours they are touches no lane's numbers.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, int1d, lowest
from fdspec.compiler.records import read, write
from fdspec.kernels.batch.deferred_peaks import (
    N_BRACE,
    N_DEFERRED,
    QUANTITIES,
    defer_brace_peak,
    defer_peaks,
    search_all_deferred,
    search_deferred_brace,
)
from fdspec.kernels.batch.layout import (
    N_ROWS,
    ROW,
    WIDTH,
    Stride,
    at,
    has_no_new_brace_peak,
    has_no_new_peak,
    put_lane,
    put_state,
    rest_lane,
    start_lane,
    take_state,
)
from fdspec.kernels.batch.uneventful import all_losses, slip_lanes, stick_lanes, stick_losses
from fdspec.kernels.mathematics.oscillator import TERMS, step_map
from fdspec.kernels.storey.constants import Plan, plan, steps_per_sample
from fdspec.kernels.storey.energy import N_FORMS, put_losses
from fdspec.kernels.storey.history import finish, settle_at_rest
from fdspec.kernels.storey.step import come_to_rest, take_step
from fdspec.kernels.types import N_STATE, OK, STATE, STICK, Storey

LINE: Final = 8
"""Numbers in a line of the cache: a vector of 512 bits that begins elsewhere lies across two of them."""


@entry(types.void(float2d, types.float64, types.float64, types.boolean, int1d, float2d, float2d, float2d))
def prepare(storeys, dt, radians, certify, parts, plans, forms, stride):
    """Work out the constants of storeys (m, 8), rows of `Storey`.

    Filled: parts (m,) steps a sample; plans (m, N_PLAN); forms (m, N_FORMS), zeros unless certify;
    stride (m, N_STRIDE).
    """
    for i in range(storeys.shape[0]):
        storey = read(Storey, storeys, i)
        parts[i] = steps_per_sample(storey, dt, radians)
        scheme = plan(storey, dt / parts[i], radians)
        write(plans, i, scheme)
        floor_map = step_map(scheme.floor.g, scheme.floor.w2, scheme.step)
        write(stride, i, Stride(floor_map, step_map(scheme.brace.g, scheme.brace.w2, scheme.step)))
        forms[i] = 0.0
        if certify:
            put_losses(scheme, forms[i])


@entry(
    types.void(
        float2d,
        float2d,
        float2d,
        given1d,
        types.float64,
        types.int64,
        types.boolean,
        types.int64,
        types.boolean,
        float2d,
        float1d,
    )
)
def run_lanes(plans, forms, stride, ground, dt, parts, certify, free_steps, at_rest, results, held):
    """Integrate up to WIDTH histories from rest.

    plans, forms, stride: their rows from `prepare`; parts: the steps a sample that all of them take.
    certify: whether the balance of all energies is wanted.  free_steps: steps of dt with the ground at rest
    that follow; at_rest: whether each goes on from there until nothing can slip any more.
    Filled: results (count, len(RESULTS)); held (count,), the largest reaction (N) for which the bounds
    leave room while the storey never slips.
    """
    count = plans.shape[0]
    room = np.zeros(N_ROWS * WIDTH + LINE)
    first = -(room.ctypes.data // room.itemsize) % LINE
    p = room[first : first + N_ROWS * WIDTH]
    # One state and one row of losses for all lanes: a view of an array for each step would count references.
    s, losses = np.zeros(N_STATE), np.zeros(N_FORMS)
    given_up = np.zeros((WIDTH, N_STATE))
    deferred = np.zeros((WIDTH, len(QUANTITIES), N_DEFERRED))
    deferred_brace = np.zeros((WIDTH, N_BRACE))
    floor, brace, search = np.empty(TERMS), np.empty(TERMS), np.empty(TERMS)
    times, phases, traces = np.empty(0), np.empty(0, np.int64), np.empty((0, 0))
    slipping = 0
    real = (1 << count) - 1
    for lane in range(WIDTH):
        i = min(lane, count - 1)
        put_lane(p, lane, read(Plan, plans, i), read(Stride, stride, i), forms[i], certify)
        start_lane(p, lane)
        if lane >= count:
            rest_lane(p, lane)
        elif p[ROW.phase * WIDTH + lane] != STICK:
            slipping += 1
    step = dt / parts
    for i in range(ground.size - 1 + free_steps):
        a0 = 0.0
        rate = 0.0
        if i < ground.size - 1:
            a0 = ground[i]
            rate = (ground[i + 1] - a0) / dt
        for j in range(parts):
            start = a0 + rate * (j * step)
            eventful = 0
            to_defer = 0
            if slipping < WIDTH:
                eventful, to_defer = stick_lanes(p, step, start, rate)
            if slipping > 0:
                slipping_eventful, slipping_to_defer = slip_lanes(p, step, start, rate)
                eventful |= slipping_eventful
                to_defer |= slipping_to_defer
            if certify and slipping == 0:
                stick_losses(p, start, rate, eventful)
            elif certify:
                all_losses(p, start, rate, eventful)
            busy = (eventful | to_defer) & real
            while busy != 0:
                lane = lowest(busy)
                busy &= busy - 1
                if to_defer >> lane & 1:
                    defer_peaks(p, lane, read(Plan, plans, lane), deferred, start, rate, floor, search)
                    if at(p, ROW.bound_b, lane) > at(p, ROW.peak_brace, lane):
                        defer_brace_peak(
                            p, lane, read(Plan, plans, lane), deferred_brace, start, rate, floor, search
                        )
                else:
                    take_state(p, lane, s)
                    if certify:
                        for k in range(N_FORMS):
                            losses[k] = forms[lane, k]
                    before = s[STATE.phase] != STICK
                    take_step(
                        read(Plan, plans, lane),
                        losses,
                        s,
                        0.0,
                        start,
                        rate,
                        certify,
                        has_no_new_peak(p, lane, s),
                        has_no_new_brace_peak(p, lane, s),
                        floor,
                        brace,
                        search,
                        times,
                        phases,
                        traces,
                        0.0,
                        0,
                        0.0,
                    )
                    put_state(p, lane, s)
                    after = s[STATE.phase] != STICK
                    if s[STATE.status] != OK:
                        for row in range(N_STATE):
                            given_up[lane, row] = s[row]
                        rest_lane(p, lane)
                        after = False
                    slipping += (1 if after else 0) - (1 if before else 0)
    for lane in range(count):
        search_all_deferred(p, lane, read(Plan, plans, lane), deferred, floor, search)
        search_deferred_brace(p, lane, read(Plan, plans, lane), deferred_brace, floor, search)
        take_state(p, lane, s)
        if given_up[lane, STATE.status] != OK:
            for row in range(N_STATE):
                s[row] = given_up[lane, row]
        if at_rest and s[STATE.status] == OK:
            for k in range(N_FORMS):
                losses[k] = forms[lane, k]
            come_to_rest(
                read(Plan, plans, lane),
                losses,
                s,
                parts,
                certify,
                floor,
                brace,
                search,
                times,
                phases,
                traces,
            )
        finish(read(Plan, plans, lane).storey, s, certify, results[lane])
        if at_rest and s[STATE.status] == OK:
            settle_at_rest(read(Plan, plans, lane).storey, s, results[lane])
        held[lane] = p[ROW.held * WIDTH + lane]
