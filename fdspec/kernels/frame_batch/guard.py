"""Which storeys may change their phase on the step, and the first instant of a history in which one may.

Bounds, for eight histories at once, clear most storeys; the rest is searched, history by history.
"""

from __future__ import annotations

from fdspec.jit import inner, wide
from fdspec.kernels.frame import SLIP_FORCE
from fdspec.kernels.frame_batch.eight import ALL, WIDTH, above, abs8, fma8, load, splat, sqrt8
from fdspec.kernels.frame_batch.layout import (
    DASHPOT,
    FRICTION,
    GROUND,
    INERTIA_REACH,
    JERK_REACH,
    LENGTH,
    LIMIT,
    OVER_BRACE,
    RISE,
    SECOND_REACH,
    SIGN,
    SLOWNESS,
    SPECIAL,
    SPRING,
    of,
    term,
)
from fdspec.kernels.oscillator import INVERSE
from fdspec.kernels.roots import NO_ROOT, first_root
from fdspec.kernels.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.types import STICK


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
        x = load(p, of(at.state, DISPLACEMENT, size, i))
        y = load(p, of(at.state, VELOCITY, size, i))
        drift = x - u
        drift_rate = y - v
        u = x
        v = y
        inertia = load(p, term(at.inertia, i, 0))
        reach = abs8(inertia) + load(p, of(at.reach, INERTIA_REACH, size, i))
        friction = load(p, of(at.model, FRICTION, size, i))
        sign = load(p, of(at.model, SIGN, size, i))
        swing = drift_rate - load(p, of(at.state, SLIDING, size, i))
        stretch = drift - load(p, of(at.state, OFFSET, size, i))
        force = friction - load(p, of(at.model, SPRING, size, i)) * stretch
        force = force - load(p, of(at.model, DASHPOT, size, i)) * swing
        slowness = load(p, of(at.model, SLOWNESS, size, i))
        kick = slowness * fma8(force, load(p, of(at.model, OVER_BRACE, size, i)), nothing - below_start)
        ring = sqrt8(fma8(swing, swing, kick * kick)) + jerk * slowness
        slips = above(abs8(sign), nothing)
        slips_on = above(sign * drift_rate - h * (reach + below), ring)
        room = load(p, of(at.model, LIMIT, size, i)) - load(p, of(at.reach, SECOND_REACH, size, i))
        sticks_on = above(room, abs8(load(p, term(at.second, i, 0))))
        special = above(load(p, of(at.model, SPECIAL, size, i)), nothing)
        clear = ((slips & slips_on) | (~slips & sticks_on)) & ~special
        alerts[i] = ALL & ~clear
        found |= alerts[i]
        below = reach
        below_start = inertia
        jerk = load(p, of(at.reach, JERK_REACH, size, i))
    return found


@inner
def search(p, at, size, lane, alerts, frame, phase, fresh, touching, n, c, instants, signs):
    """Fill instants[i], the fraction of the step at which storey i of a lane changes, and signs[i].

    Return the smallest instant (NO_ROOT where there is none).  A storey that has just begun to slip has
    fresh[i] leading terms of its sliding velocity that vanish; one that has just stuck at its limit, in
    direction touching[i], as many of its distance to the limit.
    """
    first = NO_ROOT
    h = p[LENGTH * WIDTH + lane]
    for i in range(size):
        instants[i] = NO_ROOT
        if alerts[i] >> lane & 1 == 0:
            continue
        q = term(at.second, i, 0) + lane
        if phase[i] == STICK:
            room = frame[SLIP_FORCE, i] - p[of(at.reach, SECOND_REACH, size, i) + lane]
            for sign in (1, -1):
                if sign * p[q] < room and touching[i] != sign:
                    continue
                for k in range(n):
                    c[k] = -sign * p[q + k * WIDTH]
                c[0] += frame[SLIP_FORCE, i]
                if touching[i] == sign:
                    for k in range(fresh[i]):
                        c[k] = 0.0
                x = first_root(c, 0, n - 1, 1.0)
                if x < instants[i]:
                    instants[i] = x
                    signs[i] = sign
        else:
            signs[i] = phase[i]
            if fresh[i] > 1:
                p[q] = 0.0
            c[0] = p[of(at.state, SLIDING, size, i) + lane]
            for k in range(n):
                c[k + 1] = p[q + k * WIDTH] * (h * INVERSE[k + 1])
            instants[i] = first_root(c, 0, n, float(phase[i]))
        first = min(first, instants[i])
    return first
