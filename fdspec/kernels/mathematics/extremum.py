"""The extremum of a quantity inside a segment, where the quantity turns there just once.

A quantity is a weighted sum of the floor's displacement and velocity and of the brace's displacement; its
velocity bears no force, for a brace with damping is left to the search.  Where the quantity's curvature keeps
one sign it has at most one extremum.  That of the cubic through both ends is close, and the motion's own
derivatives there lead to it, as they lead to a crossing (`zero_crossing.py`).  Other segments are
searched (`polynomial_roots.py`).
"""

from __future__ import annotations

from typing import NamedTuple

from fdspec.compiler.options import fma, inlined, inner, seldom
from fdspec.kernels.mathematics.oscillator import acceleration, ahead, undamped_ahead
from fdspec.kernels.mathematics.zero_crossing import (
    BEND_OFF,
    HALF,
    NEAR,
    R_24,
    R_120,
    SETTLED,
    SIXTH,
    Rates,
    lowest,
    rates_of,
    step_to_zero,
)


class Weights(NamedTuple):
    """What a quantity is of the floor's displacement and velocity, the brace's displacement, and at rest."""

    u: float
    v: float
    d: float
    base: float


@inlined
def floor_weights(u, v, base):
    """Those of a quantity in which the brace has no part."""
    return Weights(u, v, 0.0, base)


@inlined
def still():
    """Rates of a brace that has no part in a quantity."""
    return Rates(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def weighed(w, r, q):
    """A quantity's value and its first four derivatives, from those of floor and brace."""
    return (
        fma(w.u, r.x, fma(w.v, r.v, fma(w.d, q.x, w.base))),
        fma(w.u, r.v, fma(w.v, r.a, w.d * q.v)),
        fma(w.u, r.a, fma(w.v, r.j, w.d * q.a)),
        fma(w.u, r.j, fma(w.v, r.s, w.d * q.j)),
        fma(w.u, r.s, fma(w.v, r.c, w.d * q.s)),
    )


@inner
def top_inside(floor, brace, n, rings, w, start, end, force, h, fourth, best):
    """The greater of ``best`` and the quantity's largest magnitude on a segment; and whether that is sure.

    floor, brace: the oscillators that move; n: order of the floor's series; rings: whether the brace has part
    in the quantity: it then has mass and no damping.  fourth: a bound on h^4 times the quantity's fourth
    derivative.
    """
    seldom()
    stop = fma(force.p1, h, force.p0)
    r0 = rates_of(start.u, start.v, floor.g, floor.w2, force.p0, force.p1)
    r1 = rates_of(end.u, end.v, floor.g, floor.w2, stop, force.p1)
    q0 = q1 = still()
    if rings:
        q0 = rates_of(start.d, start.e, 0.0, brace.w2, force.b0, force.b1)
        q1 = rates_of(end.d, end.e, 0.0, brace.w2, fma(force.b1, h, force.b0), force.b1)
    first, rise0, bend0, _, _ = weighed(w, r0, q0)
    last, rise1, bend1, _, _ = weighed(w, r1, q1)
    best = max(best, max(abs(first), abs(last)))
    margin = BEND_OFF * fourth
    bend0 *= h * h
    bend1 *= h * h
    if max(bend0, bend1) + margin < 0.0:
        side = 1.0
    elif min(bend0, bend1) - margin > 0.0:
        side = -1.0
    else:
        return best, False
    if not side * rise0 > 0.0 > side * rise1:
        return best, True
    t = h * lowest(-side * first, -side * h * rise0, -side * last, -side * h * rise1)
    x, v, _ = ahead(start.u, start.v, floor.g, floor.w2, force.p0, force.p1, t, n)
    p = fma(force.p1, t, force.p0)
    r = rates_of(x, v, floor.g, floor.w2, p, force.p1)
    q = still()
    rate = floor.rate
    if rings:
        x, v, _ = undamped_ahead(start.d, start.e, brace.rate, brace.slowness, force.b0, force.b1, t)
        q = rates_of(x, v, 0.0, brace.w2, fma(force.b1, t, force.b0), force.b1)
        rate = max(rate, brace.rate)
    y, y1, y2, y3, y4 = weighed(w, r, q)
    y5 = fma(w.u, r.c, fma(w.d, q.c, w.v * acceleration(r.s, r.c, floor.g, floor.w2, 0.0)))
    later, moved = step_to_zero(y1, y2, y3, y4, y5)
    if not (rate * abs(later) <= NEAR and rate * moved <= SETTLED):
        return best, False
    rise = fma(later, fma(later, fma(later, fma(later, R_120 * y5, R_24 * y4), SIXTH * y3), HALF * y2), y1)
    return max(best, side * fma(later, rise, y)), True
