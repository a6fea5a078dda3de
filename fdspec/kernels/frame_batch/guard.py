"""Which storeys may change their phase on the step: bounds, for eight histories at once, clear most."""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.frame_batch.eight import (
    ALL,
    WIDTH,
    above,
    abs8,
    fma8,
    less8,
    load,
    max8,
    splat,
    sqrt8,
    store,
)
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
    RING,
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


@inner
def alert(p, at, size, alerts):
    """Set alerts[i] to the lanes in which storey i must be searched; return the lanes that have any.

    A quantity that begins with two known terms stays between their values at both ends, give or take the sum
    of the magnitudes of the others.  That clears reactions, and short slips.  In a longer slip the brace
    swings about the floor below with an amplitude that grows by no more than that floor's jerk makes
    it: the floors' own motion may then carry the slip on.
    """
    wide()
    h = load(p, LENGTH * WIDTH)
    half = splat(0.5) * h
    nothing = splat(0.0)
    below = load(p, GROUND * WIDTH)
    below_reach = abs8(load(p, RISE * WIDTH))
    jerk = below_reach
    u = nothing
    v = nothing
    found = 0
    for i in range(size):
        x = load(p, row(START + DISPLACEMENT, i))
        y = load(p, row(START + VELOCITY, i))
        z = load(p, row(START + SLIDING, i))
        drift = x - u
        drift_rate = y - v
        u = x
        v = y
        inertia = load(p, term(at, INERTIA, i, 0))
        reach = load(p, row(REACH + INERTIA_REACH, i))
        second = load(p, term(at, SECOND, i, 0))
        rise = load(p, term(at, SECOND, i, 1))
        second_reach = load(p, row(REACH + SECOND_REACH, i))
        sign = load(p, row(SIGN, i))
        swing = drift_rate - z
        stretch = drift - load(p, row(START + OFFSET, i))
        force = less8(load(p, row(FRICTION, i)), load(p, row(SPRING, i)), stretch)
        force = less8(force, load(p, row(DASHPOT, i)), swing)
        slowness = load(p, row(SLOWNESS, i))
        pull = slowness * fma8(force, load(p, row(OVER_BRACE, i)), nothing - below)
        ring = fma8(jerk, slowness, sqrt8(fma8(swing, swing, pull * pull)))
        store(p, row(RING, i), ring)
        slips = above(abs8(sign), nothing)
        slowest = fma8(
            nothing - half, reach + below_reach, least(sign * drift_rate, sign * h * (inertia - below))
        )
        carried = above(slowest, ring)
        slowest = fma8(nothing - half, second_reach, least(sign * z, sign * h * second))
        slips_on = carried | above(slowest, nothing)
        room = load(p, row(LIMIT, i)) - (second_reach - abs8(rise))
        sticks_on = above(room, max8(abs8(second), abs8(second + rise)))
        special = above(load(p, row(SPECIAL, i)), nothing)
        clear = ((slips & slips_on) | (~slips & sticks_on)) & ~special
        alerts[i] = ALL & ~clear
        found |= alerts[i]
        below = inertia
        below_reach = reach
        jerk = load(p, row(REACH + JERK_REACH, i))
    return found


@inlined
def least(start, change):
    """Lower end of a line that begins here and changes so much."""
    return start - max8(splat(0.0) - change, splat(0.0))
