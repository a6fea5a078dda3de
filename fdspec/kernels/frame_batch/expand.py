"""Taylor series of eight frames' motion over a step each.

Per storey two series are kept, in powers of the fraction of the step: I, the floor's absolute acceleration,
and Q, the acceleration of its sliding where it slips, else the reaction of its damper.  Displacements and
velocities are these integrated from the step's start.  With drift g and brace force B as in
:mod:`fdspec.kernels.frame`, and P the force on the floor without its own damper:

    stick   I = (P - B) / (m_f + m_d)        Q = R = (m_d P + m_f B) / (m_f + m_d)
    slip    I = (P - s F) / m_f              Q = P / m_f + B / m_d - (1/m_f + 1/m_d) s F

A history of lower order than its neighbours has coefficients of zero beyond its own: they add nothing, and
its numbers are those it has alone.
"""

from __future__ import annotations

from fdspec.jit import inner, wide
from fdspec.kernels.frame_batch.eight import WIDTH, abs8, fma8, load, splat, store, where_above
from fdspec.kernels.frame_batch.layout import (
    COLUMN_DASHPOTS,
    COLUMNS,
    COMPLIANCE,
    DASHPOT,
    FRICTION,
    GROUND,
    GROUND_DASHPOTS,
    GROUND_SPRINGS,
    HELD,
    INERTIA_REACH,
    JERK_REACH,
    LENGTH,
    LOOSE_MASS,
    MASS,
    OF_BRACE,
    OF_FLOOR,
    ORDER,
    RISE,
    SECOND_REACH,
    SLIDES,
    SPRING,
    of,
    term,
)
from fdspec.kernels.oscillator import INVERSE
from fdspec.kernels.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY


@inner
def multiply(p, matrix, x, size, pull):
    """Add a matrix of lanes times a row of storeys to ``pull``; four rows share each load."""
    wide()
    i = 0
    while i + 3 < size:
        a = load(p, pull + i * WIDTH)
        b = load(p, pull + (i + 1) * WIDTH)
        c = load(p, pull + (i + 2) * WIDTH)
        d = load(p, pull + (i + 3) * WIDTH)
        for j in range(size):
            y = load(p, x + j * WIDTH)
            entry = matrix + (j * size + i) * WIDTH  # symmetric: read along its columns
            a = fma8(load(p, entry), y, a)
            b = fma8(load(p, entry + WIDTH), y, b)
            c = fma8(load(p, entry + 2 * WIDTH), y, c)
            d = fma8(load(p, entry + 3 * WIDTH), y, d)
        store(p, pull + i * WIDTH, a)
        store(p, pull + (i + 1) * WIDTH, b)
        store(p, pull + (i + 2) * WIDTH, c)
        store(p, pull + (i + 3) * WIDTH, d)
        i += 4
    while i < size:
        a = load(p, pull + i * WIDTH)
        for j in range(size):
            a = fma8(load(p, matrix + (j * size + i) * WIDTH), load(p, x + j * WIDTH), a)
        store(p, pull + i * WIDTH, a)
        i += 1


@inner
def expand(p, at, size, orders, dense_stiffness, dense_damping, damped, grounded, thrust):
    """Fill the series of ``orders`` terms over the steps that start at the block ``state``.

    dense_stiffness, dense_damping: whether there are such matrices; damped: whether dashpots stand between
    neighbours, grounded: whether floors hold to the ground; thrust: whether sums of masses times accelerations
    are wanted.
    """
    wide()
    model = at.model
    now = at.now
    h = load(p, LENGTH * WIDTH)
    order = load(p, ORDER * WIDTH)
    nothing = splat(0.0)
    for i in range(4 * size):
        store(p, now + i * WIDTH, load(p, at.state + i * WIDTH))
    for k in range(orders):
        factor = where_above(order, splat(float(k + 1)), h * splat(INVERSE[k + 1]), nothing)
        if dense_stiffness or dense_damping:
            for i in range(size):
                store(p, at.pull + i * WIDTH, nothing)
            if dense_stiffness:
                multiply(p, at.stiffness, of(now, DISPLACEMENT, size, 0), size, at.pull)
            if dense_damping:
                multiply(p, at.damping, of(now, VELOCITY, size, 0), size, at.pull)
        upper = nothing
        total = nothing
        for i in range(size - 1, -1, -1):
            x = load(p, of(now, DISPLACEMENT, size, i))
            y = load(p, of(now, VELOCITY, size, i))
            o = load(p, of(now, OFFSET, size, i))
            z = load(p, of(now, SLIDING, size, i))
            drift = x
            rate = y
            if i > 0:
                drift = x - load(p, of(now, DISPLACEMENT, size, i - 1))
            brace = load(p, of(model, SPRING, size, i)) * (drift - o)
            storey = load(p, of(model, COLUMNS, size, i)) * drift
            if damped:
                if i > 0:
                    rate = y - load(p, of(now, VELOCITY, size, i - 1))
                brace = fma8(load(p, of(model, DASHPOT, size, i)), rate - z, brace)
                storey = fma8(load(p, of(model, COLUMN_DASHPOTS, size, i)), rate, storey)
            floor = upper - storey
            upper = storey + brace
            if grounded:
                floor = floor - load(p, of(model, GROUND_SPRINGS, size, i)) * x
                floor = floor - load(p, of(model, GROUND_DASHPOTS, size, i)) * y
            if dense_stiffness or dense_damping:
                floor = floor - load(p, at.pull + i * WIDTH)
            push = floor - load(p, of(model, HELD, size, i)) * brace
            second = load(p, of(model, OF_FLOOR, size, i)) * floor
            second = fma8(load(p, of(model, OF_BRACE, size, i)), brace, second)
            slides = load(p, of(model, SLIDES, size, i))
            if k == 0:
                friction = load(p, of(model, FRICTION, size, i))
                push = push - friction
                both = load(p, of(model, OF_FLOOR, size, i)) + load(p, of(model, OF_BRACE, size, i))
                second = second - friction * both
            inertia = push * load(p, of(model, COMPLIANCE, size, i))
            store(p, term(at.inertia, i, k), inertia)
            store(p, term(at.second, i, k), second)
            if thrust:
                total = fma8(load(p, of(model, MASS, size, i)), inertia, total)
                total = total - load(p, of(model, LOOSE_MASS, size, i)) * second
            if k == 0:
                inertia = inertia - load(p, GROUND * WIDTH)
            elif k == 1:
                inertia = inertia - load(p, RISE * WIDTH)
            store(p, of(now, DISPLACEMENT, size, i), y * factor)
            store(p, of(now, VELOCITY, size, i), inertia * factor)
            store(p, of(now, OFFSET, size, i), z * factor)
            store(p, of(now, SLIDING, size, i), second * (slides * factor))
        if thrust:
            store(p, at.thrust + k * WIDTH, total)


@inner
def measure(p, at, size, orders):
    """Fill the block of reaches: how far accelerations and reactions may go from those at the start."""
    wide()
    for i in range(size):
        inertia = splat(0.0)
        jerk = splat(0.0)
        second = splat(0.0)
        for k in range(1, orders):
            swing = abs8(load(p, term(at.inertia, i, k)))
            inertia = inertia + swing
            jerk = fma8(swing, splat(float(k)), jerk)
            second = second + abs8(load(p, term(at.second, i, k)))
        store(p, of(at.reach, INERTIA_REACH, size, i), inertia)
        store(p, of(at.reach, JERK_REACH, size, i), jerk)
        store(p, of(at.reach, SECOND_REACH, size, i), second)
