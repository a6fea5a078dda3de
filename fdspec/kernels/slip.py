"""The slip phase: floor and brace apart under a constant friction force, until sliding comes to zero.

Study, equations (5) to (7).
"""

from __future__ import annotations

import math

from fdspec.jit import inlined, inner
from fdspec.kernels.bounds import crest, relative_acceleration, swing, velocity_series
from fdspec.kernels.oscillator import expand
from fdspec.kernels.roots import clears, first_root, largest_magnitude
from fdspec.kernels.types import BRACE, FLOOR, SEARCH, Peaks


@inlined
def slip_fourths(plan, motion, force, h):
    """Bounds on h^4 times fourth derivatives over the piece: floor u and v, brace d and e."""
    a = relative_acceleration(plan.floor, motion.u, motion.v, force.p0)
    b = relative_acceleration(plan.brace, motion.d, motion.e, force.b0)
    theta = plan.floor.rate * h
    phi = plan.brace.rate * h
    cube = swing(plan.floor, motion.v, a, force.p1) * theta * theta * theta
    if plan.brace.slowness > 0.0:
        ring = swing(plan.brace, motion.e, b, force.b1) * phi * phi * phi
    else:
        ring = abs(motion.e) * phi * phi * phi
    return cube * h, cube * theta, ring * h, ring * phi


@inlined
def slip_is_quiet(plan, start, end, force, phase, h):
    """Whether the sliding velocity surely keeps its sign on the piece."""
    a0 = relative_acceleration(plan.floor, start.u, start.v, force.p0)
    a1 = relative_acceleration(plan.floor, end.u, end.v, force.p0 + force.p1 * h)
    b0 = relative_acceleration(plan.brace, start.d, start.e, force.b0)
    b1 = relative_acceleration(plan.brace, end.d, end.e, force.b0 + force.b1 * h)
    _, fourth_v, _, fourth_e = slip_fourths(plan, start, force, h)
    return clears(
        phase * (start.v - start.e),
        phase * h * (a0 - b0),
        phase * (end.v - end.e),
        phase * h * (a1 - b1),
        fourth_v + fourth_e,
    )


@inner
def search_slip(plan, work, n, h, phase, kick):
    """Fraction of the expanded piece at which the sliding velocity comes to zero.

    ``kick`` is the sliding acceleration with which a slip begins at the piece's start, known from
    the rule that began it and not from differences; negative where no slip begins.
    """
    floor = work[FLOOR]
    brace = work[BRACE]
    slide = work[SEARCH]
    for k in range(n):
        slide[k] = (k + 1) * (floor[k + 1] - brace[k + 1]) / h
    slide[n] = 0.0
    if kick >= 0.0:
        slide[0] = 0.0
        slide[1] = phase * kick * h
    return first_root(slide, 0, n, float(phase))


@inlined
def base_shear(storey, motion):
    """Force (N) of columns and brace on the ground."""
    return (
        storey.floor_stiffness * motion.u
        + storey.floor_damping * motion.v
        + storey.brace_stiffness * motion.d
        + storey.brace_damping * motion.e
    )


