"""The elastic ordinate: what peers charge for it, and what the recurrence itself costs at the least."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from benchmarks.problem import Problem

Array = NDArray[np.float64]

ZETA = 0.05
LANES = 64
PERIODS = 0.05 * np.arange(1, 61)


def pyrotd_ordinates(ground: Array, dt: float) -> Array:
    """Spectral displacements (m) by pyrotd, in the frequency domain, in this process."""
    import pyrotd

    pyrotd.processes = 1
    spectrum = pyrotd.calc_spec_accels(dt, ground, 1.0 / PERIODS, ZETA)
    return np.asarray(spectrum.spec_accel) / (2.0 * np.pi / PERIODS) ** 2


def eqsig_ordinates(ground: Array, dt: float) -> Array:
    """Spectral displacements (m) by eqsig (Nigam and Jennings)."""
    from eqsig import sdof

    return np.asarray(sdof.true_response_spectra(ground, dt, PERIODS, ZETA)[0])


def sdof_ordinates(ground: Array, dt: float) -> Array:
    """Spectral displacements (m) by sdof: Newmark in C, at the record's step.

    Its own `spectrum` raises on records of some lengths, so that loop is made here.
    """
    import sdof

    found = np.empty(len(PERIODS))
    force = -np.ascontiguousarray(ground)
    for i, period in enumerate(PERIODS):
        omega = 2.0 * math.pi / period
        displacement = sdof.integrate(m=1.0, c=2.0 * ZETA * omega, k=omega**2, f=force, dt=dt)[0]
        found[i] = np.max(np.abs(displacement))
    return found


PEERS: dict[str, Callable[[Array, float], Array]] = {
    "pyrotd": pyrotd_ordinates,
    "eqsig": eqsig_ordinates,
    "sdof": sdof_ordinates,
}


@numba.njit(error_model="numpy")
def _march(ground: Array, maps: Array, peak: Array) -> None:
    """Advance lanes of oscillators side by side: eight multiplications a step, and the largest u."""
    groups = peak.size // LANES
    state = np.empty((2, LANES))
    lane = np.empty((8, LANES))
    top = np.empty(LANES)
    for group in range(groups):
        lane[:] = maps[:, group * LANES : (group + 1) * LANES]
        state[:] = 0.0
        top[:] = 0.0
        for i in range(ground.size - 1):
            p, q = ground[i], ground[i + 1]
            for j in range(LANES):
                u, v = state[0, j], state[1, j]
                x = lane[0, j] * u + lane[1, j] * v + lane[2, j] * p + lane[3, j] * q
                state[1, j] = lane[4, j] * u + lane[5, j] * v + lane[6, j] * p + lane[7, j] * q
                state[0, j] = x
                top[j] = max(top[j], abs(x))
        peak[group * LANES : (group + 1) * LANES] = top


@cache
def _maps(dt: float, count: int) -> Array:
    """Coefficients (8, count) of the exact step for periods over PERIODS' range."""
    maps = np.empty((8, count))
    for j, period in enumerate(np.linspace(PERIODS[0], PERIODS[-1], count)):
        omega = 2.0 * math.pi / period
        a = np.zeros((4, 4))
        a[0, 1] = a[2, 3] = 1.0
        a[1] = -(omega**2), -2.0 * ZETA * omega, -1.0, 0.0
        step = expm(a * dt)[:2]
        # a_g = p + (q - p) t/dt
        rise = step[:, 3] / dt
        maps[:, j] = np.column_stack([step[:, 0], step[:, 1], step[:, 2] - rise, rise]).ravel()
    return maps


def recurrence(problem: Problem, count: int = 1024) -> int:
    """March ``count`` elastic oscillators; returns their number."""
    ground, dt = problem.motion
    peak = np.empty(count)
    _march(ground, _maps(dt, count), peak)
    return count


def sampled_ordinates(problem: Problem) -> Array:
    """Largest sampled spectral displacements (m), exact at the samples."""
    ground, dt = problem.motion
    found = np.empty(len(PERIODS))
    for i, period in enumerate(PERIODS):
        omega = 2.0 * math.pi / period
        a = np.zeros((4, 4))
        a[0, 1] = a[2, 3] = 1.0
        a[1] = -(omega**2), -2.0 * ZETA * omega, -1.0, 0.0
        step = expm(a * dt)[:2]
        z = np.zeros(2)
        top = 0.0
        for k in range(len(ground) - 1):
            z = step @ np.array([z[0], z[1], ground[k], (ground[k + 1] - ground[k]) / dt])
            top = max(top, abs(z[0]))
        found[i] = top
    return found
