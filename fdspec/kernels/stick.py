"""The stick phase: floor and brace as one oscillator, until the reaction reaches the slip force.

Study, equations (2) to (4).
"""

from __future__ import annotations

from fdspec.jit import inlined, inner
from fdspec.kernels.bounds import crest, relative_acceleration, swing, velocity_series
from fdspec.kernels.oscillator import expand
from fdspec.kernels.roots import NO_ROOT, clears, first_root, largest_magnitude
from fdspec.kernels.types import FLOOR, SEARCH, STICK, Peaks


@inlined
def held_force(plan, u, v, offset):
    """Reaction (N) of the sticking damper."""
    return plan.hold_u * u + plan.hold_v * v - plan.hold_offset * offset


@inlined
def stick_fourths(plan, motion, force, h):
    """Bounds on h^4 times the fourth derivative of displacement and of velocity over the piece."""
    a = relative_acceleration(plan.stick, motion.u, motion.v, force.p0)
    theta = plan.stick.rate * h
    cube = swing(plan.stick, motion.v, a, force.p1) * theta * theta * theta
    return cube * h, cube * theta


@inlined
def stick_is_quiet(plan, start, end, force, offset, h):
    """Whether the reaction surely stays within the slip force on the piece."""
    limit = plan.storey.slip_force
    r0 = held_force(plan, start.u, start.v, offset)
    r1 = held_force(plan, end.u, end.v, offset)
    a0 = relative_acceleration(plan.stick, start.u, start.v, force.p0)
    a1 = relative_acceleration(plan.stick, end.u, end.v, force.p0 + force.p1 * h)
    rise0 = h * (plan.hold_u * start.v + plan.hold_v * a0)
    rise1 = h * (plan.hold_u * end.v + plan.hold_v * a1)
    fourth_u, fourth_v = stick_fourths(plan, start, force, h)
    fourth = abs(plan.hold_u) * fourth_u + abs(plan.hold_v) * fourth_v
    return clears(limit - r0, -rise0, limit - r1, -rise1, fourth) and clears(
        limit + r0, rise0, limit + r1, rise1, fourth
    )


@inner
def search_stick(plan, work, n, h, offset, touching):
    """Fraction of the expanded piece at which the reaction reaches the slip force, and its sign.

    ``touching`` is the sign of a reaction that stands at the slip force when the piece begins (a
    massless brace that has just stopped), else 0.
    """
    floor = work[FLOOR]
    gap = work[SEARCH]
    limit = plan.storey.slip_force
    best = NO_ROOT
    sign = STICK
    for side in (1, -1):
        for k in range(n):
            gap[k] = -side * (plan.hold_u * floor[k] + plan.hold_v * (k + 1) * floor[k + 1] / h)
        gap[n] = 0.0
        gap[0] = 0.0 if side == touching else gap[0] + limit + side * plan.hold_offset * offset
        x = first_root(gap, 0, n, 1.0)
        if x < best:
            best = x
            sign = side
    return best, sign


@inlined
def stick_peaks(plan, work, n, expanded, start, end, force, offset, h, peaks):
    """Peaks over a stick piece: its end, and extrema inside where bounds leave room for one."""
    b = plan.stick
    base = plan.lift * offset
    a0 = relative_acceleration(b, start.u, start.v, force.p0)
    a1 = relative_acceleration(b, end.u, end.v, force.p0 + force.p1 * h)
    q0 = base - b.g * start.v - b.w2 * start.u
    q1 = base - b.g * end.v - b.w2 * end.u
    acceleration = max(peaks.acceleration, abs(q1))
    displacement = max(peaks.displacement, abs(end.u))
    velocity = max(peaks.velocity, abs(end.v))
    shear = max(peaks.shear, plan.mass * abs(q1))
    fourth_u, fourth_v = stick_fourths(plan, start, force, h)
    see_u = crest(start.u, h * start.v, end.u, h * end.v, fourth_u) > displacement
    see_v = crest(start.v, h * a0, end.v, h * a1, fourth_v) > velocity
    see_q = crest(
        q0,
        -h * (b.g * a0 + b.w2 * start.v),
        q1,
        -h * (b.g * a1 + b.w2 * end.v),
        b.g * fourth_v + b.w2 * fourth_u,
    ) > min(acceleration, shear / plan.mass)
    if see_u or see_v or see_q:
        floor = work[FLOOR]
        search = work[SEARCH]
        if not expanded:
            expand(floor, n, start.u, start.v, b.g, b.w2, force.p0, force.p1, h)
        if see_u:
            displacement = largest_magnitude(floor, n, displacement)
        velocity_series(floor, n, h, search)
        if see_v:
            velocity = largest_magnitude(search, n, velocity)
        if see_q:
            for k in range(n + 1):
                search[k] = -b.g * search[k] - b.w2 * floor[k]
            search[0] += base
            top = largest_magnitude(search, n, min(acceleration, shear / plan.mass))
            acceleration = max(acceleration, top)
            shear = max(shear, plan.mass * top)
    return Peaks(acceleration, displacement, velocity, shear)
