"""One step of many histories at once in which their phases change.

Neighbours on a fine grid slip and stop on the same steps.  What `storey/step.py` does piece by piece
for one history is done here for all lanes that need it: the same rules on the same numbers, so that a
history keeps its bits whichever way it goes, with a choice between two results where the walk has a
branch.  A lane in which anything rare happens, a change of phase that must be searched for, say, is handed
back untouched, to walk by itself.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.batch.layout import (
    CALM,
    CROSSING,
    GROUND,
    LENGTH,
    ON_WAY,
    PART,
    SIDE,
    SWEPT,
    SWUNG,
    TAU,
    WAY,
    WHOLE,
    WIDTH,
    at,
)
from fdspec.kernels.batch.piece_lanes import (
    aim,
    approach,
    judge_slip,
    judge_stick,
    look_closer,
    take_parts,
    take_whole,
)
from fdspec.kernels.batch.shelf import take_plan
from fdspec.kernels.batch.way import (
    bring_back,
    end_in,
    force_in,
    keep_on,
    motion_in,
    peaks_in,
    plan_in,
    put_peaks,
    set_out,
    way,
)
from fdspec.kernels.friction import GOES_ON, phase_after_stop, reaction, sliding_kick
from fdspec.kernels.storey.bounds import floor_bounds
from fdspec.kernels.storey.energy import input_work
from fdspec.kernels.storey.slip import shear_bounds, slip_peaks
from fdspec.kernels.storey.step import with_instant
from fdspec.kernels.storey.stick import stick_peaks
from fdspec.kernels.types import (
    ANCHOR,
    EVENTS,
    INPUT,
    KICK,
    NO_KICK,
    OFFSET,
    PHASE,
    STICK,
    TRANSITION_CAP,
    TRANSITIONS,
    TRAVEL,
    D,
    E,
    Motion,
    Peaks,
    U,
    V,
)

ROUNDS = 64
"""Pieces of a step after which a lane is handed back: it has many changes, or its brace is very stiff."""

ATTEMPTS = 3
"""Places from which a crossing is looked for before the lane is handed back."""


@inlined
def looks(p, lane):
    """Whether a lane's peaks may grow on its piece."""
    calm = (at(p, CALM, lane) != 0.0) & (at(p, CROSSING, lane) == 0.0)
    return (at(p, ON_WAY, lane) != 0.0) & (not calm)


@inner
def raise_stick(p, rate):
    """Raise the peaks of lanes that stick to their piece's end; return those that may pass one inside."""
    wide()
    doubts = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        base = plan.lift * way(p, OFFSET, lane)
        start, end = motion_in(p, lane), end_in(p, lane)
        force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
        peaks = peaks_in(p, lane)
        top, _, see_u, see_v, see_q = floor_bounds(plan.stick, base, plan.mass, start, end, force, h, peaks)
        mine = looks(p, lane) & (way(p, PHASE, lane) == 0.0)
        sees = see_u | see_v | see_q
        doubts |= (1 << lane) if mine & sees else 0
        put_peaks(p, lane, mine & (not sees), top)
    return doubts


@inner
def raise_slip(p, rate):
    """Raise the peaks of lanes that slip to their piece's end; return those that may pass one inside."""
    wide()
    doubts = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        phase = way(p, PHASE, lane)
        base = -phase * plan.storey.kinetic_slip_force / plan.storey.floor_mass
        start, end = motion_in(p, lane), end_in(p, lane)
        force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
        peaks = peaks_in(p, lane)
        top, _, see_u, see_v, see_q = floor_bounds(plan.floor, base, 0.0, start, end, force, h, peaks)
        shear, see_s, _ = shear_bounds(plan, start, end, force, h, peaks.shear)
        mine = looks(p, lane) & (phase != 0.0)
        sees = see_u | see_v | see_q | see_s
        doubts |= (1 << lane) if mine & sees else 0
        put_peaks(p, lane, mine & (not sees), Peaks(top.acceleration, top.displacement, top.velocity, shear))
    return doubts


@inner
def search_peaks(p, lane, plan, rate, floor, brace, search):
    """Peaks of one lane over its piece, extrema inside included."""
    phase = int(way(p, PHASE, lane))
    start, end = motion_in(p, lane), end_in(p, lane)
    force, h = force_in(p, rate, lane), at(p, LENGTH, lane)
    peaks = peaks_in(p, lane)
    if phase == STICK:
        offset = way(p, OFFSET, lane)
        order = int(plan.stick_order)
        peaks = stick_peaks(plan, floor, search, order, 0.0, start, end, force, offset, h, peaks)
    else:
        order = int(plan.slip_order)
        peaks = slip_peaks(plan, floor, brace, search, order, 0.0, start, end, force, phase, h, peaks)
    put_peaks(p, lane, True, peaks)


