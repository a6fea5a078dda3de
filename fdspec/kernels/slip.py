"""The slip phase: floor and brace apart under a constant friction force, until sliding comes to zero.

Study, equations (5) to (7).
"""

from __future__ import annotations

from fdspec.jit import inlined, inner
from fdspec.kernels.bounds import crest, floor_fourths, floor_peaks, ready, relative_acceleration, swing
from fdspec.kernels.roots import clears, first_root, largest_magnitude
from fdspec.kernels.types import Peaks


@inlined
def brace_fourths(plan, motion, b, force, h):
    """Bounds on h^4 times the fourth derivative of the brace's displacement and velocity over a piece."""
    phi = plan.brace.rate * h
    if plan.brace.slowness > 0.0:
        ring = swing(plan.brace, motion.e, b, force.b1) * phi * phi * phi
    else:
        ring = abs(motion.e) * phi * phi * phi
    return ring * h, ring * phi


@inlined
def slip_is_quiet(plan, start, end, force, phase, h):
    """Whether the sliding velocity surely keeps its sign on the piece."""
    a0 = relative_acceleration(plan.floor, start.u, start.v, force.p0)
    a1 = relative_acceleration(plan.floor, end.u, end.v, force.p0 + force.p1 * h)
    b0 = relative_acceleration(plan.brace, start.d, start.e, force.b0)
    b1 = relative_acceleration(plan.brace, end.d, end.e, force.b0 + force.b1 * h)
    _, fourth_v = floor_fourths(plan.floor, start.v, a0, force.p1, h)
    _, fourth_e = brace_fourths(plan, start, b0, force, h)
    return clears(
        phase * (start.v - start.e),
        phase * h * (a0 - b0),
        phase * (end.v - end.e),
        phase * h * (a1 - b1),
        fourth_v + fourth_e,
    )


@inner
def search_slip(floor, brace, slide, n, h, phase, kick):
    """Fraction of the expanded piece at which the sliding velocity comes to zero.

    ``kick`` is the sliding acceleration with which a slip begins at the piece's start, known from
    the rule that began it and not from differences; negative where no slip begins.
    """
    pace = 1.0 / h
    for k in range(n):
        slide[k] = (k + 1) * (floor[k + 1] - brace[k + 1]) * pace
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
def slip_peaks(plan, floor, brace, search, n, share, start, end, force, phase, h, peaks):
    """Peaks over a slip piece: the floor's, and that of the base shear, in which the brace rings."""
    storey = plan.storey
    f = plan.floor
    b = plan.brace
    k, c, kd, cd = storey.floor_stiffness, storey.floor_damping, storey.brace_stiffness, storey.brace_damping
    a0 = relative_acceleration(f, start.u, start.v, force.p0)
    a1 = relative_acceleration(f, end.u, end.v, force.p0 + force.p1 * h)
    b0 = relative_acceleration(b, start.d, start.e, force.b0)
    b1 = relative_acceleration(b, end.d, end.e, force.b0 + force.b1 * h)
    fourth_u, fourth_v = floor_fourths(f, start.v, a0, force.p1, h)
    fourth_d, fourth_e = brace_fourths(plan, start, b0, force, h)
    s0 = base_shear(storey, start)
    s1 = base_shear(storey, end)
    shear = max(peaks.shear, abs(s1))
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
    if see_s:
        ready(floor, n, share, start.u, start.v, f.g, f.w2, force.p0, force.p1, h)
        ready(brace, n, share, start.d, start.e, b.g, b.w2, force.b0, force.b1, h)
        share = 1.0
        pace = 1.0 / h
        for j in range(n):
            search[j] = k * floor[j] + kd * brace[j] + (j + 1) * (c * floor[j + 1] + cd * brace[j + 1]) * pace
        search[n] = 0.0
        shear = largest_magnitude(search, n, shear)
    base = -phase * storey.kinetic_slip_force / storey.floor_mass
    moved = floor_peaks(f, base, 0.0, floor, search, n, share, start, end, force, h, peaks)
    return Peaks(moved.acceleration, moved.displacement, moved.velocity, shear)
