"""Which storeys may change their phase on the step: bounds, for eight histories at once, clear most."""

from __future__ import annotations

from fdspec.jit import inner, wide
from fdspec.kernels.frame_batch.eight import ALL, WIDTH, above, abs8, fma8, load, splat, sqrt8
from fdspec.kernels.frame_batch.layout import (
    DASHPOT,
    FRICTION,
    GROUND,
    INERTIA,
    INERTIA_REACH,
    JERK_REACH,
    LENGTH,
    LIMIT,
    OVER_BRACE,
    REACH,
    RISE,
    SECOND,
    SECOND_REACH,
    SIGN,
    SLOWNESS,
    SPECIAL,
    SPRING,
    START,
    row,
    term,
)
from fdspec.kernels.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY


@inner
def alert(p, at, size, alerts):
    """Set alerts[i] to the lanes in which storey i must be searched; return the lanes that have any.

    A reaction stays within its reach of that at the start.  A brace that slips swings about the floor below
    with an amplitude that grows by no more than that floor's jerk makes it; the floor itself changes its
    velocity by no more than its acceleration makes it.
    """
    wide()
    h = load(p, LENGTH * WIDTH)
    nothing = splat(0.0)
    below_start = load(p, GROUND * WIDTH)
    jerk = abs8(load(p, RISE * WIDTH))
    below = abs8(below_start) + jerk
    u = nothing
    v = nothing
    found = 0
    for i in range(size):
        x = load(p, row(START + DISPLACEMENT, i))
        y = load(p, row(START + VELOCITY, i))
        drift = x - u
        drift_rate = y - v
        u = x
        v = y
        inertia = load(p, term(at, INERTIA, i, 0))
        reach = abs8(inertia) + load(p, row(REACH + INERTIA_REACH, i))
        friction = load(p, row(FRICTION, i))
        sign = load(p, row(SIGN, i))
        swing = drift_rate - load(p, row(START + SLIDING, i))
        stretch = drift - load(p, row(START + OFFSET, i))
        force = friction - load(p, row(SPRING, i)) * stretch
        force = force - load(p, row(DASHPOT, i)) * swing
        slowness = load(p, row(SLOWNESS, i))
        kick = slowness * fma8(force, load(p, row(OVER_BRACE, i)), nothing - below_start)
        ring = sqrt8(fma8(swing, swing, kick * kick)) + jerk * slowness
        slips = above(abs8(sign), nothing)
        slips_on = above(sign * drift_rate - h * (reach + below), ring)
        room = load(p, row(LIMIT, i)) - load(p, row(REACH + SECOND_REACH, i))
        sticks_on = above(room, abs8(load(p, term(at, SECOND, i, 0))))
        special = above(load(p, row(SPECIAL, i)), nothing)
        clear = ((slips & slips_on) | (~slips & sticks_on)) & ~special
        alerts[i] = ALL & ~clear
        found |= alerts[i]
        below = reach
        below_start = inertia
        jerk = load(p, row(REACH + JERK_REACH, i))
    return found
