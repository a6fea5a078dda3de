"""The sentences that the study's conclusions fall into, each true or false of single cells of a cube.

Where the study leaves open what it means, a sentence says which meaning was taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

EDGE: Final = 1e-9
"""Relative; periods and pretensions made by steps miss round numbers by rounding."""

SAME: Final = 0.01
"""Relative change of the response that counts as none."""

NEAR: Final = 0.05
"""Relative excess over the least response that counts as least."""

FELT: Final = 0.1
"""Relative change of the response that counts as control, and spread of reductions that counts as one."""


@dataclass(frozen=True)
class Cells:
    """Responses and their two limits, m/s2, NaN where unknown; pretension in N, in the study's meaning."""

    peak: xr.DataArray
    free: xr.DataArray
    braced: xr.DataArray

    def within(self, axis: str, low: float, high: float = math.inf) -> Cells:
        """Keep an axis between bounds, both included."""
        values = self.peak[axis].values
        kept = np.flatnonzero((values >= low * (1.0 - EDGE)) & (values <= high * (1.0 + EDGE)))
        parts = (part.isel({axis: kept}) if axis in part.dims else part for part in self._parts)
        return Cells(*parts)

    def beyond(self, axis: str, low: float) -> Cells:
        """Keep what lies above a bound, without it."""
        return self.within(axis, low * (1.0 + 2.0 * EDGE))

    def at(self, axis: str, wanted: Sequence[float]) -> Cells:
        """Keep given values of an axis."""
        kept = np.flatnonzero(
            np.isclose(self.peak[axis].values[:, None], wanted, rtol=EDGE, atol=0).any(axis=1)
        )
        parts = (part.isel({axis: kept}) if axis in part.dims else part for part in self._parts)
        return Cells(*parts)

    @property
    def _parts(self) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
        return self.peak, self.free, self.braced


@dataclass(frozen=True)
class Part:
    """One sentence of a claim that cells can decide.

    `found` returns 1 where a cell does what `sentence` says, 0 where it does not, NaN where that is unknown;
    every dim but ``record`` counts cells. A sentence about single figures of the study names the records
    that they show; other records do not count.
    """

    name: str
    sentence: str
    found: Callable[[Cells], xr.DataArray]
    records: tuple[str, ...] = ()

    @property
    def claim(self) -> str:
        """The letter of its claim."""
        return self.name[0]


def _truth(condition: xr.DataArray, *needed: xr.DataArray) -> xr.DataArray:
    """Return 1 and 0 for a condition, NaN where what it needs is unknown."""
    known = condition.astype(float)
    for values in needed:
        known = known.where(np.isfinite(values))
    return known


def _grows(cells: Cells) -> xr.DataArray:
    most = cells.peak.max(["pretension", "period"], skipna=False)
    step = most.diff("stiffness_ratio")
    return _truth(step > 0.0, step)


def _still_beyond(cells: Cells) -> xr.DataArray:
    high = cells.at("stiffness_ratio", [0.5, 1.0]).within("pretension", 300e3).peak
    _enough(high, "pretension")
    least, most = high.min("pretension", skipna=False), high.max("pretension", skipna=False)
    return _truth(most <= (1.0 + SAME) * least, most)


def _uncontrolled(cells: Cells) -> xr.DataArray:
    soft = cells.at("stiffness_ratio", [0.5, 1.0])
    least = soft.peak.min("pretension", skipna=False)
    return _truth(least >= (1.0 - FELT) * soft.free, least, soft.free)


def _least_within(peak: xr.DataArray) -> xr.DataArray:
    cells = Cells(peak, peak, peak)
    band = cells.within("pretension", 100e3, 250e3).peak
    _enough(band, "pretension", 1)
    least, inside = peak.min("pretension", skipna=False), band.min("pretension", skipna=False)
    return _truth(inside <= (1.0 + NEAR) * least, least)


def _least_of_spectrum(cells: Cells) -> xr.DataArray:
    stiff = cells.beyond("stiffness_ratio", 4.0)
    return _least_within(stiff.peak.max("period", skipna=False))


