"""Taylor series of a frame's motion over a step, and what is read from it.

A series is a row of coefficients of powers of the fraction of the step: c[k] multiplies x^k, x in
[0, 1].  All series of a step lie in one array ``series`` (6, 1 + lanes, TERMS): for each of six
quantities a row of the ground, which stands still, and one of each storey.  Lanes are the storeys
and as many empty ones as fill the last group of four.
"""

from __future__ import annotations

import math

import numpy as np

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.frame.groups_of_four import (
    LANES,
    less,
    load,
    magnitude,
    minus,
    plus,
    rise_from,
    row,
    scaled,
    shifted,
    store,
    store_row,
    times,
    total_of,
)
from fdspec.kernels.frame.model import (
    BRACE,
    BRACE_DAMPING,
    BRACE_SHARE,
    BRACE_STIFFNESS,
    COLUMN_DASHPOTS,
    COLUMNS,
    COMPLIANCE,
    DASHPOT,
    FLOOR_SHARE,
    FRICTION,
    GIVEN_FORCE,
    GROUND_DASHPOTS,
    GROUND_SPRINGS,
    KINETIC_SLIP_FORCE,
    MASS,
    MASSLESS,
    SLIDING_COMPLIANCE,
    SLIP_FORCE,
    SLIP_RATE,
    SPRING,
    STUCK,
)
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.types import STICK

TERMS = 40
"""Room for coefficients: enough for steps of five radians."""

DISPLACEMENT = 0
VELOCITY = 1
"""Of the floors relative to the ground, m, m/s."""
OFFSET = 2
SLIDING = 3
"""Slip offset, m, and sliding velocity, m/s.  These four rows are those of ``state`` (4, N) as well."""
REACTION = 4
"""Reaction that keeps the sliding velocity constant, N."""
INERTIA = 5
"""Absolute acceleration of the floors, m/s2."""
QUANTITIES = 6

REACTION_REACH = 0
ACCELERATION_REACH = 1
JERK_REACH = 2
REACH_ROWS = 3
"""Rows of ``reach`` (3, lanes): sums over k >= 1 of |R_k| (N), |A_k| (m/s2), k |A_k| (m/s2)."""

UNRESOLVED = 64.0 * 2.0**-53
"""Share of the displacements below which the excess of a massless brace's stretch is rounding."""

TRUNCATION = 1e-16
"""Size of the first term left out, relative to the first one."""


def longest_phase(order):
    """Longest phase (rad) whose series is complete to rounding at this order."""
    return (TRUNCATION * math.factorial(order)) ** (1.0 / order) if order else 0.0


LONGEST_PHASE = np.array([longest_phase(n) for n in range(TERMS)])


@inner
def order_for(theta, extra):
    """Order of the series over the phase theta (rad), with ``extra`` terms more."""
    n = 5
    while n < TERMS - 1 - extra and LONGEST_PHASE[n] < theta:
        n += 1
    return n + extra


@inlined
def product(matrix, series, quantity, i, k):
    """Terms i to i + 3 of a symmetric matrix (lanes, lanes) times the coefficients k of a quantity."""
    total = (0.0, 0.0, 0.0, 0.0)
    for j in range(0, matrix.shape[0], LANES):
        total = plus(total, part_of_product(matrix, i, j, load(series, quantity, j + 1, k)))
    return total


@inlined
def part_of_product(matrix, i, j, x):
    """What columns j to j + 3, times x, put into terms i to i + 3."""
    front = plus(scaled(row(matrix, j, i), x[0]), scaled(row(matrix, j + 1, i), x[1]))
    back = plus(scaled(row(matrix, j + 2, i), x[2]), scaled(row(matrix, j + 3, i), x[3]))
    return plus(front, back)


