"""Factors that bring ground motions to a level: an ordinate of the elastic spectrum, its mean over a band, a
target spectrum; of one component, or of both components of a pair alike.

All of them are one rule.  With ordinates S_k of the motion's pseudo-acceleration and wanted ones W_k, the
factor that makes the sum of (ln f S_k - ln W_k)^2 least is f = exp(mean(ln W_k - ln S_k)): with one period it
gives the ordinate, with a constant W the geometric mean over the band, with a spectrum its closest fit
(Baker and Lee, 2018, and the database of PEER fit logarithms too).
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.model.number_check import finite_number, positive_number
from fdspec.signals.processing import rotated
from fdspec.signals.spectra import elastic_spectra
from fdspec.units import G

FloatArray = NDArray[np.float64]
Combination = Literal["geometric_mean", "rotd50", "rotd100"]

BAND_PERIODS: Final = 50
"""Periods in a band, evenly spaced on a logarithmic scale, its ends included."""

ANGLES: Final = tuple(float(angle) for angle in range(180))
"""Degrees: half a turn, in steps of one, as RotD is defined (Boore, 2010)."""

COMBINATIONS: Final[tuple[Combination, ...]] = ("geometric_mean", "rotd50", "rotd100")

UNITS: Final = {"g": G, "m/s2": 1.0, "m/s^2": 1.0, "cm/s2": 0.01, "cm/s^2": 0.01, "gal": 0.01}
"""Unit of a target's ordinates -> m/s2."""


class Target(NamedTuple):
    """A target spectrum: pseudo-accelerations (n,), m/s2, at rising periods (n,), s."""

    period: FloatArray
    acceleration: FloatArray

    def at(self, period: ArrayLike) -> FloatArray:
        """Return the ordinates at these periods: straight between points on double-logarithmic paper."""
        wanted = np.asarray(period, dtype=float)
        low, high = self.period[0], self.period[-1]
        if wanted.min() < low * (1.0 - 1e-9) or wanted.max() > high * (1.0 + 1e-9):
            raise InvalidInput(
                f"the target spectrum reaches from {low:g} to {high:g} s, and periods from "
                f"{wanted.min():g} to {wanted.max():g} s are asked for"
            )
        ordinates: FloatArray = np.exp(
            np.interp(np.log(wanted), np.log(self.period), np.log(self.acceleration))
        )
        return ordinates


def target_spectrum(period: ArrayLike, acceleration: ArrayLike) -> Target:
    """Return a target spectrum, checked: periods, s, rising; accelerations, m/s2; all positive."""
    x, y = (np.atleast_1d(np.asarray(values, dtype=float)) for values in (period, acceleration))
    if x.ndim != 1 or x.shape != y.shape or x.size < 2:
        raise InvalidInput(
            f"a target spectrum needs two or more points, periods and accelerations alike, got {x.shape} "
            f"and {y.shape}"
        )
    if not (np.isfinite(x).all() and np.isfinite(y).all() and x.min() > 0.0 and y.min() > 0.0):
        raise InvalidInput("periods and accelerations of a target spectrum must be positive and finite")
    for k in np.flatnonzero(np.diff(x) <= 0.0):
        raise InvalidInput(f"periods of a target spectrum must rise, but {x[k + 1]:g} follows {x[k]:g}")
    return Target(x, y)


def read_target(path: str | Path, units: str | None = None) -> Target:
    """Read a target spectrum from a CSV file of two columns, period in s and pseudo-acceleration.

    The unit stands in the heading, as in ``T (s), Sa (g)``, or is given: g, m/s2 or cm/s2.  A row of period
    0 is passed over.
    """
    if units is not None and units not in UNITS:
        raise InvalidInput(f"units of a target spectrum must be one of {', '.join(UNITS)}, not {units!r}")
    rows: list[tuple[float, float]] = []
    heading = ""
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            for number, row in enumerate(csv.reader(file), start=1):
                cells = [cell.strip() for cell in row if cell.strip()]
                if not cells or cells[0].startswith("#"):
                    heading += " ".join(cells)
                    continue
                try:
                    first, second = (float(cell) for cell in cells)
                except ValueError:
                    if rows:
                        raise InvalidInput(
                            f"{path}, line {number}: {','.join(row)!r:.80} is no period and acceleration"
                        ) from None
                    heading += " ".join(cells)
                    continue
                rows.append((first, second))
    except OSError as error:
        raise InvalidInput(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path} is not UTF-8 text") from None
    if not rows:
        raise InvalidInput(f"{path} holds no rows of period, acceleration")
    units = units or _unit_in(heading)
    if units is None:
        raise InvalidInput(f"{path} does not say the unit of its accelerations: give g, m/s2 or cm/s2")
    table = np.array([row for row in rows if row[0] != 0.0]).reshape(-1, 2)
    return target_spectrum(table[:, 0], table[:, 1] * UNITS[units])


