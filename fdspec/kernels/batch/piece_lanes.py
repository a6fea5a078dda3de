"""The next piece of many histories at once: its end, what happens on it, and where.

Every lane has one piece before it, of stick or of slip, whole or begun within the step.  The loops carry all
lanes to the ends of their pieces, judge them by the rules that `fdspec.kernels.storey.segment` follows for
one, and lead those whose phase changes to the instant.
"""

from __future__ import annotations

from fdspec.compiler.options import fma, inlined, inner, wide
from fdspec.kernels.batch.layout import (
    BEGIN,
    BEGIN_RISE,
    CROSSING,
    END_D,
    END_E,
    END_U,
    END_V,
    FINISH,
    FINISH_RISE,
    FORCE_B,
    FORCE_P,
    GROUND,
    HIGH,
    LENGTH,
    LOW,
    ON_WAY,
    PART,
    SEEKS,
    SHARE,
    SIDE,
    SWEPT,
    SWUNG,
    TAU,
    TRIAL,
    WHOLE,
    WIDTH,
    at,
)
from fdspec.kernels.batch.way import end_in, force_in, motion_in, plan_in, way
from fdspec.kernels.mathematics.oscillator import advance, ahead_in_lane, area, undamped_ahead
from fdspec.kernels.mathematics.zero_crossing import (
    CLEAR,
    CROSSES,
    NEAR,
    SETTLED,
    UNCLEAR,
    Course,
    Fall,
    dip_verdict,
    fall_of,
    guess,
    nearby,
    rates_of,
    step_to_zero,
    verdict,
)
from fdspec.kernels.storey.bounds import forcing, ground_at
from fdspec.kernels.storey.slip import slide_rates, slip_course
from fdspec.kernels.storey.stick import gap_rates, stick_course
from fdspec.kernels.types import KICK, OFFSET, PHASE, Motion


