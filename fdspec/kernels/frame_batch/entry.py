"""Entry point for many histories of frames of equal size under one ground motion.

Eight run side by side, each at its own time and with its own step; one that ends makes room for the next.
Whose neighbours they are touches no history's numbers.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float2d, float3d, given1d, inner, int1d, wide
from fdspec.kernels.frame.guard import SAME_INSTANT
from fdspec.kernels.frame.model import MODEL_ROWS, fastest_rate
from fdspec.kernels.frame.reset import TALLY_ROWS
from fdspec.kernels.frame.results import COUNTS, NO_TIME
from fdspec.kernels.frame.step import change_phases
from fdspec.kernels.frame.taylor import TERMS, longest_phase
from fdspec.kernels.frame_batch.advance import add_input, advance
from fdspec.kernels.frame_batch.dissipation import add_dissipation
from fdspec.kernels.frame_batch.eight import WIDTH, load, store
from fdspec.kernels.frame_batch.expand import expand, measure
from fdspec.kernels.frame_batch.guard import alert
from fdspec.kernels.frame_batch.lane import finish, is_finite, put_history, put_phase, put_state, take_state
from fdspec.kernels.frame_batch.layout import (
    END,
    FRACTION,
    GROUND,
    LENGTH,
    ORDER,
    RATE,
    RISE,
    SPECIAL,
    START,
    TAU,
    places,
    row,
)
from fdspec.kernels.frame_batch.peaks import raise_peaks
from fdspec.kernels.frame_batch.search import search
from fdspec.kernels.types import NON_FINITE_STATE, OK, TRANSITION_CAP, TRANSITION_CAP_REACHED

PARTS_OF_RADIAN: Final = 32
LONGEST: Final = 5.0
"""rad, the longest phase whose series has room."""


def _order_for(theta: float) -> int:
    order = 5
    while order < TERMS - 1 and longest_phase(order) < theta:
        order += 1
    return order


ORDERS: Final = np.array(
    [_order_for((k + 1) / PARTS_OF_RADIAN) for k in range(int(LONGEST * PARTS_OF_RADIAN) + 2)]
)
"""Order of the series for phases up to (k + 1) / PARTS_OF_RADIAN."""

LINE: Final = 8
"""Numbers in a line of the cache: a vector of 512 bits that begins elsewhere lies across two of them."""

given3d = types.Array(types.float64, 3, "C", readonly=True)


@inner
def set_step(p, lane, ground, dt, step, radians):
    """Set the lane's next step; return the order of its series."""
    tau = p[TAU * WIDTH + lane]
    rate = p[RATE * WIDTH + lane]
    left = dt - tau
    parts = max(1.0, math.ceil(left * rate / radians - 1e-9))
    h = left / parts
    # A state or a rate that is no number has any integer for its place.
    order = ORDERS[max(0, min(int(h * rate * PARTS_OF_RADIAN), ORDERS.size - 1))]
    a0 = ground[step]
    slope = (ground[step + 1] - a0) / dt
    p[LENGTH * WIDTH + lane] = h
    p[ORDER * WIDTH + lane] = order
    p[GROUND * WIDTH + lane] = a0 + slope * tau
    p[RISE * WIDTH + lane] = slope * h
    p[FRACTION * WIDTH + lane] = 1.0
    return order, parts == 1.0


@inner
def renew(p, size):
    """Let the end of a step be the start of the next."""
    wide()
    for i in range(size):
        for r in range(4):
            store(p, row(START + r, i), load(p, row(END + r, i)))


@inner
def change(
    p,
    size,
    lane,
    frame,
    stiffness,
    damping,
    model,
    kind,
    phase,
    vanishing,
    touching,
    state,
    tally,
    instants,
    signs,
    x,
    now,
    radian,
    counts,
    no_times,
    no_storeys,
):
    """Make a lane's changes of phase at the fraction x of its step, where the rows END stand.

    now, radian: the time then, s, and as in `fdspec.kernels.frame.guard.search`.

    Return how many storeys were looked at and how many changed.
    """
    take_state(p, END, size, lane, state)
    events, changes = change_phases(
        frame,
        model,
        stiffness,
        damping,
        kind,
        phase,
        vanishing,
        touching,
        state,
        tally,
        instants,
        signs,
        x,
        now,
        radian,
        no_times,
        no_storeys,
        no_storeys,
        0,
        counts,
    )
    put_state(p, END, size, lane, state)
    for i in range(size):
        if instants[i] <= x + SAME_INSTANT:
            put_phase(p, lane, frame, model, phase, i)
        p[row(SPECIAL, i) + lane] = 1.0 if vanishing[i] != 0 or touching[i] != 0 else 0.0
    return events, changes


