"""The state at the end of what is taken of a step, and the work of the ground on it."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.compiler.options import inner, wide
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, TERMS, VELOCITY
from fdspec.kernels.frame_batch.eight import WIDTH, abs8, fma8, less8, load, max8, splat, store
from fdspec.kernels.frame_batch.layout import (
    END,
    FRACTION,
    GROUND,
    INERTIA,
    INPUT,
    LAST,
    LAST_SECOND,
    LENGTH,
    MASS,
    MOST_INPUT,
    RISE,
    SECOND,
    SLIDES,
    SLIDING_MASS,
    START,
    row,
    term,
)

_k = np.arange(TERMS + 1.0)
ONCE: Final = 1.0 / (_k + 1.0)
TWICE: Final = 1.0 / ((_k + 1.0) * (_k + 2.0))
THRICE: Final = 1.0 / ((_k + 1.0) * (_k + 2.0) * (_k + 3.0))
"""Factors that integrate the power k once, twice and three times from 0 to 1."""


@inner
def advance(p, at, size, orders):
    """Fill the rows END with the state at the fraction FRACTION of the steps."""
    wide()
    x = load(p, FRACTION * WIDTH)
    t = x * load(p, LENGTH * WIDTH)
    power = splat(1.0)
    for k in range(orders):
        store(p, at.weights + 3 * k * WIDTH, power)
        store(p, at.weights + (3 * k + 1) * WIDTH, power * splat(ONCE[k]))
        store(p, at.weights + (3 * k + 2) * WIDTH, power * splat(TWICE[k]))
        power = power * x
    ground = load(p, GROUND * WIDTH)
    rise = load(p, RISE * WIDTH) * x
    shake = fma8(rise, splat(0.5), ground)
    shift = fma8(rise, splat(1.0 / 6.0), ground * splat(0.5))
    for i in range(size):
        speed = splat(0.0) - shake
        place = splat(0.0) - shift
        slide = splat(0.0)
        slip = splat(0.0)
        last = splat(0.0)
        last_second = splat(0.0)
        for k in range(orders):
            once = load(p, at.weights + (3 * k + 1) * WIDTH)
            twice = load(p, at.weights + (3 * k + 2) * WIDTH)
            inertia = load(p, term(at, INERTIA, i, k))
            here = load(p, at.weights + 3 * k * WIDTH)
            last = fma8(inertia, here, last)
            second = load(p, term(at, SECOND, i, k))
            last_second = fma8(second, here, last_second)
            speed = fma8(inertia, once, speed)
            place = fma8(inertia, twice, place)
            slide = fma8(second, once, slide)
            slip = fma8(second, twice, slip)
        slides = load(p, row(SLIDES, i)) * t
        u = load(p, row(START + DISPLACEMENT, i))
        v = load(p, row(START + VELOCITY, i))
        o = load(p, row(START + OFFSET, i))
        z = load(p, row(START + SLIDING, i))
        store(p, row(LAST, i), last)
        store(p, row(LAST_SECOND, i), last_second)
        store(p, row(END + DISPLACEMENT, i), fma8(t, fma8(t, place, v), u))
        store(p, row(END + VELOCITY, i), fma8(t, speed, v))
        store(p, row(END + OFFSET, i), fma8(t, fma8(slides, slip, z), o))
        store(p, row(END + SLIDING, i), fma8(slides, slide, z))


@inner
def add_input(p, at, size, orders):
    """Add the work of the ground acceleration a on what is taken of the steps.

    With D = sum m u of all masses since the step's start it is - the integral of a D', which is
    - a D at the end and what the rise of a times D makes of it: D'' is the series of the block ``thrust``.
    """
    wide()
    x = load(p, FRACTION * WIDTH)
    t = x * load(p, LENGTH * WIDTH)
    ground = load(p, GROUND * WIDTH)
    rise = load(p, RISE * WIDTH) * x
    mass = splat(0.0)
    momentum = splat(0.0)
    for i in range(size):
        whole = load(p, row(MASS, i))
        sliding_mass = load(p, row(SLIDING_MASS, i))
        mass = mass + whole
        momentum = fma8(whole, load(p, row(START + VELOCITY, i)), momentum)
        momentum = less8(momentum, sliding_mass, load(p, row(START + SLIDING, i)))
    twice = splat(0.0)
    thrice = splat(0.0)
    power = splat(1.0)
    for k in range(orders):
        thrust = load(p, at.thrust + k * WIDTH) * power
        twice = fma8(thrust, splat(TWICE[k]), twice)
        thrice = fma8(thrust, splat(THRICE[k]), thrice)
        power = power * x
    twice = twice - mass * fma8(rise, splat(1.0 / 6.0), ground * splat(0.5))
    thrice = thrice - mass * fma8(rise, splat(1.0 / 24.0), ground * splat(1.0 / 6.0))
    moved = fma8(t, twice, momentum) * t
    swept = fma8(t, thrice, momentum * splat(0.5)) * t
    work = rise * swept - (ground + rise) * moved
    work = load(p, INPUT * WIDTH) + work
    store(p, INPUT * WIDTH, work)
    store(p, MOST_INPUT * WIDTH, max8(abs8(work), load(p, MOST_INPUT * WIDTH)))
