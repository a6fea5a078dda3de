"""Peaks of the continuous motion of a frame with devices."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.layout import (
    BESIDE,
    BRACE,
    KIND,
    LOWER,
    MASS,
    ORIGIN,
    PEAK_DEFORMATION,
    PEAK_FORCE,
    PEAK_SLIP,
    PEAK_TOP,
    PHASE,
    UPPER,
    WITH_MASS,
    A,
    O,
    U,
    V,
    Z,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude
from fdspec.kernels.types import STICK

PEAK_ACCELERATION = 0
PEAK_DISPLACEMENT = 1
PEAK_VELOCITY = 2
PEAK_DRIFT = 3
PEAK_SHEAR = 4
PEAK_ROWS = 5
"""Rows of ``peaks`` (5, S), S as in ``carried``: absolute, relative to the ground, relative to the floor
below, N.  Column N, where there is one, has the shear on the ground of all frames."""


@inner
def raised(c, n, x, peak):
    """The greater of the peak and of |p| on the first part x of a step; nothing is searched without need."""
    most = abs(c[0])
    for k in range(1, n + 1):
        most += abs(c[k])
    if most <= peak:
        return peak
    if x < 1.0:
        power = 1.0
        for k in range(n + 1):
            c[k] *= power
            power *= x
    return largest_magnitude(c, n, peak)


@inner
def raise_peaks(frame, state, series, n, h, x, peaks):
    """Raise all peaks to those of the first part x of the step."""
    c = series.c
    floors = series.floors
    for i in range(1, frame.mass.size):
        below = frame.below[i - 1]
        for k in range(n):
            c[k] = floors[A, i, k]
        peaks[PEAK_ACCELERATION, i - 1] = raised(c, n - 1, x, peaks[PEAK_ACCELERATION, i - 1])
        for k in range(n + 1):
            c[k] = floors[U, i, k]
        peaks[PEAK_DISPLACEMENT, i - 1] = raised(c, n, x, peaks[PEAK_DISPLACEMENT, i - 1])
        for k in range(n + 1):
            c[k] = floors[V, i, k]
        peaks[PEAK_VELOCITY, i - 1] = raised(c, n, x, peaks[PEAK_VELOCITY, i - 1])
        for k in range(n + 1):
            c[k] = floors[U, i, k] - floors[U, below, k]
        peaks[PEAK_DRIFT, i - 1] = raised(c, n, x, peaks[PEAK_DRIFT, i - 1])
    for i in range(frame.carried.shape[0]):
        shear_below(frame, series, n, h, frame.carried[i], c)
        peaks[PEAK_SHEAR, i] = raised(c, n - 1, x, peaks[PEAK_SHEAR, i])
    tally = state.tally
    for j in range(frame.places.shape[1]):
        if state.mode[PHASE, j] != STICK:
            for k in range(n + 1):
                c[k] = series.sliders[O, j, k]
            c[0] -= tally[ORIGIN, j]
            tally[PEAK_SLIP, j] = raised(c, n, x, tally[PEAK_SLIP, j])
        upper = frame.places[UPPER, j]
        lower = frame.places[LOWER, j]
        for k in range(n + 1):
            c[k] = floors[U, upper, k] - floors[U, lower, k]
        tally[PEAK_DEFORMATION, j] = raised(c, n, x, tally[PEAK_DEFORMATION, j])
        for k in range(n + 1):
            c[k] = floors[U, upper, k] - series.sliders[O, j, k]
        tally[PEAK_TOP, j] = raised(c, n, x, tally[PEAK_TOP, j])
        beside = frame.links[BESIDE, j]
        for k in range(n):
            c[k] = series.sliders[BRACE, j, k] + beside * (floors[U, upper, k] - floors[U, lower, k])
        tally[PEAK_FORCE, j] = raised(c, n - 1, x, tally[PEAK_FORCE, j])


@inner
def shear_below(frame, series, n, h, carried, c):
    """Series of the shear (N) that carries the inertia of these nodes (N + 1,), plates with them."""
    for k in range(n):
        c[k] = 0.0
    for i in range(1, frame.mass.size):
        if carried[i]:
            for k in range(n):
                c[k] -= frame.mass[i] * series.floors[A, i, k]
    for j in range(frame.places.shape[1]):
        upper = frame.places[UPPER, j]
        if frame.places[KIND, j] == WITH_MASS and carried[upper]:
            mass = frame.links[MASS, j]
            for k in range(n):
                c[k] -= mass * (series.floors[A, upper, k] - (k + 1) / h * series.sliders[Z, j, k + 1])
