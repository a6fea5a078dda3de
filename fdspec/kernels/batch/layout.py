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
from fdspec.compiler.records import size_of
from fdspec.kernels.mathematics.oscillator import StepMap
from fdspec.kernels.mathematics.polynomial_roots import TAIL
from fdspec.kernels.storey.constants import Plan, is_slow
from fdspec.kernels.storey.energy import STICK_FORM, STRIDE_FORM
from fdspec.kernels.types import (
    N_STATE,
    NO_ONSET,
    OFFSET,
    ONSET,
    PEAK_ACCELERATION,
    PEAK_BRACE,
    PEAK_DISPLACEMENT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
    PHASE,
    STICK,
    D,
    E,
    U,
    V,
)

WIDTH = 16
"""Histories side by side: two registers of AVX-512, four of AVX2, so that one hides another's latency."""


class Stride(NamedTuple):
    """Step maps of floor and brace apart over a whole step."""

    floor: StepMap
    brace: StepMap


N_PLAN = size_of(Plan)
"""Numbers of a plan, as they stand in a row."""

N_STRIDE = size_of(Stride)

# Rows behind the state: the motion at the step's start, bounds on peaks in it, the largest reaction so far.
_AT = N_STATE
FROM_U, FROM_V, FROM_D, FROM_E, BOUND_U, BOUND_V, BOUND_Q, BOUND_S, BOUND_B, HELD = range(_AT, _AT + 10)
_AT += 10
# Constants of the storey.
LIMIT, PUSH_FLOOR, PUSH_BRACE, LIFT, MASS, FLOOR_MASS, BRACE_MASS, LIGHT, ALONE = range(_AT, _AT + 9)
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
    p[LIMIT * WIDTH + lane] = storey.slip_force
    p[PUSH_FLOOR * WIDTH + lane] = sliding / storey.floor_mass
    p[PUSH_BRACE * WIDTH + lane] = sliding / storey.brace_mass if massive else 0.0
    p[LIFT * WIDTH + lane] = plan.lift
    p[MASS * WIDTH + lane] = plan.mass
    p[FLOOR_MASS * WIDTH + lane] = storey.floor_mass
    p[BRACE_MASS * WIDTH + lane] = storey.brace_mass
    p[LIGHT * WIDTH + lane] = 1.0 / plan.mass
    # A slow brace's quasi-static motion says nothing; a damped one's losses are not tallied a step at a time.
    slow = massive and is_slow(plan)
    p[ALONE * WIDTH + lane] = 1.0 if slow or (certify and storey.brace_damping > 0.0) else 0.0
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
        p[(S_MAP + k) * WIDTH + lane] = plan.stick_map[k]
        p[(F_MAP + k) * WIDTH + lane] = stride.floor[k]
        p[(B_MAP + k) * WIDTH + lane] = stride.brace[k]
    for k in range(10):
        double = 1.0 if k in (0, 4, 7, 9) else 2.0  # off the diagonal of the quadratic form
        p[(S_LOSS + k) * WIDTH + lane] = forms[STICK_FORM + k] * double
        p[(F_LOSS + k) * WIDTH + lane] = forms[STRIDE_FORM + k] * double


@inner
def start_lane(p, lane):
    """Set a lane to rest at t = 0; a damper without friction slides from the start."""
    for row in range(N_STATE):
        p[row * WIDTH + lane] = 0.0
    p[ONSET * WIDTH + lane] = NO_ONSET
    p[PHASE * WIDTH + lane] = 1.0 if at(p, LIMIT, lane) == 0.0 else 0.0


@inner
def rest_lane(p, lane):
    """Make a lane uneventful for good: sticking, no slip force to reach, no peak to pass."""
    p[LIMIT * WIDTH + lane] = math.inf
    start_lane(p, lane)
    for row in range(PEAK_ACCELERATION, PEAK_SHEAR + 1):
        p[row * WIDTH + lane] = math.inf
    p[PEAK_BRACE * WIDTH + lane] = math.inf


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
    if s[PHASE] == STICK:
        s[D] = s[U] - s[OFFSET]
        s[E] = s[V]


@inlined
def has_no_new_peak(p, lane, s):
    """Whether a step passes none of the peaks in the state ``s``, unless the phase changes on it."""
    return (
        at(p, BOUND_Q, lane) <= s[PEAK_ACCELERATION]
        and at(p, BOUND_U, lane) <= s[PEAK_DISPLACEMENT]
        and at(p, BOUND_V, lane) <= s[PEAK_VELOCITY]
        and at(p, BOUND_S, lane) <= s[PEAK_SHEAR]
    )


@inlined
def has_no_new_brace_peak(p, lane, s):
    """Whether a step passes no peak of the brace force in the state ``s``, unless the phase changes on it."""
    return at(p, BOUND_B, lane) <= s[PEAK_BRACE]
