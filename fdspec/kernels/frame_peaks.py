"""Peaks of a frame's continuous motion, storey by storey."""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.frame import BRACE_MASS, FLOOR_MASS
from fdspec.kernels.roots import largest_magnitude
from fdspec.kernels.taylor import FLOOR, INERTIA, OFFSET

ACCELERATION = 0
DISPLACEMENT = 1
VELOCITY = 2
DRIFT = 3
SHEAR = 4
BRACE_DISPLACEMENT = 5
PEAK_ROWS = 6
"""Rows of the ``peaks`` array (6, N): absolute, relative to the ground, relative to the floor below, N."""


@inner
def raise_peaks(frame, series, n, h, c, tail, peaks):
    """Raise the peaks to those of the step.

    A quantity is at most its value at the start plus the magnitudes of its other terms; only where
    that leaves room for a new peak is it searched.  tail (4, N + 1) is room to work in.
    """
    size = frame.shape[1]
    u = series[FLOOR]
    o = series[OFFSET]
    inertia = series[INERTIA]
    for row in range(4):
        for i in range(size + 1):
            tail[row, i] = 0.0
    for k in range(1, n + 1):
        for i in range(1, size + 1):
            tail[0, i] += abs(u[k, i])
            tail[3, i] += abs(o[k, i])
    for k in range(2, n + 1):
        for i in range(1, size + 1):
            tail[1, i] += k * abs(u[k, i])
    for k in range(1, n - 1):
        for i in range(1, size + 1):
            tail[2, i] += abs(inertia[k, i])
    shear = 0.0
    shear_tail = 0.0
    for i in range(size, 0, -1):
        j = i - 1
        if abs(inertia[0, i]) + tail[2, i] > peaks[ACCELERATION, j]:
            for k in range(n - 1):
                c[k] = inertia[k, i]
            peaks[ACCELERATION, j] = largest_magnitude(c, n - 2, peaks[ACCELERATION, j])
        if abs(u[0, i]) + tail[0, i] > peaks[DISPLACEMENT, j]:
            for k in range(n + 1):
                c[k] = u[k, i]
            peaks[DISPLACEMENT, j] = largest_magnitude(c, n, peaks[DISPLACEMENT, j])
        if abs(u[1, i]) + tail[1, i] > peaks[VELOCITY, j] * h:
            for k in range(n):
                c[k] = (k + 1) * u[k + 1, i] / h
            peaks[VELOCITY, j] = largest_magnitude(c, n - 1, peaks[VELOCITY, j])
        if abs(u[0, i] - u[0, j]) + tail[0, i] + tail[0, j] > peaks[DRIFT, j]:
            for k in range(n + 1):
                c[k] = u[k, i] - u[k, j]
            peaks[DRIFT, j] = largest_magnitude(c, n, peaks[DRIFT, j])
        if abs(u[0, i] - o[0, i]) + tail[0, i] + tail[3, i] > peaks[BRACE_DISPLACEMENT, j]:
            for k in range(n + 1):
                c[k] = u[k, i] - o[k, i]
            peaks[BRACE_DISPLACEMENT, j] = largest_magnitude(c, n, peaks[BRACE_DISPLACEMENT, j])
        # The storey shear carries the inertia of all masses above: those of floor and brace, less what
        # the brace's acceleration falls short of the floor's.
        mass = frame[FLOOR_MASS, j] + frame[BRACE_MASS, j]
        lag = frame[BRACE_MASS, j] / (h * h)
        shear += mass * inertia[0, i] - lag * 2.0 * o[2, i]
        shear_tail += mass * tail[2, i]
        for k in range(1, n - 1):
            shear_tail += lag * (k + 2) * (k + 1) * abs(o[k + 2, i])
        if abs(shear) + shear_tail > peaks[SHEAR, j]:
            storey_shear(frame, series, n, h, j, c)
            peaks[SHEAR, j] = largest_magnitude(c, n - 2, peaks[SHEAR, j])


@inner
def storey_shear(frame, series, n, h, storey, c):
    """Series of the shear (N) in frame and brace of one storey, counted from 0, positive with the drift."""
    o = series[OFFSET]
    inertia = series[INERTIA]
    for k in range(n - 1):
        c[k] = 0.0
    for i in range(frame.shape[1], storey, -1):
        mass = frame[FLOOR_MASS, i - 1] + frame[BRACE_MASS, i - 1]
        lag = frame[BRACE_MASS, i - 1] / (h * h)
        for k in range(n - 1):
            c[k] -= mass * inertia[k, i] - lag * (k + 2) * (k + 1) * o[k + 2, i]
