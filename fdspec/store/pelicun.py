"""Demands of a cube of buildings as Pelicun reads them: one row a record, one column a demand and floor.

Pelicun 3: the first column is an index, a column's name is TYPE-location-direction after the event's number,
the row ``Units`` has each column's unit, and rows with a 1 under ``ERROR`` are left out.
"""

from __future__ import annotations

import csv
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.store.replacing import replacing

if TYPE_CHECKING:
    import xarray as xr

DIRECTION: Final = 1
"""Buildings here move in one plane."""

_FIXED: Final = ("building", "stiffness_scale", "slip_scale", "intensity")


def write_pelicun(
    cube: xr.Dataset, path: str | os.PathLike[str], *, storey_height: float | None = None
) -> None:
    """Write the demands of one building as a table of Pelicun's.

    Floor accelerations (PFA; location 0 is the ground), storey drift ratios (PID) and residual drift ratios
    (RID), as far as the cube has them.  A history that ended with a status other than ok or collapsed has a
    1 under ``ERROR``.

    Parameters
    ----------
    cube : xarray.Dataset
        What `sweep_buildings` returns, of one building, stiffness scale, slip scale and intensity.
    path : path
        A file ending in .csv.  It appears only when it is complete.
    storey_height : float, optional
        m, of every storey; needed unless the cube has ``peak_drift_ratio`` and no residual drift is wanted.

    Raises
    ------
    InvalidInput
        For a cube that has several buildings, or lacks a height that is needed.
    StoreError
        Where the file cannot be written.
    """
    one = _one(cube)
    if storey_height is not None and not 0.0 < storey_height < np.inf:
        raise InvalidInput(f"storey_height must be positive, in m, got {storey_height!r}")
    factor = float(one["intensity"].item()) if "intensity" in one.coords else 1.0
    columns: list[tuple[str, str, NDArray[np.float64]]] = [
        (_name("PFA", 0), "mps2", factor * np.atleast_1d(one["pga"].values))
    ]
    columns += _by_storey(one, "PFA", "peak_acceleration", "mps2", 1.0)
    if "peak_drift_ratio" in one:
        columns += _by_storey(one, "PID", "peak_drift_ratio", "rad", 1.0)
    elif storey_height is None:
        raise InvalidInput("drift ratios need the storeys' height: give storey_height, in m")
    else:
        columns += _by_storey(one, "PID", "peak_drift", "rad", storey_height)
    if storey_height is not None:
        columns += _by_storey(one, "RID", "residual_drift", "rad", storey_height)
    status = np.atleast_1d(one["status"].values)
    names = str(one["status"].attrs.get("flag_meanings", "ok")).split()
    codes = np.atleast_1d(one["status"].attrs.get("flag_values", np.arange(len(names))))
    sound = [int(code) for code, name in zip(codes, names, strict=True) if name in ("ok", "collapsed")]
    failed = ~np.isin(status, sound)
    with (
        replacing(path, suffixes=(".csv",)) as part,
        Path(part).open("w", encoding="utf-8", newline="") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["", *(name for name, _, _ in columns), *(["ERROR"] if failed.any() else [])])
        writer.writerow(["Units", *(unit for _, unit, _ in columns), *(["ea"] if failed.any() else [])])
        for row in range(status.size):
            numbers = [repr(float(values[row])) for _, _, values in columns]
            writer.writerow([row, *numbers, *([int(failed[row])] if failed.any() else [])])


def _one(cube: xr.Dataset) -> xr.Dataset:
    """Return the cube over record and storey alone; say which dims still hold several."""
    if "storey" not in cube.dims or "record" not in cube.dims:
        raise InvalidInput(
            "Pelicun's demands come from a cube of buildings over records, as fdspec.sweep_buildings makes"
        )
    many = [dim for dim in _FIXED if cube.sizes.get(dim, 1) > 1]
    if many:
        raise InvalidInput(
            f"the cube holds several values along {', '.join(many)}; select one of each, as with "
            f"cube.sel({many[0]}=...)"
        )
    return cube.squeeze([dim for dim in _FIXED if dim in cube.dims])


def _by_storey(
    one: xr.Dataset, kind: str, variable: str, unit: str, over: float
) -> list[tuple[str, str, NDArray[np.float64]]]:
    if variable not in one:
        return []
    values = np.abs(one[variable].transpose("record", "storey").values) / over
    return [(_name(kind, k + 1), unit, values[:, k]) for k in range(values.shape[1])]


def _name(kind: str, location: int) -> str:
    return f"1-{kind}-{location}-{DIRECTION}"
