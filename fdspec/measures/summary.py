"""Statistics over records: median, mean, percentiles and worst of every result, as one Dataset."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

PERCENTILES: Final = (16.0, 84.0)
"""One standard deviation to either side of the median of a normal, or lognormal, distribution."""

ABOUT: Final = ("title", "source", "references", "comment", "Conventions", "fdspec_version")
"""Attributes of a cube that are true of its statistics too."""


def summary(
    cube: xr.Dataset,
    variables: Iterable[str] | None = None,
    *,
    percentiles: Sequence[float] = PERCENTILES,
    over: str = "record",
) -> xr.Dataset:
    """Return statistics of a cube's results over its records.

    Only histories that ended well count; ``records`` says of how many.  A percentile lies between records,
    linearly, as numpy's default has it.  "worst" is the largest amount, with its sign: of a residual
    displacement the one furthest from zero.

    Parameters
    ----------
    cube : xarray.Dataset
        What `sweep` or `sweep_buildings` returns.
    variables : iterable of str, optional
        Results to be summed up; all numbers over the records unless given.
    percentiles : sequence of float
        From 0 to 100.
    over : str
        The dim that statistics are taken over.

    Returns
    -------
    xarray.Dataset
        The variables with the dim ``statistic`` ("median", "mean", "p16", "p84", "worst") in place of
        ``record``; and ``records``, the number of histories behind each cell.  It can be saved, opened and
        exported as a cube is.

    Raises
    ------
    InvalidInput
        For what is no cube, an unknown variable, or a percentile outside 0 to 100.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=20e3)
    >>> motions = [fdspec.GroundMotion([0.0, a, -a, 0.0], 0.1, name=f"{a:g}") for a in (1.0, 2.0, 4.0)]
    >>> cube = fdspec.sweep_buildings(motions, frame, slip_scale=1, stiffness_scale=1)
    >>> told = fdspec.summary(cube, ["peak_drift"])
    >>> told.peak_drift.sel(statistic="worst").item() == cube.peak_drift.max().item()
    True
    """
    import xarray as xr

    if over not in cube.dims:
        raise InvalidInput(f"cube must have the dim {over!r}, has {', '.join(map(str, cube.dims)) or 'none'}")
    levels = [_level(value) for value in percentiles]
    names = _names(cube, variables, over)
    status = cube["status"] if "status" in cube and over in cube["status"].dims else None
    kept: dict[str, xr.DataArray] = {}
    for name in names:
        array = cube[name]
        counted = array
        if status is not None and set(status.dims) <= set(array.dims):
            counted = array.where(status == 0)
        kept[name] = _statistics(counted, levels, over).assign_attrs(_about(array))
    told = xr.Dataset(kept)
    if status is not None:
        told["records"] = (status == 0).sum(over).astype(np.int64)
        told["records"].attrs = {"units": "1", "long_name": f"number of {over}s that count"}
    labels = ["median", "mean", *(f"p{level:g}" for level in levels), "worst"]
    told = told.assign_coords(statistic=("statistic", labels, {"long_name": f"statistic over the {over}s"}))
    told = told.assign_coords(
        {
            name: array
            for name, array in cube.coords.items()
            if over not in array.dims and set(array.dims) <= set(told.dims)
        }
    )
    told.attrs = {name: cube.attrs[name] for name in ABOUT if name in cube.attrs}
    told.attrs["title"] = f"Statistics over {cube.sizes[over]} {over}s: {cube.attrs.get('title', 'a cube')}"
    told.attrs["history"] = f"{cube.attrs.get('history', '')}\nfdspec.summary over {over}".strip()
    if "parameters" in cube.attrs:  # under another name: these are no sweep's results
        told.attrs["parameters_of_the_cube"] = cube.attrs["parameters"]
    return told


def nearest_design(cube: xr.Dataset) -> xr.Dataset:
    """Return a cube of buildings at the factors on its dampers that are nearest to 1, the design as given."""
    at: dict[str, Any] = {}
    for dim in ("stiffness_scale", "slip_scale"):
        if dim in cube.dims:
            values = np.asarray(cube[dim].values, dtype=float)
            with np.errstate(divide="ignore"):
                at[dim] = int(np.argmin(np.abs(np.log(values))))
    return cube.isel(at)


def _level(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not 0.0 <= value <= 100.0:
        raise InvalidInput(f"percentiles must be from 0 to 100, got {value!r}")
    return float(value)


def _names(cube: xr.Dataset, variables: Iterable[str] | None, over: str) -> list[str]:
    known = [
        str(name)
        for name, array in cube.data_vars.items()
        if over in array.dims and array.dtype.kind in "iuf" and "flag_values" not in array.attrs
    ]
    if variables is None:
        return known
    names = [variables] if isinstance(variables, str) else list(variables)
    for name in names:
        if name not in known:
            raise InvalidInput(f"variables: {name!r} is none of {', '.join(known)}")
    return list(dict.fromkeys(names))


def _statistics(array: xr.DataArray, levels: Sequence[float], over: str) -> xr.DataArray:
    import xarray as xr

    values = np.moveaxis(np.asarray(array.values, dtype=np.float64), array.dims.index(over), 0)
    dims = [dim for dim in array.dims if dim != over]
    known = ~np.isnan(values)
    none = ~known.any(axis=0)
    # A cell without a history that ended well has no statistics; numpy would warn of it.
    filled = np.where(none, 0.0, values)
    median, *shares = np.nanpercentile(filled, [50.0, *levels], axis=0)
    largest = np.argmax(np.where(np.isnan(filled), -1.0, np.abs(filled)), axis=0)
    worst = np.take_along_axis(filled, largest[np.newaxis], axis=0)[0]
    rows = np.stack([median, np.nanmean(filled, axis=0), *shares, worst])
    rows[:, none] = np.nan
    return xr.DataArray(rows, dims=("statistic", *dims))


def _about(array: xr.DataArray) -> dict[str, Any]:
    return {name: array.attrs[name] for name in ("units", "long_name") if name in array.attrs}
