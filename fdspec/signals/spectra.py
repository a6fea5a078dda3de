"""Elastic response spectra of ground motions: exact for motion that is linear between samples."""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.variables import TEXT, Registry, Variable, describe

if TYPE_CHECKING:
    import xarray as xr

SHORTEST: Final = 0.05
"""In units of dt: an oscillator with a shorter period follows the ground to rounding of the sampling."""

ENDLESS: Final = 1e300
"""A strength that nothing reaches, m/s2; a displacement that nothing reaches, m."""

_DIMS: Final = ("record", "damping_ratio", "period")

SPECTRA: Final[Registry] = MappingProxyType(
    {
        variable.name: variable
        for variable in (
            Variable("record", ("record",), "", "name of the ground motion", TEXT),
            Variable("damping_ratio", ("damping_ratio",), "1", "damping ratio of the oscillator"),
            Variable("period", ("period",), "s", "undamped natural period of the oscillator"),
            Variable("spectral_displacement", _DIMS, "m", "largest displacement relative to the ground"),
            Variable(
                "pseudo_acceleration",
                _DIMS,
                "m/s^2",
                "largest displacement times the square of the frequency",
            ),
            Variable("absolute_acceleration", _DIMS, "m/s^2", "largest absolute acceleration"),
        )
    }
)


def elastic_spectra(
    motions: GroundMotion | Sequence[GroundMotion],
    period: ArrayLike,
    damping_ratio: ArrayLike = 0.05,
    *,
    after: Literal["record", "peak"] = "record",
) -> xr.Dataset:
    """Compute the elastic response spectra of ground motions.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Names must differ.
    period : array_like, s
        Undamped natural periods: 0, which rides with the ground, or at least a twentieth of the longest time
        step.
    damping_ratio : float or array_like
        From 0 up; 1 and more is an oscillator that creeps back.
    after : "record" or "peak"
        Where to stop: at the record's end, or when no larger peak can come.  Oscillators of long period may
        have their largest peak after the record, most where it was cut off early.

    Returns
    -------
    xarray.Dataset
        Over (record, damping_ratio, period): `spectral_displacement`, m, relative to the ground;
        `pseudo_acceleration`, m/s2, that times (2 pi / period)^2; `absolute_acceleration`, m/s2.

    Raises
    ------
    InvalidInput
        When an argument cannot be used.

    Notes
    -----
    The oscillator starts at rest, the ground acceleration is linear between its samples and zero after the
    record, peaks are those of the continuous motion. Nigam and Jennings (1969) for the motion at the samples.

    Examples
    --------
    >>> from fdspec.model.motion import GroundMotion
    >>> spectra = elastic_spectra(GroundMotion([0.0, 1.0, 0.0, 0.0], 0.5, "a"), [0.5, 1.0])
    >>> spectra.absolute_acceleration.shape
    (1, 1, 2)
    """
    import xarray as xr

    records = [motions] if isinstance(motions, GroundMotion) else list(motions)
    names = [motion.name for motion in records]
    if not records or len(set(names)) < len(names):
        raise InvalidInput(f"motions must be one or more with names that differ, not {names}")
    periods = _axis("period", period)
    ratios = _axis("damping_ratio", damping_ratio)
    shortest = max(motion.dt for motion in records) * SHORTEST
    for value in periods[(periods != 0.0) & (periods < shortest)]:
        raise InvalidInput(
            f"period must be 0 or at least {shortest:g} s, a twentieth of the longest dt, not {value:g}"
        )
    if after not in ("record", "peak"):
        raise InvalidInput(f'after must be "record" or "peak", not {after!r}')
    if ratios.min(initial=math.inf) < 0.0:
        raise InvalidInput(f"damping_ratio must be 0 or more, not {ratios.min():g}")
    swings = periods > 0.0
    frequency = 2.0 * np.pi / periods[swings]
    omega, zeta = (grid.ravel() for grid in np.meshgrid(frequency, ratios))
    peaks_of = _peaks if after == "record" else _peaks_at_last
    peaks = np.zeros((len(records), 2, ratios.size, periods.size))
    for found, motion in zip(peaks, records, strict=True):
        found[..., swings] = peaks_of(motion, omega, zeta).reshape(2, ratios.size, -1)
        found[1][..., ~swings] = motion.pga
    displacement = peaks[:, 0]
    pseudo = peaks[:, 1].copy()  # of period 0, where the two agree
    pseudo[..., swings] = displacement[..., swings] * frequency**2
    dataset = xr.Dataset(
        {
            "spectral_displacement": (_DIMS, displacement),
            "pseudo_acceleration": (_DIMS, pseudo),
            "absolute_acceleration": (_DIMS, peaks[:, 1]),
        },
        coords={"record": names, "damping_ratio": ratios, "period": periods},
    )
    return describe(dataset, SPECTRA)


def _axis(argument: str, values: ArrayLike) -> NDArray[np.float64]:
    try:
        axis = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        raise InvalidInput(f"{argument} must be a number or a sequence of numbers, not {values!r}") from None
    if axis.ndim != 1 or axis.size == 0 or not np.isfinite(axis).all():
        raise InvalidInput(f"{argument} must be one or more finite numbers in one dimension, not {values!r}")
    return axis


def _peaks(
    motion: GroundMotion, omega: NDArray[np.float64], zeta: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return |x| and |x'' + a_g|, shape (2, oscillators); equal subdivisions of dt run together."""
    from fdspec.kernels.mathematics.elastic_peaks import elastic_peaks

    rate = omega * (zeta + np.sqrt(zeta * zeta + 1.0))  # bound on growth of derivatives, 1/s
    halvings = np.maximum(np.ceil(np.log2(np.maximum(rate * motion.dt, 1.0))), 0.0).astype(int)
    peaks = np.empty((2, omega.size))
    for count in np.unique(halvings):
        chosen = halvings == count
        parts = 2**count
        found = np.empty((2, int(chosen.sum())))
        ground = np.ascontiguousarray(_subdivided(motion.acceleration, int(parts)))
        elastic_peaks(omega[chosen], zeta[chosen], ground, motion.dt / parts, found)
        peaks[:, chosen] = found
    return peaks


def _peaks_at_last(
    motion: GroundMotion, omega: NDArray[np.float64], zeta: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the same with free vibration until no larger peak can come."""
    from fdspec.kernels.bilinear.entry import bilinear_histories
    from fdspec.kernels.bilinear.history import RESULTS

    peaks = np.empty((2, omega.size))
    never, out = np.array([ENDLESS]), np.empty((1, len(RESULTS)))
    for at, (rate, ratio) in enumerate(zip(omega, zeta, strict=True)):
        damping, stiffness = 2.0 * ratio * rate, rate * rate
        bilinear_histories(
            motion.acceleration, motion.dt, damping, stiffness, 0.0, never, never, False, True, 0, out
        )
        peaks[:, at] = out[0, :2]
    return peaks


def _subdivided(acceleration: NDArray[np.float64], parts: int) -> NDArray[np.float64]:
    """Return the same piecewise linear motion with `parts` steps in each of its steps."""
    if parts == 1:
        return acceleration
    fractions = np.arange(parts) / parts
    steps = np.diff(acceleration)
    return np.append((acceleration[:-1, None] + steps[:, None] * fractions).ravel(), acceleration[-1])
