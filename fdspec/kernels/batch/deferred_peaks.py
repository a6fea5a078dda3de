"""Extrema between the ends of uneventful steps, looked at only when it is clear that they matter.

While a history grows, each of its turns may pass the peak so far, and most are passed by the next.  So
a step whose bounds leave room for a new peak is kept, one for each quantity of a lane, until either
the peak passes its bound, and it is forgotten, or another step comes for its place or the end does,
and it is searched.
"""

from __future__ import annotations

import numpy as np

from fdspec.compiler.options import inner, seldom
from fdspec.kernels.batch.layout import ROW, WIDTH, at
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.mathematics.oscillator import series_order
from fdspec.kernels.storey.bounds import floor_peaks
from fdspec.kernels.storey.demands import step_brace_peak
from fdspec.kernels.types import STICK, Force, Motion, Peaks

QUANTITIES = np.array([ROW.bound_q, ROW.bound_u, ROW.bound_v])
"""Rows of the bounds: acceleration (and base shear, its multiple while sticking), displacement, velocity."""

BOUND, SLIPS, START_U, START_V, STOP_U, STOP_V, BASE, GROUND, RATE = range(9)
N_DEFERRED = 9
"""Numbers of a kept step: bound of its quantity, whether it slips, motion at both ends, forces."""


HELD_OFFSET = 6
"""Place of the slip offset in the kept step of the brace force, whose others are those of any kept step."""
N_BRACE = 9


@inner
def least_peak(p, quantity, lane, slips, mass):
    """The peak that a bound must pass to matter."""
    top = at(p, ROW.peak_acceleration + quantity, lane)
    if quantity == 0 and slips == 0.0:
        return min(top, at(p, ROW.peak_shear, lane) / mass)
    return top


@inner
def search_deferred(p, lane, plan, kept, floor, search):
    """Search a kept step and put the lane's peaks right."""
    peaks = Peaks(
        at(p, ROW.peak_acceleration, lane),
        at(p, ROW.peak_displacement, lane),
        at(p, ROW.peak_velocity, lane),
        at(p, ROW.peak_shear, lane),
    )
    branch, mass = plan.stick, plan.mass
    if kept[SLIPS] != 0.0:
        branch, mass = plan.floor, 0.0
    peaks = floor_peaks(
        branch,
        kept[BASE],
        mass,
        floor,
        search,
        series_order(branch.rate * plan.step),
        0.0,
        Motion(kept[START_U], kept[START_V], 0.0, 0.0),
        Motion(kept[STOP_U], kept[STOP_V], 0.0, 0.0),
        Force(kept[BASE] - kept[GROUND], -kept[RATE], 0.0, 0.0),
        plan.step,
        peaks,
    )
    p[ROW.peak_acceleration * WIDTH + lane] = peaks.acceleration
    p[ROW.peak_displacement * WIDTH + lane] = peaks.displacement
    p[ROW.peak_velocity * WIDTH + lane] = peaks.velocity
    p[ROW.peak_shear * WIDTH + lane] = peaks.shear
    kept[BOUND] = 0.0


@inner
def defer_peaks(p, lane, plan, deferred, ground, rate, floor, search):
    """Keep the uneventful step that a lane has just taken for each quantity whose peak it may hold."""
    seldom()
    phase = at(p, ROW.phase, lane)
    slips = 0.0 if phase == STICK else 1.0
    for quantity in range(3):
        bound = at(p, QUANTITIES[quantity], lane)
        if bound <= least_peak(p, quantity, lane, slips, plan.mass):
            continue
        kept = deferred[lane, quantity]
        if kept[BOUND] > least_peak(p, quantity, lane, kept[SLIPS], plan.mass):
            search_deferred(p, lane, plan, kept, floor, search)
            if bound <= least_peak(p, quantity, lane, slips, plan.mass):
                continue
        kept[BOUND] = bound
        kept[SLIPS] = slips
        kept[START_U] = at(p, ROW.from_u, lane)
        kept[START_V] = at(p, ROW.from_v, lane)
        kept[STOP_U] = at(p, ROW.u, lane)
        kept[STOP_V] = at(p, ROW.v, lane)
        if phase == STICK:
            kept[BASE] = at(p, ROW.lift, lane) * at(p, ROW.offset, lane)
        else:
            kept[BASE] = sliding_force(-phase, at(p, ROW.push_floor, lane))
        kept[GROUND] = ground
        kept[RATE] = rate


@inner
def search_all_deferred(p, lane, plan, deferred, floor, search):
    """Search the kept steps that still matter at the end."""
    for quantity in range(3):
        kept = deferred[lane, quantity]
        if kept[BOUND] > least_peak(p, quantity, lane, kept[SLIPS], plan.mass):
            search_deferred(p, lane, plan, kept, floor, search)


@inner
def search_deferred_brace(p, lane, plan, deferred_brace, room, search):
    """Search the step kept for the brace force, if it still matters."""
    seldom()
    kept = deferred_brace[lane]
    if kept[BOUND] <= at(p, ROW.peak_brace, lane):
        return
    p[ROW.peak_brace * WIDTH + lane] = step_brace_peak(
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
        at(p, ROW.peak_brace, lane),
    )
    kept[BOUND] = 0.0


@inner
def defer_brace_peak(p, lane, plan, deferred_brace, ground, rate, room, search):
    """Keep the uneventful step that a lane has just taken, whose bound on the brace force passes its peak."""
    seldom()
    bound = at(p, ROW.bound_b, lane)
    search_deferred_brace(p, lane, plan, deferred_brace, room, search)
    if bound <= at(p, ROW.peak_brace, lane):
        return
    phase = at(p, ROW.phase, lane)
    kept = deferred_brace[lane]
    kept[BOUND] = bound
    kept[SLIPS] = phase
    kept[START_U] = at(p, ROW.from_u, lane) if phase == STICK else at(p, ROW.from_d, lane)
    kept[START_V] = at(p, ROW.from_v, lane) if phase == STICK else at(p, ROW.from_e, lane)
    kept[HELD_OFFSET] = at(p, ROW.offset, lane)
    kept[GROUND] = ground
    kept[RATE] = rate
