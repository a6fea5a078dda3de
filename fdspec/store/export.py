"""Export one record's cube for tools that want less than netCDF with text and four dims."""

from __future__ import annotations

import csv
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import StoreError
from fdspec.store.excel import EXCEL_SUFFIXES, write_excel
from fdspec.store.history_csv import CSV_SUFFIXES, write_history
from fdspec.store.layout import is_text
from fdspec.store.matlab import MATLAB_SUFFIXES, write_matlab
from fdspec.store.netcdf import write_netcdf
from fdspec.store.replacing import NETCDF_SUFFIXES, replacing
from fdspec.store.table import blocks, columns_of, dims_of, heading, links_in_columns, origin
from fdspec.variables import motion_variables

if TYPE_CHECKING:
    import xarray as xr


EXPORT_SUFFIXES: Final = (*NETCDF_SUFFIXES, *CSV_SUFFIXES, *EXCEL_SUFFIXES, *MATLAB_SUFFIXES)
"""What the file of an export may end with."""


def export(cube: xr.Dataset, path: str | os.PathLike[str], *, record: str | None = None) -> None:
    """Write a cube for other tools; the suffix of the file chooses the form.

    ``.nc``: netCDF of one record over (stiffness_ratio, pretension, period) without any text variable, for
    CDO, VTK and ParaView, which refuse four dims. What is told of the record in words becomes global
    attributes ``record``, ``record_event`` and so on. A cube of buildings is written over (building,
    stiffness_scale, slip_scale, storey), the buildings' names in their order in the attribute ``building``.

    ``.csv``: one row a cell, one column for each axis, ``record`` among them where there are several, and one
    for each variable, numbers written so that they read back to the bit. Lines that start with ``#`` come
    first and give each column's unit and meaning; ``pandas.read_csv(path, comment="#")`` and R's
    ``read.csv(path, comment.char = "#")`` pass over them. Of a history there is a row for each time, with a
    column for each storey; its changes of phase go into a file of their own beside it,
    ``NAME-transitions.csv``.

    ``.xlsx``: the same rows as a workbook, changes of phase on a sheet of their own, and a sheet ``about``
    with units, meanings and origin; needs openpyxl. Numbers have 16 digits,
    not a number is an empty cell, infinity is text.

    ``.mat``: every variable as an array over its dims, which ``dims`` names, for Matlab and Octave;
    ``units``, ``meanings`` and ``about`` say the rest.

    Parameters
    ----------
    cube : xarray.Dataset
        What `sweep` or `sweep_buildings` returns, with or without its dim ``record``, or `simulate`.
    path : path
        The file, in a folder that exists. It appears only when it is complete.
    record : str, optional
        The record's name; may be left out when the cube has one record only, and but for netCDF all are
        written then.

    Raises
    ------
    StoreError
        For an unknown record or suffix, what the form cannot hold, and when the file cannot be written.
    """
    with replacing(path, suffixes=EXPORT_SUFFIXES) as part:
        suffix = Path(path).suffix.lower()
        if not suffix:
            raise StoreError(
                f"cannot export to {os.fspath(path)}: the name should end in .nc, .csv, .xlsx or .mat"
            )
        one = _one_record(cube, record, several=suffix not in NETCDF_SUFFIXES)
        if suffix in EXCEL_SUFFIXES:
            write_excel(one, part)
        elif suffix in MATLAB_SUFFIXES:
            write_matlab(one, part)
        elif suffix in CSV_SUFFIXES and "time" in one.dims:
            write_history(one, part, Path(path), list(origin(one)))
        elif suffix in CSV_SUFFIXES:
            _write_csv(one, part)
        else:
            write_netcdf(_without_text(one), part, path)


def _one_record(cube: xr.Dataset, record: str | None, *, several: bool) -> xr.Dataset:
    if "statistic" in cube.dims and "record" not in cube.coords and record is None:
        return cube  # what `fdspec.summary` makes of all records
    if "record" not in cube.coords:
        raise StoreError("the dataset has no record coordinate; export takes what sweep returns")
    names = [str(name) for name in np.atleast_1d(cube["record"].values)]
    if record is None and len(names) > 1:
        if several:
            return cube
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
    one = links_in_columns(one)
    dims = dims_of(one)
    columns = columns_of(one, dims)
    with part.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {line}\n" for line in heading(one, columns))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for rows in blocks(one, dims, columns):
            writer.writerows(rows)
