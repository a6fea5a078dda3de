"""A cube as one table: a row a cell, a column for each axis and each variable."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from fdspec.store.history_csv import meaning_of
from fdspec.store.layout import is_text

if TYPE_CHECKING:
    import xarray as xr


def dims_of(one: xr.Dataset) -> tuple[str, ...]:
    """Return every dim of the results, in the order of the variable that has most of them."""
    by_size = sorted((array.dims for array in one.data_vars.values()), key=len, reverse=True)
    return tuple(dict.fromkeys(str(dim) for dims in by_size for dim in dims))


def links_in_columns(one: xr.Dataset) -> xr.Dataset:
    """Return the cube with a variable for each link, ``link_energy_high`` say, in place of their dim."""
    if "link" not in one.dims:
        return one
    of_links = [str(name) for name, array in one.data_vars.items() if "link" in array.dims]
    apart = {
        f"{name}_{label}": one[name].isel(link=k).drop_vars("link")
        for name in of_links
        for k, label in enumerate(one["link"].values.tolist())
    }
    return one.drop_vars([*of_links, "link"]).assign(apart)


def columns_of(one: xr.Dataset, dims: tuple[str, ...]) -> list[str]:
    """Return the dims, what else is known along them, and the results; text stands in the heading."""
    along = [str(name) for name, array in one.coords.items() if array.ndim and name not in dims]
    results = [str(name) for name in one.data_vars if one[name].ndim or not dims]
    return [name for name in (*dims, *along, *results) if name in dims or not is_text(one[name].variable)]


def heading(one: xr.Dataset, columns: list[str]) -> Iterator[str]:
    """Give the origin, and each column's unit and meaning."""
    yield from origin(one)
    for name in columns:
        yield meaning_of(name, one[name].attrs)


def origin(one: xr.Dataset) -> Iterator[str]:
    """Give the records and what the dataset says of itself."""
    if "record" in one.coords:
        names = [str(name) for name in np.atleast_1d(one["record"].values)]
        yield f"record{'s' if len(names) > 1 else ''}: {', '.join(names)}"
    for name in ("title", "source", "history", "comment", "parameters"):
        if name in one.attrs:
            yield f"{name}: {one.attrs[name]}".replace("\n", " ").replace("\r", " ")


def blocks(one: xr.Dataset, dims: tuple[str, ...], columns: list[str]) -> Iterator[Iterator[tuple[Any, ...]]]:
    """Give the rows block by block, one block a set of positions along all dims but the last."""
    *outer, inner = dims or ("",)
    arrays = [one[name].variable for name in columns]
    sizes = [range(one.sizes[dim]) for dim in outer]
    for position in itertools.product(*sizes):
        at = dict(zip(outer, position, strict=True))
        lists = []
        for array in arrays:
            piece = array.isel({dim: index for dim, index in at.items() if dim in array.dims}).values
            lists.append(np.broadcast_to(piece, one.sizes.get(inner, 1)).tolist())
        yield zip(*lists, strict=True)
