"""Work into the dashpots of eight frames: quadrature of their power over what is taken of the steps.

Six nodes integrate a floor's power to rounding over a step of 2.5 radians of the brace that shakes it, since
that brace is the lighter one; where braces have dashpots too, twelve are taken.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.compiler.options import inner, wide
from fdspec.kernels.frame.taylor import SLIDING, VELOCITY
from fdspec.kernels.frame_batch.advance import ONCE
from fdspec.kernels.frame_batch.eight import WIDTH, fma8, load, splat, store
from fdspec.kernels.frame_batch.layout import (
    COLUMN_DASHPOTS,
    DASHPOT,
    FRACTION,
    GROUND,
    GROUND_DASHPOTS,
    INERTIA,
    LENGTH,
    MOST_NODES,
    RISE,
    SECOND,
    SLIDES,
    START,
    VISCOUS,
    row,
    term,
)

SIX: Final = 6

_points, _weights = np.polynomial.legendre.leggauss(SIX)
FEW_NODES: Final = 0.5 * (1.0 + _points)
FEW_WEIGHTS: Final = 0.5 * _weights

_points, _weights = np.polynomial.legendre.leggauss(MOST_NODES)
NODES: Final = 0.5 * (1.0 + _points)
WEIGHTS: Final = 0.5 * _weights


@inner
def floor_speeds(p, at, size, orders, nodes, first):
    """Put the floors' velocities at six nodes, from ``first`` on, into the block ``speeds``."""
    wide()
    x = load(p, FRACTION * WIDTH)
    ground = splat(0.0) - load(p, GROUND * WIDTH)
    rise = splat(-0.5) * load(p, RISE * WIDTH)
    for i in range(size):
        put_speeds(
            p,
            at,
            INERTIA,
            i,
            size,
            orders,
            nodes,
            first,
            x,
            ground,
            rise,
            load(p, LENGTH * WIDTH),
            load(p, row(START + VELOCITY, i)),
            at.speeds,
        )


@inner
def sliding_speeds(p, at, size, orders, nodes, first):
    """Put the sliding velocities at six nodes into the block ``slides``."""
    wide()
    x = load(p, FRACTION * WIDTH)
    nothing = splat(0.0)
    for i in range(size):
        h = load(p, LENGTH * WIDTH) * load(p, row(SLIDES, i))
        put_speeds(
            p,
            at,
            SECOND,
            i,
            size,
            orders,
            nodes,
            first,
            x,
            nothing,
            nothing,
            h,
            load(p, row(START + SLIDING, i)),
            at.slides,
        )


@inner
def put_speeds(p, at, series, i, size, orders, nodes, first, x, ground, rise, h, speed, to):
    """Integrate a storey's acceleration up to six nodes: its series, and ground + rise x beside it."""
    wide()
    a = x * splat(nodes[first])
    b = x * splat(nodes[first + 1])
    c = x * splat(nodes[first + 2])
    d = x * splat(nodes[first + 3])
    e = x * splat(nodes[first + 4])
    f = x * splat(nodes[first + 5])
    at_a = splat(0.0)
    at_b = splat(0.0)
    at_c = splat(0.0)
    at_d = splat(0.0)
    at_e = splat(0.0)
    at_f = splat(0.0)
    for k in range(orders - 1, -1, -1):
        rate = load(p, term(at, series, i, k)) * splat(ONCE[k])
        at_a = fma8(at_a, a, rate)
        at_b = fma8(at_b, b, rate)
        at_c = fma8(at_c, c, rate)
        at_d = fma8(at_d, d, rate)
        at_e = fma8(at_e, e, rate)
        at_f = fma8(at_f, f, rate)
    place = to + (first * size + i) * WIDTH
    apart = size * WIDTH
    store(p, place, fma8(at_a + fma8(rise, a, ground), a * h, speed))
    store(p, place + apart, fma8(at_b + fma8(rise, b, ground), b * h, speed))
    store(p, place + 2 * apart, fma8(at_c + fma8(rise, c, ground), c * h, speed))
    store(p, place + 3 * apart, fma8(at_d + fma8(rise, d, ground), d * h, speed))
    store(p, place + 4 * apart, fma8(at_e + fma8(rise, e, ground), e * h, speed))
    store(p, place + 5 * apart, fma8(at_f + fma8(rise, f, ground), f * h, speed))


@inner
def power_at(p, at, size, node, dense_damping, damped, grounded, damped_braces):
    """Power of all dashpots at a node, W."""
    wide()
    speeds = at.speeds + node * size * WIDTH
    slides = at.slides + node * size * WIDTH
    power = splat(0.0)
    below = splat(0.0)
    for i in range(size):
        speed = load(p, speeds + i * WIDTH)
        if damped:
            drift = speed - below
            below = speed
            power = fma8(load(p, row(COLUMN_DASHPOTS, i)), drift * drift, power)
            if damped_braces:
                brace = drift - load(p, slides + i * WIDTH)
                power = fma8(load(p, row(DASHPOT, i)), brace * brace, power)
        if grounded:
            power = fma8(load(p, row(GROUND_DASHPOTS, i)), speed * speed, power)
        if dense_damping:
            one = splat(0.0)
            two = splat(0.0)
            j = 0
            while j + 1 < i:
                one = fma8(load(p, at.damping + (i * size + j) * WIDTH), load(p, speeds + j * WIDTH), one)
                two = fma8(
                    load(p, at.damping + (i * size + j + 1) * WIDTH), load(p, speeds + (j + 1) * WIDTH), two
                )
                j += 2
            if j < i:
                one = fma8(load(p, at.damping + (i * size + j) * WIDTH), load(p, speeds + j * WIDTH), one)
            one = splat(2.0) * (one + two)
            one = fma8(load(p, at.damping + (i * size + i) * WIDTH), speed, one)
            power = fma8(one, speed, power)
    return power


@inner
def add_dissipation(p, at, size, orders, dense_damping, damped, grounded, damped_braces):
    """Add the work into dashpots on what is taken of the steps.

    damped_braces: whether any brace has a dashpot; the other arguments are those of `expand`.
    """
    wide()
    total = splat(0.0)
    if damped_braces:
        for first in range(0, len(NODES), SIX):
            floor_speeds(p, at, size, orders, NODES, first)
            sliding_speeds(p, at, size, orders, NODES, first)
        for node in range(len(NODES)):
            power = power_at(p, at, size, node, dense_damping, damped, grounded, damped_braces)
            total = fma8(splat(WEIGHTS[node]), power, total)
    else:
        floor_speeds(p, at, size, orders, FEW_NODES, 0)
        for node in range(SIX):
            power = power_at(p, at, size, node, dense_damping, damped, grounded, damped_braces)
            total = fma8(splat(FEW_WEIGHTS[node]), power, total)
    work = load(p, FRACTION * WIDTH) * load(p, LENGTH * WIDTH) * total
    store(p, VISCOUS * WIDTH, load(p, VISCOUS * WIDTH) + work)
