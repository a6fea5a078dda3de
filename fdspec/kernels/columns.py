"""Many single-storey histories under one ground motion: every slip force for each of many storeys.

A storey whose slip force exceeds the largest reaction of the braced frame never slips: one history
serves all such slip forces, exactly.  The others run in lanes, side by side with whatever others
take as many steps a sample; neither that nor the order of the grid touches a lane's arithmetic.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.jit import entry, float1d, float2d, float3d, ground1d, inner
from fdspec.kernels.bounds import floor_peaks
from fdspec.kernels.energy import N_FORMS, put_losses
from fdspec.kernels.oscillator import TERMS
from fdspec.kernels.packed import (
    ALERT,
    CREST,
    END_A,
    END_S,
    END_U,
    END_V,
    END_W,
    END_X,
    HELD,
    WIDTH,
    LIFT,
    LIMIT,
    N_ROWS,
    PUSH_FLOOR,
    accept_lanes,
    count_alerts,
    loss_lanes,
    put_lane,
    slip_lanes,
    stick_lanes,
    work_lanes,
)
from fdspec.kernels.plan import plan, steps_per_sample
from fdspec.kernels.sdof import RESULTS, finish
from fdspec.kernels.shelf import N_SHELF, put_plan, take_plan
from fdspec.kernels.types import (
    KICK,
    N_STATE,
    NO_KICK,
    OFFSET,
    OK,
    PEAK_ACCELERATION,
    PEAK_SHEAR,
    PHASE,
    STATUS,
    STICK,
    Force,
    Motion,
    Peaks,
    Storey,
    U,
    V,
)
from fdspec.kernels.walk import begin, walk

N_RESULTS = len(RESULTS)


@inner
def put_state(p, lane, s):
    """Store a history's state in its lane."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = s[row]


@inner
def take_state(p, lane, s):
    """Take a history's state from its lane."""
    for row in range(N_STATE):
        s[row] = p[row * WIDTH + lane]


@inner
def rest_lane(p, lane):
    """Make a lane quiet for good: sticking, no slip force to reach, no peak to pass.  Its numbers serve nobody."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = 0.0
    p[KICK * WIDTH + lane] = NO_KICK
    p[LIMIT * WIDTH + lane] = math.inf
    for row in range(PEAK_ACCELERATION, PEAK_SHEAR + 1):
        p[row * WIDTH + lane] = math.inf


@inner
def see_crest(p, lane, plan, ground, rate, floor, search):
    """Look for the floor's extrema inside a quiet step of one lane and put its peaks right."""
    phase = p[PHASE * WIDTH + lane]
    start = Motion(p[U * WIDTH + lane], p[V * WIDTH + lane], 0.0, 0.0)
    end = Motion(p[END_U * WIDTH + lane], p[END_V * WIDTH + lane], 0.0, 0.0)
    peaks = Peaks(
        p[END_A * WIDTH + lane],
        p[END_X * WIDTH + lane],
        p[END_W * WIDTH + lane],
        p[END_S * WIDTH + lane],
    )
    if phase == STICK:
        base = p[LIFT * WIDTH + lane] * p[OFFSET * WIDTH + lane]
        branch, mass, order = plan.stick, plan.mass, plan.stick_order
    else:
        base = -phase * p[PUSH_FLOOR * WIDTH + lane]
        branch, mass, order = plan.floor, 0.0, plan.floor_order
    force = Force(base - ground, -rate, 0.0, 0.0)
    peaks = floor_peaks(
        branch, base, mass, floor, search, int(order), 0.0, start, end, force, plan.step, peaks
    )
    p[END_A * WIDTH + lane] = peaks.acceleration
    p[END_X * WIDTH + lane] = peaks.displacement
    p[END_W * WIDTH + lane] = peaks.velocity
    p[END_S * WIDTH + lane] = peaks.shear