@inlined
def slip_peaks(plan, work, n, expanded, start, end, force, phase, h, peaks):
    """Peaks over a slip piece: its end, and extrema inside where bounds leave room for one."""
    storey = plan.storey
    f = plan.floor
    b = plan.brace
    base = -phase * storey.kinetic_slip_force / storey.floor_mass
    a0 = relative_acceleration(f, start.u, start.v, force.p0)
    a1 = relative_acceleration(f, end.u, end.v, force.p0 + force.p1 * h)
    b0 = relative_acceleration(b, start.d, start.e, force.b0)
    b1 = relative_acceleration(b, end.d, end.e, force.b0 + force.b1 * h)
    q0 = base - f.g * start.v - f.w2 * start.u
    q1 = base - f.g * end.v - f.w2 * end.u
    s0 = base_shear(storey, start)
    s1 = base_shear(storey, end)
    k, c, kd, cd = (
        storey.floor_stiffness,
        storey.floor_damping,
        storey.brace_stiffness,
        storey.brace_damping,
    )
    acceleration = max(peaks.acceleration, abs(q1))
    displacement = max(peaks.displacement, abs(end.u))
    velocity = max(peaks.velocity, abs(end.v))
    shear = max(peaks.shear, abs(s1))
    fourth_u, fourth_v, fourth_d, fourth_e = slip_fourths(plan, start, force, h)
    see_u = crest(start.u, h * start.v, end.u, h * end.v, fourth_u) > displacement
    see_v = crest(start.v, h * a0, end.v, h * a1, fourth_v) > velocity
    see_q = (
        crest(
            q0,
            -h * (f.g * a0 + f.w2 * start.v),
            q1,
            -h * (f.g * a1 + f.w2 * end.v),
            f.g * fourth_v + f.w2 * fourth_u,
        )
        > acceleration
    )
    see_s = (
        crest(
            s0,
            h * (k * start.v + c * a0 + kd * start.e + cd * b0),
            s1,
            h * (k * end.v + c * a1 + kd * end.e + cd * b1),
            k * fourth_u + c * fourth_v + kd * fourth_d + cd * fourth_e,
        )
        > shear
    )
    if see_u or see_v or see_q or see_s:
        floor = work[FLOOR]
        brace = work[BRACE]
        search = work[SEARCH]
        if not expanded:
            expand(floor, n, start.u, start.v, f.g, f.w2, force.p0, force.p1, h)
            expand(brace, n, start.d, start.e, b.g, b.w2, force.b0, force.b1, h)
        if see_u:
            displacement = largest_magnitude(floor, n, displacement)
        velocity_series(floor, n, h, search)
        if see_v:
            velocity = largest_magnitude(search, n, velocity)
        if see_q:
            for j in range(n + 1):
                search[j] = -f.g * search[j] - f.w2 * floor[j]
            search[0] += base
            acceleration = largest_magnitude(search, n, acceleration)
        if see_s:
            for j in range(n):
                search[j] = (
                    k * floor[j] + kd * brace[j] + (j + 1) * (c * floor[j + 1] + cd * brace[j + 1]) / h
                )
            search[n] = 0.0
            shear = largest_magnitude(search, n, shear)
    return Peaks(acceleration, displacement, velocity, shear)


@inlined
def stride_is_quiet(plan, start, end, force, phase, dt, ground, peaks):
    """Whether a whole record step of slip surely holds no stop and no new peak inside.

    The brace swings about its quasi-static motion with an amplitude that does not grow, and the
    slowest sliding is at least the floor's slowest less that swing.  ``ground`` bounds the ground's
    acceleration (m/s2) on the step.
    """
    storey = plan.storey
    f = plan.floor
    b = plan.brace
    a0 = relative_acceleration(f, start.u, start.v, force.p0)
    a1 = relative_acceleration(f, end.u, end.v, force.p0 + force.p1 * dt)
    fourth_u, fourth_v, _, _ = slip_fourths(plan, start, force, dt)
    drift = force.b1 * b.drift
    ring_rate = relative_acceleration(b, start.d, start.e, force.b0) * b.slowness
    ring = math.sqrt((start.e - drift) * (start.e - drift) + ring_rate * ring_rate)
    reach = phase * drift + ring
    if not clears(
        phase * start.v - reach,
        phase * dt * a0,
        phase * end.v - reach,
        phase * dt * a1,
        fourth_v,
    ):
        return False
    base = -phase * storey.kinetic_slip_force / storey.floor_mass
    top = crest(
        base - f.g * start.v - f.w2 * start.u,
        -dt * (f.g * a0 + f.w2 * start.v),
        base - f.g * end.v - f.w2 * end.u,
        -dt * (f.g * a1 + f.w2 * end.v),
        f.g * fourth_v + f.w2 * fourth_u,
    )
    # Base shear is the inertia of both masses; the brace's own acceleration is at most ring times omega.
    shear = storey.floor_mass * top + storey.brace_mass * (ring / b.slowness + ground)
    return (
        crest(start.u, dt * start.v, end.u, dt * end.v, fourth_u) <= peaks.displacement
        and crest(start.v, dt * a0, end.v, dt * a1, fourth_v) <= peaks.velocity
        and top <= peaks.acceleration
        and shear <= peaks.shear
    )
