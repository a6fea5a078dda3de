"""Peaks of a linear oscillator by matrix exponentials and bracketed roots; imports nothing from fdspec."""

import math

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

LOOKS = 8
"""Looks within a step or a radian, whichever is shorter."""


def elastic_peaks(acceleration, dt, period, zeta):
    """Return max |x| and max |x'' + a_g| of x'' + 2 zeta w x' + w^2 x = -a_g, a_g linear between samples."""
    w = 2.0 * math.pi / period
    # State: displacement, velocity, ground acceleration, its rate.
    matrix = np.zeros((4, 4))
    matrix[0, 1] = matrix[2, 3] = 1.0
    matrix[1] = -w * w, -2.0 * zeta * w, -1.0, 0.0
    parts = LOOKS * math.ceil(max(1.0, 2.0 * (1.0 + zeta) * w * dt))
    advance = expm(matrix * (dt / parts))
    states = np.empty(((len(acceleration) - 1) * parts + 1, 4))
    state = np.zeros(4)
    for k, start in enumerate(acceleration[:-1]):
        state = np.array([state[0], state[1], start, (acceleration[k + 1] - start) / dt])
        for part in range(parts):
            states[k * parts + part] = state
            state = advance @ state
    states[-1] = state
    displacement = np.array([1.0, 0.0, 0.0, 0.0])
    absolute = matrix[1] + np.array([0.0, 0.0, 1.0, 0.0])
    return [_peak(states, matrix, advance, row, dt / parts) for row in (displacement, absolute)]


def _peak(states, matrix, advance, row, piece):
    """Return the largest |row @ state|, also between the states, where its rate changes sign."""
    best = np.abs(states @ row).max()
    rate = row @ matrix
    # An eighth of a radian from a peak a sine is still 0.99 of it.
    for state in states[:-1][np.abs(states[:-1] @ row) > 0.95 * best]:
        if (rate @ state) * (rate @ (advance @ state)) < 0.0:
            turn = brentq(lambda t, s=state: rate @ (expm(matrix * t) @ s), 0.0, piece, xtol=1e-16)
            best = max(best, abs(row @ (expm(matrix * turn) @ state)))
    return best