@inner
def run_lanes(
    p,
    shelf,
    forms,
    states,
    count,
    ground,
    dt,
    parts,
    energy,
    certify,
    floor,
    brace,
    search,
    times,
    phases,
    traces,
):
    """Take ``count`` lanes, set to their start, through the motion; their states end in ``states``."""
    slipping = 0
    for lane in range(WIDTH):
        if p[PHASE * WIDTH + lane] != STICK:
            slipping += 1
    step = dt / parts
    for i in range(ground.size - 1):
        rate = (ground[i + 1] - ground[i]) / dt
        for j in range(parts):
            start = ground[i] + rate * (j * step)
            if slipping < WIDTH:
                stick_lanes(p, step, start, rate)
            if slipping > 0:
                slip_lanes(p, step, start, rate)
            if energy:
                work_lanes(p, step, start, rate)
            if certify:
                loss_lanes(p, start, rate)
            if count_alerts(p) == 0.0:
                accept_lanes(p, energy, certify)
                continue
            for lane in range(count):
                if p[ALERT * WIDTH + lane] > 0.0:
                    take_state(p, lane, states[lane])
                elif p[CREST * WIDTH + lane] > 0.0:
                    see_crest(p, lane, take_plan(shelf, lane), start, rate, floor, search)
            accept_lanes(p, energy, certify)
            for lane in range(count):
                if p[ALERT * WIDTH + lane] > 0.0:
                    s = states[lane]
                    before = s[PHASE] != STICK
                    walk(
                        take_plan(shelf, lane),
                        forms[lane],
                        s,
                        0.0,
                        start,
                        rate,
                        energy,
                        certify,
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
                    after = s[PHASE] != STICK
                    if s[STATUS] != OK:
                        rest_lane(p, lane)
                        after = False
                    slipping += (1 if after else 0) - (1 if before else 0)
    for lane in range(count):
        if states[lane, STATUS] == OK:
            take_state(p, lane, states[lane])


@entry(
    types.void(
        float2d,
        float1d,
        float1d,
        ground1d,
        types.float64,
        types.float64,
        types.boolean,
        types.boolean,
        float2d,
        float3d,
    )
)
def sweep_columns(storeys, slip_force, kinetic_slip_force, ground, dt, radians, energy, certify, braced, out):
    """Integrate storeys (m, 6), braced and under each of the slip forces (p,).

    A storey's row: floor mass, damping, stiffness, brace mass, damping, stiffness.  energy, certify:
    whether the work of the ground, and the balance of all energies, are wanted.  braced
    (m, N_RESULTS) and out (m, p, N_RESULTS) are filled, see RESULTS.
    """
    columns = storeys.shape[0]
    forces = slip_force.size
    parts = np.empty(columns, np.int64)
    for i in range(columns):
        s = storeys[i]
        parts[i] = steps_per_sample(Storey(s[0], s[1], s[2], s[3], s[4], s[5], math.inf, 0.0), dt, radians)
    order = np.argsort(parts)
    # Which histories run: first every column without slip, then the slip forces that it can reach.
    column = np.empty(columns * forces, np.int64)
    force = np.empty(columns * forces, np.int64)
    likeness = np.empty(columns * forces)
    held = np.empty(columns)
    p = np.empty(N_ROWS * WIDTH)
    shelf = np.empty((WIDTH, N_SHELF))
    forms = np.empty((WIDTH, N_FORMS))
    states = np.empty((WIDTH, N_STATE))
    floor, brace, search = np.empty(TERMS), np.empty(TERMS), np.empty(TERMS)
    times, phases, traces = np.empty(0), np.empty(0, np.int64), np.empty((0, 0))
    waiting = columns
    for sliding in (False, True):
        if sliding:
            waiting = 0
            for k in range(columns):
                i = order[k]
                for j in range(forces):
                    if slip_force[j] > held[i]:
                        out[i, j] = braced[i]
                    else:
                        column[waiting] = i
                        force[waiting] = j
                        # Neighbours slip about as much: where none of them does, only stick is computed.
                        likeness[waiting] = parts[i] + 0.5 * slip_force[j] / (held[i] + 1e-300)
                        waiting += 1
            turn = np.argsort(likeness[:waiting])
            column[:waiting] = column[:waiting][turn]
            force[:waiting] = force[:waiting][turn]
        first = 0
        while first < waiting:
            here = parts[column[first] if sliding else order[first]]
            count = 0
            while count < WIDTH and first + count < waiting:
                i = column[first + count] if sliding else order[first + count]
                if parts[i] != here:
                    break
                limit = math.inf
                kinetic = 0.0
                if sliding:
                    limit = slip_force[force[first + count]]
                    kinetic = kinetic_slip_force[force[first + count]]
                s = storeys[i]
                scheme = plan(Storey(s[0], s[1], s[2], s[3], s[4], s[5], limit, kinetic), dt / here, radians)
                if certify:
                    put_losses(scheme, forms[count])
                put_plan(shelf, count, scheme)
                put_lane(p, count, scheme, forms[count], certify)
                begin(scheme, Motion(0.0, 0.0, 0.0, 0.0), states[count])
                put_state(p, count, states[count])
                count += 1
            for lane in range(count, WIDTH):
                put_lane(p, lane, scheme, forms[0], certify)
                rest_lane(p, lane)
            run_lanes(
                p,
                shelf,
                forms,
                states,
                count,
                ground,
                dt,
                here,
                energy,
                certify,
                floor,
                brace,
                search,
                times,
                phases,
                traces,
            )
            for lane in range(count):
                storey = take_plan(shelf, lane).storey
                if sliding:
                    finish(storey, states[lane], certify, out[column[first + lane], force[first + lane]])
                else:
                    finish(storey, states[lane], certify, braced[order[first + lane]])
                    held[order[first + lane]] = p[HELD * WIDTH + lane]
            first += count
