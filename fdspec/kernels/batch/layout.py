"""Many histories side by side: the same arithmetic on neighbouring numbers, one lane a history.

Grid points are independent, so WIDTH of them advance together through the steps in which nothing
happens to them (`uneventful.py`).  State and constants stand in one packed array, row r of lane
l at r * WIDTH + l: with several arrays the compiler could not prove that a store leaves the other
loads alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fdspec.compiler.options import inlined, inner
from fdspec.compiler.positions import positions
from fdspec.compiler.records import size_of
from fdspec.kernels.mathematics.oscillator import StepMap
from fdspec.kernels.mathematics.polynomial_roots import TAIL
from fdspec.kernels.storey.constants import Plan, is_slow
from fdspec.kernels.storey.energy import STICK_FORM, STRIDE_FORM
from fdspec.kernels.types import N_STATE, NO_ONSET, STATE, STICK

WIDTH = 16
"""Histories side by side: two registers of AVX-512, four of AVX2, so that one hides another's latency."""


class Stride(NamedTuple):
    """Step maps of floor and brace apart over a whole step."""

    floor: StepMap
    brace: StepMap


N_PLAN = size_of(Plan)
"""Numbers of a plan, as they stand in a row."""

N_STRIDE = size_of(Stride)

_MAPS = ("stick_map", "floor_map", "brace_map")
_LOSSES = ("stick_loss", "floor_loss")
_NAMES = (
    *STATE._fields,
    # The motion at the step's start, bounds on peaks in it, the largest reaction so far.
    *"from_u from_v from_d from_e bound_u bound_v bound_q bound_s bound_b held".split(),
    # Constants of the storey.
    *"limit push_floor push_brace lift mass floor_mass brace_mass alone".split(),
    *"hold_u hold_v hold_offset hold_tail stick_damp floor_damp".split(),
    # Floor and brace as one, the floor alone: rates, weights in the bound on free motion, its own weights.
    *"stick_g stick_w2 stick_drift stick_slow stick_tail_u stick_tail_v stick_tail_q".split(),
    *"floor_g floor_w2 floor_drift floor_slow floor_tail_u floor_tail_v floor_tail_q".split(),
    # The brace alone.
    *"brace_g brace_w2 brace_drift brace_slow brace_omega brace_ground brace_tail_e brace_tail_q".split(),
    # Step maps, and quadratic forms of the viscous work.
    *_MAPS,
    *_LOSSES,
    "end",
)
ROW = positions(_NAMES, dict.fromkeys(_MAPS, 12) | dict.fromkeys(_LOSSES, 10))
"""Rows of the packed array: the state's, in its order, then what the loops need."""

N_ROWS = ROW.end


