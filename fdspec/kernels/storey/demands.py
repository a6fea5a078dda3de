"""What a designer reads off beside the floor's peaks: the force in the brace, of one segment at a time.

The brace's spring and dashpot carry B = k_d d + c_d d'.  While floor and brace stick they move as one, and B
is a quantity of that one oscillator.  While they slip the brace rings about its quasi-static motion,

    B = s F_sl - m_d (d'' + a_g),        |B| <= max |s F_sl - m_d a_g| + m_d omega_d ring,

with ``ring`` the amplitude of its velocity, which does not grow.  A brace without mass carries s F_sl.

The slip offset needs no search: sliding keeps its sign until it comes to zero, and so the largest offset
stands where slip stops, or at the history's end.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import fma, inlined, inner, seldom
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.extremum import Weights, top_inside
from fdspec.kernels.mathematics.oscillator import advance, expand
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude
from fdspec.kernels.storey.bounds import floor_fourths, magnitude_bound, relative_acceleration
from fdspec.kernels.storey.constants import has_closed_form
from fdspec.kernels.storey.slip import brace_fourths
from fdspec.kernels.types import STICK, Force, Motion


@inlined
def brace_force(storey, motion):
    """Force (N) in the brace's spring and dashpot."""
    return fma(storey.brace_stiffness, motion.d, storey.brace_damping * motion.e)


@inner
def force_series(kd, cd, c, n, share, h, out):
    """Series of k_d x + c_d x' on the first part ``share`` of a segment on which c is the series of x.

    h: length (s) of that part.
    """
    pace = 1.0 / h
    power = 1.0
    for k in range(n):
        more = power * share
        out[k] = kd * c[k] * power + cd * (k + 1) * c[k + 1] * more * pace
        power = more
    out[n] = kd * c[n] * power


@inlined
def stick_brace_peak(plan, floor, search, n, share, start, end, force, offset, h, best):
    """The greater of ``best`` and the largest brace force after the start of a segment of stick.

    ``share`` tells what ``floor`` holds, as for `fdspec.kernels.storey.bounds.floor_peaks`; it is left
    as it is unless that is nothing.
    """
    b = plan.stick
    kd, cd = plan.storey.brace_stiffness, plan.storey.brace_damping
    a0 = relative_acceleration(b, start.u, start.v, force.p0)
    a1 = relative_acceleration(b, end.u, end.v, fma(force.p1, h, force.p0))
    first = fma(kd, start.u - offset, cd * start.v)
    last = fma(kd, end.u - offset, cd * end.v)
    fourth_u, fourth_v = floor_fourths(b, start.v, a0, force.p1, h)
    fourth = fma(kd, fourth_u, cd * fourth_v)
    best = max(best, abs(last))
    inside = magnitude_bound(first, h * fma(kd, start.v, cd * a0), last, h * fma(kd, end.v, cd * a1), fourth)
    if inside <= best:
        return best
    return search_stick_brace(plan, floor, search, n, share, start, end, force, offset, h, fourth, best)


@inner
def search_stick_brace(plan, floor, search, n, share, start, end, force, offset, h, fourth, best):
    """The same where bounds leave room for a peak inside."""
    seldom()
    b = plan.stick
    kd, cd = plan.storey.brace_stiffness, plan.storey.brace_damping
    if share == 0.0:
        w = Weights(kd, cd, 0.0, -kd * offset)
        best, sure = top_inside(b, b, n, False, w, start, end, force, h, fourth, best)
        if sure:
            return best
        expand(floor, n, start.u, start.v, b.g, b.w2, force.p0, force.p1, h)
        share = 1.0
    force_series(kd, cd, floor, n, share, h, search)
    search[0] -= kd * offset
    return largest_magnitude(search, n, best)


