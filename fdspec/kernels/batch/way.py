"""Lanes on their way through a step: their plans, the state between two pieces, and the piece they are on.

A walk keeps these in variables; here they are rows of the packed array (`layout.py`), from which
every loop over the lanes takes what it needs.
"""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.batch.layout import (
    CALM,
    CREST_Q,
    CREST_S,
    CREST_U,
    CREST_V,
    END_D,
    END_E,
    END_U,
    END_V,
    FORCE_B,
    FORCE_P,
    ON_WAY,
    PART,
    PLAN,
    TAU,
    WAY,
    WHOLE,
    WIDTH,
    at,
)
from fdspec.kernels.batch.shelf import (
    BRACE_BRANCH,
    BRACE_MAP,
    FLOOR_BRANCH,
    FLOOR_MAP,
    SCALARS,
    STICK_BRANCH,
    STICK_MAP,
)
from fdspec.kernels.mathematics.oscillator import StepMap
from fdspec.kernels.storey.constants import Branch, Plan
from fdspec.kernels.types import (
    N_STATE,
    PEAK_ACCELERATION,
    PEAK_DISPLACEMENT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
    PHASE,
    TOUCHING,
    D,
    E,
    Force,
    Motion,
    Peaks,
    Storey,
    U,
    V,
)


@inlined
def branch_in(p, row, lane):
    """A Branch of a lane's plan."""
    return Branch(
        at(p, row, lane),
        at(p, row + 1, lane),
        at(p, row + 2, lane),
        at(p, row + 3, lane),
        at(p, row + 4, lane),
    )


@inlined
def map_in(p, row, lane):
    """A StepMap of a lane's plan."""
    return StepMap(
        at(p, row, lane),
        at(p, row + 1, lane),
        at(p, row + 2, lane),
        at(p, row + 3, lane),
        at(p, row + 4, lane),
        at(p, row + 5, lane),
        at(p, row + 6, lane),
        at(p, row + 7, lane),
        at(p, row + 8, lane),
        at(p, row + 9, lane),
        at(p, row + 10, lane),
        at(p, row + 11, lane),
    )


@inlined
def plan_in(p, lane):
    """The plan of a lane; what of it is not used costs nothing."""
    row = PLAN
    numbers = PLAN + SCALARS
    return Plan(
        Storey(
            at(p, row, lane),
            at(p, row + 1, lane),
            at(p, row + 2, lane),
            at(p, row + 3, lane),
            at(p, row + 4, lane),
            at(p, row + 5, lane),
            at(p, row + 6, lane),
            at(p, row + 7, lane),
        ),
        branch_in(p, PLAN + STICK_BRANCH, lane),
        branch_in(p, PLAN + FLOOR_BRANCH, lane),
        branch_in(p, PLAN + BRACE_BRANCH, lane),
        at(p, numbers, lane),
        at(p, numbers + 1, lane),
        at(p, numbers + 2, lane),
        at(p, numbers + 3, lane),
        at(p, numbers + 4, lane),
        at(p, numbers + 5, lane),
        at(p, numbers + 6, lane),
        at(p, numbers + 7, lane),
        at(p, numbers + 8, lane),
        at(p, numbers + 9, lane),
        at(p, numbers + 10, lane),
        map_in(p, PLAN + STICK_MAP, lane),
        map_in(p, PLAN + FLOOR_MAP, lane),
        map_in(p, PLAN + BRACE_MAP, lane),
    )


@inlined
def way(p, row, lane):
    """A number of the state on its way."""
    return at(p, WAY + row, lane)


@inlined
def motion_in(p, lane):
    """Motion at the piece's start."""
    return Motion(way(p, U, lane), way(p, V, lane), way(p, D, lane), way(p, E, lane))


@inlined
def end_in(p, lane):
    """Motion at the piece's end."""
    return Motion(at(p, END_U, lane), at(p, END_V, lane), at(p, END_D, lane), at(p, END_E, lane))


@inlined
def force_in(p, rate, lane):
    """Force on the piece."""
    sticks = way(p, PHASE, lane) == 0.0
    return Force(at(p, FORCE_P, lane), -rate, at(p, FORCE_B, lane), 0.0 if sticks else -rate)


@inlined
def peaks_in(p, lane):
    """Peaks so far of the state on its way."""
    return Peaks(
        way(p, PEAK_ACCELERATION, lane),
        way(p, PEAK_DISPLACEMENT, lane),
        way(p, PEAK_VELOCITY, lane),
        way(p, PEAK_SHEAR, lane),
    )


@inlined
def put_peaks(p, lane, mine, peaks):
    """Store the peaks of the state on its way."""
    old = peaks_in(p, lane)
    p[(WAY + PEAK_ACCELERATION) * WIDTH + lane] = peaks.acceleration if mine else old.acceleration
    p[(WAY + PEAK_DISPLACEMENT) * WIDTH + lane] = peaks.displacement if mine else old.displacement
    p[(WAY + PEAK_VELOCITY) * WIDTH + lane] = peaks.velocity if mine else old.velocity
    p[(WAY + PEAK_SHEAR) * WIDTH + lane] = peaks.shear if mine else old.shear


@inner
def keep_on(p, on_way):
    """Mark the lanes of this set, and no other, as on their way."""
    wide()
    for lane in range(WIDTH):
        p[ON_WAY * WIDTH + lane] = 1.0 if on_way >> lane & 1 else 0.0


@inner
def set_out(p, to_walk):
    """Put lanes of this set on their way; return those that cannot go, and those whose peaks may grow."""
    wide()
    lost = 0
    eager = 0
    for row in range(N_STATE):
        for lane in range(WIDTH):
            p[(WAY + row) * WIDTH + lane] = at(p, row, lane)
    for lane in range(WIDTH):
        calm = (
            (at(p, CREST_Q, lane) <= at(p, PEAK_ACCELERATION, lane))
            & (at(p, CREST_U, lane) <= at(p, PEAK_DISPLACEMENT, lane))
            & (at(p, CREST_V, lane) <= at(p, PEAK_VELOCITY, lane))
            & (at(p, CREST_S, lane) <= at(p, PEAK_SHEAR, lane))
        )
        lost |= (1 << lane) if at(p, TOUCHING, lane) != 0.0 else 0
        eager |= 0 if calm else 1 << lane
        p[CALM * WIDTH + lane] = 1.0 if calm else 0.0
        p[TAU * WIDTH + lane] = 0.0
        p[PART * WIDTH + lane] = 0.0
        p[WHOLE * WIDTH + lane] = 1.0
    keep_on(p, to_walk & ~lost)
    return to_walk & lost, to_walk & eager


@inner
def bring_back(p, lanes):
    """Make the states at the end of their way those of the lanes of this set."""
    wide()
    for row in range(N_STATE):
        for lane in range(WIDTH):
            there = way(p, row, lane)
            p[row * WIDTH + lane] = there if lanes >> lane & 1 else at(p, row, lane)