@inlined
def next_terms(
    model, i, k, factor, x, y, o, z, below, below_rate, above, dense, pull, damped, grounded, ground, rise
):
    """Reactions and inertia of order k of four storeys, and velocities of order k + 1.

    x, y: coefficients k of displacement and velocity; o, z: of slip offset and sliding velocity; below,
    below_rate: x and y of the storey below the four; above: the force in the storey above them; pull: what
    the dense matrices ask for.  The last value is the force in the lowest of the four storeys.

    Each coefficient waits for the one before it through the dashpots alone, so what they ask for comes
    last in each sum: the time this takes is that of its longest chain.
    """
    drift = rise_from(x, below)
    brace = times(row(model, SPRING, i), minus(drift, o))
    storey = times(row(model, COLUMNS, i), drift)
    if damped:
        drift_rate = rise_from(y, below_rate)
        brace = plus(brace, times(row(model, DASHPOT, i), minus(drift_rate, z)))
        storey = plus(storey, times(row(model, COLUMN_DASHPOTS, i), drift_rate))
    if k == 0:
        brace = plus(brace, row(model, GIVEN_FORCE, i))
    total = plus(storey, brace)
    floor = minus(shifted(total, above), storey)
    push = minus(floor, times(row(model, STUCK, i), brace))
    if grounded:
        hold = times(row(model, GROUND_SPRINGS, i), x)
        hold = plus(hold, times(row(model, GROUND_DASHPOTS, i), y))
        push = minus(push, hold)
        floor = minus(floor, hold)
    if dense:
        push = minus(push, pull)
        floor = minus(floor, pull)
    held = plus(times(row(model, FLOOR_SHARE, i), floor), times(row(model, BRACE_SHARE, i), brace))
    slide = held
    if k == 0:
        push = minus(push, row(model, FRICTION, i))
        slide = minus(slide, row(model, FRICTION, i))
    compliance = row(model, COMPLIANCE, i)
    inertia = times(push, compliance)
    if k == 0:
        y_next = scaled(less(inertia, ground), factor)
    elif k == 1:
        y_next = scaled(less(inertia, rise), factor)
    else:
        y_next = times(push, scaled(compliance, factor))
    z_next = times(slide, scaled(row(model, SLIDING_COMPLIANCE, i), factor))
    return y_next, z_next, held, inertia, total[0]


@inner
def expand(
    model,
    dense_stiffness,
    dense_damping,
    damped,
    grounded,
    n,
    h,
    ground,
    rise,
    state,
    series,
    momentum,
    reach,
):
    """Fill the series of order n over the step h (s) that starts at ``state``.

    Beside them the momentum's, sum m u', and how far reactions and accelerations may reach.
    ground: the ground's acceleration at the start, m/s2; rise: its change over the step.  The dense
    matrices are (lanes, lanes) or empty.
    """
    for quantity in range(4):
        for i in range(state.shape[1]):
            series[quantity, i + 1, 0] = state[quantity, i]
    if model.shape[1] == LANES:
        expand_four(
            model,
            dense_stiffness,
            dense_damping,
            damped,
            grounded,
            n,
            h,
            ground,
            rise,
            series,
            momentum,
            reach,
        )
    else:
        expand_groups(
            model, dense_stiffness, dense_damping, damped, grounded, n, h, ground, rise, series, momentum
        )
        measure(series, n, reach)


@inlined
def expand_four(
    model, dense_stiffness, dense_damping, damped, grounded, n, h, ground, rise, series, momentum, reach
):
    """Fill the series of up to four storeys: their last coefficients never leave the registers."""
    dense = dense_stiffness.shape[0] + dense_damping.shape[0] > 0
    pull = (0.0, 0.0, 0.0, 0.0)
    x = load(series, DISPLACEMENT, 1, 0)
    y = load(series, VELOCITY, 1, 0)
    o = load(series, OFFSET, 1, 0)
    z = load(series, SLIDING, 1, 0)
    far = (0.0, 0.0, 0.0, 0.0)
    swing = (0.0, 0.0, 0.0, 0.0)
    jerk = (0.0, 0.0, 0.0, 0.0)
    momentum[0] = total_of(minus(times(row(model, MASS, 0), y), times(row(model, BRACE, 0), z)))
    for k in range(n):
        factor = h / (k + 1)
        if dense:
            pull = (0.0, 0.0, 0.0, 0.0)
            if dense_stiffness.shape[0] > 0:
                pull = part_of_product(dense_stiffness, 0, 0, x)
            if dense_damping.shape[0] > 0:
                pull = plus(pull, part_of_product(dense_damping, 0, 0, y))
        y_next, z_next, held, inertia, _ = next_terms(
            model, 0, k, factor, x, y, o, z, 0.0, 0.0, 0.0, dense, pull, damped, grounded, ground, rise
        )
        x = scaled(y, factor)
        o = scaled(z, factor)
        y = y_next
        z = z_next
        store(series, VELOCITY, 1, k + 1, y)
        store(series, DISPLACEMENT, 1, k + 1, x)
        store(series, OFFSET, 1, k + 1, o)
        store(series, SLIDING, 1, k + 1, z)
        store(series, REACTION, 1, k, held)
        store(series, INERTIA, 1, k, inertia)
        momentum[k + 1] = total_of(minus(times(row(model, MASS, 0), y), times(row(model, BRACE, 0), z)))
        if k > 0:
            far = plus(far, magnitude(held))
            term = magnitude(inertia)
            swing = plus(swing, term)
            jerk = plus(jerk, scaled(term, float(k)))
    store_row(reach, REACTION_REACH, 0, far)
    store_row(reach, ACCELERATION_REACH, 0, swing)
    store_row(reach, JERK_REACH, 0, jerk)


