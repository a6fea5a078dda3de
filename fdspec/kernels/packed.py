"""Many histories side by side: the same arithmetic on neighbouring numbers, one lane a history.

Grid points are independent, so WIDTH of them advance together through the steps in which nothing
happens to them, in one loop without a branch, which the compiler turns into vector instructions.
State and constants stand in one packed array, row r of lane l at r * WIDTH + l: with several arrays
the compiler could not prove that a store leaves the other loads alone.  Bounds decide lane by lane
whether a step is quiet; a lane that is not walks this step by itself.

While sticking a step is one whole piece, and the bounds are those of the walk.  While slipping the
brace may ring many radians in a step: it swings about its quasi-static motion with an amplitude that
does not grow, so the slowest sliding is at least the floor's slowest less that swing, and a floor
that slides faster cannot be caught.
"""

from __future__ import annotations

import math

from fdspec.jit import inlined, inner
from fdspec.kernels.energy import STICK_FORM, STRIDE_FORM
from fdspec.kernels.roots import TAIL, THIRD
from fdspec.kernels.shelf import STICK_MAP
from fdspec.kernels.types import (
    INPUT,
    KICK,
    N_STATE,
    NO_KICK,
    OFFSET,
    PEAK_ACCELERATION,
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

WIDTH = 16
"""Histories side by side: two registers of AVX-512, four of AVX2, so that one hides another's latency."""

# Rows behind the state: where a step would lead, and whether a lane must walk it.
_AT = N_STATE
END_U, END_V, END_D, END_E, END_A, END_X, END_W, END_S, END_INPUT, END_VISCOUS = range(_AT, _AT + 10)
_AT += 10
ALERT, CREST, CREST_U, CREST_V, CREST_Q, CREST_S, HELD = range(_AT, _AT + 7)
_AT += 7
# Constants of the storey.
LIMIT, PUSH_FLOOR, PUSH_BRACE, LIFT, MASS, FLOOR_MASS, BRACE_MASS, LIGHT, MUST_WALK = range(_AT, _AT + 9)
_AT += 9
# Floor and brace as one: rates, weights in the bound on free motion, and that bound's weights.
S_G, S_W2, S_DRIFT, S_SLOW, S_TAIL_U, S_TAIL_V, S_TAIL_Q = range(_AT, _AT + 7)
_AT += 7
HOLD_U, HOLD_V, HOLD_O, HOLD_TAIL = range(_AT, _AT + 4)
_AT += 4
# The floor alone, and the brace alone.
F_G, F_W2, F_DRIFT, F_SLOW, F_TAIL_U, F_TAIL_V, F_TAIL_Q = range(_AT, _AT + 7)
_AT += 7
B_G, B_W2, B_DRIFT, B_SLOW, B_OMEGA, B_GROUND, B_TAIL_E, B_TAIL_Q = range(_AT, _AT + 8)
_AT += 8
# Step maps, twelve rows each, and quadratic forms of the viscous work, ten rows each.
S_MAP, F_MAP, B_MAP, S_LOSS, F_LOSS = _AT, _AT + 12, _AT + 24, _AT + 36, _AT + 46
_AT += 56
S_DAMP, F_DAMP = _AT, _AT + 1
N_ROWS = _AT + 2


@inlined
def at(p, row, lane):
    """The number of a lane in a row."""
    return p[row * WIDTH + lane]


@inlined
def carry(p, row, lane, x, v, p0, rate):
    """A linear form (four rows) in displacement, velocity, force over mass and minus its rate."""
    return (
        at(p, row, lane) * x
        + at(p, row + 1, lane) * v
        + (at(p, row + 2, lane) * p0 - at(p, row + 3, lane) * rate)
    )


@inlined
def form(p, row, lane, x, v, p0, p1):
    """A quadratic form (ten rows) in displacement, velocity, force over mass and its rate."""
    return (
        x
        * (
            at(p, row, lane) * x
            + at(p, row + 1, lane) * v
            + (at(p, row + 2, lane) * p0 + at(p, row + 3, lane) * p1)
        )
        + v * (at(p, row + 4, lane) * v + at(p, row + 5, lane) * p0 + at(p, row + 6, lane) * p1)
        + p0 * (at(p, row + 7, lane) * p0 + at(p, row + 8, lane) * p1)
        + at(p, row + 9, lane) * p1 * p1
    )


@inner
def put_branch(p, row, lane, branch, h):
    """Store an oscillator that carries the floor: seven rows."""
    theta = branch.rate * h
    fourth = TAIL * theta * theta * theta
    p[row * WIDTH + lane] = branch.g
    p[(row + 1) * WIDTH + lane] = branch.w2
    p[(row + 2) * WIDTH + lane] = branch.drift
    p[(row + 3) * WIDTH + lane] = branch.slowness
    p[(row + 4) * WIDTH + lane] = fourth * h
    p[(row + 5) * WIDTH + lane] = fourth * theta
    p[(row + 6) * WIDTH + lane] = fourth * (branch.g * theta + branch.w2 * h)


@inner
def put_lane(p, lane, plan, shelf, forms, stride, certify):
    """Store the constants of a plan: those it holds, and what bounds over a whole step weigh them with.

    shelf, forms, stride: the rows of the plan, of its losses, and of the maps of floor and brace over
    a whole step.
    """
    storey = plan.storey
    sliding = storey.kinetic_slip_force if storey.slip_force < math.inf else 0.0
    massive = storey.brace_mass > 0.0
    p[LIMIT * WIDTH + lane] = storey.slip_force
    p[PUSH_FLOOR * WIDTH + lane] = sliding / storey.floor_mass
    p[PUSH_BRACE * WIDTH + lane] = sliding / storey.brace_mass if massive else 0.0
    p[LIFT * WIDTH + lane] = plan.lift
    p[MASS * WIDTH + lane] = plan.mass
    p[FLOOR_MASS * WIDTH + lane] = storey.floor_mass
    p[BRACE_MASS * WIDTH + lane] = storey.brace_mass
    p[LIGHT * WIDTH + lane] = 1.0 / plan.mass
    # A loose brace has no quasi-static motion; a damped one's losses are not tallied a step at a time.
    loose = massive and storey.brace_stiffness == 0.0
    p[MUST_WALK * WIDTH + lane] = 1.0 if loose or (certify and storey.brace_damping > 0.0) else 0.0
    put_branch(p, S_G, lane, plan.stick, plan.step)
    put_branch(p, F_G, lane, plan.floor, plan.step)
    tail_u, tail_v = at(p, S_TAIL_U, lane), at(p, S_TAIL_V, lane)
    p[HOLD_U * WIDTH + lane] = plan.hold_u
    p[HOLD_V * WIDTH + lane] = plan.hold_v
    p[HOLD_O * WIDTH + lane] = plan.hold_offset
    p[HOLD_TAIL * WIDTH + lane] = abs(plan.hold_u) * tail_u + abs(plan.hold_v) * tail_v
    brace = plan.brace
    p[B_G * WIDTH + lane] = brace.g
    p[B_W2 * WIDTH + lane] = brace.w2
    p[B_DRIFT * WIDTH + lane] = brace.drift
    p[B_SLOW * WIDTH + lane] = brace.slowness if massive else 0.0
    p[B_OMEGA * WIDTH + lane] = math.sqrt(brace.w2) if massive else 0.0
    p[B_GROUND * WIDTH + lane] = 1.0 if massive else 0.0
    phi = brace.rate * plan.step
    p[B_TAIL_E * WIDTH + lane] = TAIL * phi * phi * phi * phi
    p[B_TAIL_Q * WIDTH + lane] = TAIL * phi * phi * phi * phi * brace.rate
    p[S_DAMP * WIDTH + lane] = storey.floor_damping + storey.brace_damping
    p[F_DAMP * WIDTH + lane] = storey.floor_damping
    p[HELD * WIDTH + lane] = 0.0
    for k in range(12):
        p[(S_MAP + k) * WIDTH + lane] = shelf[STICK_MAP + k]
        p[(F_MAP + k) * WIDTH + lane] = stride[k]
        p[(B_MAP + k) * WIDTH + lane] = stride[12 + k]
    for k in range(10):
        double = 1.0 if k in (0, 4, 7, 9) else 2.0  # off the diagonal of the quadratic form
        p[(S_LOSS + k) * WIDTH + lane] = forms[STICK_FORM + k] * double
        p[(F_LOSS + k) * WIDTH + lane] = forms[STRIDE_FORM + k] * double


@inner
def start_lane(p, lane):
    """Set a lane to rest at t = 0; a damper without friction slides from the start."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = 0.0
    p[KICK * WIDTH + lane] = NO_KICK
    p[PHASE * WIDTH + lane] = 1.0 if at(p, LIMIT, lane) == 0.0 else 0.0


@inner
def rest_lane(p, lane):
    """Make a lane quiet for good: sticking, no slip force to reach, no peak to pass."""
    p[LIMIT * WIDTH + lane] = math.inf
    start_lane(p, lane)
    for row in range(PEAK_ACCELERATION, PEAK_SHEAR + 1):
        p[row * WIDTH + lane] = math.inf


@inner
def put_state(p, lane, s):
    """Store a history's state in its lane."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = s[row]


@inner
def take_state(p, lane, s):
    """Take a history's state from its lane."""
    for row in range(N_STATE):
        s[row] = p[row * WIDTH + lane]


@inner
def stick_lanes(p, h, ground, rate):
    """Advance every lane by a step as if it stuck; ALERT where it may slip, CREST where a peak may pass.

    HELD keeps the largest reaction for which the bounds leave room: above it no slip force is reached.
    """
    third = h * THIRD
    ground_end = ground + rate * h
    steep = abs(rate)
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
        q0 = base - g * v - w2 * u
        q1 = base - g * v1 - w2 * u1
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = abs(v) + steep * at(p, S_DRIFT, lane) + abs(a0) * at(p, S_SLOW, lane)

        hold_u = at(p, HOLD_U, lane)
        hold_v = at(p, HOLD_V, lane)
        locked = at(p, HOLD_O, lane) * offset
        r0 = hold_u * u + hold_v * v - locked
        r1 = hold_u * u1 + hold_v * v1 - locked
        rise0 = third * (hold_u * v + hold_v * a0)
        rise1 = third * (hold_u * v1 + hold_v * a1)
        held = max(abs(r0 + rise0), abs(r1 - rise1)) + swing * at(p, HOLD_TAIL, lane)
        held = max(max(abs(r0), abs(r1)), held)

        top_a = max(at(p, PEAK_ACCELERATION, lane), abs(q1))
        top_s = max(at(p, PEAK_SHEAR, lane), at(p, MASS, lane) * abs(q1))
        top_u = max(at(p, PEAK_DISPLACEMENT, lane), abs(u1))
        top_v = max(at(p, PEAK_VELOCITY, lane), abs(v1))
        crest_u = max(abs(u + third * v), abs(u1 - third * v1)) + swing * at(p, S_TAIL_U, lane)
        crest_v = max(abs(v + third * a0), abs(v1 - third * a1)) + swing * at(p, S_TAIL_V, lane)
        crest_q = max(abs(q0 - third * (g * a0 + w2 * v)), abs(q1 + third * (g * a1 + w2 * v1)))
        crest_q += swing * at(p, S_TAIL_Q, lane)
        alert = abs(at(p, TOUCHING, lane))
        alert += 1.0 if held >= at(p, LIMIT, lane) else 0.0
        peak = 1.0 if crest_q > min(top_a, top_s * at(p, LIGHT, lane)) else 0.0
        peak += 1.0 if crest_u > top_u else 0.0
        peak += 1.0 if crest_v > top_v else 0.0
        p[END_U * WIDTH + lane] = u1
        p[END_V * WIDTH + lane] = v1
        p[END_D * WIDTH + lane] = u1 - offset
        p[END_E * WIDTH + lane] = v1
        p[END_A * WIDTH + lane] = top_a
        p[END_X * WIDTH + lane] = top_u
        p[END_W * WIDTH + lane] = top_v
        p[END_S * WIDTH + lane] = top_s
        p[ALERT * WIDTH + lane] = alert
        p[CREST * WIDTH + lane] = peak
        p[CREST_U * WIDTH + lane] = crest_u
        p[CREST_V * WIDTH + lane] = crest_v
        p[CREST_Q * WIDTH + lane] = crest_q
        p[CREST_S * WIDTH + lane] = at(p, MASS, lane) * crest_q
        p[HELD * WIDTH + lane] = max(at(p, HELD, lane), held)


@inner
def slip_lanes(p, h, ground, rate):
    """Advance every slipping lane by a step; ALERT where it may stop, CREST where a peak may pass."""
    third = h * THIRD
    ground_end = ground + rate * h
    steep = abs(rate)
    shake = max(abs(ground), abs(ground_end))
    for lane in range(WIDTH):
        sign = at(p, PHASE, lane)
        slips = sign != 0.0
        u = at(p, U, lane)
        v = at(p, V, lane)
        d = at(p, D, lane)
        e = at(p, E, lane)
        g = at(p, F_G, lane)
        w2 = at(p, F_W2, lane)
        solid = at(p, B_GROUND, lane)
        base = -sign * at(p, PUSH_FLOOR, lane)
        p0 = base - ground
        b0 = sign * at(p, PUSH_BRACE, lane) - solid * ground
        b1 = solid * rate
        u1 = carry(p, F_MAP, lane, u, v, p0, rate)
        v1 = carry(p, F_MAP + 4, lane, u, v, p0, rate)
        d1 = carry(p, B_MAP, lane, d, e, b0, b1)
        e1 = carry(p, B_MAP + 4, lane, d, e, b0, b1)
        q0 = base - g * v - w2 * u
        q1 = base - g * v1 - w2 * u1
        a0 = q0 - ground
        a1 = q1 - ground_end
        swing = abs(v) + steep * at(p, F_DRIFT, lane) + abs(a0) * at(p, F_SLOW, lane)

        drift = -b1 * at(p, B_DRIFT, lane)
        g_b = at(p, B_G, lane)
        w2_b = at(p, B_W2, lane)
        c0 = b0 - g_b * e - w2_b * d
        c1 = b0 - b1 * h - g_b * e1 - w2_b * d1
        ring_v = e - drift
        ring_a = c0 * at(p, B_SLOW, lane)
        ring = math.sqrt(ring_v * ring_v + ring_a * ring_a)
        tail_v = swing * at(p, F_TAIL_V, lane)
        inside = min(sign * (v + third * a0), sign * (v1 - third * a1)) - tail_v
        slowest = min(min(sign * v, sign * v1), inside) - (sign * drift + ring)
        w0 = sign * (v - e)
        w1 = sign * (v1 - e1)
        inside = min(w0 + sign * third * (a0 - c0), w1 - sign * third * (a1 - c1))
        inside -= tail_v + ring * at(p, B_TAIL_E, lane)
        slowest = max(slowest, min(min(w0, w1), inside))

        top_a = max(at(p, PEAK_ACCELERATION, lane), abs(q1))
        top_u = max(at(p, PEAK_DISPLACEMENT, lane), abs(u1))
        top_v = max(at(p, PEAK_VELOCITY, lane), abs(v1))
        crest_u = max(abs(u + third * v), abs(u1 - third * v1)) + swing * at(p, F_TAIL_U, lane)
        crest_v = max(abs(v + third * a0), abs(v1 - third * a1)) + tail_v
        crest_q = max(abs(q0 - third * (g * a0 + w2 * v)), abs(q1 + third * (g * a1 + w2 * v1)))
        crest_q += swing * at(p, F_TAIL_Q, lane)
        # Base shear is the inertia of both masses; the brace itself accelerates at most by ring times omega.
        m = at(p, FLOOR_MASS, lane)
        m_b = at(p, BRACE_MASS, lane)
        s0 = m * q0 + m_b * (c0 + ground)
        s1 = m * q1 + m_b * (c1 + ground_end)
        rise0 = third * (m * (g * a0 + w2 * v) + m_b * (g_b * c0 + w2_b * e))
        rise1 = third * (m * (g * a1 + w2 * v1) + m_b * (g_b * c1 + w2_b * e1))
        inside = max(abs(s0 - rise0), abs(s1 + rise1))
        inside += m * swing * at(p, F_TAIL_Q, lane) + m_b * ring * at(p, B_TAIL_Q, lane)
        crest_s = m * max(max(abs(q0), abs(q1)), crest_q) + m_b * (ring * at(p, B_OMEGA, lane) + shake)
        crest_s = min(crest_s, max(max(abs(s0), abs(s1)), inside))
        shear = max(at(p, PEAK_SHEAR, lane), abs(s1))
        alert = at(p, MUST_WALK, lane)
        alert += 1.0 if at(p, KICK, lane) >= 0.0 else 0.0
        alert += 1.0 if slowest <= 0.0 else 0.0
        alert += 1.0 if crest_s > shear else 0.0
        peak = 1.0 if crest_q > top_a else 0.0
        peak += 1.0 if crest_u > top_u else 0.0
        peak += 1.0 if crest_v > top_v else 0.0
        p[END_U * WIDTH + lane] = u1 if slips else at(p, END_U, lane)
        p[END_V * WIDTH + lane] = v1 if slips else at(p, END_V, lane)
        p[END_D * WIDTH + lane] = d1 if slips else at(p, END_D, lane)
        p[END_E * WIDTH + lane] = e1 if slips else at(p, END_E, lane)
        p[END_A * WIDTH + lane] = top_a if slips else at(p, END_A, lane)
        p[END_X * WIDTH + lane] = top_u if slips else at(p, END_X, lane)
        p[END_W * WIDTH + lane] = top_v if slips else at(p, END_W, lane)
        p[END_S * WIDTH + lane] = shear if slips else at(p, END_S, lane)
        p[ALERT * WIDTH + lane] = alert if slips else at(p, ALERT, lane)
        p[CREST * WIDTH + lane] = peak if slips else at(p, CREST, lane)
        p[CREST_U * WIDTH + lane] = crest_u if slips else at(p, CREST_U, lane)
        p[CREST_V * WIDTH + lane] = crest_v if slips else at(p, CREST_V, lane)
        p[CREST_Q * WIDTH + lane] = crest_q if slips else at(p, CREST_Q, lane)
        p[CREST_S * WIDTH + lane] = crest_s if slips else at(p, CREST_S, lane)


@inner
def work_lanes(p, h, ground, rate):
    """Work of the ground up to the end of a quiet step."""
    for lane in range(WIDTH):
        sign = at(p, PHASE, lane)
        u = at(p, U, lane)
        v = at(p, V, lane)
        d = at(p, D, lane)
        u1 = at(p, END_U, lane)
        d1 = at(p, END_D, lane)
        solid = at(p, B_GROUND, lane)
        p0 = at(p, LIFT, lane) * at(p, OFFSET, lane) - ground
        f0 = -sign * at(p, PUSH_FLOOR, lane) - ground
        b0 = sign * at(p, PUSH_BRACE, lane) - solid * ground
        both_area = carry(p, S_MAP + 8, lane, u, v, p0, rate)
        floor_area = carry(p, F_MAP + 8, lane, u, v, f0, rate)
        brace_area = carry(p, B_MAP + 8, lane, d, at(p, E, lane), b0, solid * rate)
        moved = ground * (u1 - u)
        one = at(p, MASS, lane) * (moved + rate * (h * u1 - both_area))
        two = at(p, FLOOR_MASS, lane) * (moved + rate * (h * u1 - floor_area))
        two += at(p, BRACE_MASS, lane) * (ground * (d1 - d) + rate * (h * d1 - brace_area))
        p[END_INPUT * WIDTH + lane] = at(p, INPUT, lane) - (two if sign != 0.0 else one)


@inner
def loss_lanes(p, ground, rate):
    """Viscous work up to the end of a quiet step."""
    for lane in range(WIDTH):
        sign = at(p, PHASE, lane)
        u = at(p, U, lane)
        v = at(p, V, lane)
        p0 = at(p, LIFT, lane) * at(p, OFFSET, lane) - ground
        f0 = -sign * at(p, PUSH_FLOOR, lane) - ground
        one = at(p, S_DAMP, lane) * form(p, S_LOSS, lane, u, v, p0, -rate)
        two = at(p, F_DAMP, lane) * form(p, F_LOSS, lane, u, v, f0, -rate)
        p[END_VISCOUS * WIDTH + lane] = at(p, VISCOUS, lane) + (two if sign != 0.0 else one)


@inner
def alerted(p):
    """Lanes to look at in this step, a bit for each: to walk, and to keep for their peaks."""
    to_walk = 0  # integers: sums of floats would be taken one by one, in order
    to_keep = 0
    for lane in range(WIDTH):
        to_walk |= (1 << lane) if at(p, ALERT, lane) > 0.0 else 0
        to_keep |= (1 << lane) if at(p, CREST, lane) > 0.0 else 0
    return to_walk, to_keep


@inlined
def is_calm(p, lane, s):
    """Whether a step passes none of the peaks in the state ``s``, unless the phase changes on it."""
    return (
        at(p, CREST_Q, lane) <= s[PEAK_ACCELERATION]
        and at(p, CREST_U, lane) <= s[PEAK_DISPLACEMENT]
        and at(p, CREST_V, lane) <= s[PEAK_VELOCITY]
        and at(p, CREST_S, lane) <= s[PEAK_SHEAR]
    )


@inner
def accept_lanes(p, energy, certify):
    """Move every lane to the end of the step; those that walk are set again from their own state."""
    for lane in range(WIDTH):
        p[U * WIDTH + lane] = at(p, END_U, lane)
        p[V * WIDTH + lane] = at(p, END_V, lane)
        p[D * WIDTH + lane] = at(p, END_D, lane)
        p[E * WIDTH + lane] = at(p, END_E, lane)
        p[PEAK_ACCELERATION * WIDTH + lane] = at(p, END_A, lane)
        p[PEAK_DISPLACEMENT * WIDTH + lane] = at(p, END_X, lane)
        p[PEAK_VELOCITY * WIDTH + lane] = at(p, END_W, lane)
        p[PEAK_SHEAR * WIDTH + lane] = at(p, END_S, lane)
    if energy:
        for lane in range(WIDTH):
            p[INPUT * WIDTH + lane] = at(p, END_INPUT, lane)
    if certify:
        for lane in range(WIDTH):
            p[VISCOUS * WIDTH + lane] = at(p, END_VISCOUS, lane)
