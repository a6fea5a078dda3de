"""Peaks of a frame's continuous motion, storey by storey."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import BRACE_MASS, FLOOR_MASS, SLIDING_COMPLIANCE
from fdspec.kernels.frame.taylor import (
    ACCELERATION_REACH,
    DISPLACEMENT,
    INERTIA,
    JERK_REACH,
    OFFSET,
    REACTION_REACH,
    SLIDING,
    VELOCITY,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude

PEAK_ACCELERATION = 0
PEAK_DISPLACEMENT = 1
PEAK_VELOCITY = 2
PEAK_DRIFT = 3
PEAK_SHEAR = 4
PEAK_BRACE_DISPLACEMENT = 5
PEAK_ROWS = 6
"""Rows of the ``peaks`` array (6, N): absolute, relative to the ground, relative to the floor below, N."""


@inner
def raise_peaks(frame, model, series, reach, state, n, h, x, ground, rise, c, peaks):
    """Raise the peaks to those of the first part x of the step, at whose end ``state`` stands.

    Between two instants a quantity leaves the larger of its two values by at most an eighth of its
    largest second derivative; accelerations leave that at the start by at most their reach.  Only where
    these leave room for a new peak is it searched.
    """
    strongest = abs(ground) + abs(rise)
    eighth = 0.125 * h * h
    shear = 0.0
    shear_reach = 0.0
    for j in range(frame.shape[1] - 1, -1, -1):
        i = j + 1
        inertia = abs(series[INERTIA, i, 0])
        pull = inertia + reach[ACCELERATION_REACH, j]
        if pull > peaks[PEAK_ACCELERATION, j]:
            take(series, INERTIA, i, n - 1, x, c)
            peaks[PEAK_ACCELERATION, j] = largest_magnitude(c, n - 1, peaks[PEAK_ACCELERATION, j])
        most = max(abs(series[VELOCITY, i, 0]), abs(state[VELOCITY, j]))
        if most + 0.125 * h * (reach[JERK_REACH, j] + abs(rise)) > peaks[PEAK_VELOCITY, j]:
            take(series, VELOCITY, i, n, x, c)
            peaks[PEAK_VELOCITY, j] = largest_magnitude(c, n, peaks[PEAK_VELOCITY, j])
        most = max(abs(series[DISPLACEMENT, i, 0]), abs(state[DISPLACEMENT, j]))
        if most + eighth * (pull + strongest) > peaks[PEAK_DISPLACEMENT, j]:
            take(series, DISPLACEMENT, i, n, x, c)
            peaks[PEAK_DISPLACEMENT, j] = largest_magnitude(c, n, peaks[PEAK_DISPLACEMENT, j])
        most = abs(series[DISPLACEMENT, i, 0] - series[DISPLACEMENT, j, 0])
        if j > 0:
            most = max(most, abs(state[DISPLACEMENT, j] - state[DISPLACEMENT, j - 1]))
            below = abs(series[INERTIA, j, 0]) + reach[ACCELERATION_REACH, j - 1]
        else:
            most = max(most, abs(state[DISPLACEMENT, j]))
            below = strongest
        if most + eighth * (pull + below) > peaks[PEAK_DRIFT, j]:
            take_difference(series, DISPLACEMENT, i, DISPLACEMENT, j, n, x, c)
            peaks[PEAK_DRIFT, j] = largest_magnitude(c, n, peaks[PEAK_DRIFT, j])
        # Sliding accelerates by its compliance times the reaction; a massless brace has no such bound.
        most = max(
            abs(series[DISPLACEMENT, i, 0] - series[OFFSET, i, 0]),
            abs(state[DISPLACEMENT, j] - state[OFFSET, j]),
        )
        slide = model[SLIDING_COMPLIANCE, j] * reach[REACTION_REACH, j]
        most += eighth * (pull + strongest + slide) + 0.125 * h * abs(series[SLIDING, i, 1])
        if most > peaks[PEAK_BRACE_DISPLACEMENT, j] or frame[BRACE_MASS, j] == 0.0:
            take_difference(series, DISPLACEMENT, i, OFFSET, i, n, x, c)
            peaks[PEAK_BRACE_DISPLACEMENT, j] = largest_magnitude(c, n, peaks[PEAK_BRACE_DISPLACEMENT, j])
        # The storey shear carries the inertia of all masses above: that of floor and brace, less what
        # the brace's acceleration falls short of the floor's.
        mass = frame[FLOOR_MASS, j] + frame[BRACE_MASS, j]
        lag = frame[BRACE_MASS, j] / h
        shear += mass * series[INERTIA, i, 0] - lag * series[SLIDING, i, 1]
        shear_reach += mass * reach[ACCELERATION_REACH, j] + frame[BRACE_MASS, j] * slide
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
