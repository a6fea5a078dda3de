"""Steps in which nothing happens, of many histories at once.

One loop without a branch over the lanes, which the compiler turns into vector instructions.  Bounds
decide lane by lane whether a step is uneventful: a lane whose phase surely stays moves to the step's end.
Any other stays where it is: its step is eventful, and `take_step` takes it alone.  Sets of lanes are
integers, a bit for each lane.

While sticking a step is one whole segment, and the bounds are those of `take_step`.  While slipping the
brace may ring many radians in a step: it swings about its quasi-static motion with an amplitude that
does not grow, so the slowest sliding is at least the floor's slowest less that swing, and a floor
that slides faster cannot be caught.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import fma, inlined, inner, wide
from fdspec.kernels.batch.layout import ROW, WIDTH, at
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.oscillator import acceleration, dot4
from fdspec.kernels.mathematics.polynomial_roots import THIRD


@inlined
def carry(p, row, lane, x, v, p0, rate):
    """A linear form (four rows) in displacement, velocity, force over mass and minus its rate."""
    return dot4(
        at(p, row, lane), x, at(p, row + 1, lane), v, at(p, row + 2, lane), p0, -at(p, row + 3, lane), rate
    )


@inlined
def form(p, row, lane, x, v, p0, p1):
    """A quadratic form (ten rows) in displacement, velocity, force over mass and its rate."""
    of_x = dot4(
        at(p, row, lane), x, at(p, row + 1, lane), v, at(p, row + 2, lane), p0, at(p, row + 3, lane), p1
    )
    of_v = fma(at(p, row + 4, lane), v, fma(at(p, row + 5, lane), p0, at(p, row + 6, lane) * p1))
    of_p = fma(at(p, row + 7, lane), p0, at(p, row + 8, lane) * p1)
    return fma(x, of_x, fma(v, of_v, fma(p0, of_p, at(p, row + 9, lane) * p1 * p1)))


@inner
def stick_lanes(p, h, ground, rate):
    """Advance the sticking lanes in which nothing happens; return the eventful ones, and those to defer.

    The brace's motion follows from the floor's and is left for `take_state` to tell.

    Deferred are the peaks of lanes that advance where the bounds leave room for a new one.
    The row ``held`` keeps the largest reaction for which the bounds leave room: above it no slip force is
    reached.
    """
    wide()
    third = h * THIRD
    ground_end = fma(rate, h, ground)
    steep = abs(rate)
    eventful = 0  # integers: sums of floats would be taken one by one, in order
    to_defer = 0
    for lane in range(WIDTH):
        u = at(p, ROW.u, lane)
        v = at(p, ROW.v, lane)
        offset = at(p, ROW.offset, lane)
        g = at(p, ROW.stick_g, lane)
        w2 = at(p, ROW.stick_w2, lane)
        base = at(p, ROW.lift, lane) * offset
        p0 = base - ground
        u1 = carry(p, ROW.stick_map, lane, u, v, p0, rate)
        v1 = carry(p, ROW.stick_map + 4, lane, u, v, p0, rate)
        area = carry(p, ROW.stick_map + 8, lane, u, v, p0, rate)
        q0 = acceleration(u, v, g, w2, base)
        q1 = acceleration(u1, v1, g, w2, base)
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = fma(abs(a0), at(p, ROW.stick_slow, lane), fma(steep, at(p, ROW.stick_drift, lane), abs(v)))

        hold_u = at(p, ROW.hold_u, lane)
        hold_v = at(p, ROW.hold_v, lane)
        locked = at(p, ROW.hold_offset, lane) * offset
        r0 = fma(hold_u, u, fma(hold_v, v, -locked))
        r1 = fma(hold_u, u1, fma(hold_v, v1, -locked))
        rise0 = third * fma(hold_u, v, hold_v * a0)
        rise1 = third * fma(hold_u, v1, hold_v * a1)
        inside = fma(swing, at(p, ROW.hold_tail, lane), max(abs(r0 + rise0), abs(r1 - rise1)))
        held = max(max(abs(r0), abs(r1)), inside)

        top_a = max(at(p, ROW.peak_acceleration, lane), abs(q1))
        mass = at(p, ROW.mass, lane)
        top_s = max(at(p, ROW.peak_shear, lane), mass * abs(q1))
        top_u = max(at(p, ROW.peak_displacement, lane), abs(u1))
        top_v = max(at(p, ROW.peak_velocity, lane), abs(v1))
        bound_u = max(abs(fma(third, v, u)), abs(fma(-third, v1, u1)))
        bound_u = fma(swing, at(p, ROW.stick_tail_u, lane), bound_u)
        bound_v = max(abs(fma(third, a0, v)), abs(fma(-third, a1, v1)))
        bound_v = fma(swing, at(p, ROW.stick_tail_v, lane), bound_v)
        fall0, fall1 = fma(g, a0, w2 * v), fma(g, a1, w2 * v1)
        bound_q = max(abs(fma(-third, fall0, q0)), abs(fma(third, fall1, q1)))
        bound_q = fma(swing, at(p, ROW.stick_tail_q, lane), bound_q)
        # The brace carries the reaction less the inertia of its own mass.
        m_b = at(p, ROW.brace_mass, lane)
        bound_b = fma(m_b, bound_q, inside)
        top_b = max(at(p, ROW.peak_brace, lane), abs(fma(-m_b, q1, r1)))
        sticks = at(p, ROW.phase, lane) == 0.0
        alert = (held >= at(p, ROW.limit, lane)) | (at(p, ROW.touching, lane) != 0.0)
        peak = (bound_q > top_a) | (mass * bound_q > top_s) | (bound_u > top_u) | (bound_v > top_v)
        peak |= bound_b > top_b
        moves = sticks & (not alert)
        eventful |= (1 << lane) if sticks & alert else 0
        to_defer |= (1 << lane) if moves & peak else 0
        moved = fma(ground, u1 - u, rate * fma(h, u1, -area))
        p[ROW.from_u * WIDTH + lane] = u
        p[ROW.from_v * WIDTH + lane] = v
        p[ROW.u * WIDTH + lane] = u1 if moves else u
        p[ROW.v * WIDTH + lane] = v1 if moves else v
        p[ROW.peak_acceleration * WIDTH + lane] = top_a if moves else at(p, ROW.peak_acceleration, lane)
        p[ROW.peak_displacement * WIDTH + lane] = top_u if moves else at(p, ROW.peak_displacement, lane)
        p[ROW.peak_velocity * WIDTH + lane] = top_v if moves else at(p, ROW.peak_velocity, lane)
        p[ROW.peak_shear * WIDTH + lane] = top_s if moves else at(p, ROW.peak_shear, lane)
        p[ROW.peak_brace * WIDTH + lane] = top_b if moves else at(p, ROW.peak_brace, lane)
        p[ROW.bound_b * WIDTH + lane] = bound_b
        p[ROW.input * WIDTH + lane] -= mass * moved if moves else 0.0
        p[ROW.bound_u * WIDTH + lane] = bound_u
        p[ROW.bound_v * WIDTH + lane] = bound_v
        p[ROW.bound_q * WIDTH + lane] = bound_q
        p[ROW.held * WIDTH + lane] = max(at(p, ROW.held, lane), held)
    return eventful, to_defer


@inner
def slip_lanes(p, h, ground, rate):
    """Advance the slipping lanes in which nothing happens; return the eventful ones, and those to defer."""
    wide()
    third = h * THIRD
    ground_end = fma(rate, h, ground)
    steep = abs(rate)
    shake = max(abs(ground), abs(ground_end))
    eventful = 0
    to_defer = 0
    for lane in range(WIDTH):
        sign = at(p, ROW.phase, lane)
        u = at(p, ROW.u, lane)
        v = at(p, ROW.v, lane)
        d = at(p, ROW.d, lane)
        e = at(p, ROW.e, lane)
        g = at(p, ROW.floor_g, lane)
        w2 = at(p, ROW.floor_w2, lane)
        solid = at(p, ROW.brace_ground, lane)
        base = sliding_force(-sign, at(p, ROW.push_floor, lane))
        p0 = base - ground
        b0 = sliding_force(sign, at(p, ROW.push_brace, lane)) - solid * ground
        b1 = solid * rate
        u1 = carry(p, ROW.floor_map, lane, u, v, p0, rate)
        v1 = carry(p, ROW.floor_map + 4, lane, u, v, p0, rate)
        floor_area = carry(p, ROW.floor_map + 8, lane, u, v, p0, rate)
        d1 = carry(p, ROW.brace_map, lane, d, e, b0, b1)
        e1 = carry(p, ROW.brace_map + 4, lane, d, e, b0, b1)
        brace_area = carry(p, ROW.brace_map + 8, lane, d, e, b0, b1)
        q0 = acceleration(u, v, g, w2, base)
        q1 = acceleration(u1, v1, g, w2, base)
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = fma(abs(a0), at(p, ROW.floor_slow, lane), fma(steep, at(p, ROW.floor_drift, lane), abs(v)))

        drift = -b1 * at(p, ROW.brace_drift, lane)
        g_b = at(p, ROW.brace_g, lane)
        w2_b = at(p, ROW.brace_w2, lane)
        c0 = acceleration(d, e, g_b, w2_b, b0)
        c1 = acceleration(d1, e1, g_b, w2_b, fma(-b1, h, b0))
        ring_v = e - drift
        ring_a = c0 * at(p, ROW.brace_slow, lane)
        ring = math.sqrt(fma(ring_v, ring_v, ring_a * ring_a))
        tail_v = swing * at(p, ROW.floor_tail_v, lane)
        inside = min(sign * fma(third, a0, v), sign * fma(-third, a1, v1)) - tail_v
        slowest = min(min(sign * v, sign * v1), inside) - (sign * drift + ring)
        w0 = sign * (v - e)
        w1 = sign * (v1 - e1)
        inside = min(fma(sign * third, a0 - c0, w0), fma(-sign * third, a1 - c1, w1))
        inside -= fma(ring, at(p, ROW.brace_tail_e, lane), tail_v)
        slowest = max(slowest, min(min(w0, w1), inside))

        top_a = max(at(p, ROW.peak_acceleration, lane), abs(q1))
        top_u = max(at(p, ROW.peak_displacement, lane), abs(u1))
        top_v = max(at(p, ROW.peak_velocity, lane), abs(v1))
        bound_u = max(abs(fma(third, v, u)), abs(fma(-third, v1, u1)))
        bound_u = fma(swing, at(p, ROW.floor_tail_u, lane), bound_u)
        bound_v = max(abs(fma(third, a0, v)), abs(fma(-third, a1, v1))) + tail_v
        fall0, fall1 = fma(g, a0, w2 * v), fma(g, a1, w2 * v1)
        bound_q = max(abs(fma(-third, fall0, q0)), abs(fma(third, fall1, q1)))
        bound_q = fma(swing, at(p, ROW.floor_tail_q, lane), bound_q)
        # Base shear is the inertia of both masses; the brace itself accelerates at most by ring times omega.
        m = at(p, ROW.floor_mass, lane)
        m_b = at(p, ROW.brace_mass, lane)
        s0 = fma(m, q0, m_b * (c0 + ground))
        s1 = fma(m, q1, m_b * (c1 + ground_end))
        drop0, drop1 = fma(g_b, c0, w2_b * e), fma(g_b, c1, w2_b * e1)
        rise0 = third * fma(m, fall0, m_b * drop0)
        rise1 = third * fma(m, fall1, m_b * drop1)
        inside = max(abs(s0 - rise0), abs(s1 + rise1))
        inside += fma(m * swing, at(p, ROW.floor_tail_q, lane), m_b * ring * at(p, ROW.brace_tail_q, lane))
        bound_s = m_b * fma(ring, at(p, ROW.brace_omega, lane), shake)
        bound_s = fma(m, max(max(abs(q0), abs(q1)), bound_q), bound_s)
        bound_s = min(bound_s, max(max(abs(s0), abs(s1)), inside))
        shear = max(at(p, ROW.peak_shear, lane), abs(s1))
        # The brace carries friction less its inertia: that of its quasi-static motion, and of its ringing.
        f0 = fma(g_b, e, w2_b * d)
        f1 = fma(g_b, e1, w2_b * d1)
        inside = max(abs(fma(third, drop0, f0)), abs(fma(-third, drop1, f1)))
        inside = fma(ring, at(p, ROW.brace_tail_q, lane), inside)
        bound_b = fma(ring, at(p, ROW.brace_omega, lane), max(abs(b0), abs(fma(-b1, h, b0))))
        bound_b = m_b * min(bound_b, max(max(abs(f0), abs(f1)), inside))
        top_b = max(at(p, ROW.peak_brace, lane), m_b * abs(f1))
        slips = sign != 0.0
        alert = (at(p, ROW.alone, lane) != 0.0) | (at(p, ROW.onset, lane) >= 0.0)
        alert |= (slowest <= 0.0) | (bound_s > shear)
        peak = (bound_q > top_a) | (bound_u > top_u) | (bound_v > top_v)
        peak |= bound_b > top_b
        moves = slips & (not alert)
        eventful |= (1 << lane) if slips & alert else 0
        to_defer |= (1 << lane) if moves & peak else 0
        moved = ground * (u1 - u)
        work = m * fma(rate, fma(h, u1, -floor_area), moved)
        work = fma(m_b, fma(ground, d1 - d, rate * fma(h, d1, -brace_area)), work)
        p[ROW.from_u * WIDTH + lane] = u if slips else at(p, ROW.from_u, lane)
        p[ROW.from_v * WIDTH + lane] = v if slips else at(p, ROW.from_v, lane)
        p[ROW.u * WIDTH + lane] = u1 if moves else u
        p[ROW.v * WIDTH + lane] = v1 if moves else v
        p[ROW.d * WIDTH + lane] = d1 if moves else d
        p[ROW.e * WIDTH + lane] = e1 if moves else e
        p[ROW.peak_acceleration * WIDTH + lane] = top_a if moves else at(p, ROW.peak_acceleration, lane)
        p[ROW.peak_displacement * WIDTH + lane] = top_u if moves else at(p, ROW.peak_displacement, lane)
        p[ROW.peak_velocity * WIDTH + lane] = top_v if moves else at(p, ROW.peak_velocity, lane)
        p[ROW.peak_shear * WIDTH + lane] = shear if moves else at(p, ROW.peak_shear, lane)
        p[ROW.peak_brace * WIDTH + lane] = top_b if moves else at(p, ROW.peak_brace, lane)
        p[ROW.from_d * WIDTH + lane] = d if slips else at(p, ROW.from_d, lane)
        p[ROW.from_e * WIDTH + lane] = e if slips else at(p, ROW.from_e, lane)
        p[ROW.bound_b * WIDTH + lane] = bound_b if slips else at(p, ROW.bound_b, lane)
        p[ROW.input * WIDTH + lane] -= work if moves else 0.0
        p[ROW.bound_u * WIDTH + lane] = bound_u if slips else at(p, ROW.bound_u, lane)
        p[ROW.bound_v * WIDTH + lane] = bound_v if slips else at(p, ROW.bound_v, lane)
        p[ROW.bound_q * WIDTH + lane] = bound_q if slips else at(p, ROW.bound_q, lane)
        p[ROW.bound_s * WIDTH + lane] = bound_s if slips else at(p, ROW.bound_s, lane)
    return eventful, to_defer


@inlined
def stick_loss(p, lane, u, v, ground, rate):
    """Viscous work of a step of stick that begins with this motion."""
    p0 = at(p, ROW.lift, lane) * at(p, ROW.offset, lane) - ground
    return at(p, ROW.stick_damp, lane) * form(p, ROW.stick_loss, lane, u, v, p0, -rate)


@inner
def stick_losses(p, ground, rate, eventful):
    """Add the viscous work of this step, where all lanes stick, to those for which it is uneventful."""
    wide()
    for lane in range(WIDTH):
        done = stick_loss(p, lane, at(p, ROW.from_u, lane), at(p, ROW.from_v, lane), ground, rate)
        p[ROW.viscous * WIDTH + lane] += done if eventful >> lane & 1 == 0 else 0.0


@inner
def all_losses(p, ground, rate, eventful):
    """The same where some slip."""
    wide()
    for lane in range(WIDTH):
        sign = at(p, ROW.phase, lane)
        u, v = at(p, ROW.from_u, lane), at(p, ROW.from_v, lane)
        p0 = sliding_force(-sign, at(p, ROW.push_floor, lane)) - ground
        slip_loss = at(p, ROW.floor_damp, lane) * form(p, ROW.floor_loss, lane, u, v, p0, -rate)
        while_stuck = stick_loss(p, lane, u, v, ground, rate)  # for all: the loop has no branch
        done = slip_loss if sign != 0.0 else while_stuck
        p[ROW.viscous * WIDTH + lane] += done if eventful >> lane & 1 == 0 else 0.0