@inner
def take_whole(p, a0, rate):
    """Lay out every lane's next piece, and carry it to its end as if it were whole.

    Returns the lanes whose piece is no whole one, and those that stick.
    """
    wide()
    parts = 0
    holding = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        phase = way(p, PHASE, lane)
        sticks = phase == 0.0
        part = at(p, PART, lane)
        tau = at(p, TAU, lane)
        last = sticks | (part + 1.0 == plan.slip_steps)
        h = (plan.step if last else (part + 1.0) * plan.slip_step) - tau
        ground = ground_at(a0, rate, tau)
        offset = way(p, OFFSET, lane)
        force = forcing(plan, phase, offset, ground, rate)
        motion = motion_in(p, lane)
        one = advance(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
        two = advance(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
        brace = advance(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
        one_area = area(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
        two_area = area(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
        brace_area = area(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
        u = one[0] if sticks else two[0]
        v = one[1] if sticks else two[1]
        walks = at(p, ON_WAY, lane) != 0.0
        parts |= (1 << lane) if walks & (at(p, WHOLE, lane) == 0.0) else 0
        holding |= (1 << lane) if walks & sticks else 0
        p[LENGTH * WIDTH + lane] = h
        p[GROUND * WIDTH + lane] = ground
        p[FORCE_P * WIDTH + lane] = force.p0
        p[FORCE_B * WIDTH + lane] = force.b0
        p[END_U * WIDTH + lane] = u
        p[END_V * WIDTH + lane] = v
        p[END_D * WIDTH + lane] = u - offset if sticks else brace[0]
        p[END_E * WIDTH + lane] = v if sticks else brace[1]
        p[SWEPT * WIDTH + lane] = one_area if sticks else two_area
        p[SWUNG * WIDTH + lane] = 0.0 if sticks else brace_area
    return parts, holding


@inlined
def motion_at(p, rate, lane, t):
    """Motion of a lane at the time t of its piece, and the integrals of both displacements until there."""
    plan = plan_in(p, lane)
    sticks = way(p, PHASE, lane) == 0.0
    motion = motion_in(p, lane)
    force = force_in(p, rate, lane)
    g = plan.stick.g if sticks else plan.floor.g
    w2 = plan.stick.w2 if sticks else plan.floor.w2
    order = plan.stick_order if sticks else plan.floor_order
    u, v, swept = ahead_in_lane(motion.u, motion.v, g, w2, force.p0, force.p1, t, order)
    d, e, swung = undamped_ahead(
        motion.d, motion.e, plan.brace.rate, plan.brace.slowness, force.b0, force.b1, t
    )
    d = u - way(p, OFFSET, lane) if sticks else d
    e = v if sticks else e
    return Motion(u, v, d, e), swept, 0.0 if sticks else swung


@inner
def take_parts(p, rate):
    """Carry the lanes to their piece's end whose piece is no whole one."""
    wide()
    for lane in range(WIDTH):
        whole = at(p, WHOLE, lane) != 0.0
        end, swept, swung = motion_at(p, rate, lane, at(p, LENGTH, lane))
        p[END_U * WIDTH + lane] = at(p, END_U, lane) if whole else end.u
        p[END_V * WIDTH + lane] = at(p, END_V, lane) if whole else end.v
        p[END_D * WIDTH + lane] = at(p, END_D, lane) if whole else end.d
        p[END_E * WIDTH + lane] = at(p, END_E, lane) if whole else end.e
        p[SWEPT * WIDTH + lane] = at(p, SWEPT, lane) if whole else swept
        p[SWUNG * WIDTH + lane] = at(p, SWUNG, lane) if whole else swung


@inlined
def note(p, lane, mine, crosses, side, fall):
    """Put down for lanes of one phase whether they cross, and between what."""
    p[CROSSING * WIDTH + lane] = (1.0 if crosses else 0.0) if mine else at(p, CROSSING, lane)
    p[SIDE * WIDTH + lane] = side if mine else at(p, SIDE, lane)
    p[BEGIN * WIDTH + lane] = fall.start if mine else at(p, BEGIN, lane)
    p[BEGIN_RISE * WIDTH + lane] = fall.start_rise if mine else at(p, BEGIN_RISE, lane)
    p[FINISH * WIDTH + lane] = fall.end if mine else at(p, FINISH, lane)
    p[FINISH_RISE * WIDTH + lane] = fall.end_rise if mine else at(p, FINISH_RISE, lane)
    p[SHARE * WIDTH + lane] = fall.share if mine else at(p, SHARE, lane)


@inner
def judge_stick(p, rate):
    """Find out what happens in the lanes that stick; return those whose phase changes, and those in doubt."""
    wide()
    seeks = 0
    doubts = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        sticks = way(p, PHASE, lane) == 0.0
        start, end = motion_in(p, lane), end_in(p, lane)
        force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
        course, side, one_sided = stick_course(plan, start, end, force, way(p, OFFSET, lane), h)
        found = verdict(course) if one_sided else UNCLEAR
        mine = sticks & (at(p, ON_WAY, lane) != 0.0)
        seeks |= (1 << lane) if mine & (found == CROSSES) else 0
        doubts |= (1 << lane) if mine & (found == UNCLEAR) else 0
        note(p, lane, sticks, found == CROSSES, side, fall_of(course))
    return seeks, doubts


@inner
def judge_slip(p, rate):
    """Find out what happens in the lanes that slip; return those whose phase changes, and those in doubt."""
    wide()
    seeks = 0
    doubts = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        phase = way(p, PHASE, lane)
        slips = phase != 0.0
        start, end = motion_in(p, lane), end_in(p, lane)
        force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
        kick = way(p, KICK, lane)
        course, leaves = slip_course(plan, start, end, force, phase, kick, h)
        begins = CLEAR if leaves else UNCLEAR
        found = begins if kick >= 0.0 else verdict(course)
        mine = slips & (at(p, ON_WAY, lane) != 0.0)
        seeks |= (1 << lane) if mine & (found == CROSSES) else 0
        doubts |= (1 << lane) if mine & (found == UNCLEAR) else 0
        note(p, lane, slips, found == CROSSES, phase, fall_of(course))
    return seeks, doubts


@inlined
def either(first, one, other):
    """One course or the other, number by number, which lanes can do."""
    return Course(
        one.start if first else other.start,
        one.start_rise if first else other.start_rise,
        one.start_bend if first else other.start_bend,
        one.end if first else other.end,
        one.end_rise if first else other.end_rise,
        one.end_bend if first else other.end_bend,
        one.fourth if first else other.fourth,
        one.fifth if first else other.fifth,
    )


@inner
def look_closer(p, rate, doubts):
    """Judge lanes in doubt by the bottoms of their dips; return those that cross, and those left in doubt."""
    wide()
    seeks = 0
    lost = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        phase = way(p, PHASE, lane)
        start, end = motion_in(p, lane), end_in(p, lane)
        force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
        kick = way(p, KICK, lane)
        sticks = phase == 0.0
        gap, side, one_sided = stick_course(plan, start, end, force, way(p, OFFSET, lane), h)
        slide, _ = slip_course(plan, start, end, force, phase, kick, h)
        found, fall = dip_verdict(either(sticks, gap, slide))
        found = found if (one_sided if sticks else kick < 0.0) else UNCLEAR
        mine = (doubts >> lane & 1) != 0
        seeks |= (1 << lane) if mine & (found == CROSSES) else 0
        lost |= (1 << lane) if mine & (found == UNCLEAR) else 0
        note(p, lane, mine, found == CROSSES, side if sticks else phase, fall)
    return seeks, lost


@inner
def aim(p):
    """Guess where the lanes cross."""
    wide()
    for lane in range(WIDTH):
        h = at(p, LENGTH, lane)
        fall = Fall(
            at(p, BEGIN, lane),
            at(p, BEGIN_RISE, lane),
            at(p, FINISH, lane),
            at(p, FINISH_RISE, lane),
            at(p, SHARE, lane),
        )
        p[TRIAL * WIDTH + lane] = h * guess(fall)
        p[LOW * WIDTH + lane] = 0.0
        p[HIGH * WIDTH + lane] = h * fall.share
        p[SEEKS * WIDTH + lane] = at(p, CROSSING, lane) * at(p, ON_WAY, lane)


@inner
def approach(p, rate):
    """Step closer to the change of phase in the lanes that seek one; return those that still do."""
    wide()
    seeks = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        phase = way(p, PHASE, lane)
        sticks = phase == 0.0
        force = force_in(p, rate, lane)
        t = at(p, TRIAL, lane)
        motion, swept, swung = motion_at(p, rate, lane, t)
        offset = way(p, OFFSET, lane)
        side = at(p, SIDE, lane)
        g = plan.stick.g if sticks else plan.floor.g
        w2 = plan.stick.w2 if sticks else plan.floor.w2
        pace = plan.stick.rate if sticks else max(plan.floor.rate, plan.brace.rate)
        r = rates_of(motion.u, motion.v, g, w2, fma(force.p1, t, force.p0), force.p1)
        q = rates_of(motion.d, motion.e, 0.0, plan.brace.w2, fma(force.b1, t, force.b0), force.b1)
        gap = gap_rates(plan, r, offset, side)
        slide = slide_rates(r, q, phase)
        y = gap[0] if sticks else slide[0]
        y1 = gap[1] if sticks else slide[1]
        y2 = gap[2] if sticks else slide[2]
        y3 = gap[3] if sticks else slide[3]
        y4 = gap[4] if sticks else slide[4]
        later, last = step_to_zero(y, y1, y2, y3, y4)
        above = y > 0.0
        low = t if above else at(p, LOW, lane)
        high = at(p, HIGH, lane) if above else t
        inside = (low <= t + later) & (t + later <= high)
        settles = inside & (pace * abs(later) <= NEAR) & (pace * last <= SETTLED)
        u, v, more = nearby(r, later)
        d, e, swing_more = nearby(q, later)
        seeking = at(p, SEEKS, lane) != 0.0
        here = seeking & settles
        goes_on = seeking & (not settles)
        seeks |= (1 << lane) if goes_on else 0
        p[SEEKS * WIDTH + lane] = 1.0 if goes_on else 0.0
        p[LOW * WIDTH + lane] = low
        p[HIGH * WIDTH + lane] = high
        p[TRIAL * WIDTH + lane] = t + later if inside else 0.5 * (low + high)
        p[LENGTH * WIDTH + lane] = t + later if here else at(p, LENGTH, lane)
        p[END_U * WIDTH + lane] = u if here else at(p, END_U, lane)
        p[END_V * WIDTH + lane] = v if here else at(p, END_V, lane)
        p[END_D * WIDTH + lane] = (u - offset if sticks else d) if here else at(p, END_D, lane)
        p[END_E * WIDTH + lane] = (v if sticks else e) if here else at(p, END_E, lane)
        p[SWEPT * WIDTH + lane] = swept + more if here else at(p, SWEPT, lane)
        p[SWUNG * WIDTH + lane] = (0.0 if sticks else swung + swing_more) if here else at(p, SWUNG, lane)
    return seeks
