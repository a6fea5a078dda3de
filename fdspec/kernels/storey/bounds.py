"""Forces on a segment of motion, bounds on what it does between its ends, and the floor's peaks."""

from __future__ import annotations

from fdspec.compiler.options import fma, inlined, inner
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.extremum import floor_weights, top_inside
from fdspec.kernels.mathematics.oscillator import acceleration, expand
from fdspec.kernels.mathematics.polynomial_roots import TAIL, THIRD, largest_magnitude
from fdspec.kernels.types import STICK, Force, Peaks


@inlined
def ground_at(start, rate, t):
    """Ground acceleration a time t after it was ``start``."""
    return fma(rate, t, start)


@inlined
def forcing(plan, phase, offset, acceleration, rate):
    """Force over mass on a segment that begins at this ground acceleration (m/s2) and rate (m/s3)."""
    if phase == STICK:
        return Force(plan.lift * offset - acceleration, -rate, 0.0, 0.0)
    storey = plan.storey
    push = sliding_force(phase, storey.kinetic_slip_force)
    floor = -acceleration - push / storey.floor_mass
    if storey.brace_mass > 0.0:
        return Force(floor, -rate, push / storey.brace_mass - acceleration, -rate)
    return Force(floor, -rate, 0.0, 0.0)


@inlined
def relative_acceleration(branch, x, v, force):
    """x'' of an oscillator under this force over mass."""
    return acceleration(x, v, branch.g, branch.w2, force)


@inlined
def swing(branch, v, a, force_rate):
    """Amplitude (m/s) that bounds free motion: |d^k v/dt^k| <= rate^k swing for k >= 1."""
    return fma(abs(a), branch.slowness, fma(abs(force_rate), branch.drift, abs(v)))


@inlined
def magnitude_bound(start, start_rise, end, end_rise, fourth):
    """Bound on a magnitude over a step, from values and rises (slope times step) at both ends."""
    inside = max(abs(fma(start_rise, THIRD, start)), abs(fma(-end_rise, THIRD, end)))
    return max(max(abs(start), abs(end)), fma(fourth, TAIL, inside))


@inner
def velocity_series(c, n, h, out):
    """Series of velocity from the series c of displacement."""
    pace = 1.0 / h
    for k in range(n):
        out[k] = (k + 1) * c[k + 1] * pace
    out[n] = 0.0


@inner
def shorten(c, n, share):
    """Rescale the series of a segment to its first part."""
    power = 1.0
    for k in range(1, n + 1):
        power *= share
        c[k] *= power


@inner
def ready(c, n, share, x, v, g, w2, p0, p1, h):
    """Make c the series of a segment of length h: from nothing (share 0), or from that of a longer one."""
    if share == 0.0:
        expand(c, n, x, v, g, w2, p0, p1, h)
    elif share < 1.0:
        shorten(c, n, share)


@inlined
def floor_fourths(branch, v, a, force_rate, h):
    """Bounds on h^4 times the fourth derivative of displacement and of velocity over a segment."""
    theta = branch.rate * h
    cube = swing(branch, v, a, force_rate) * theta * theta * theta
    return cube * h, cube * theta


@inner
def largest_velocity(floor, search, n, h, best):
    """The greater of ``best`` and the floor's largest velocity on the expanded segment."""
    velocity_series(floor, n, h, search)
    return largest_magnitude(search, n, best)


@inner
def largest_acceleration(floor, search, n, h, g, w2, base, best):
    """The greater of ``best`` and the floor's largest absolute acceleration on the expanded segment."""
    velocity_series(floor, n, h, search)
    for k in range(n + 1):
        search[k] = fma(-g, search[k], -w2 * floor[k])
    search[0] += base
    return largest_magnitude(search, n, best)


@inlined
def floor_bounds(b, base, mass, start, end, force, h, peaks):
    """Peaks with the end of a segment, the acceleration that matters inside, and what may be passed there.

    Absolute acceleration is base - g v - w2 u; base shear is ``mass`` times it (0: not by this rule).  What
    may be passed: displacement, velocity, acceleration.
    """
    a0 = relative_acceleration(b, start.u, start.v, force.p0)
    a1 = relative_acceleration(b, end.u, end.v, fma(force.p1, h, force.p0))
    q0 = relative_acceleration(b, start.u, start.v, base)
    q1 = relative_acceleration(b, end.u, end.v, base)
    acceleration = max(peaks.acceleration, abs(q1))
    displacement = max(peaks.displacement, abs(end.u))
    velocity = max(peaks.velocity, abs(end.v))
    shear = max(peaks.shear, mass * abs(q1))
    least = min(acceleration, shear / mass) if mass > 0.0 else acceleration
    fourth_u, fourth_v = floor_fourths(b, start.v, a0, force.p1, h)
    see_u = magnitude_bound(start.u, h * start.v, end.u, h * end.v, fourth_u) > displacement
    see_v = magnitude_bound(start.v, h * a0, end.v, h * a1, fourth_v) > velocity
    see_q = (
        magnitude_bound(
            q0,
            -h * fma(b.g, a0, b.w2 * start.v),
            q1,
            -h * fma(b.g, a1, b.w2 * end.v),
            fma(b.g, fourth_v, b.w2 * fourth_u),
        )
        > least
    )
    return Peaks(acceleration, displacement, velocity, shear), least, see_u, see_v, see_q


@inlined
def floor_peaks(b, base, mass, floor, search, n, share, start, end, force, h, peaks):
    """Peaks over a segment in which the oscillator ``b`` carries the floor: its end, and extrema inside.

    base, mass: as in `floor_bounds`.  ``share`` tells what ``floor`` holds: 0 nothing, else the series of a
    segment of which this one is that part.  An extremum is looked for only where bounds leave room for one.
    """
    ends, least, see_u, see_v, see_q = floor_bounds(b, base, mass, start, end, force, h, peaks)
    acceleration, displacement, velocity, shear = ends
    if share == 0.0 and (see_u or see_v or see_q):
        a0 = relative_acceleration(b, start.u, start.v, force.p0)
        fourth_u, fourth_v = floor_fourths(b, start.v, a0, force.p1, h)
        if see_u:
            w = floor_weights(1.0, 0.0, 0.0)
            displacement, sure = top_inside(b, b, n, False, w, start, end, force, h, fourth_u, displacement)
            see_u = not sure
        if see_v:
            w = floor_weights(0.0, 1.0, 0.0)
            velocity, sure = top_inside(b, b, n, False, w, start, end, force, h, fourth_v, velocity)
            see_v = not sure
        if see_q:
            w = floor_weights(-b.w2, -b.g, base)
            fourth = fma(b.g, fourth_v, b.w2 * fourth_u)
            top, sure = top_inside(b, b, n, False, w, start, end, force, h, fourth, least)
            acceleration = max(acceleration, top)
            shear = max(shear, mass * top)
            see_q = not sure
    if see_u or see_v or see_q:
        ready(floor, n, share, start.u, start.v, b.g, b.w2, force.p0, force.p1, h)
        if see_u:
            displacement = largest_magnitude(floor, n, displacement)
        if see_v:
            velocity = largest_velocity(floor, search, n, h, velocity)
        if see_q:
            top = largest_acceleration(floor, search, n, h, b.g, b.w2, base, least)
            acceleration = max(acceleration, top)
            shear = max(shear, mass * top)
    return Peaks(acceleration, displacement, velocity, shear)