@inner
def forget(p, size, lane, vanishing, touching):
    """A phase that has gone on for a while is no longer special."""
    for i in range(size):
        vanishing[i] = 0
        touching[i] = 0
        p[row(SPECIAL, i) + lane] = 0.0


@inner
def run(
    frames,
    dense,
    stiffnesses,
    dampings,
    damped,
    grounded,
    damped_braces,
    ground,
    dt,
    certify,
    radians,
    p,
    models,
    kinds,
    phases,
    vanishings,
    touchings,
    tallies,
    state,
    c,
    instants,
    signs,
    alerts,
    orders,
    slots,
    firsts,
    steps,
    of_lane,
    events,
    transitions,
    held_rates_,
    no_times,
    no_storeys,
    by_storey,
    totals,
):
    """Integrate all histories: arguments as in :func:`integrate_frames`, and room to work in."""
    size = frames.shape[2]
    at = places(size, stiffnesses.shape[1], dampings.shape[1])
    dense_stiffness = stiffnesses.shape[1] > 0
    dense_damping = dampings.shape[1] > 0
    waiting = 0
    running = 0
    special = 0
    last = ground.size - 1
    for lane in range(WIDTH):
        orders[lane] = 0
        p[LENGTH * WIDTH + lane] = 0.0
        p[ORDER * WIDTH + lane] = 0.0
    while True:
        for lane in range(WIDTH):
            if running >> lane & 1 == 0 and waiting < frames.shape[0]:
                of_lane[lane] = waiting
                held_rates_[lane] = put_history(
                    p,
                    at,
                    size,
                    lane,
                    frames[waiting],
                    stiffnesses[dense[waiting]],
                    dampings[dense[waiting]],
                    models[lane],
                    kinds[lane],
                    phases[lane],
                    vanishings[lane],
                    touchings[lane],
                    state,
                    tallies[lane],
                )
                steps[lane] = 0
                events[lane] = 0
                transitions[lane] = 0
                running |= 1 << lane
                waiting += 1
        if running == 0:
            return
        most = 0
        whole = 0
        for lane in range(WIDTH):
            if running >> lane & 1:
                orders[lane], is_whole = set_step(p, lane, ground, dt, steps[lane], radians)
                most = max(most, orders[lane])
                whole |= (1 << lane) if is_whole else 0
        expand(p, at, size, most, dense_stiffness, dense_damping, damped, grounded)
        measure(p, at, size, most)
        found = running & alert(p, at, size, alerts)
        happens = 0
        if found != 0:
            search(
                p,
                at,
                size,
                dt,
                steps,
                found,
                alerts,
                frames,
                of_lane,
                phases,
                vanishings,
                touchings,
                tallies,
                orders,
                c,
                instants,
                signs,
                slots[0],
                slots[1],
                slots[2],
                slots[3],
                firsts,
            )
            for lane in range(WIDTH):
                if found >> lane & 1 and firsts[lane] <= 1.0:
                    happens |= 1 << lane
                    p[FRACTION * WIDTH + lane] = firsts[lane]
        advance(p, at, size, most)
        add_input(p, at, size, most)
        if certify:
            add_dissipation(p, at, size, most, dense_damping, damped, grounded, damped_braces)
        raise_peaks(p, at, size, running, orders, c)
        for lane in range(WIDTH):
            if running >> lane & 1 == 0:
                continue
            x = p[FRACTION * WIDTH + lane]
            status = OK
            ended = False
            if special >> lane & 1 and x > 0.0:
                forget(p, size, lane, vanishings[lane], touchings[lane])
                special &= ~(1 << lane)
            tau = p[TAU * WIDTH + lane] + p[LENGTH * WIDTH + lane] * x
            if happens >> lane & 1:
                h = of_lane[lane]
                looked, changed = change(
                    p,
                    size,
                    lane,
                    frames[h],
                    stiffnesses[dense[h]],
                    dampings[dense[h]],
                    models[lane],
                    kinds[lane],
                    phases[lane],
                    vanishings[lane],
                    touchings[lane],
                    state,
                    tallies[lane],
                    instants[lane],
                    signs[lane],
                    x,
                    steps[lane] * dt + tau,
                    min(dt, 1.0 / p[RATE * WIDTH + lane]),
                    by_storey[h, COUNTS],
                    no_times,
                    no_storeys,
                )
                special |= 1 << lane
                events[lane] += looked
                transitions[lane] += changed
                p[RATE * WIDTH + lane] = fastest_rate(models[lane], phases[lane], held_rates_[lane])
                ended = dt - tau <= NO_TIME * dt
                if events[lane] > TRANSITION_CAP:
                    status = TRANSITION_CAP_REACHED
            elif whole >> lane & 1:
                ended = True
            if ended:
                tau = 0.0
                steps[lane] += 1
                if not is_finite(p, END, size, lane):
                    status = NON_FINITE_STATE
            p[TAU * WIDTH + lane] = tau
            if status != OK or steps[lane] == last:
                h = of_lane[lane]
                finish(
                    p,
                    size,
                    lane,
                    frames[h],
                    stiffnesses[dense[h]],
                    phases[lane],
                    state,
                    tallies[lane],
                    transitions[lane],
                    status,
                    certify,
                    by_storey[h],
                    totals[h],
                )
                running &= ~(1 << lane)
                special &= ~(1 << lane)
                orders[lane] = 0
                p[LENGTH * WIDTH + lane] = 0.0
                p[ORDER * WIDTH + lane] = 0.0
        renew(p, size)