def _least_at_each_period(cells: Cells) -> xr.DataArray:
    return _least_within(cells.beyond("stiffness_ratio", 4.0).peak)


def _rises_past_optimum(cells: Cells) -> xr.DataArray:
    peak = cells.within("period", 0.0, 0.4).peak
    _enough(peak, "pretension")
    peak = peak.transpose(..., "pretension")
    values = peak.values
    unknown = np.isnan(values).any(axis=-1)
    best = np.argmin(np.where(np.isnan(values), np.inf, values), axis=-1)
    step = values[..., 1:] >= (1.0 - SAME) * values[..., :-1]
    before = np.arange(step.shape[-1]) < best[..., None]
    rises = (step | before).all(axis=-1) & (values[..., -1] > (1.0 + NEAR) * values.min(axis=-1))
    return peak.isel(pretension=0, drop=True).copy(data=np.where(unknown, np.nan, rises))


def _falls_with_period(cells: Cells) -> xr.DataArray:
    return _in_pairs(cells.beyond("period", 0.4).peak, -1.0)


def _rises_with_period(cells: Cells) -> xr.DataArray:
    past = cells.within("period", 0.0, 0.4).within("pretension", 100e3)
    return _in_pairs(past.peak, 1.0)


def _free_falls(cells: Cells) -> xr.DataArray:
    return _in_pairs(cells.free, -1.0)


def _braced_falls(cells: Cells) -> xr.DataArray:
    return _in_pairs(cells.braced, -1.0)


def _in_pairs(values: xr.DataArray, way: float) -> xr.DataArray:
    """Whether of any two periods the longer has more (way 1) or less (way -1)."""
    _enough(values, "period")
    values = values.transpose(..., "period")
    shorter, longer = np.triu_indices(values.sizes["period"], k=1)
    before, after = values.values[..., shorter], values.values[..., longer]
    found = np.where(np.isfinite(before + after), way * after > way * before, np.nan)
    pairs = values.isel(period=0, drop=True).expand_dims(pair=shorter.size, axis=-1)
    return pairs.copy(data=found)


def _low(cells: Cells) -> Cells:
    stiff = cells.at("stiffness_ratio", [8.0, 10.0]).within("period", 0.0, 0.6)
    return stiff.within("pretension", 100e3, 300e3)


def _below_free(cells: Cells) -> xr.DataArray:
    low = _low(cells)
    return _truth(low.peak < low.free, low.peak, low.free)


def _below_braced(cells: Cells) -> xr.DataArray:
    low = _low(cells)
    return _truth(low.peak < low.braced, low.peak, low.braced)


def _evenly_reduced(cells: Cells) -> xr.DataArray:
    stiff = cells.beyond("stiffness_ratio", 4.0).within("pretension", 100e3, 250e3)
    _enough(stiff.peak, "period")
    reduction = 1.0 - stiff.peak / stiff.free
    return _truth(abs(reduction - reduction.median("period", skipna=True)) <= FELT, reduction)


def _untouched(cells: Cells) -> xr.DataArray:
    softest = cells.at("stiffness_ratio", [0.5])
    off = abs(softest.peak - softest.free)
    return _truth(off <= FELT * softest.free, softest.peak, softest.free)


def _low_to_half_a_second(cells: Cells) -> xr.DataArray:
    low = cells.at("stiffness_ratio", [8.0, 10.0]).within("period", 0.0, 0.5).within("pretension", 0.0, 300e3)
    return _truth(low.peak < low.free, low.peak, low.free)


def _low_to_100_kilonewtons(cells: Cells) -> xr.DataArray:
    low = cells.within("period", 0.0, 0.4).within("pretension", 0.0, 100e3)
    return _truth(low.peak < low.free, low.peak, low.free)


def _climbs_to_one_second(cells: Cells) -> xr.DataArray:
    return _in_pairs(cells.beyond("stiffness_ratio", 2.0).within("period", 0.4, 1.0).peak, 1.0)


