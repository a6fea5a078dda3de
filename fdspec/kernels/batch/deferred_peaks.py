"""Extrema between the ends of quiet steps, looked at only when it is clear that they matter.

While a history grows, each of its turns may pass the peak so far, and most are passed by the next.  So
a step whose bounds leave room for a new peak is kept, one for each quantity of a lane, until either
the peak passes its bound, and it is forgotten, or another step comes for its place or the end does,
and it is searched.
"""

from __future__ import annotations

import numpy as np

from fdspec.compiler.options import inner, seldom
from fdspec.kernels.batch.layout import (
    CREST_B,
    CREST_Q,
    CREST_U,
    CREST_V,
    FROM_D,
    FROM_E,
    FROM_U,
    FROM_V,
    LIFT,
    PUSH_FLOOR,
    WIDTH,
    at,
)
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.oscillator import series_order
from fdspec.kernels.storey.bounds import floor_peaks
from fdspec.kernels.storey.demands import step_brace_peak
from fdspec.kernels.types import (
    OFFSET,
    PEAK_ACCELERATION,
    PEAK_BRACE,
    PEAK_DISPLACEMENT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
    PHASE,
    STICK,
    Force,
    Motion,
    Peaks,
    U,
    V,
)

QUANTITIES = np.array([CREST_Q, CREST_U, CREST_V])
"""Rows of the bounds: acceleration (and base shear, its multiple while sticking), displacement, velocity."""

BOUND, SLIPS, START_U, START_V, STOP_U, STOP_V, BASE, GROUND, RATE = range(9)
N_CREST = 9
"""Numbers of a kept step: bound of its quantity, whether it slips, motion at both ends, forces."""


HELD_OFFSET = 6
"""Place of the slip offset in the kept step of the brace force, whose others are those of a crest."""
N_BRACE = 9


@inner
def least_peak(p, quantity, lane, slips, mass):
    """The peak that a bound must pass to matter."""
    top = at(p, PEAK_ACCELERATION + quantity, lane)
    if quantity == 0 and slips == 0.0:
        return min(top, at(p, PEAK_SHEAR, lane) / mass)
    return top


@inner
def settle(p, lane, plan, crest, floor, search):
    """Search a kept step and put the lane's peaks right."""
    peaks = Peaks(
        at(p, PEAK_ACCELERATION, lane),
        at(p, PEAK_DISPLACEMENT, lane),
        at(p, PEAK_VELOCITY, lane),
        at(p, PEAK_SHEAR, lane),
    )
    branch, mass = plan.stick, plan.mass
    if crest[SLIPS] != 0.0:
        branch, mass = plan.floor, 0.0
    peaks = floor_peaks(
        branch,
        crest[BASE],
        mass,
        floor,
        search,
        series_order(branch.rate * plan.step),
        0.0,
        Motion(crest[START_U], crest[START_V], 0.0, 0.0),
        Motion(crest[STOP_U], crest[STOP_V], 0.0, 0.0),
        Force(crest[BASE] - crest[GROUND], -crest[RATE], 0.0, 0.0),
        plan.step,
        peaks,
    )
    p[PEAK_ACCELERATION * WIDTH + lane] = peaks.acceleration
    p[PEAK_DISPLACEMENT * WIDTH + lane] = peaks.displacement
    p[PEAK_VELOCITY * WIDTH + lane] = peaks.velocity
    p[PEAK_SHEAR * WIDTH + lane] = peaks.shear
    crest[BOUND] = 0.0


@inner
def keep_crests(p, lane, plan, crests, ground, rate, floor, search):
    """Keep the quiet step that a lane has just taken for each quantity whose peak it may hold."""
    phase = at(p, PHASE, lane)
    slips = 0.0 if phase == STICK else 1.0
    for quantity in range(3):
        bound = at(p, QUANTITIES[quantity], lane)
        if bound <= least_peak(p, quantity, lane, slips, plan.mass):
            continue
        crest = crests[lane, quantity]
        if crest[BOUND] > least_peak(p, quantity, lane, crest[SLIPS], plan.mass):
            settle(p, lane, plan, crest, floor, search)
            if bound <= least_peak(p, quantity, lane, slips, plan.mass):
                continue
        crest[BOUND] = bound
        crest[SLIPS] = slips
        crest[START_U] = at(p, FROM_U, lane)
        crest[START_V] = at(p, FROM_V, lane)
        crest[STOP_U] = at(p, U, lane)
        crest[STOP_V] = at(p, V, lane)
        if phase == STICK:
            crest[BASE] = at(p, LIFT, lane) * at(p, OFFSET, lane)
        else:
            crest[BASE] = sliding_force(-phase, at(p, PUSH_FLOOR, lane))
        crest[GROUND] = ground
        crest[RATE] = rate


@inner
def settle_crests(p, lane, plan, crests, floor, search):
    """Search the kept steps that still matter at the end."""
    for quantity in range(3):
        crest = crests[lane, quantity]
        if crest[BOUND] > least_peak(p, quantity, lane, crest[SLIPS], plan.mass):
            settle(p, lane, plan, crest, floor, search)


@inner
def settle_brace(p, lane, plan, braces, room, search):
    """Search the step kept for the brace force, if it still matters."""
    seldom()
    kept = braces[lane]
    if kept[BOUND] <= at(p, PEAK_BRACE, lane):
        return
    p[PEAK_BRACE * WIDTH + lane] = step_brace_peak(
        plan,
        int(kept[SLIPS]),
        kept[START_U],
        kept[START_V],
        kept[START_U],
        kept[START_V],
        kept[HELD_OFFSET],
        kept[GROUND],
        kept[RATE],
        room,
        search,
        at(p, PEAK_BRACE, lane),
    )
    kept[BOUND] = 0.0


@inner
def keep_brace(p, lane, plan, braces, ground, rate, room, search):
    """Keep the quiet step that a lane has just taken, whose bound on the brace force passes its peak."""
    seldom()
    bound = at(p, CREST_B, lane)
    settle_brace(p, lane, plan, braces, room, search)
    if bound <= at(p, PEAK_BRACE, lane):
        return
    phase = at(p, PHASE, lane)
    kept = braces[lane]
    kept[BOUND] = bound
    kept[SLIPS] = phase
    kept[START_U] = at(p, FROM_U, lane) if phase == STICK else at(p, FROM_D, lane)
    kept[START_V] = at(p, FROM_V, lane) if phase == STICK else at(p, FROM_E, lane)
    kept[HELD_OFFSET] = at(p, OFFSET, lane)
    kept[GROUND] = ground
    kept[RATE] = rate