def band(low: float, high: float) -> FloatArray:
    """Return the periods that stand for a band, s."""
    low, high = positive_number("low", low, "s"), positive_number("high", high, "s")
    if low >= high:
        raise InvalidInput(f"a band of periods must rise, not {low!r} to {high!r} s")
    return np.geomspace(low, high, BAND_PERIODS)


def pair_spectrum(
    first: GroundMotion,
    second: GroundMotion,
    period: ArrayLike,
    combination: Combination = "rotd50",
    *,
    damping_ratio: float = 0.05,
) -> FloatArray:
    """Return the pseudo-acceleration of a pair of components at right angles, m/s2, at each period.

    Parameters
    ----------
    first, second : GroundMotion
        Of equal length and time step.
    period : array_like, s
    combination : str
        ``geometric_mean`` of the two; ``rotd50`` and ``rotd100``, the median and the largest over all
        directions in the plane, in steps of one degree (Boore, 2010), each the exact peak of the continuous
        motion in that direction.
    damping_ratio : float
    """
    if combination not in COMBINATIONS:
        raise InvalidInput(f"combination must be one of {', '.join(COMBINATIONS)}, not {combination!r}")
    periods = np.atleast_1d(np.asarray(period, dtype=float))
    if combination == "geometric_mean":
        both = [spectrum(motion, periods, damping_ratio=damping_ratio) for motion in (first, second)]
        mean: FloatArray = np.sqrt(both[0] * both[1])
        return mean
    turned = [rotated(first, second, angle)[0] for angle in ANGLES]
    every = np.stack([spectrum(motion, periods, damping_ratio=damping_ratio) for motion in turned])
    return np.asarray(np.median(every, axis=0) if combination == "rotd50" else every.max(axis=0))


def spectrum(motion: GroundMotion, period: ArrayLike, *, damping_ratio: float = 0.05) -> FloatArray:
    """Return the pseudo-acceleration of one component, m/s2, at each period."""
    found = elastic_spectra(motion, np.atleast_1d(np.asarray(period, dtype=float)), damping_ratio)
    return np.asarray(found["pseudo_acceleration"].values[0, 0])


def scaled_to_spectrum(
    motion: GroundMotion,
    target: float | Target,
    period: float | Sequence[float] | FloatArray,
    *,
    damping_ratio: float = 0.05,
    pair: GroundMotion | None = None,
    combination: Combination = "rotd50",
) -> GroundMotion:
    """Scale a motion so that its elastic spectrum comes to a target.

    Parameters
    ----------
    motion : GroundMotion
    target : float or Target
        Pseudo-acceleration, m/s2: of the one period, or the geometric mean over the band; or a spectrum,
        which the scaled one fits best in the mean square of logarithms.
    period : float, or two of them, or more
        s; two are the ends of a band, for which `BAND_PERIODS` in it stand; more are the periods themselves.
    damping_ratio : float
    pair : GroundMotion, optional
        The other component: the factor is then that of the pair, the same for both.
    combination : str
        How a pair has one spectrum, as for `pair_spectrum`.

    Returns
    -------
    GroundMotion
        With the factor and what it was for in its history.

    Raises
    ------
    InvalidInput
        Where the motion is zero, or an argument cannot be used.

    Examples
    --------
    >>> motion = GroundMotion([0.0, 1.0, -1.0, 0.5, 0.0], 0.1, "mine")
    >>> spectrum(scaled_to_spectrum(motion, 4.0, 0.5), 0.5).round(9).tolist()
    [4.0]
    """
    periods = np.atleast_1d(np.asarray(period, dtype=float))
    if periods.size == 2:
        periods = band(*periods.tolist())
    if isinstance(target, Target):
        wanted, told = target.at(periods), "a target spectrum"
    else:
        wanted = np.full(periods.size, positive_number("target", target, "m/s2"))
        told = f"{'a mean Sa' if periods.size > 1 else 'an Sa'} of {float(target)!r} m/s2"
    if pair is None:
        ordinates, of = spectrum(motion, periods, damping_ratio=damping_ratio), ""
    else:
        ordinates = pair_spectrum(motion, pair, periods, combination, damping_ratio=damping_ratio)
        of = f", {combination} with {pair.component or pair.name or 'the other component'}"
    if not (ordinates > 0.0).all():
        raise InvalidInput(
            f"record {motion.name} has no response at {periods.min():g} s: no factor scales it"
        )
    factor = finite_number("factor", float(np.exp(np.mean(np.log(wanted) - np.log(ordinates)))))
    where = f"{periods[0]:g} s" if periods.size == 1 else f"{periods[0]:g} to {periods[-1]:g} s"
    return motion.rescaled(
        factor, f"scaled by {factor!r} to {told} at {where}, damping ratio {damping_ratio:g}{of}"
    )


def _unit_in(heading: str) -> str | None:
    """Find the one unit of acceleration that a heading names, in brackets or after a slash or blank."""
    words = re.findall(r"(?<![A-Za-z0-9])(cm/s\^?2|m/s\^?2|gal|g)(?![A-Za-z0-9])", heading.lower())
    return words[0] if len(set(words)) == 1 else None