@entry(
    types.void(
        given3d,
        int1d,
        given3d,
        given3d,
        types.boolean,
        types.boolean,
        types.boolean,
        given1d,
        types.float64,
        types.boolean,
        types.float64,
        float3d,
        float2d,
    )
)
def integrate_frames(
    frames,
    dense,
    stiffnesses,
    dampings,
    damped,
    grounded,
    damped_braces,
    ground,
    dt,
    certify,
    radians,
    by_storey,
    totals,
):
    """Integrate histories of frames of N storeys from rest, none of whose braces is massless.

    frames (m, FRAME_ROWS, N); stiffnesses, dampings (b, N, N), or (b, 0, 0): the dense matrices, of which
    history i takes number dense[i]; see :mod:`fdspec.kernels.frame.model`.  damped, grounded,
    damped_braces: whether any dashpot stands between neighbours, any spring or dashpot on the ground, any
    dashpot beside a brace.  ground: acceleration at the samples dt apart, m/s2, (n,).  radians: longest phase
    of a step.

    by_storey (m, len(STOREY_RESULTS), N), totals (m, len(TOTALS)): results.  viscous_energy and
    energy_error are worked out where ``certify`` says so.
    """
    size = frames.shape[2]
    by_storey[:] = 0.0
    room = np.zeros(places(size, stiffnesses.shape[1], dampings.shape[1]).size + LINE)
    first = -(room.ctypes.data // room.itemsize) % LINE
    run(
        frames,
        dense,
        stiffnesses,
        dampings,
        damped,
        grounded,
        damped_braces,
        ground,
        dt,
        certify,
        radians,
        room[first:],
        np.zeros((WIDTH, MODEL_ROWS, size)),
        np.zeros((WIDTH, size), np.int64),
        np.zeros((WIDTH, size), np.int64),
        np.zeros((WIDTH, size), np.int64),
        np.zeros((WIDTH, size), np.int64),
        np.zeros((WIDTH, TALLY_ROWS, size)),
        np.zeros((4, size)),
        np.zeros(TERMS + 2),
        np.zeros((WIDTH, size)),
        np.zeros((WIDTH, size), np.int64),
        np.zeros(size, np.int64),
        np.zeros(WIDTH, np.int64),
        np.zeros((4, WIDTH), np.int64),
        np.zeros(WIDTH),
        np.zeros(WIDTH, np.int64),
        np.zeros(WIDTH, np.int64),
        np.zeros(WIDTH, np.int64),
        np.zeros(WIDTH, np.int64),
        np.zeros(WIDTH),
        np.zeros(0),
        np.zeros(0, np.int64),
        by_storey,
        totals,
    )
