"""Taylor series of eight frames' motion over a step each.

Per storey two series are kept, in powers of the fraction of the step: I, the floor's absolute acceleration,
and Q, the acceleration of its sliding where it slips, else the reaction of its damper.  Displacements and
velocities are these integrated from the step's start.  With drift g and brace force B as in
:mod:`fdspec.kernels.frame.model`, and P the force on the floor without its own damper:

    stick   I = (P - B) / (m_f + m_d)        Q = R = (m_d P + m_f B) / (m_f + m_d)
    slip    I = (P - s F) / m_f              Q = P / m_f + B / m_d - (1/m_f + 1/m_d) s F

A history of lower order than its neighbours has coefficients of zero beyond its own: they add nothing, and
its numbers are those it has alone.
"""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.frame_batch.eight import WIDTH, abs8, fma8, less8, load, splat, store, where_above
from fdspec.kernels.frame_batch.layout import (
    BEND_REACH,
    COLUMN_DASHPOTS,
    COLUMNS,
    COMPLIANCE,
    DASHPOT,
    FRICTION,
    GROUND,
    GROUND_DASHPOTS,
    GROUND_SPRINGS,
    INERTIA,
    INERTIA_REACH,
    JERK_REACH,
    LENGTH,
    MASS,
    NOW,
    OF_BRACE,
    OF_FLOOR,
    ORDER,
    PULL,
    REACH,
    RISE,
    SECOND,
    SECOND_REACH,
    SLIDES,
    SLIDING_MASS,
    SPRING,
    START,
    STUCK,
    row,
    term,
)
from fdspec.kernels.mathematics.oscillator import INVERSE


@inlined
def multiply(p, matrix, x, size):
    """Put a matrix of lanes times a row of all storeys into the row PULL; four storeys share each load."""
    i = 0
    while i + 3 < size:
        a = splat(0.0)
        b = splat(0.0)
        c = splat(0.0)
        d = splat(0.0)
        for j in range(size):
            y = load(p, row(x, j))
            entry = matrix + (j * size + i) * WIDTH  # symmetric: read along its columns
            a = fma8(load(p, entry), y, a)
            b = fma8(load(p, entry + WIDTH), y, b)
            c = fma8(load(p, entry + 2 * WIDTH), y, c)
            d = fma8(load(p, entry + 3 * WIDTH), y, d)
        store(p, row(PULL, i), a)
        store(p, row(PULL, i + 1), b)
        store(p, row(PULL, i + 2), c)
        store(p, row(PULL, i + 3), d)
        i += 4
    while i < size:
        a = splat(0.0)
        for j in range(size):
            a = fma8(load(p, matrix + (j * size + i) * WIDTH), load(p, row(x, j)), a)
        store(p, row(PULL, i), a)
        i += 1


@inner
def add_stiffness(p, at, size):
    """Add what the dense stiffness asks for to the row PULL."""
    wide()
    for i in range(size):
        a = load(p, row(PULL, i))
        for j in range(size):
            entry = at.stiffness + (j * size + i) * WIDTH
            a = fma8(load(p, entry), load(p, row(NOW + DISPLACEMENT, j)), a)
        store(p, row(PULL, i), a)


@inner
def expand(p, at, size, orders, dense_stiffness, dense_damping, damped, grounded):
    """Fill the series of ``orders`` terms over the steps that start at the state in the rows START.

    Beside them the sums of all masses times their accelerations.  dense_stiffness, dense_damping: whether
    there are such matrices; damped: whether dashpots stand between neighbours, grounded: whether
    floors hold to the ground.
    """
    wide()
    h = load(p, LENGTH * WIDTH)
    order = load(p, ORDER * WIDTH)
    nothing = splat(0.0)
    dense = dense_stiffness or dense_damping
    for i in range(size):
        for r in range(4):
            store(p, row(NOW + r, i), load(p, row(START + r, i)))
        store(p, row(PULL, i), nothing)
    for k in range(orders):
        factor = where_above(order, splat(float(k + 1)), h * splat(INVERSE[k + 1]), nothing)
        if dense_damping:
            multiply(p, at.damping, NOW + VELOCITY, size)
        if dense_stiffness:
            if not dense_damping:
                for i in range(size):
                    store(p, row(PULL, i), nothing)
            add_stiffness(p, at, size)
        upper = nothing
        total = nothing
        x = load(p, row(NOW + DISPLACEMENT, size - 1))
        y = load(p, row(NOW + VELOCITY, size - 1))
        for i in range(size - 1, -1, -1):
            o = load(p, row(NOW + OFFSET, i))
            z = load(p, row(NOW + SLIDING, i))
            x_below = nothing
            y_below = nothing
            if i > 0:
                x_below = load(p, row(NOW + DISPLACEMENT, i - 1))
                y_below = load(p, row(NOW + VELOCITY, i - 1))
            drift = x - x_below
            brace = load(p, row(SPRING, i)) * (drift - o)
            storey = load(p, row(COLUMNS, i)) * drift
            if damped:
                rate = y - y_below
                brace = fma8(load(p, row(DASHPOT, i)), rate - z, brace)
                storey = fma8(load(p, row(COLUMN_DASHPOTS, i)), rate, storey)
            floor = upper - storey
            upper = storey + brace
            if grounded:
                floor = less8(floor, load(p, row(GROUND_SPRINGS, i)), x)
                floor = less8(floor, load(p, row(GROUND_DASHPOTS, i)), y)
            if dense:
                floor = floor - load(p, row(PULL, i))
            push = less8(floor, load(p, row(STUCK, i)), brace)
            second = load(p, row(OF_FLOOR, i)) * floor
            second = fma8(load(p, row(OF_BRACE, i)), brace, second)
            if k == 0:
                friction = load(p, row(FRICTION, i))
                push = push - friction
                second = less8(second, friction, load(p, row(OF_FLOOR, i)) + load(p, row(OF_BRACE, i)))
            inertia = push * load(p, row(COMPLIANCE, i))
            store(p, term(at, INERTIA, i, k), inertia)
            store(p, term(at, SECOND, i, k), second)
            total = fma8(load(p, row(MASS, i)), inertia, total)
            total = less8(total, load(p, row(SLIDING_MASS, i)), second)
            if k == 0:
                inertia = inertia - load(p, GROUND * WIDTH)
            elif k == 1:
                inertia = inertia - load(p, RISE * WIDTH)
            store(p, row(NOW + DISPLACEMENT, i), y * factor)
            store(p, row(NOW + VELOCITY, i), inertia * factor)
            store(p, row(NOW + OFFSET, i), z * factor)
            store(p, row(NOW + SLIDING, i), second * (load(p, row(SLIDES, i)) * factor))
            x = x_below
            y = y_below
        store(p, at.thrust + k * WIDTH, total)


@inner
def measure(p, at, size, orders):
    """Fill the reaches: how far accelerations and reactions may go from those at the start."""
    wide()
    for i in range(size):
        inertia = splat(0.0)
        jerk = splat(0.0)
        bend = splat(0.0)
        second = splat(0.0)
        for k in range(1, orders):
            swing = abs8(load(p, term(at, INERTIA, i, k)))
            inertia = inertia + swing
            jerk = fma8(swing, splat(float(k)), jerk)
            bend = fma8(swing, splat(float(k * (k - 1))), bend)
            second = second + abs8(load(p, term(at, SECOND, i, k)))
        store(p, row(REACH + INERTIA_REACH, i), inertia)
        store(p, row(REACH + JERK_REACH, i), jerk)
        store(p, row(REACH + BEND_REACH, i), bend)
        store(p, row(REACH + SECOND_REACH, i), second)