@inlined
def slip_brace_bound(plan, start, b0, b1, h):
    """What the brace force does not pass within a time h of slip, however it rings."""
    storey = plan.storey
    if storey.brace_mass == 0.0:
        return storey.kinetic_slip_force
    b = plan.brace
    if b.w2 == 0.0:
        return math.inf
    ring_v = start.e - b1 * b.drift
    ring_a = relative_acceleration(b, start.d, start.e, b0) * b.slowness
    ring = math.sqrt(fma(ring_v, ring_v, ring_a * ring_a))
    steady = max(abs(b0), abs(fma(b1, h, b0)))
    impedance = storey.brace_stiffness * b.slowness  # m_d omega_d
    return fma(storey.brace_mass, steady, impedance * ring)


@inlined
def slip_brace_peak(plan, brace, search, n, share, start, end, force, h, best):
    """The greater of ``best`` and the largest brace force after the start of a segment of slip.

    ``share`` tells what ``brace`` holds; see `stick_brace_peak`.
    """
    storey = plan.storey
    if storey.brace_mass == 0.0:
        return max(best, storey.kinetic_slip_force)
    b = plan.brace
    kd, cd = storey.brace_stiffness, storey.brace_damping
    a0 = relative_acceleration(b, start.d, start.e, force.b0)
    a1 = relative_acceleration(b, end.d, end.e, fma(force.b1, h, force.b0))
    first, last = brace_force(storey, start), brace_force(storey, end)
    fourth_d, fourth_e = brace_fourths(plan, start, a0, force, h)
    fourth = fma(kd, fourth_d, cd * fourth_e)
    best = max(best, abs(last))
    inside = magnitude_bound(first, h * fma(kd, start.e, cd * a0), last, h * fma(kd, end.e, cd * a1), fourth)
    if inside <= best:
        return best
    return search_slip_brace(plan, brace, search, n, share, start, end, force, h, fourth, best)


@inner
def search_slip_brace(plan, brace, search, n, share, start, end, force, h, fourth, best):
    """The same where bounds leave room for a peak inside."""
    seldom()
    b = plan.brace
    kd, cd = plan.storey.brace_stiffness, plan.storey.brace_damping
    if share == 0.0:
        if has_closed_form(plan):
            w = Weights(0.0, 0.0, kd, 0.0)
            order = int(plan.floor_order)
            best, sure = top_inside(plan.floor, b, order, True, w, start, end, force, h, fourth, best)
            if sure:
                return best
        expand(brace, n, start.d, start.e, b.g, b.w2, force.b0, force.b1, h)
        share = 1.0
    force_series(kd, cd, brace, n, share, h, search)
    return largest_magnitude(search, n, best)


@inner
def step_brace_peak(plan, phase, u, v, d, e, offset, ground, rate, room, search, best):
    """The greater of ``best`` and the largest brace force on a whole step without a change of phase.

    u, v: the floor at its start, where it sticks; d, e: the brace, where it slips.  room, search: (TERMS,).
    """
    storey = plan.storey
    if phase == STICK:
        force = Force(plan.lift * offset - ground, -rate, 0.0, 0.0)
        u1, v1 = advance(plan.stick_map, u, v, force.p0, force.p1)
        start = Motion(u, v, u - offset, v)
        end = Motion(u1, v1, u1 - offset, v1)
        n = int(plan.stick_order)
        return stick_brace_peak(plan, room, search, n, 0.0, start, end, force, offset, plan.step, best)
    if storey.brace_mass == 0.0:
        return max(best, storey.kinetic_slip_force)
    b0 = sliding_force(phase, storey.kinetic_slip_force / storey.brace_mass) - ground
    h = plan.slip_step
    n = int(plan.slip_order)
    for _ in range(int(plan.slip_steps)):
        d1, e1 = advance(plan.brace_map, d, e, b0, -rate)
        force = Force(0.0, 0.0, b0, -rate)
        start, end = Motion(0.0, 0.0, d, e), Motion(0.0, 0.0, d1, e1)
        best = slip_brace_peak(plan, room, search, n, 0.0, start, end, force, h, best)
        d, e = d1, e1
        b0 = fma(-rate, h, b0)
    return best