def _least_of_stiff_spectrum(cells: Cells) -> xr.DataArray:
    stiff = cells.at("stiffness_ratio", [8.0, 10.0])
    spectrum = stiff.peak.max("period", skipna=False)
    _enough(spectrum, "pretension")
    band = Cells(spectrum, spectrum, spectrum).within("pretension", 100e3, 300e3).peak
    _enough(band, "pretension", 1)
    least, inside = spectrum.min("pretension", skipna=False), band.min("pretension", skipna=False)
    return _truth(inside <= (1.0 + NEAR) * least, least)


def _enough(peak: xr.DataArray, axis: str, least: int = 2) -> None:
    if peak.sizes[axis] < least:
        raise TooFewPoints


class TooFewPoints(Exception):
    """The cube has not the points that a part speaks of."""


PARTS: Final = (
    Part(
        "a",
        "from each stiffness ratio to the next, the largest response over pretension and period rises",
        _grows,
    ),
    Part(
        "b1",
        "at stiffness ratio 0.5 and 1 and each period, the response at 300 kN and more varies by 1 % at most",
        _still_beyond,
    ),
    Part(
        "b2",
        "at stiffness ratio 0.5 and 1 and each period, no pretension brings the response 10 % below the "
        "free frame's",
        _uncontrolled,
    ),
    Part(
        "c1",
        "at each stiffness ratio over 4, the largest response over all periods is least, within 5 %, "
        "at a pretension of 100 to 250 kN",
        _least_of_spectrum,
    ),
    Part(
        "c2",
        "at each stiffness ratio over 4 and each period, the response is least, within 5 %, "
        "at a pretension of 100 to 250 kN",
        _least_at_each_period,
    ),
    Part(
        "d1",
        "at each stiffness ratio and period to 0.4 s, past the best pretension the response nowhere falls by "
        "over 1 % from one to the next, and ends over 5 % above the least",
        _rises_past_optimum,
    ),
    Part(
        "d2",
        "at each stiffness ratio and pretension, of any two periods beyond 0.4 s the longer responds less",
        _falls_with_period,
    ),
    Part(
        "d3",
        "at each stiffness ratio and pretension of 100 kN and more, which is past most optima, of any two "
        "periods to 0.4 s the longer responds more",
        _rises_with_period,
    ),
    Part(
        "e1",
        "at stiffness ratio 8 and 10, periods to 0.6 s and 100 to 300 kN, the response is below "
        "the free frame's",
        _below_free,
    ),
    Part(
        "e2",
        "at stiffness ratio 8 and 10, periods to 0.6 s and 100 to 300 kN, the response is below "
        "the braced frame's",
        _below_braced,
    ),
    Part(
        "f",
        "at each stiffness ratio over 4 and pretension of 100 to 250 kN, the reduction against the free "
        "frame is within 0.1 of its median over the periods",
        _evenly_reduced,
    ),
    Part("g1", "of any two periods of the free frame the longer responds less", _free_falls),
    Part(
        "g2",
        "at each stiffness ratio, of any two periods of the braced frame the longer responds less",
        _braced_falls,
    ),
    Part(
        "h1",
        "Figures 11 and 12: at stiffness ratio 8 and 10, the largest response over all periods is least, "
        "within 5 %, at a pretension of 100 to 300 kN",
        _least_of_stiff_spectrum,
        ("FSR2", "FSR3"),
    ),
    Part(
        "h2",
        "Figures 13 to 15: at each stiffness ratio over 2 and pretension, of any two periods from 0.4 to 1 s "
        "the longer responds more",
        _climbs_to_one_second,
        ("FMR1", "FMR2", "FMR3"),
    ),
    Part(
        "h3",
        "Figure 15: at stiffness ratio 8 and 10, periods to 0.5 s and pretensions to 300 kN, the response is "
        "below the free frame's",
        _low_to_half_a_second,
        ("FMR3",),
    ),
    Part(
        "h4",
        "Figure 16: at stiffness ratio 0.5, each pretension and period, the response is within 10 % of the "
        "free frame's",
        _untouched,
        ("FHR1",),
    ),
    Part(
        "h5",
        "Figure 18: at each stiffness ratio, periods to 0.4 s and pretensions to 100 kN, the response is "
        "below the free frame's",
        _low_to_100_kilonewtons,
        ("FHR3",),
    ),
)
