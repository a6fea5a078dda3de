"""What maps and surfaces of acceleration share: the data of one record, its scale and its title."""

from __future__ import annotations

import math
import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

COLOURS = "viridis"
"""Perceptually even, safe for colour-blind eyes and in grey print."""

LEVELS = 18
"""Steps of colour, at most."""

COLUMNS = 4

LETTERS_PER_INCH = 11
"""Of matplotlib's own font at the titles' size, less a margin."""


@dataclass(frozen=True)
class Acceleration:
    """Peak acceleration of one record in units a reader has at hand.

    `pretension` in kN (n_f,), `period` in s (n_t,), `peak` in g (n_sr, n_f, n_t), NaN where a history did not
    end well.
    """

    title: tuple[str, ...]
    stiffness_ratio: NDArray[np.float64]
    pretension: NDArray[np.float64]
    period: NDArray[np.float64]
    peak: NDArray[np.float64]

    @property
    def levels(self) -> NDArray[np.float64]:
        """Bounds of the colours, the same for every panel, at round numbers from zero."""
        return np.asarray(
            MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, float(np.nanmax(self.peak)))
        )

    @property
    def panels(self) -> tuple[int, int]:
        """Rows and columns of panels, one panel a stiffness ratio."""
        n = self.stiffness_ratio.size
        rows = math.ceil(n / COLUMNS)
        return rows, math.ceil(n / rows)

    def wrapped_title(self, width: float) -> str:
        """Return the title in lines that fit a figure of this width, in."""
        lines = [
            part
            for line in self.title
            for part in textwrap.wrap(line, int(LETTERS_PER_INCH * width), break_on_hyphens=False)
        ]
        return "\n".join(lines)


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
        title=_title(one, record),
        stiffness_ratio=one["stiffness_ratio"].values,
        pretension=one["pretension"].values / 1e3,
        period=one["period"].values,
        peak=values,
    )


def _title(one: xr.Dataset, record: str) -> tuple[str, ...]:
    """Say what is drawn and which record it is really made with."""
    lines = [f"Peak absolute acceleration of the floor, record {record}"]
    if "source" in one.coords:
        lines.append(str(one["source"].item()))
    if "pga" in one.coords:
        factor = one["scale_factor"].item() if "scale_factor" in one.coords else 1.0
        scaled = "" if factor == 1.0 else f", the recorded motion times {factor:.3g}"
        lines.append(f"PGA {one['pga'].item() / G:.3g} g{scaled}")
    return tuple(lines)
