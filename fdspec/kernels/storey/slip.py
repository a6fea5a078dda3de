"""The slip phase: floor and brace apart under a constant friction force, until sliding comes to zero.

Study, equations (5) to (7).
"""

from __future__ import annotations

from fdspec.compiler.options import fma, inlined, inner
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.extremum import Weights, top_inside
from fdspec.kernels.mathematics.oscillator import ahead, dot4, undamped_ahead
from fdspec.kernels.mathematics.polynomial_roots import first_root, largest_magnitude
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
    leaves_zero,
    nearby,
    rates_of,
    step_to_zero,
)
from fdspec.kernels.storey.bounds import (
    floor_fourths,
    floor_peaks,
    magnitude_bound,
    ready,
    relative_acceleration,
    swing,
)
from fdspec.kernels.storey.constants import has_closed_form
from fdspec.kernels.types import Motion, Peaks

NOISE = 1e-9
"""What the curvature at the start of a slip may be off by, relative to what it is made of: ample."""


@inlined
def brace_fourths(plan, motion, b, force, h):
    """Bounds on h^4 times the fourth derivative of the brace's displacement and velocity over a segment."""
    phi = plan.brace.rate * h
    if plan.brace.slowness > 0.0:
        ring = swing(plan.brace, motion.e, b, force.b1) * phi * phi * phi
    else:
        ring = abs(motion.e) * phi * phi * phi
    return ring * h, ring * phi


@inlined
def slip_course(plan, start, end, force, phase, onset, h):
    """The sliding velocity over the segment, and whether a slip that begins with it surely leaves zero.

    ``onset`` as in `search_slip`.
    """
    f = plan.floor
    b = plan.brace
    a0 = relative_acceleration(f, start.u, start.v, force.p0)
    a1 = relative_acceleration(f, end.u, end.v, fma(force.p1, h, force.p0))
    b0 = relative_acceleration(b, start.d, start.e, force.b0)
    b1 = relative_acceleration(b, end.d, end.e, fma(force.b1, h, force.b0))
    j0 = relative_acceleration(f, start.v, a0, force.p1)
    k0 = relative_acceleration(b, start.e, b0, force.b1)
    j1 = relative_acceleration(f, end.v, a1, force.p1)
    k1 = relative_acceleration(b, end.e, b1, force.b1)
    _, fourth_v = floor_fourths(f, start.v, a0, force.p1, h)
    _, fourth_e = brace_fourths(plan, start, b0, force, h)
    fourth = fourth_v + fourth_e
    twist = fma(b.g, k0, fma(b.w2, b0, fma(-f.g, j0, -f.w2 * a0)))
    noise = NOISE * h * h * (abs(j0) + abs(k0))
    leaves = leaves_zero(h * onset, phase * h * h * (j0 - k0), phase * h * h * h * twist, fourth, noise)
    course = Course(
        phase * (start.v - start.e),
        phase * h * (a0 - b0),
        phase * h * h * (j0 - k0),
        phase * (end.v - end.e),
        phase * h * (a1 - b1),
        phase * h * h * (j1 - k1),
        fourth,
        fourth * max(f.rate, b.rate) * h,
    )
    return course, leaves


@inlined
def slip_verdict(plan, start, end, force, phase, onset, h):
    """Whether sliding goes on over the segment, comes to zero, or neither is sure.

    Returned with the verdict: after how long it comes to zero, nearly (s), and until when it does so just
    once.  ``onset`` as in `search_slip`.
    """
    course, leaves = slip_course(plan, start, end, force, phase, onset, h)
    if onset >= 0.0:
        return CLEAR if leaves else UNCLEAR, 0.0, h
    if is_clear(course):
        return CLEAR, 0.0, h
    found, fall = judged(course)
    return found, h * guess(fall) if found == CROSSES else 0.0, h * fall.share


@inlined
def slip_ahead(plan, start, force, t):
    """Motion at the time t of a segment, and the integrals of both displacements until then.

    For a brace with mass and without damping.
    """
    f = plan.floor
    u, v, swept = ahead(start.u, start.v, f.g, f.w2, force.p0, force.p1, t, int(plan.floor_order))
    b = plan.brace
    d, e, swung = undamped_ahead(start.d, start.e, b.rate, b.slowness, force.b0, force.b1, t)
    return Motion(u, v, d, e), swept, swung


@inlined
def slide_rates(r, q, phase):
    """The sliding velocity at an instant, and its derivatives, from those of floor and brace."""
    return (
        phase * (r.v - q.v),
        phase * (r.a - q.a),
        phase * (r.j - q.j),
        phase * (r.s - q.s),
        phase * (r.c - q.c),
    )


