"""Intensity measures of a ground motion: numbers that tell how strong and how long it is.

Integrals are exact for an acceleration that is linear between samples.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.units import G


@dataclass(frozen=True)
class Intensity:
    """What `intensity` returns; SI units, see there."""

    pga: float
    pgv: float
    pgd: float
    arias: float
    significant_duration: float
    cav: float


def velocity(motion: GroundMotion) -> NDArray[np.float64]:
    """Return the ground velocity at the samples, m/s, shape (n,), from rest."""
    a = motion.acceleration
    return np.concatenate([[0.0], np.cumsum((a[:-1] + a[1:]) * (0.5 * motion.dt))])


def displacement(motion: GroundMotion) -> NDArray[np.float64]:
    """Return the ground displacement at the samples, m, shape (n,), from rest."""
    a, v, h = motion.acceleration, velocity(motion), motion.dt
    return np.concatenate([[0.0], np.cumsum(v[:-1] * h + (2.0 * a[:-1] + a[1:]) * (h * h / 6.0))])


def husid(motion: GroundMotion) -> NDArray[np.float64]:
    """Return the Arias intensity up to each sample, m/s, shape (n,): pi / (2 g) times the integral of a^2."""
    a = motion.acceleration
    pieces = (a[:-1] * a[:-1] + a[:-1] * a[1:] + a[1:] * a[1:]) * (motion.dt / 3.0)
    return np.concatenate([[0.0], np.cumsum(pieces)]) * (math.pi / (2.0 * G))


def arias_time(motion: GroundMotion, share: float) -> float:
    """Return the first time, s, at which the given share (0 to 1) of the Arias intensity has arrived.

    Between samples the share is taken as linear in time. All of it has arrived where the shaking ends,
    with or without zeros behind.
    """
    if not 0.0 <= share <= 1.0:
        raise InvalidInput(f"share must be from 0 to 1, not {share!r}")
    arrived = husid(motion)
    if arrived[-1] == 0.0:
        raise InvalidInput("a motion that is zero throughout has no Arias intensity")
    after = int(np.searchsorted(arrived, share * arrived[-1]))
    around = slice(max(after - 1, 0), after + 1)
    return float(np.interp(share * arrived[-1], arrived[around], motion.time[around]))


def intensity(motion: GroundMotion, start: float = 0.05, end: float = 0.95) -> Intensity:
    """Compute peaks, Arias intensity, duration and cumulative absolute velocity of a motion.

    Parameters
    ----------
    motion : GroundMotion
    start, end : float
        Shares of the Arias intensity that bound the significant duration.

    Returns
    -------
    Intensity
        `pga`, m/s2; `pgv`, m/s, and `pgd`, m, of the continuous motion, integrated from rest without
        correction; `arias`, m/s (Arias 1970); `significant_duration`, s (Trifunac and Brady 1975); `cav`,
        m/s.

    Examples
    --------
    >>> found = intensity(GroundMotion([0.0, 2.0, 0.0], 0.5))
    >>> found.pga, found.pgv, found.cav
    (2.0, 1.0, 1.0)
    """
    if not start < end:
        raise InvalidInput(f"start must be below end, not {start!r} and {end!r}")
    return Intensity(
        pga=motion.pga,
        pgv=_peak_velocity(motion),
        pgd=_peak_displacement(motion),
        arias=float(husid(motion)[-1]),
        significant_duration=arias_time(motion, end) - arias_time(motion, start),
        cav=_cav(motion),
    )


LOWEST_FREQUENCY: Final = 0.25
HIGHEST_FREQUENCY: Final = 20.0
"""Hz; the band of the mean period."""


def mean_period(motion: GroundMotion) -> float:
    """Return the mean period of a motion, s: its periods, weighted by the squares of its Fourier amplitudes.

    T_m = sum(C_i^2 / f_i) / sum(C_i^2) over 0.25 to 20 Hz; Rathje, Abrahamson and Bray (1998), J. Geotech.
    Geoenviron. Eng. 124(2).

    Parameters
    ----------
    motion : GroundMotion

    Raises
    ------
    InvalidInput
        When the motion has nothing in that band.

    Examples
    --------
    >>> wave = np.sin(2.0 * np.pi * np.arange(0.0, 20.0, 0.01) / 0.4)
    >>> round(mean_period(GroundMotion(wave, 0.01)), 3)
    0.4
    """
    frequency = np.fft.rfftfreq(motion.n, motion.dt)
    inside = (frequency >= LOWEST_FREQUENCY) & (frequency <= HIGHEST_FREQUENCY)
    power = np.abs(np.fft.rfft(motion.acceleration)[inside]) ** 2
    if not power.sum() > 0.0:
        raise InvalidInput(
            f"{motion.name or 'the motion'} has nothing between 0.25 and 20 Hz: no mean period"
        )
    return float((power / frequency[inside]).sum() / power.sum())


def _peak_velocity(motion: GroundMotion) -> float:
    """Return the largest |velocity|, m/s: at a sample, or between two where the acceleration changes sign."""
    a, v = motion.acceleration, velocity(motion)
    before = np.flatnonzero(a[:-1] * a[1:] < 0.0)
    until_turn = motion.dt * a[before] / (a[before] - a[before + 1])
    turns = v[before] + 0.5 * a[before] * until_turn
    return float(np.abs(np.concatenate([v, turns])).max())


def _peak_displacement(motion: GroundMotion) -> float:
    """Return the largest |displacement|, m: at a sample, or between two where the velocity is zero."""
    a, v, d, h = motion.acceleration[:-1], velocity(motion)[:-1], displacement(motion), motion.dt
    bend = np.diff(motion.acceleration) / (2.0 * h)  # velocity is v + a t + bend t^2
    with np.errstate(all="ignore"):
        root = np.sqrt(a * a - 4.0 * bend * v)
        large = -0.5 * (a + np.copysign(root, a))
        times = np.stack([large / bend, v / large])
        turns = d[:-1] + times * (v + times * (a / 2.0 + times * (bend / 3.0)))
        inside = (times > 0.0) & (times < h)
    return float(np.abs(np.concatenate([d, turns[inside]])).max())


def _cav(motion: GroundMotion) -> float:
    """Return the integral of |a|, m/s: trapezia, but two triangles where a changes sign."""
    a, b = motion.acceleration[:-1], motion.acceleration[1:]
    low, high = np.abs(a), np.abs(b)
    total = low + high
    crossing = (a * b < 0.0) & (total > 0.0)
    triangles = (low * low + high * high) / np.where(crossing, total, 1.0)
    return float(np.where(crossing, triangles, total).sum() * 0.5 * motion.dt)