@inner
def arrive(p, rate):
    """Move every lane to its piece's end; return those whose step is not over, and those that are lost."""
    wide()
    on_way = 0
    lost = 0
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        sticks = way(p, PHASE, lane) == 0.0
        start, end = motion_in(p, lane), end_in(p, lane)
        h, ground = at(p, LENGTH, lane), at(p, GROUND, lane)
        swept, swung = at(p, SWEPT, lane), at(p, SWUNG, lane)
        held_work = input_work(plan, 0, start, end, swept, swung, ground, rate, h)
        slip_work = input_work(plan, 1, start, end, swept, swung, ground, rate, h)
        happens = at(p, CROSSING, lane) != 0.0
        part = at(p, PART, lane)
        last = sticks | (part + 1.0 == plan.slip_steps)
        target = plan.step if last else (part + 1.0) * plan.slip_step
        to = at(p, TAU, lane) + h if happens else target
        walks = at(p, ON_WAY, lane) != 0.0
        finite = abs(end.u) + abs(end.v) + abs(end.d) + abs(end.e) < math.inf
        lost |= (1 << lane) if walks & (not (finite & (h > 0.0))) else 0
        further = walks & (to < plan.step)
        on_way |= (1 << lane) if further else 0
        calm = (at(p, CALM, lane) != 0.0) & (not happens)
        p[CALM * WIDTH + lane] = 1.0 if calm else 0.0
        p[TAU * WIDTH + lane] = to
        p[PART * WIDTH + lane] = part + 1.0
        p[WHOLE * WIDTH + lane] = 0.0 if happens else 1.0
        p[(WAY + U) * WIDTH + lane] = end.u if walks else start.u
        p[(WAY + V) * WIDTH + lane] = end.v if walks else start.v
        p[(WAY + D) * WIDTH + lane] = end.d if walks else start.d
        p[(WAY + E) * WIDTH + lane] = end.e if walks else start.e
        p[(WAY + KICK) * WIDTH + lane] = NO_KICK if walks else way(p, KICK, lane)
        p[(WAY + INPUT) * WIDTH + lane] += (held_work if sticks else slip_work) if walks else 0.0
    return on_way, lost


@inner
def change(p, lost):
    """Follow the rules where a slip begins, or sliding has come to zero; return the lanes that are lost."""
    wide()
    for lane in range(WIDTH):
        plan = plan_in(p, lane)
        storey = plan.storey
        phase = way(p, PHASE, lane)
        sticks = phase == 0.0
        u, v, d = way(p, U, lane), way(p, V, lane), way(p, D, lane)
        mine = (at(p, CROSSING, lane) != 0.0) & (at(p, ON_WAY, lane) != 0.0)
        side = at(p, SIDE, lane)
        offset, anchor = way(p, OFFSET, lane), way(p, ANCHOR, lane)
        gap = u - d
        slipped = side * (gap - anchor)
        held = reaction(storey, u, v, d)
        after = side if sticks else phase_after_stop(side, held, storey.slip_force)
        holds = after == 0.0
        goes_on = after == GOES_ON
        after = side if goes_on else after
        stops = (not sticks) & (not goes_on)
        kick = sliding_kick(storey, storey.slip_force if sticks else held)
        kick = NO_KICK if holds else kick
        offset = gap if holds else offset
        kept = way(p, OFFSET, lane) if sticks else anchor
        motion = Motion(u, v, d, v)
        put_peaks(p, lane, mine, with_instant(plan, after, offset, motion, peaks_in(p, lane)))
        tau = at(p, TAU, lane)
        part = min(math.floor(tau / plan.slip_step), plan.slip_steps - 1.0)
        part += 1.0 if (part + 1.0 < plan.slip_steps) & ((part + 1.0) * plan.slip_step <= tau) else 0.0
        events = way(p, EVENTS, lane) + 1.0
        lost |= (
            (1 << lane)
            if mine & ((events > TRANSITION_CAP) | (holds & (abs(held) == storey.slip_force)))
            else 0
        )
        p[PART * WIDTH + lane] = (0.0 if holds else part) if mine else at(p, PART, lane)
        p[(WAY + E) * WIDTH + lane] = v if mine else way(p, E, lane)
        p[(WAY + OFFSET) * WIDTH + lane] = offset if mine else way(p, OFFSET, lane)
        p[(WAY + PHASE) * WIDTH + lane] = after if mine else phase
        p[(WAY + KICK) * WIDTH + lane] = kick if mine else way(p, KICK, lane)
        p[(WAY + ANCHOR) * WIDTH + lane] = (gap if stops else kept) if mine else anchor
        p[(WAY + TRAVEL) * WIDTH + lane] += slipped if mine & stops else 0.0
        p[(WAY + TRANSITIONS) * WIDTH + lane] += 1.0 if mine & (not goes_on) else 0.0
        p[(WAY + EVENTS) * WIDTH + lane] = events if mine else way(p, EVENTS, lane)
    return lost


@inner
def walk_lanes(p, a0, rate, to_walk, shelf, floor, brace, search):
    """Take a set of lanes over one step, as `storey/step.py` would; return those handed back untouched.

    a0, rate: as for the walk; no viscous work is kept.  shelf: the lanes' plans; floor, brace, search: room
    for series, (TERMS,).
    """
    lost, eager = set_out(p, to_walk)
    on_way = to_walk
    for _ in range(ROUNDS):
        parts, holding = take_whole(p, a0, rate)
        if parts != 0:
            take_parts(p, rate)
        sliding = on_way & ~holding
        seeks = 0
        doubts = 0
        if holding != 0:
            seeks, doubts = judge_stick(p, rate)
        if sliding != 0:
            more, others = judge_slip(p, rate)
            seeks |= more
            doubts |= others
        if doubts != 0:
            more, doubts = look_closer(p, rate, doubts)
            seeks |= more
            lost |= doubts
        crosses = seeks != 0
        eager |= seeks
        if crosses:
            aim(p)
            for _ in range(ATTEMPTS):
                if seeks == 0:
                    break
                seeks = approach(p, rate)
            lost |= seeks
        sees = 0
        if holding & eager != 0:
            sees |= raise_stick(p, rate)
        if sliding & eager != 0:
            sees |= raise_slip(p, rate)
        sees &= ~lost
        for lane in range(WIDTH):
            if sees >> lane & 1:
                search_peaks(p, lane, take_plan(shelf, lane), rate, floor, brace, search)
        further, fallen = arrive(p, rate)
        lost |= fallen
        if crosses:
            lost = change(p, lost)
        on_way = further & ~lost
        keep_on(p, on_way)
        if on_way == 0:
            break
    lost |= on_way
    bring_back(p, to_walk & ~lost)
    return lost
