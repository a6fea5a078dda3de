"""What many records say together: mean, median, 84th percentile, worst; one pretension for all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

STATISTICS: Final[Mapping[str, Callable[..., Any]]] = MappingProxyType(
    {
        "mean": np.mean,
        "median": np.median,
        "p84": lambda values, axis: np.quantile(values, 0.84, axis=axis),
        "worst": np.max,
    }
)
"""Name -> function of an array and the axis of its records.

The 84th percentile, one standard deviation above the median of a normal distribution, is that of the
sample, linear between its members (type 7 of Hyndman and Fan 1996, Am. Stat. 50(4)).
"""


def statistic_of(name: str) -> Callable[..., Any]:
    """Return a statistic by its name, or raise InvalidInput."""
    if name not in STATISTICS:
        raise InvalidInput(f"statistic must be one of {', '.join(STATISTICS)}, got {name!r}")
    return STATISTICS[name]


def ensemble(values: xr.DataArray | xr.Dataset) -> xr.Dataset:
    """Compute mean, median, 84th percentile and worst over the records.

    Parameters
    ----------
    values : xarray.DataArray or Dataset
        Over record and whatever else, larger being worse: `index_of` of a cube, or one of its peaks.

    Returns
    -------
    xarray.Dataset
        With `statistic` in place of `record`: "mean", "median", "p84", "worst".  NaN where a record has
        none: an ensemble without one of its members is another.

    Raises
    ------
    InvalidInput
        When there are no records.
    """
    import xarray as xr

    if values.sizes.get("record", 0) == 0:
        raise InvalidInput("an ensemble needs the dimension record with at least one record")
    given = (
        values
        if isinstance(values, xr.Dataset)
        else values.to_dataset(name="index" if values.name is None else values.name)
    )
    found = [given.reduce(function, "record", keep_attrs=True) for function in STATISTICS.values()]
    return xr.concat(found, dim=xr.Variable("statistic", list(STATISTICS)))


def best_for_all(index: xr.DataArray, statistic: str = "mean") -> xr.Dataset:
    """Find the pretension of the grid that serves all records best, and what each record loses by it.

    For one that lies between the grid's pretensions ask `fdspec.best_pretension`.

    Parameters
    ----------
    index : xarray.DataArray
        Over (record, pretension) and whatever else, positive, less being better: `index_of` of a cube.
    statistic : str
        What is to be least over the records: "mean", "median", "p84" or "worst".

    Returns
    -------
    xarray.Dataset
        `pretension`, N; `index`, its statistic there; and over record `index_of_record` and `regret`:
        how far the record's index lies above the least that record has at any pretension, as a share of
        that.

    Raises
    ------
    InvalidInput
        When a dimension is missing or the statistic is unknown.
    """
    import xarray as xr

    for dim in ("record", "pretension"):
        if index.sizes.get(dim, 0) == 0:
            raise InvalidInput(f"the index has no dimension {dim}; best_for_all compares along it")
    over_records = index.reduce(statistic_of(statistic), "record")
    known = over_records.fillna(np.inf)
    place = known.argmin("pretension")
    there = index.isel(pretension=place).drop_vars("pretension")
    pretension = index["pretension"].isel(pretension=place).where(np.isfinite(known.min("pretension")))
    regret = there / index.min("pretension") - 1.0
    found = xr.Dataset(
        {
            "pretension": pretension.drop_vars("pretension", errors="ignore"),
            "index": over_records.isel(pretension=place).drop_vars("pretension"),
            "index_of_record": there,
            "regret": regret,
        }
    )
    found["pretension"].attrs = {"units": "N", "long_name": f"pretension with the least {statistic} index"}
    found["index"].attrs = {"units": "1", "long_name": f"{statistic} index there"}
    found["index_of_record"].attrs = {"units": "1", "long_name": "index of the record there"}
    found["regret"].attrs = {
        "units": "1",
        "long_name": "index above the least of the record, as a share of it",
    }
    return found
