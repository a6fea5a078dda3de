"""Extrema between the ends of quiet steps, looked at only when it is clear that they matter.

While a history grows, each of its turns may pass the peak so far, and most are passed by the next.  So
a step whose bounds leave room for a new peak is kept, one for each quantity of a lane, until either
the peak passes its bound, and it is forgotten, or another step comes for its place or the end does,
and it is searched.
"""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.bounds import floor_peaks
from fdspec.kernels.packed import (
    CREST_Q,
    CREST_U,
    CREST_V,
    END_A,
    END_U,
    END_V,
    LIFT,
    PUSH_FLOOR,
    WIDTH,
)
from fdspec.kernels.types import (
    OFFSET,
    PEAK_ACCELERATION,
    PHASE,
    STICK,
    Force,
    Motion,
    Peaks,
    U,
    V,
)

QUANTITIES = (CREST_Q, CREST_U, CREST_V)
"""Rows of the bounds: acceleration (and base shear, its multiple while sticking), displacement, velocity."""

BOUND, SLIPS, START_U, START_V, STOP_U, STOP_V, BASE, GROUND, RATE = range(9)
N_CREST = 9
"""Numbers of a kept step: bound of its quantity, whether it slips, motion at both ends, forces."""


@inner
def least_peak(p, tops, quantity, lane, slips, mass):
    """The peak that a bound must pass to matter; ``tops`` is the row where a lane's peaks begin."""
    top = p[(tops + quantity) * WIDTH + lane]
    if quantity == 0 and slips == 0.0:
        return min(top, p[(tops + 3) * WIDTH + lane] / mass)
    return top


@inner
def settle(p, tops, lane, plan, crest, floor, search):
    """Search a kept step and put the lane's peaks right."""
    peaks = Peaks(
        p[tops * WIDTH + lane],
        p[(tops + 1) * WIDTH + lane],
        p[(tops + 2) * WIDTH + lane],
        p[(tops + 3) * WIDTH + lane],
    )
    branch, mass, order = plan.stick, plan.mass, plan.stick_order
    if crest[SLIPS] != 0.0:
        branch, mass, order = plan.floor, 0.0, plan.floor_order
    peaks = floor_peaks(
        branch,
        crest[BASE],
        mass,
        floor,
        search,
        int(order),
        0.0,
        Motion(crest[START_U], crest[START_V], 0.0, 0.0),
        Motion(crest[STOP_U], crest[STOP_V], 0.0, 0.0),
        Force(crest[BASE] - crest[GROUND], -crest[RATE], 0.0, 0.0),
        plan.step,
        peaks,
    )
    p[tops * WIDTH + lane] = peaks.acceleration
    p[(tops + 1) * WIDTH + lane] = peaks.displacement
    p[(tops + 2) * WIDTH + lane] = peaks.velocity
    p[(tops + 3) * WIDTH + lane] = peaks.shear
    crest[BOUND] = 0.0


@inner
def keep_crests(p, lane, plan, crests, ground, rate, floor, search):
    """Keep a quiet step of a lane for each quantity whose peak it may hold."""
    phase = p[PHASE * WIDTH + lane]
    slips = 0.0 if phase == STICK else 1.0
    for quantity in range(3):
        bound = p[QUANTITIES[quantity] * WIDTH + lane]
        if bound <= least_peak(p, END_A, quantity, lane, slips, plan.mass):
            continue
        crest = crests[lane, quantity]
        if crest[BOUND] > least_peak(p, END_A, quantity, lane, crest[SLIPS], plan.mass):
            settle(p, END_A, lane, plan, crest, floor, search)
            if bound <= least_peak(p, END_A, quantity, lane, slips, plan.mass):
                continue
        crest[BOUND] = bound
        crest[SLIPS] = slips
        crest[START_U] = p[U * WIDTH + lane]
        crest[START_V] = p[V * WIDTH + lane]
        crest[STOP_U] = p[END_U * WIDTH + lane]
        crest[STOP_V] = p[END_V * WIDTH + lane]
        if phase == STICK:
            crest[BASE] = p[LIFT * WIDTH + lane] * p[OFFSET * WIDTH + lane]
        else:
            crest[BASE] = -phase * p[PUSH_FLOOR * WIDTH + lane]
        crest[GROUND] = ground
        crest[RATE] = rate


@inner
def settle_crests(p, lane, plan, crests, floor, search):
    """Search the kept steps that still matter at the end."""
    for quantity in range(3):
        crest = crests[lane, quantity]
        if crest[BOUND] > least_peak(p, PEAK_ACCELERATION, quantity, lane, crest[SLIPS], plan.mass):
            settle(p, PEAK_ACCELERATION, lane, plan, crest, floor, search)
