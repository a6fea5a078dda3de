"""The one damper that serves best over all periods of a cube."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fdspec.measures.cells import ended_well, require

if TYPE_CHECKING:
    import xarray as xr


def best_damper(cube: xr.Dataset) -> xr.Dataset:
    """Find the one damper that lowers acceleration most over all periods of a cube.

    Each peak acceleration is divided by that of the frame without brace and friction, `elastic_acceleration`,
    so that long periods, where all accelerations are small, count as much as short ones; the mean of that
    ratio over the periods is smallest for the best pair of stiffness ratio and pretension. Histories that did
    not end well rule their pair out. For a band of periods, select it: ``cube.sel(period=slice(0, 0.6))``.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with peak_acceleration and elastic_acceleration.

    Returns
    -------
    xarray.Dataset
        Over (record,): `acceleration_ratio` (1), NaN where no pair can be told; `pretension` (N) and
        `stiffness_ratio` (1) of the best pair.

    Raises
    ------
    InvalidInput
        When the cube lacks a variable or a dimension, or has no period.
    """
    require(cube, ("peak_acceleration", "elastic_acceleration"))
    peak = ended_well(cube, "peak_acceleration")
    ratio = (peak / cube["elastic_acceleration"]).mean("period", skipna=False)
    known = ratio.fillna(np.inf)
    best = known.isel(known.argmin(["stiffness_ratio", "pretension"]))
    return (
        best.where(np.isfinite(best))
        .rename("acceleration_ratio")
        .reset_coords(["pretension", "stiffness_ratio"])
    )
