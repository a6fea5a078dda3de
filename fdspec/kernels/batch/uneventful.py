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
from fdspec.kernels.batch.layout import (
    ALONE,
    B_DRIFT,
    B_G,
    B_GROUND,
    B_MAP,
    B_OMEGA,
    B_SLOW,
    B_TAIL_E,
    B_TAIL_Q,
    B_W2,
    BOUND_B,
    BOUND_Q,
    BOUND_S,
    BOUND_U,
    BOUND_V,
    BRACE_MASS,
    F_DAMP,
    F_DRIFT,
    F_G,
    F_LOSS,
    F_MAP,
    F_SLOW,
    F_TAIL_Q,
    F_TAIL_U,
    F_TAIL_V,
    F_W2,
    FLOOR_MASS,
    FROM_D,
    FROM_E,
    FROM_U,
    FROM_V,
    HELD,
    HOLD_O,
    HOLD_TAIL,
    HOLD_U,
    HOLD_V,
    LIFT,
    LIGHT,
    LIMIT,
    MASS,
    PUSH_BRACE,
    PUSH_FLOOR,
    S_DAMP,
    S_DRIFT,
    S_G,
    S_LOSS,
    S_MAP,
    S_SLOW,
    S_TAIL_Q,
    S_TAIL_U,
    S_TAIL_V,
    S_W2,
    WIDTH,
    at,
)
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.oscillator import acceleration, dot4
from fdspec.kernels.mathematics.polynomial_roots import THIRD
from fdspec.kernels.types import (
    INPUT,
    OFFSET,
    ONSET,
    PEAK_ACCELERATION,
    PEAK_BRACE,
    PEAK_DISPLACEMENT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
    PHASE,
    TOUCHING,
    VISCOUS,
    D,
    E,
    U,
    V,
)


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
    HELD defers the largest reaction for which the bounds leave room: above it no slip force is reached.
    """
    wide()
    third = h * THIRD
    ground_end = fma(rate, h, ground)
    steep = abs(rate)
    eventful = 0  # integers: sums of floats would be taken one by one, in order
    to_defer = 0
    for lane in range(WIDTH):
        u = at(p, U, lane)
        v = at(p, V, lane)
        offset = at(p, OFFSET, lane)
        g = at(p, S_G, lane)
        w2 = at(p, S_W2, lane)
        base = at(p, LIFT, lane) * offset
        p0 = base - ground
        u1 = carry(p, S_MAP, lane, u, v, p0, rate)
        v1 = carry(p, S_MAP + 4, lane, u, v, p0, rate)
        area = carry(p, S_MAP + 8, lane, u, v, p0, rate)
        q0 = acceleration(u, v, g, w2, base)
        q1 = acceleration(u1, v1, g, w2, base)
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = fma(abs(a0), at(p, S_SLOW, lane), fma(steep, at(p, S_DRIFT, lane), abs(v)))

        hold_u = at(p, HOLD_U, lane)
        hold_v = at(p, HOLD_V, lane)
        locked = at(p, HOLD_O, lane) * offset
        r0 = fma(hold_u, u, fma(hold_v, v, -locked))
        r1 = fma(hold_u, u1, fma(hold_v, v1, -locked))
        rise0 = third * fma(hold_u, v, hold_v * a0)
        rise1 = third * fma(hold_u, v1, hold_v * a1)
        inside = fma(swing, at(p, HOLD_TAIL, lane), max(abs(r0 + rise0), abs(r1 - rise1)))
        held = max(max(abs(r0), abs(r1)), inside)

        top_a = max(at(p, PEAK_ACCELERATION, lane), abs(q1))
        top_s = max(at(p, PEAK_SHEAR, lane), at(p, MASS, lane) * abs(q1))
        top_u = max(at(p, PEAK_DISPLACEMENT, lane), abs(u1))
        top_v = max(at(p, PEAK_VELOCITY, lane), abs(v1))
        bound_u = max(abs(fma(third, v, u)), abs(fma(-third, v1, u1)))
        bound_u = fma(swing, at(p, S_TAIL_U, lane), bound_u)
        bound_v = max(abs(fma(third, a0, v)), abs(fma(-third, a1, v1)))
        bound_v = fma(swing, at(p, S_TAIL_V, lane), bound_v)
        fall0, fall1 = fma(g, a0, w2 * v), fma(g, a1, w2 * v1)
        bound_q = max(abs(fma(-third, fall0, q0)), abs(fma(third, fall1, q1)))
        bound_q = fma(swing, at(p, S_TAIL_Q, lane), bound_q)
        # The brace carries the reaction less the inertia of its own mass.
        m_b = at(p, BRACE_MASS, lane)
        bound_b = fma(m_b, bound_q, inside)
        top_b = max(at(p, PEAK_BRACE, lane), abs(fma(-m_b, q1, r1)))
        sticks = at(p, PHASE, lane) == 0.0
        alert = (held >= at(p, LIMIT, lane)) | (at(p, TOUCHING, lane) != 0.0)
        peak = (bound_q > min(top_a, top_s * at(p, LIGHT, lane))) | (bound_u > top_u) | (bound_v > top_v)
        peak |= bound_b > top_b
        moves = sticks & (not alert)
        eventful |= (1 << lane) if sticks & alert else 0
        to_defer |= (1 << lane) if moves & peak else 0
        moved = fma(ground, u1 - u, rate * fma(h, u1, -area))
        p[FROM_U * WIDTH + lane] = u
        p[FROM_V * WIDTH + lane] = v
        p[U * WIDTH + lane] = u1 if moves else u
        p[V * WIDTH + lane] = v1 if moves else v
        p[PEAK_ACCELERATION * WIDTH + lane] = top_a if moves else at(p, PEAK_ACCELERATION, lane)
        p[PEAK_DISPLACEMENT * WIDTH + lane] = top_u if moves else at(p, PEAK_DISPLACEMENT, lane)
        p[PEAK_VELOCITY * WIDTH + lane] = top_v if moves else at(p, PEAK_VELOCITY, lane)
        p[PEAK_SHEAR * WIDTH + lane] = top_s if moves else at(p, PEAK_SHEAR, lane)
        p[PEAK_BRACE * WIDTH + lane] = top_b if moves else at(p, PEAK_BRACE, lane)
        p[BOUND_B * WIDTH + lane] = bound_b
        p[INPUT * WIDTH + lane] -= at(p, MASS, lane) * moved if moves else 0.0
        p[BOUND_U * WIDTH + lane] = bound_u
        p[BOUND_V * WIDTH + lane] = bound_v
        p[BOUND_Q * WIDTH + lane] = bound_q
        p[BOUND_S * WIDTH + lane] = at(p, MASS, lane) * bound_q
        p[HELD * WIDTH + lane] = max(at(p, HELD, lane), held)
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
        sign = at(p, PHASE, lane)
        u = at(p, U, lane)
        v = at(p, V, lane)
        d = at(p, D, lane)
        e = at(p, E, lane)
        g = at(p, F_G, lane)
        w2 = at(p, F_W2, lane)
        solid = at(p, B_GROUND, lane)
        base = sliding_force(-sign, at(p, PUSH_FLOOR, lane))
        p0 = base - ground
        b0 = sliding_force(sign, at(p, PUSH_BRACE, lane)) - solid * ground
        b1 = solid * rate
        u1 = carry(p, F_MAP, lane, u, v, p0, rate)
        v1 = carry(p, F_MAP + 4, lane, u, v, p0, rate)
        floor_area = carry(p, F_MAP + 8, lane, u, v, p0, rate)
        d1 = carry(p, B_MAP, lane, d, e, b0, b1)
        e1 = carry(p, B_MAP + 4, lane, d, e, b0, b1)
        brace_area = carry(p, B_MAP + 8, lane, d, e, b0, b1)
        q0 = acceleration(u, v, g, w2, base)
        q1 = acceleration(u1, v1, g, w2, base)
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = fma(abs(a0), at(p, F_SLOW, lane), fma(steep, at(p, F_DRIFT, lane), abs(v)))

        drift = -b1 * at(p, B_DRIFT, lane)
        g_b = at(p, B_G, lane)
        w2_b = at(p, B_W2, lane)
        c0 = acceleration(d, e, g_b, w2_b, b0)
        c1 = acceleration(d1, e1, g_b, w2_b, fma(-b1, h, b0))
        ring_v = e - drift
        ring_a = c0 * at(p, B_SLOW, lane)
        ring = math.sqrt(fma(ring_v, ring_v, ring_a * ring_a))
        tail_v = swing * at(p, F_TAIL_V, lane)
        inside = min(sign * fma(third, a0, v), sign * fma(-third, a1, v1)) - tail_v
        slowest = min(min(sign * v, sign * v1), inside) - (sign * drift + ring)
        w0 = sign * (v - e)
        w1 = sign * (v1 - e1)
        inside = min(fma(sign * third, a0 - c0, w0), fma(-sign * third, a1 - c1, w1))
        inside -= fma(ring, at(p, B_TAIL_E, lane), tail_v)
        slowest = max(slowest, min(min(w0, w1), inside))

        top_a = max(at(p, PEAK_ACCELERATION, lane), abs(q1))
        top_u = max(at(p, PEAK_DISPLACEMENT, lane), abs(u1))
        top_v = max(at(p, PEAK_VELOCITY, lane), abs(v1))
        bound_u = max(abs(fma(third, v, u)), abs(fma(-third, v1, u1)))
        bound_u = fma(swing, at(p, F_TAIL_U, lane), bound_u)
        bound_v = max(abs(fma(third, a0, v)), abs(fma(-third, a1, v1))) + tail_v
        fall0, fall1 = fma(g, a0, w2 * v), fma(g, a1, w2 * v1)
        bound_q = max(abs(fma(-third, fall0, q0)), abs(fma(third, fall1, q1)))
        bound_q = fma(swing, at(p, F_TAIL_Q, lane), bound_q)
        # Base shear is the inertia of both masses; the brace itself accelerates at most by ring times omega.
        m = at(p, FLOOR_MASS, lane)
        m_b = at(p, BRACE_MASS, lane)
        s0 = fma(m, q0, m_b * (c0 + ground))
        s1 = fma(m, q1, m_b * (c1 + ground_end))
        drop0, drop1 = fma(g_b, c0, w2_b * e), fma(g_b, c1, w2_b * e1)
        rise0 = third * fma(m, fall0, m_b * drop0)
        rise1 = third * fma(m, fall1, m_b * drop1)
        inside = max(abs(s0 - rise0), abs(s1 + rise1))
        inside += fma(m * swing, at(p, F_TAIL_Q, lane), m_b * ring * at(p, B_TAIL_Q, lane))
        bound_s = m_b * fma(ring, at(p, B_OMEGA, lane), shake)
        bound_s = fma(m, max(max(abs(q0), abs(q1)), bound_q), bound_s)
        bound_s = min(bound_s, max(max(abs(s0), abs(s1)), inside))
        shear = max(at(p, PEAK_SHEAR, lane), abs(s1))
        # The brace carries friction less its inertia: that of its quasi-static motion, and of its ringing.
        f0 = fma(g_b, e, w2_b * d)
        f1 = fma(g_b, e1, w2_b * d1)
        inside = max(abs(fma(third, drop0, f0)), abs(fma(-third, drop1, f1)))
        inside = fma(ring, at(p, B_TAIL_Q, lane), inside)
        bound_b = fma(ring, at(p, B_OMEGA, lane), max(abs(b0), abs(fma(-b1, h, b0))))
        bound_b = m_b * min(bound_b, max(max(abs(f0), abs(f1)), inside))
        top_b = max(at(p, PEAK_BRACE, lane), m_b * abs(f1))
        slips = sign != 0.0
        alert = (at(p, ALONE, lane) != 0.0) | (at(p, ONSET, lane) >= 0.0)
        alert |= (slowest <= 0.0) | (bound_s > shear)
        peak = (bound_q > top_a) | (bound_u > top_u) | (bound_v > top_v)
        peak |= bound_b > top_b
        moves = slips & (not alert)
        eventful |= (1 << lane) if slips & alert else 0
        to_defer |= (1 << lane) if moves & peak else 0
        moved = ground * (u1 - u)
        work = m * fma(rate, fma(h, u1, -floor_area), moved)
        work = fma(m_b, fma(ground, d1 - d, rate * fma(h, d1, -brace_area)), work)
        p[FROM_U * WIDTH + lane] = u if slips else at(p, FROM_U, lane)
        p[FROM_V * WIDTH + lane] = v if slips else at(p, FROM_V, lane)
        p[U * WIDTH + lane] = u1 if moves else u
        p[V * WIDTH + lane] = v1 if moves else v
        p[D * WIDTH + lane] = d1 if moves else d
        p[E * WIDTH + lane] = e1 if moves else e
        p[PEAK_ACCELERATION * WIDTH + lane] = top_a if moves else at(p, PEAK_ACCELERATION, lane)
        p[PEAK_DISPLACEMENT * WIDTH + lane] = top_u if moves else at(p, PEAK_DISPLACEMENT, lane)
        p[PEAK_VELOCITY * WIDTH + lane] = top_v if moves else at(p, PEAK_VELOCITY, lane)
        p[PEAK_SHEAR * WIDTH + lane] = shear if moves else at(p, PEAK_SHEAR, lane)
        p[PEAK_BRACE * WIDTH + lane] = top_b if moves else at(p, PEAK_BRACE, lane)
        p[FROM_D * WIDTH + lane] = d if slips else at(p, FROM_D, lane)
        p[FROM_E * WIDTH + lane] = e if slips else at(p, FROM_E, lane)
        p[BOUND_B * WIDTH + lane] = bound_b if slips else at(p, BOUND_B, lane)
        p[INPUT * WIDTH + lane] -= work if moves else 0.0
        p[BOUND_U * WIDTH + lane] = bound_u if slips else at(p, BOUND_U, lane)
        p[BOUND_V * WIDTH + lane] = bound_v if slips else at(p, BOUND_V, lane)
        p[BOUND_Q * WIDTH + lane] = bound_q if slips else at(p, BOUND_Q, lane)
        p[BOUND_S * WIDTH + lane] = bound_s if slips else at(p, BOUND_S, lane)
    return eventful, to_defer


@inner
def stick_losses(p, ground, rate, eventful):
    """Add the viscous work of this step to the sticking lanes for which it is uneventful."""
    wide()
    for lane in range(WIDTH):
        p0 = at(p, LIFT, lane) * at(p, OFFSET, lane) - ground
        loss = form(p, S_LOSS, lane, at(p, FROM_U, lane), at(p, FROM_V, lane), p0, -rate)
        taken = (at(p, PHASE, lane) == 0.0) & (eventful >> lane & 1 == 0)
        p[VISCOUS * WIDTH + lane] += at(p, S_DAMP, lane) * loss if taken else 0.0


@inner
def slip_losses(p, ground, rate, eventful):
    """The same for the slipping lanes."""
    wide()
    for lane in range(WIDTH):
        sign = at(p, PHASE, lane)
        p0 = sliding_force(-sign, at(p, PUSH_FLOOR, lane)) - ground
        loss = form(p, F_LOSS, lane, at(p, FROM_U, lane), at(p, FROM_V, lane), p0, -rate)
        taken = (sign != 0.0) & (eventful >> lane & 1 == 0)
        p[VISCOUS * WIDTH + lane] += at(p, F_DAMP, lane) * loss if taken else 0.0