@inlined
def expand_groups(
    model, dense_stiffness, dense_damping, damped, grounded, n, h, ground, rise, series, momentum
):
    """Fill the series of any number of storeys, from the top group of four down."""
    dense = dense_stiffness.shape[0] + dense_damping.shape[0] > 0
    pull = (0.0, 0.0, 0.0, 0.0)
    groups = model.shape[1] // LANES
    for k in range(n):
        factor = h / (k + 1)
        above = 0.0
        moved = 0.0
        for group in range(groups - 1, -1, -1):
            i = LANES * group
            x = load(series, DISPLACEMENT, i + 1, k)
            y = load(series, VELOCITY, i + 1, k)
            o = load(series, OFFSET, i + 1, k)
            z = load(series, SLIDING, i + 1, k)
            if dense:
                pull = product(dense_stiffness, series, DISPLACEMENT, i, k)
                pull = plus(pull, product(dense_damping, series, VELOCITY, i, k))
            y_next, z_next, held, inertia, above = next_terms(
                model,
                i,
                k,
                factor,
                x,
                y,
                o,
                z,
                series[DISPLACEMENT, i, k],
                series[VELOCITY, i, k],
                above,
                dense,
                pull,
                damped,
                grounded,
                ground,
                rise,
            )
            store(series, VELOCITY, i + 1, k + 1, y_next)
            store(series, DISPLACEMENT, i + 1, k + 1, scaled(y, factor))
            store(series, OFFSET, i + 1, k + 1, scaled(z, factor))
            store(series, SLIDING, i + 1, k + 1, z_next)
            store(series, REACTION, i + 1, k, held)
            store(series, INERTIA, i + 1, k, inertia)
            moved += total_of(minus(times(row(model, MASS, i), y), times(row(model, BRACE, i), z)))
        momentum[k] = moved
    momentum[n] = 0.0
    for i in range(0, model.shape[1], LANES):
        y = load(series, VELOCITY, i + 1, n)
        z = load(series, SLIDING, i + 1, n)
        momentum[n] += total_of(minus(times(row(model, MASS, i), y), times(row(model, BRACE, i), z)))


@inner
def measure(series, n, reach):
    """Fill ``reach``: how far reactions and accelerations may go from their values at the start."""
    for i in range(0, reach.shape[1], LANES):
        far = (0.0, 0.0, 0.0, 0.0)
        swing = (0.0, 0.0, 0.0, 0.0)
        jerk = (0.0, 0.0, 0.0, 0.0)
        for k in range(1, n):
            far = plus(far, magnitude(load(series, REACTION, i + 1, k)))
            term = magnitude(load(series, INERTIA, i + 1, k))
            swing = plus(swing, term)
            jerk = plus(jerk, scaled(term, float(k)))
        store_row(reach, REACTION_REACH, i, far)
        store_row(reach, ACCELERATION_REACH, i, swing)
        store_row(reach, JERK_REACH, i, jerk)


@inner
def excess_of(frame, phase, state, i):
    """What the stretch (m) of a slipping massless brace is beyond s F / k_d, and what of it rounding leaves.

    The second is ample: the excess is a difference of displacements, which are sums of terms of a series.
    """
    below = state[DISPLACEMENT, i - 1] if i > 0 else 0.0
    stretch = sliding_force(phase[i], frame[KINETIC_SLIP_FORCE, i]) / frame[BRACE_STIFFNESS, i]
    size = abs(state[DISPLACEMENT, i]) + abs(below) + abs(state[OFFSET, i]) + abs(stretch)
    return state[DISPLACEMENT, i] - below - state[OFFSET, i] - stretch, UNRESOLVED * size


@inner
def relax(frame, model, kind, phase, vanishing, state):
    """Set the rates that the slips of massless braces with dashpots add to the motion.

    The excess of such a brace's stretch decays as exp(- k_d t / c_d) and pulls at nothing.  Once rounding
    hides it, the brace is quasi-static, as one without a dashpot, and however fast the decay would be
    it asks for no short steps.
    """
    for i in range(phase.size):
        if kind[i] != MASSLESS or frame[BRACE_DAMPING, i] == 0.0:
            continue
        model[SLIP_RATE, i] = 0.0
        if phase[i] != STICK:
            excess, hidden = excess_of(frame, phase, state, i)
            if abs(excess) > hidden:
                model[SLIP_RATE, i] = frame[BRACE_STIFFNESS, i] / frame[BRACE_DAMPING, i]
            elif vanishing[i] > 0:
                below = state[VELOCITY, i - 1] if i > 0 else 0.0
                vanishing[i] = 0 if phase[i] * (state[VELOCITY, i] - below) > 0.0 else 1