@inlined
def at(p, row, lane):
    """The number of a lane in a row."""
    return p[row * WIDTH + lane]


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
def put_lane(p, lane, plan, stride, forms, certify):
    """Store the constants of a plan: those it holds, and what bounds over a whole step weigh them with.

    stride: the `Stride` of the plan; forms: the row of its losses.
    """
    storey = plan.storey
    sliding = storey.kinetic_slip_force if storey.slip_force < math.inf else 0.0
    massive = storey.brace_mass > 0.0
    p[ROW.limit * WIDTH + lane] = storey.slip_force
    p[ROW.push_floor * WIDTH + lane] = sliding / storey.floor_mass
    p[ROW.push_brace * WIDTH + lane] = sliding / storey.brace_mass if massive else 0.0
    p[ROW.lift * WIDTH + lane] = plan.lift
    p[ROW.mass * WIDTH + lane] = plan.mass
    p[ROW.floor_mass * WIDTH + lane] = storey.floor_mass
    p[ROW.brace_mass * WIDTH + lane] = storey.brace_mass
    # A slow brace's quasi-static motion says nothing; a damped one's losses are not tallied a step at a time.
    slow = massive and is_slow(plan)
    p[ROW.alone * WIDTH + lane] = 1.0 if slow or (certify and storey.brace_damping > 0.0) else 0.0
    put_branch(p, ROW.stick_g, lane, plan.stick, plan.step)
    put_branch(p, ROW.floor_g, lane, plan.floor, plan.step)
    tail_u, tail_v = at(p, ROW.stick_tail_u, lane), at(p, ROW.stick_tail_v, lane)
    p[ROW.hold_u * WIDTH + lane] = plan.hold_u
    p[ROW.hold_v * WIDTH + lane] = plan.hold_v
    p[ROW.hold_offset * WIDTH + lane] = plan.hold_offset
    p[ROW.hold_tail * WIDTH + lane] = abs(plan.hold_u) * tail_u + abs(plan.hold_v) * tail_v
    brace = plan.brace
    p[ROW.brace_g * WIDTH + lane] = brace.g
    p[ROW.brace_w2 * WIDTH + lane] = brace.w2
    p[ROW.brace_drift * WIDTH + lane] = brace.drift
    p[ROW.brace_slow * WIDTH + lane] = brace.slowness if massive else 0.0
    p[ROW.brace_omega * WIDTH + lane] = math.sqrt(brace.w2) if massive else 0.0
    p[ROW.brace_ground * WIDTH + lane] = 1.0 if massive else 0.0
    phi = brace.rate * plan.step
    p[ROW.brace_tail_e * WIDTH + lane] = TAIL * phi * phi * phi * phi
    p[ROW.brace_tail_q * WIDTH + lane] = TAIL * phi * phi * phi * phi * brace.rate
    p[ROW.stick_damp * WIDTH + lane] = storey.floor_damping + storey.brace_damping
    p[ROW.floor_damp * WIDTH + lane] = storey.floor_damping
    p[ROW.held * WIDTH + lane] = 0.0
    for k in range(12):
        p[(ROW.stick_map + k) * WIDTH + lane] = plan.stick_map[k]
        p[(ROW.floor_map + k) * WIDTH + lane] = stride.floor[k]
        p[(ROW.brace_map + k) * WIDTH + lane] = stride.brace[k]
    for k in range(10):
        double = 1.0 if k in (0, 4, 7, 9) else 2.0  # off the diagonal of the quadratic form
        p[(ROW.stick_loss + k) * WIDTH + lane] = forms[STICK_FORM + k] * double
        p[(ROW.floor_loss + k) * WIDTH + lane] = forms[STRIDE_FORM + k] * double


@inner
def start_lane(p, lane):
    """Set a lane to rest at t = 0; a damper without friction slides from the start."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = 0.0
    p[ROW.onset * WIDTH + lane] = NO_ONSET
    p[ROW.phase * WIDTH + lane] = 1.0 if at(p, ROW.limit, lane) == 0.0 else 0.0


@inner
def rest_lane(p, lane):
    """Make a lane uneventful for good: sticking, no slip force to reach, no peak to pass."""
    p[ROW.limit * WIDTH + lane] = math.inf
    start_lane(p, lane)
    for row in range(ROW.peak_acceleration, ROW.peak_shear + 1):
        p[row * WIDTH + lane] = math.inf
    p[ROW.peak_brace * WIDTH + lane] = math.inf


@inner
def put_state(p, lane, s):
    """Store a history's state in its lane."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = s[row]


@inner
def take_state(p, lane, s):
    """Take a history's state from its lane; the brace of one that sticks moves as its floor does."""
    for row in range(N_STATE):
        s[row] = p[row * WIDTH + lane]
    if s[STATE.phase] == STICK:
        s[STATE.d] = s[STATE.u] - s[STATE.offset]
        s[STATE.e] = s[STATE.v]


@inlined
def has_no_new_peak(p, lane, s):
    """Whether a step passes none of the peaks in the state ``s``, unless the phase changes on it."""
    shear = at(p, ROW.bound_s, lane)
    if s[STATE.phase] == STICK:
        shear = at(p, ROW.mass, lane) * at(p, ROW.bound_q, lane)
    return (
        at(p, ROW.bound_q, lane) <= s[STATE.peak_acceleration]
        and at(p, ROW.bound_u, lane) <= s[STATE.peak_displacement]
        and at(p, ROW.bound_v, lane) <= s[STATE.peak_velocity]
        and shear <= s[STATE.peak_shear]
    )


@inlined
def has_no_new_brace_peak(p, lane, s):
    """Whether a step passes no peak of the brace force in the state ``s``, unless the phase changes on it."""
    return at(p, ROW.bound_b, lane) <= s[STATE.peak_brace]
