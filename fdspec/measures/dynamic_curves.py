"""Incremental dynamic analysis: how a demand grows with intensity, over the records."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.measures.fragility import COLLAPSED

if TYPE_CHECKING:
    import xarray as xr

FRACTILES: Final = (0.16, 0.5, 0.84)


def ida_curves(cube: xr.Dataset, *, demand: str, intensity: str = "intensity") -> xr.Dataset:
    """Return a demand over intensity: each record's curve and the 16, 50 and 84 % fractiles over the records.

    Parameters
    ----------
    cube : xarray.Dataset
        With dims ``record`` and ``intensity``; others stay.  Of storeys the largest demand counts.
    demand : str
        The variable.
    intensity : str
        The dim of intensities.

    Returns
    -------
    xarray.Dataset
        ``demand`` over record and intensity, ``fractile_demand`` over fractile and intensity.  A history that
        collapsed has an infinite demand, so that a fractile is infinite where enough of them do; one that
        failed otherwise is left out.
    """
    import xarray as xr

    for dim in ("record", intensity):
        if dim not in cube.dims:
            raise InvalidInput(
                f"curves over intensity need a cube over {dim}, this one has {', '.join(map(str, cube.dims))}"
            )
    if demand not in cube:
        raise InvalidInput(f"the cube has no {demand}; sweep with it among the outputs")
    values = abs(cube[demand])
    if "storey" in values.dims:
        values = values.max("storey")
    if "status" in cube:
        names = str(cube["status"].attrs.get("flag_meanings", "")).split()
        if COLLAPSED in names:
            values = values.where(cube["status"] != names.index(COLLAPSED), np.inf)
        values = values.where((cube["status"] == 0) | np.isinf(values))
    fractiles = xr.apply_ufunc(
        lambda array: np.moveaxis(np.nanquantile(array, FRACTILES, axis=-1, method="inverted_cdf"), 0, -1),
        values,
        input_core_dims=[["record"]],
        output_core_dims=[["fractile"]],
    ).assign_coords(fractile=list(FRACTILES))
    units = str(cube[demand].attrs.get("units", "1"))
    result = xr.Dataset({"demand": values, "fractile_demand": fractiles})
    result["demand"].attrs = {**cube[demand].attrs}
    result["fractile_demand"].attrs = {"long_name": f"fractile over the records of {demand}", "units": units}
    result["fractile"].attrs = {"long_name": "share of the records at or below", "units": "1"}
    result.attrs = {"title": "Demand over intensity", "demand_variable": demand}
    return result