@inner
def follow_drift(frame, model, state, vanishing, phase, n, h, series, i):
    """Series of the offset of a slipping massless brace: the drift less the brace's own stretch.

    The stretch is s F / k_d, towards which it relaxes at the rate k_d / c_d where there is a dashpot.
    """
    stiffness = frame[BRACE_STIFFNESS, i]
    stretch = sliding_force(phase[i], frame[KINETIC_SLIP_FORCE, i]) / stiffness
    excess = 0.0
    decay = 0.0
    rate = 0.0
    if model[SLIP_RATE, i] > 0.0:
        rate = -model[SLIP_RATE, i]
        decay = rate * h
        excess = series[DISPLACEMENT, i + 1, 0] - series[DISPLACEMENT, i, 0] - state[OFFSET, i] - stretch
    else:
        series[OFFSET, i + 1, 0] = series[DISPLACEMENT, i + 1, 0] - series[DISPLACEMENT, i, 0] - stretch
    for k in range(n + 1):
        if k > 0:
            excess *= decay / k
            series[OFFSET, i + 1, k] = series[DISPLACEMENT, i + 1, k] - series[DISPLACEMENT, i, k] - excess
        series[SLIDING, i + 1, k] = series[VELOCITY, i + 1, k] - series[VELOCITY, i, k] - rate * excess
    if vanishing[i] > 0:  # it begins or turns here: its first velocity is known, and not from differences
        gap = frame[SLIP_FORCE, i] - frame[KINETIC_SLIP_FORCE, i]
        speed = -rate * phase[i] * gap / stiffness
        series[SLIDING, i + 1, 0] = speed
        if rate != 0.0:
            series[OFFSET, i + 1, 1] = speed * h


@inner
def end_of_step(series, n, x, state):
    """Set the state to that at the fraction x of the step."""
    size = state.shape[1]
    for i in range(0, size, LANES):
        for quantity in (DISPLACEMENT, OFFSET):
            place = load(series, quantity, i + 1, n)
            speed = load(series, quantity + 1, i + 1, n)
            if x == 1.0:
                for k in range(n - 1, -1, -1):
                    place = plus(place, load(series, quantity, i + 1, k))
                    speed = plus(speed, load(series, quantity + 1, i + 1, k))
            else:
                for k in range(n - 1, -1, -1):
                    place = plus(scaled(place, x), load(series, quantity, i + 1, k))
                    speed = plus(scaled(speed, x), load(series, quantity + 1, i + 1, k))
            for lane in range(min(LANES, size - i)):
                state[quantity, i + lane] = place[lane]
                state[quantity + 1, i + lane] = speed[lane]


@inner
def reaction_now(frame, model, dense_stiffness, dense_damping, state, i):
    """Reaction (N) that storey i would need to stick, its sliding velocity taken as zero."""
    size = frame.shape[1]
    drift = state[DISPLACEMENT, i] - (state[DISPLACEMENT, i - 1] if i > 0 else 0.0)
    drift_rate = state[VELOCITY, i] - (state[VELOCITY, i - 1] if i > 0 else 0.0)
    brace = frame[BRACE_STIFFNESS, i] * (drift - state[OFFSET, i]) + frame[BRACE_DAMPING, i] * drift_rate
    floor = (
        -model[COLUMNS, i] * drift
        - model[COLUMN_DASHPOTS, i] * drift_rate
        - model[GROUND_SPRINGS, i] * state[DISPLACEMENT, i]
        - model[GROUND_DASHPOTS, i] * state[VELOCITY, i]
    )
    if i + 1 < size:
        j = i + 1
        drift = state[DISPLACEMENT, j] - state[DISPLACEMENT, i]
        drift_rate = state[VELOCITY, j] - state[VELOCITY, i]
        floor += (
            model[COLUMNS, j] * drift
            + model[COLUMN_DASHPOTS, j] * drift_rate
            + model[SPRING, j] * (drift - state[OFFSET, j])
            + model[DASHPOT, j] * (drift_rate - state[SLIDING, j])
            + model[GIVEN_FORCE, j]
        )
    for j in range(min(size, dense_stiffness.shape[0])):
        floor -= dense_stiffness[j, i] * state[DISPLACEMENT, j]
    for j in range(min(size, dense_damping.shape[0])):
        floor -= dense_damping[j, i] * state[VELOCITY, j]
    return model[FLOOR_SHARE, i] * floor + model[BRACE_SHARE, i] * brace
