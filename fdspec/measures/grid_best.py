"""The best pretension of a cube's own grid, record by record: a first look."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr


def best_on_grid(index: xr.DataArray, band: float = 0.05) -> xr.Dataset:
    """Find the pretension of the grid with the least index, and the ones nearly as good.

    No value between the grid's is guessed; `fdspec.best_pretension` computes them.

    Parameters
    ----------
    index : xarray.DataArray
        Over pretension and whatever else, positive, less being better: `index_of` of a cube.
    band : float
        Share above the least that counts as nearly as good.

    Returns
    -------
    xarray.Dataset
        `pretension`, N, the lowest with the least index; `index` there; `band_start` and `band_end`, N: the
        lowest and the highest pretension within the band, between which others may be outside it.  NaN
        where no index is known.

    Raises
    ------
    InvalidInput
        When the index has no pretension or the band is negative.
    """
    import xarray as xr

    if index.sizes.get("pretension", 0) == 0:
        raise InvalidInput("the index has no dimension pretension; best_on_grid compares along it")
    if not 0.0 <= band < np.inf:
        raise InvalidInput(f"band must be zero or positive, got {band!r}")
    known = index.fillna(np.inf)
    place = known.argmin("pretension")
    least = known.min("pretension")
    told = np.isfinite(least)
    inside = known <= (1.0 + band) * least
    axis = index["pretension"]
    found = xr.Dataset(
        {
            "pretension": axis.isel(pretension=place).drop_vars("pretension").where(told),
            "index": least.where(told),
            "band_start": axis.where(inside).min("pretension").where(told),
            "band_end": axis.where(inside).max("pretension").where(told),
        }
    )
    for name in ("pretension", "band_start", "band_end"):
        found[name].attrs["units"] = "N"
    found["index"].attrs = dict(index.attrs)
    return found
