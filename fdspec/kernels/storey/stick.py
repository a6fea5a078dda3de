"""The stick phase: floor and brace as one oscillator, until the reaction reaches the slip force.

Study, equations (2) to (4).
"""

from __future__ import annotations

from fdspec.compiler.options import fma, inlined, inner
from fdspec.kernels.mathematics.oscillator import ahead
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, clears, first_root
from fdspec.kernels.mathematics.zero_crossing import (
    ATTEMPTS,
    CLEAR,
    CROSSES,
    NEAR,
    SETTLED,
    UNCLEAR,
    Course,
    falls,
    guess,
    is_clear,
    judged,
    nearby,
    rates_of,
    step_to_zero,
)
from fdspec.kernels.storey.bounds import floor_fourths, floor_peaks, relative_acceleration
from fdspec.kernels.types import STICK, Motion


@inlined
def held_force(plan, u, v, offset):
    """Reaction (N) of the sticking damper."""
    return fma(plan.hold_u, u, fma(plan.hold_v, v, -plan.hold_offset * offset))


@inlined
def stick_course(plan, start, end, force, offset, h):
    """What the reaction lacks to the slip force on the side to which it tends over the segment.

    Returned with this `Course`: the side, and whether the slip force surely is not reached on the other one.
    """
    b = plan.stick
    limit = plan.storey.slip_force
    r0 = held_force(plan, start.u, start.v, offset)
    r1 = held_force(plan, end.u, end.v, offset)
    a0 = relative_acceleration(b, start.u, start.v, force.p0)
    a1 = relative_acceleration(b, end.u, end.v, fma(force.p1, h, force.p0))
    rise0 = h * fma(plan.hold_u, start.v, plan.hold_v * a0)
    rise1 = h * fma(plan.hold_u, end.v, plan.hold_v * a1)
    fourth_u, fourth_v = floor_fourths(b, start.v, a0, force.p1, h)
    fourth = abs(plan.hold_u) * fourth_u + abs(plan.hold_v) * fourth_v
    side = 1.0 if r1 > 0.0 else -1.0
    j0 = relative_acceleration(b, start.v, a0, force.p1)
    j1 = relative_acceleration(b, end.v, a1, force.p1)
    course = Course(
        limit - side * r0,
        -side * rise0,
        -side * h * h * fma(plan.hold_u, a0, plan.hold_v * j0),
        limit - side * r1,
        -side * rise1,
        -side * h * h * fma(plan.hold_u, a1, plan.hold_v * j1),
        fourth,
        fourth * b.rate * h,
    )
    return course, side, clears(limit + side * r0, side * rise0, limit + side * r1, side * rise1, fourth)


@inlined
def stick_verdict(plan, start, end, force, offset, h):
    """Whether the reaction stays within the slip force on the segment, reaches it, or neither is sure.

    Returned with the verdict: the side on which it is reached, after how long, nearly (s), and until when
    it is reached just once.
    """
    course, side, one_sided = stick_course(plan, start, end, force, offset, h)
    if not one_sided:
        return UNCLEAR, int(side), 0.0, h
    if is_clear(course):
        return CLEAR, int(side), 0.0, h
    found, fall = judged(course)
    return found, int(side), h * guess(fall) if found == CROSSES else 0.0, h * fall.share


@inlined
def stick_ahead(plan, start, force, offset, t):
    """Motion at the time t of a segment, and the integral of displacement until then."""
    b = plan.stick
    u, v, swept = ahead(start.u, start.v, b.g, b.w2, force.p0, force.p1, t, int(plan.stick_order))
    return Motion(u, v, u - offset, v), swept


@inlined
def gap_rates(plan, r, offset, side):
    """What the reaction lacks to the slip force at an instant, and its derivatives, from the floor's."""
    return (
        plan.storey.slip_force - side * held_force(plan, r.x, r.v, offset),
        -side * fma(plan.hold_u, r.v, plan.hold_v * r.a),
        -side * fma(plan.hold_u, r.a, plan.hold_v * r.j),
        -side * fma(plan.hold_u, r.j, plan.hold_v * r.s),
        -side * fma(plan.hold_u, r.s, plan.hold_v * r.c),
    )


@inner
def locate_slip(plan, start, force, offset, side, t, h):
    """Time at which the reaction reaches the slip force on this side, with what `stick_ahead` gives there.

    It does so once until h, near t.  A negative time says that it was not found.
    """
    b = plan.stick
    low = 0.0
    high = h
    for _ in range(ATTEMPTS):
        motion, swept = stick_ahead(plan, start, force, offset, t)
        r = rates_of(motion.u, motion.v, b.g, b.w2, fma(force.p1, t, force.p0), force.p1)
        gap, y1, y2, y3, y4 = gap_rates(plan, r, offset, side)
        later, last = step_to_zero(gap, y1, y2, y3, y4)
        if gap > 0.0:
            low = t
        else:
            high = t
        if not (low <= t + later <= high and falls(later, y1, y2, y3)):
            t = 0.5 * (low + high)
            continue
        if b.rate * abs(later) <= NEAR and b.rate * last <= SETTLED:
            u, v, more = nearby(r, later)
            return t + later, Motion(u, v, u - offset, v), swept + more
        t += later
    return -1.0, start, 0.0


@inner
def search_stick(plan, floor, gap, n, h, offset, touching):
    """Fraction of the expanded segment at which the reaction reaches the slip force, and its sign.

    ``touching`` is the sign of a reaction that stands at the kinetic slip force when the segment begins (a
    massless brace that has just stopped), else 0.  Next to a displacement that is large the static slip force
    may lie closer than rounding, so it is not worked out anew.
    """
    limit = plan.storey.slip_force
    lacks = limit - plan.storey.kinetic_slip_force
    best = NO_ROOT
    sign = STICK
    pace = 1.0 / h
    for side in (1, -1):
        for k in range(n):
            gap[k] = -side * (plan.hold_u * floor[k] + plan.hold_v * (k + 1) * floor[k + 1] * pace)
        gap[n] = 0.0
        rest = gap[0] + limit + side * plan.hold_offset * offset
        # Less than nothing can only be rounding: where the reaction goes is what counts.
        gap[0] = lacks if side == touching else max(rest, 0.0)
        x = first_root(gap, 0, n, 1.0)
        if x < best:
            best = x
            sign = side
    return best, sign


@inlined
def stick_peaks(plan, floor, search, n, share, start, end, force, offset, h, peaks):
    """Peaks over a stick segment; base shear is the inertia of floor and brace as one."""
    return floor_peaks(
        plan.stick, plan.lift * offset, plan.mass, floor, search, n, share, start, end, force, h, peaks
    )
