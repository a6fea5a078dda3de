"""Bilinear oscillators from periods and strengths to peaks, and from ductilities to strengths."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.kernels.bilinear.ductility import strengths_for
from fdspec.kernels.bilinear.entry import bilinear_histories, rigid_histories
from fdspec.kernels.bilinear.history import RESULTS
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ENDLESS: Final = 1e300
"""A strength that nothing reaches, m/s2."""

MOST_ROOTS: Final = 8
"""Roots kept of one ductility; more are counted."""


class Oscillator(NamedTuple):
    """Damping ratio, hardening ratio, and the ductility at which collapse is called."""

    damping_ratio: float
    hardening_ratio: float
    collapse_ductility: float


def bilinear_peaks(
    oscillator: Oscillator,
    period: float,
    strength: FloatArray,
    motion: GroundMotion,
    *,
    certify: bool = True,
    halvings: int = 0,
) -> FloatArray:
    """Return the results of one period under strengths (m,), m/s2: (m, len(RESULTS)).

    Period 0 is a rigid block on the ground.  certify: whether the energy balance is closed.  halvings: of the
    steps; no result depends on it.
    """
    strength = np.ascontiguousarray(strength, dtype=np.float64)
    out = np.empty((strength.size, len(RESULTS)))
    if period == 0.0:
        rigid_histories(motion.acceleration, motion.dt, strength, out)
        return out
    omega = 2.0 * math.pi / period
    limit = oscillator.collapse_ductility * strength / omega**2
    bilinear_histories(
        motion.acceleration,
        motion.dt,
        2.0 * oscillator.damping_ratio * omega,
        omega * omega,
        oscillator.hardening_ratio,
        strength,
        limit,
        certify,
        True,
        halvings,
        out,
    )
    return out


def elastic_strength(oscillator: Oscillator, period: float, motion: GroundMotion) -> float:
    """Return the strength, m/s2, from which the oscillator stays elastic: stiffness times elastic peak."""
    if period == 0.0:
        return float(np.abs(motion.acceleration).max())
    elastic = oscillator._replace(hardening_ratio=0.0, collapse_ductility=math.inf)
    peaks = bilinear_peaks(elastic, period, np.array([ENDLESS]), motion)
    return float(peaks[0, 0] * (2.0 * math.pi / period) ** 2)


def ductility_strengths(
    oscillator: Oscillator, period: float, ductility: FloatArray, motion: GroundMotion
) -> tuple[FloatArray, IntArray]:
    """Return all strengths of each ductility (n,), the largest first, NaN behind the last, and their number.

    A rigid block has no ductility; as the period goes to 0, the strength goes to the peak ground
    acceleration for every ductility.
    """
    roots = np.full((ductility.size, MOST_ROOTS), np.nan)
    counts = np.ones(ductility.size, np.int64)
    if period == 0.0:
        roots[:, 0] = elastic_strength(oscillator, period, motion)
        return roots, counts
    omega = 2.0 * math.pi / period
    strengths_for(
        motion.acceleration,
        motion.dt,
        2.0 * oscillator.damping_ratio * omega,
        omega * omega,
        oscillator.hardening_ratio,
        oscillator.collapse_ductility,
        np.ascontiguousarray(ductility, dtype=np.float64),
        roots,
        counts,
    )
    return roots, counts
