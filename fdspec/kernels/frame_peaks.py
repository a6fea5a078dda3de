"""Peaks of a frame's continuous motion, storey by storey."""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.frame import BRACE_MASS, FLOOR_MASS, SLIDING_COMPLIANCE
from fdspec.kernels.roots import largest_magnitude
from fdspec.kernels.taylor import (
    ACCELERATION_REACH,
    DISPLACEMENT,
    INERTIA,
    OFFSET,
    REACTION_REACH,
    SLIDING,
    VELOCITY,
)

PEAK_ACCELERATION = 0
PEAK_DISPLACEMENT = 1
PEAK_VELOCITY = 2
PEAK_DRIFT = 3
PEAK_SHEAR = 4
PEAK_BRACE_DISPLACEMENT = 5
PEAK_ROWS = 6
"""Rows of the ``peaks`` array (6, N): absolute, relative to the ground, relative to the floor below, N."""


@inner
def raise_peaks(frame, model, series, reach, n, h, x, ground, rise, c, peaks):
    """Raise the peaks to those of the first part x of the step.

    A quantity is at most its value at the start and what its acceleration can make of it over the
    whole step; only where that leaves room for a new peak is it searched.
    """
    strongest = abs(ground) + abs(rise)
    shear = 0.0
    shear_reach = 0.0
    for j in range(frame.shape[1] - 1, -1, -1):
        i = j + 1
        reach_a = reach[ACCELERATION_REACH, j]
        now = abs(series[INERTIA, i, 0])
        if now + reach_a > peaks[PEAK_ACCELERATION, j]:
            take(series, INERTIA, i, n - 1, x, c)
            peaks[PEAK_ACCELERATION, j] = largest_magnitude(c, n - 1, peaks[PEAK_ACCELERATION, j])
        pull = h * (now + reach_a + strongest)
        if abs(series[VELOCITY, i, 0]) + pull > peaks[PEAK_VELOCITY, j]:
            take(series, VELOCITY, i, n, x, c)
            peaks[PEAK_VELOCITY, j] = largest_magnitude(c, n, peaks[PEAK_VELOCITY, j])
        way = h * (abs(series[VELOCITY, i, 0]) + 0.5 * pull)
        if abs(series[DISPLACEMENT, i, 0]) + way > peaks[PEAK_DISPLACEMENT, j]:
            take(series, DISPLACEMENT, i, n, x, c)
            peaks[PEAK_DISPLACEMENT, j] = largest_magnitude(c, n, peaks[PEAK_DISPLACEMENT, j])
        way_below = 0.0
        if j > 0:
            pull = h * (abs(series[INERTIA, j, 0]) + reach[ACCELERATION_REACH, j - 1] + strongest)
            way_below = h * (abs(series[VELOCITY, j, 0]) + 0.5 * pull)
        if (
            abs(series[DISPLACEMENT, i, 0] - series[DISPLACEMENT, j, 0]) + way + way_below
            > peaks[PEAK_DRIFT, j]
        ):
            take_difference(series, DISPLACEMENT, i, DISPLACEMENT, j, n, x, c)
            peaks[PEAK_DRIFT, j] = largest_magnitude(c, n, peaks[PEAK_DRIFT, j])
        # Sliding accelerates by its compliance times the reaction; a massless brace has none and goes with
        # the drift.
        slide = abs(series[SLIDING, i, 1]) + h * model[SLIDING_COMPLIANCE, j] * reach[REACTION_REACH, j]
        if frame[BRACE_MASS, j] > 0.0:
            way += h * (abs(series[SLIDING, i, 0]) + slide)
        else:
            way = peaks[PEAK_BRACE_DISPLACEMENT, j]
        if abs(series[DISPLACEMENT, i, 0] - series[OFFSET, i, 0]) + way > peaks[PEAK_BRACE_DISPLACEMENT, j]:
            take_difference(series, DISPLACEMENT, i, OFFSET, i, n, x, c)
            peaks[PEAK_BRACE_DISPLACEMENT, j] = largest_magnitude(c, n, peaks[PEAK_BRACE_DISPLACEMENT, j])
        # The storey shear carries the inertia of all masses above: that of floor and brace, less what
        # the brace's acceleration falls short of the floor's.
        mass = frame[FLOOR_MASS, j] + frame[BRACE_MASS, j]
        lag = frame[BRACE_MASS, j] / h
        shear += mass * series[INERTIA, i, 0] - lag * series[SLIDING, i, 1]
        shear_reach += (
            mass * reach_a + frame[BRACE_MASS, j] * model[SLIDING_COMPLIANCE, j] * (reach[REACTION_REACH, j])
        )
        if abs(shear) + shear_reach > peaks[PEAK_SHEAR, j]:
            storey_shear(frame, series, n, h, j, c)
            shorten(c, n - 1, x)
            peaks[PEAK_SHEAR, j] = largest_magnitude(c, n - 1, peaks[PEAK_SHEAR, j])


@inner
def take(series, quantity, i, n, x, c):
    """Copy a series, rescaled to the first part x of its step."""
    power = 1.0
    for k in range(n + 1):
        c[k] = series[quantity, i, k] * power
        power *= x


@inner
def take_difference(series, quantity, i, other, j, n, x, c):
    """Copy the difference of two series, rescaled to the first part x of their step."""
    power = 1.0
    for k in range(n + 1):
        c[k] = (series[quantity, i, k] - series[other, j, k]) * power
        power *= x


@inner
def shorten(c, n, x):
    """Rescale a series to the first part x of its step."""
    power = 1.0
    for k in range(n + 1):
        c[k] *= power
        power *= x


@inner
def storey_shear(frame, series, n, h, storey, c):
    """Series of the shear (N) in frame and brace of one storey, counted from 0, positive with the drift."""
    for k in range(n):
        c[k] = 0.0
    for j in range(frame.shape[1] - 1, storey - 1, -1):
        mass = frame[FLOOR_MASS, j] + frame[BRACE_MASS, j]
        lag = frame[BRACE_MASS, j] / h
        for k in range(n):
            c[k] -= mass * series[INERTIA, j + 1, k] - lag * (k + 1) * series[SLIDING, j + 1, k + 1]
