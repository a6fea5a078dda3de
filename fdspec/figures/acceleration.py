"""What pictures of peak acceleration share: the data of one record, its limits, its scale and its words."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

COLOURS = "viridis"
"""Perceptually even, safe for colour-blind eyes and in grey print."""

LEVELS = 20
"""Steps of colour, at most."""

NEAR = 0.05
"""Share above the least acceleration that counts as nearly as good."""

WIDE = 20.0
"""Largest over smallest pretension from which on their axis is logarithmic."""


@dataclass(frozen=True)
class Acceleration:
    """Peak acceleration of one record in units a reader has at hand.

    `pretension` in kN (n_f,), `period` in s (n_t,), `peak` in g (n_sr, n_f, n_t), NaN where a history did not
    end well. The limits, NaN where the cube has them not: `free` (n_t,), the damper that slides without
    friction, and `braced` (n_sr, n_t), the damper that never slips.
    """

    record: str
    words: tuple[str, ...]
    frame: str
    stiffness_ratio: FloatArray
    pretension: FloatArray
    period: FloatArray
    peak: FloatArray
    free: FloatArray
    braced: FloatArray

    @property
    def levels(self) -> FloatArray:
        """Bounds of the colours, the same for every panel and the limits, at round numbers from zero."""
        most = max(float(np.nanmax(values)) for values in self._all if np.isfinite(values).any())
        return np.asarray(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, most))

    @property
    def _all(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        return self.peak, self.free, self.braced

    @property
    def logarithmic(self) -> bool:
        """Whether pretension spans so much that a linear axis would hide where the response changes."""
        low, high = float(self.pretension.min()), float(self.pretension.max())
        return low > 0.0 and high >= WIDE * low

    def best(self, k: int) -> tuple[FloatArray, FloatArray]:
        """Return periods, s, and the pretension of the least acceleration at each, kN, of one panel."""
        peak = self.peak[k]
        known = np.isfinite(peak).any(axis=0)
        rows = np.argmin(np.where(np.isnan(peak), np.inf, peak), axis=0)
        return self.period[known], self.pretension[rows[known]]

    def band(self, k: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return periods, s, and the ends of the stretch about the best that is within 5 % of it, kN."""
        return band_of(self.period, self.pretension, self.peak[k], NEAR)


def of_record(cube: xr.Dataset, record: str) -> Acceleration:
    """Take one record out of a cube.

    Raises
    ------
    InvalidInput
        When the cube has no such record or no peak acceleration, or too few points to draw.
    """
    names = [str(name) for name in np.atleast_1d(cube["record"].values)]
    if record not in names:
        raise InvalidInput(f"the cube has no record {record!r}; it has {', '.join(names)}")
    if "peak_acceleration" not in cube:
        raise InvalidInput("the cube has no peak_acceleration; sweep with it among the outputs")
    one = cube.sel(record=record) if "record" in cube.dims else cube
    one = one.isel(pretension=np.flatnonzero(np.isfinite(one["pretension"].values)))
    for axis in ("pretension", "period"):
        if one.sizes[axis] < 2:
            raise InvalidInput(
                f"a picture over {axis} needs at least 2 finite values, the cube has {one.sizes[axis]}"
            )
    peak = one["peak_acceleration"].transpose("stiffness_ratio", "pretension", "period")
    if "status" in one:
        peak = peak.where(one["status"] == 0)
    values = np.asarray(peak.values, dtype=np.float64) / G
    if not np.isfinite(values).any():
        raise InvalidInput(f"no history of record {record!r} ended well; there is nothing to draw")
    return Acceleration(
        record=record,
        words=_words(one),
        frame=_frame(cube),
        stiffness_ratio=one["stiffness_ratio"].values,
        pretension=one["pretension"].values / 1e3,
        period=one["period"].values,
        peak=values,
        free=_limit(one, "elastic_acceleration", ("period",)),
        braced=_limit(one, "braced_acceleration", ("stiffness_ratio", "period")),
    )


def band_of(
    period: FloatArray, pretension: FloatArray, values: FloatArray, near: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return periods (m,) and the ends (m,) of the pretensions about the least that are nearly as good.

    `pretension` (n_f,) ascends, `values` (n_f, n_t) are NaN where unknown; periods at which none is known are
    left out. Between two pretensions the values are taken as straight.
    """
    starts, ends, kept = [], [], []
    for t in range(period.size):
        column = values[:, t]
        if not np.isfinite(column).any():
            continue
        best = int(np.nanargmin(column))
        limit = (1.0 + near) * column[best]
        inside = column <= limit
        low = high = best
        while low > 0 and inside[low - 1]:
            low -= 1
        while high < column.size - 1 and inside[high + 1]:
            high += 1
        starts.append(_crossing(pretension, column, low, low - 1, limit))
        ends.append(_crossing(pretension, column, high, high + 1, limit))
        kept.append(period[t])
    return np.array(kept), np.array(starts), np.array(ends)


def _crossing(x: FloatArray, y: FloatArray, inner: int, outer: int, limit: float) -> float:
    """Where a straight line from a point within to its neighbour beyond reaches the limit."""
    if outer < 0 or outer >= x.size or not np.isfinite(y[outer]):
        return float(x[inner])
    share = (limit - y[inner]) / (y[outer] - y[inner])
    return float(x[inner] + share * (x[outer] - x[inner]))


def _limit(one: xr.Dataset, name: str, dims: tuple[str, ...]) -> FloatArray:
    if name not in one:
        return np.full([one.sizes[dim] for dim in dims], np.nan)
    return np.asarray(one[name].transpose(*dims).values, dtype=np.float64) / G


def _words(one: xr.Dataset) -> tuple[str, ...]:
    """Say which record was really used and what was done to it."""
    words = []
    if "source" in one.coords:
        words.append(str(one["source"].item()))
    if "pga" in one.coords:
        factor = one["scale_factor"].item() if "scale_factor" in one.coords else 1.0
        scaled = "" if factor == 1.0 else f", the recorded motion times {factor:.3g}"
        words.append(f"PGA {one['pga'].item() / G:.3g} g{scaled}")
    return tuple(words)


FRAME = {
    "floor_mass": "floor {:,.0f}\u00a0kg",
    "brace_mass": "brace {:,.0f}\u00a0kg",
    "damping_ratio": "damping ratio {:.3g}",
    "friction_coefficient": "friction coefficient {:.3g}",
    "normal_force_factor": "normal force {:.3g} times the pretension",
}


def _frame(cube: xr.Dataset) -> str:
    """Say which frame was swept, as far as the cube tells."""
    told = told_parameters(cube)
    numbers = ((form, told[name]) for name, form in FRAME.items() if isinstance(told.get(name), int | float))
    return ", ".join(form.format(value).replace(",", "\u00a0") for form, value in numbers)


def told_parameters(cube: xr.Dataset) -> dict[str, Any]:
    """Return the parameters that a cube carries, empty where it carries none."""
    try:
        told = json.loads(str(cube.attrs.get("parameters", "{}")))
    except json.JSONDecodeError:
        return {}
    return told if isinstance(told, dict) else {}