@inner
def locate_stop(plan, start, force, phase, t, h):
    """Time at which sliding comes to zero, with what `slip_ahead` gives there.

    It does so once until h, near t.  A negative time says that it was not found.
    """
    f = plan.floor
    b = plan.brace
    rate = max(f.rate, b.rate)
    low = 0.0
    high = h
    for _ in range(ATTEMPTS):
        motion, swept, swung = slip_ahead(plan, start, force, t)
        r = rates_of(motion.u, motion.v, f.g, f.w2, fma(force.p1, t, force.p0), force.p1)
        q = rates_of(motion.d, motion.e, 0.0, b.w2, fma(force.b1, t, force.b0), force.b1)
        slide, y1, y2, y3, y4 = slide_rates(r, q, phase)
        later, last = step_to_zero(slide, y1, y2, y3, y4)
        if slide > 0.0:
            low = t
        else:
            high = t
        if not (low <= t + later <= high and falls(later, y1, y2, y3)):
            t = 0.5 * (low + high)
            continue
        if rate * abs(later) <= NEAR and rate * last <= SETTLED:
            u, v, more = nearby(r, later)
            d, e, swing_more = nearby(q, later)
            return t + later, Motion(u, v, d, e), swept + more, swung + swing_more
        t += later
    return -1.0, start, 0.0, 0.0


@inner
def search_slip(floor, brace, slide, n, h, phase, onset):
    """Fraction of the expanded segment at which the sliding velocity comes to zero.

    ``onset`` is the sliding acceleration with which a slip begins at the segment's start, known from
    the rule that began it and not from differences; negative where no slip begins.
    """
    pace = 1.0 / h
    for k in range(n):
        slide[k] = (k + 1) * (floor[k + 1] - brace[k + 1]) * pace
    slide[n] = 0.0
    if onset >= 0.0:
        slide[0] = 0.0
        slide[1] = phase * onset * h
    elif phase * slide[0] < 0.0:  # by rounding: where sliding goes is what counts
        slide[0] = 0.0
    return first_root(slide, 0, n, float(phase))


@inlined
def base_shear(storey, motion):
    """Force (N) of columns and brace on the ground."""
    return dot4(
        storey.floor_stiffness,
        motion.u,
        storey.floor_damping,
        motion.v,
        storey.brace_stiffness,
        motion.d,
        storey.brace_damping,
        motion.e,
    )


@inlined
def shear_bounds(plan, start, end, force, h, peak):
    """Largest base shear at the end of a slip segment, whether it may be passed inside, and what bounds it.

    The last is a bound on h^4 times its fourth derivative.
    """
    storey = plan.storey
    f = plan.floor
    b = plan.brace
    k, c, kd, cd = storey.floor_stiffness, storey.floor_damping, storey.brace_stiffness, storey.brace_damping
    a0 = relative_acceleration(f, start.u, start.v, force.p0)
    a1 = relative_acceleration(f, end.u, end.v, fma(force.p1, h, force.p0))
    b0 = relative_acceleration(b, start.d, start.e, force.b0)
    b1 = relative_acceleration(b, end.d, end.e, fma(force.b1, h, force.b0))
    fourth_u, fourth_v = floor_fourths(f, start.v, a0, force.p1, h)
    fourth_d, fourth_e = brace_fourths(plan, start, b0, force, h)
    fourth = dot4(k, fourth_u, c, fourth_v, kd, fourth_d, cd, fourth_e)
    s0 = base_shear(storey, start)
    s1 = base_shear(storey, end)
    inside = magnitude_bound(
        s0,
        h * dot4(k, start.v, c, a0, kd, start.e, cd, b0),
        s1,
        h * dot4(k, end.v, c, a1, kd, end.e, cd, b1),
        fourth,
    )
    shear = max(peak, abs(s1))
    return shear, inside > shear, fourth


@inlined
def slip_peaks(plan, floor, brace, search, n, share, start, end, force, phase, h, peaks):
    """Peaks over a slip segment: the floor's, and that of the base shear, in which the brace rings."""
    storey = plan.storey
    f = plan.floor
    b = plan.brace
    k, c, kd, cd = storey.floor_stiffness, storey.floor_damping, storey.brace_stiffness, storey.brace_damping
    shear, see_s, fourth = shear_bounds(plan, start, end, force, h, peaks.shear)
    if see_s and share == 0.0 and has_closed_form(plan):
        order = int(plan.floor_order)
        w = Weights(k, c, kd, 0.0)
        shear, sure = top_inside(f, b, order, True, w, start, end, force, h, fourth, shear)
        see_s = not sure
    if see_s:
        ready(floor, n, share, start.u, start.v, f.g, f.w2, force.p0, force.p1, h)
        ready(brace, n, share, start.d, start.e, b.g, b.w2, force.b0, force.b1, h)
        share = 1.0
        pace = 1.0 / h
        for j in range(n):
            search[j] = k * floor[j] + kd * brace[j] + (j + 1) * (c * floor[j + 1] + cd * brace[j + 1]) * pace
        search[n] = 0.0
        shear = largest_magnitude(search, n, shear)
    base = sliding_force(-phase, storey.kinetic_slip_force) / storey.floor_mass
    moved = floor_peaks(f, base, 0.0, floor, search, n, share, start, end, force, h, peaks)
    return Peaks(moved.acceleration, moved.displacement, moved.velocity, shear)
