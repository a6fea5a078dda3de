"""Export one record's cube for tools that want less than netCDF with text and four dims."""

from __future__ import annotations

import csv
import itertools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fdspec.errors import StoreError
from fdspec.store.history_csv import CSV_SUFFIXES, meaning_of, write_history
from fdspec.store.layout import is_text
from fdspec.store.netcdf import write_netcdf
from fdspec.store.replacing import NETCDF_SUFFIXES, replacing
from fdspec.variables import motion_variables

if TYPE_CHECKING:
    import xarray as xr


def export(cube: xr.Dataset, path: str | os.PathLike[str], *, record: str | None = None) -> None:
    """Write one record's cube for other tools; the suffix of the file chooses the form.

    ``.nc``: netCDF over (stiffness_ratio, pretension, period) without any text variable, for CDO, VTK and
    ParaView, which refuse four dims. What is told of the record in words becomes global attributes
    ``record``, ``record_event`` and so on. A cube of buildings is written over (building, stiffness_scale,
    slip_scale, storey), the buildings' names in their order in the attribute ``building``.

    ``.csv``: one row a cell, one column a variable, numbers written so that they read back to the bit. Lines
    that start with ``#`` come first and give each column's unit and meaning; ``pandas.read_csv(path,
    comment="#")`` and R's ``read.csv(path, comment.char = "#")`` pass over them. Of a history there is a row
    for each time, with a column for each storey; its changes of phase go into a file of their own beside it,
    ``NAME-transitions.csv``.

    Parameters
    ----------
    cube : xarray.Dataset
        What `sweep` or `sweep_buildings` returns, with or without its dim ``record``, or `simulate`.
    path : path
        The file, in a folder that exists. It appears only when it is complete.
    record : str, optional
        The record's name; may be left out when the cube has one record only.

    Raises
    ------
    StoreError
        For an unknown record or suffix, and when the file cannot be written.
    """
    with replacing(path, suffixes=(*NETCDF_SUFFIXES, *CSV_SUFFIXES)) as part:
        suffix = Path(path).suffix.lower()
        if not suffix:
            raise StoreError(f"cannot export to {os.fspath(path)}: the name should end in .nc or .csv")
        one = _one_record(cube, record)
        if suffix in CSV_SUFFIXES and "time" in one.dims:
            write_history(one, part, Path(path), list(_origin(one)))
        elif suffix in CSV_SUFFIXES:
            _write_csv(one, part)
        else:
            write_netcdf(_without_text(one), part, path)


def _one_record(cube: xr.Dataset, record: str | None) -> xr.Dataset:
    if "statistic" in cube.dims and "record" not in cube.coords and record is None:
        return cube  # what `fdspec.summary` makes of all records
    if "record" not in cube.coords:
        raise StoreError("the dataset has no record coordinate; export takes what sweep returns")
    names = [str(name) for name in np.atleast_1d(cube["record"].values)]
    if record is None and len(names) > 1:
        raise StoreError(f"the cube holds {len(names)} records; name one of {', '.join(names)}")
    if record is not None and record not in names:
        raise StoreError(f"the cube holds no record {record!r}; it has {', '.join(names)}")
    if "record" not in cube.dims:
        return cube
    return cube.isel(record=0 if record is None else names.index(record))


def _without_text(one: xr.Dataset) -> xr.Dataset:
    """Turn text about the record and names along a dim into global attributes, and drop any other text."""
    text = [str(name) for name, variable in one.variables.items() if is_text(variable)]
    told = {variable.name for variable in motion_variables(())}
    attributes = {
        name if name == "record" else f"record_{name}": one[name].item() for name in text if name in told
    }
    attributes |= {name: ", ".join(one[name].values.tolist()) for name in text if name in one.dims}
    return one.drop_encoding().drop_vars(text).reset_coords().assign_attrs(attributes)


def _write_csv(one: xr.Dataset, part: Path) -> None:
    dims = _dims(one)
    columns = _columns(one, dims)
    with part.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {line}\n" for line in _heading(one, columns))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for rows in _blocks(one, dims, columns):
            writer.writerows(rows)


def _dims(one: xr.Dataset) -> tuple[str, ...]:
    """Return every dim of the results, in the order of the variable that has most of them."""
    by_size = sorted((array.dims for array in one.data_vars.values()), key=len, reverse=True)
    return tuple(dict.fromkeys(str(dim) for dims in by_size for dim in dims))


def _columns(one: xr.Dataset, dims: tuple[str, ...]) -> list[str]:
    """Return the dims, what else is known along them, and the results; text stands in the heading."""
    along = [str(name) for name, array in one.coords.items() if array.ndim and name not in dims]
    results = [str(name) for name in one.data_vars if one[name].ndim or not dims]
    return [name for name in (*dims, *along, *results) if name in dims or not is_text(one[name].variable)]


def _heading(one: xr.Dataset, columns: list[str]) -> Iterator[str]:
    yield from _origin(one)
    for name in columns:
        yield meaning_of(name, one[name].attrs)


def _origin(one: xr.Dataset) -> Iterator[str]:
    if "record" in one.coords:
        yield f"record: {one['record'].item()}"
    for name in ("title", "source", "history", "comment", "parameters"):
        if name in one.attrs:
            yield f"{name}: {one.attrs[name]}".replace("\n", " ").replace("\r", " ")


def _blocks(
    one: xr.Dataset, dims: tuple[str, ...], columns: list[str]
) -> Iterator[Iterator[tuple[Any, ...]]]:
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
