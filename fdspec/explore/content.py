"""What the page shows of a cube: axes, records and indices in words, and each record's numbers."""

from __future__ import annotations

import gzip
import json
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.explore.indices import Index, known_indices
from fdspec.explore.packing import pack
from fdspec.measures import best_on_grid
from fdspec.store.suitable import loaded
from fdspec.units import G
from fdspec.variables import BUILDING_DIMS, STUDY_DIMS

if TYPE_CHECKING:
    import xarray as xr

AXES: Final = STUDY_DIMS[1:]


class Content:
    """Hold a cube of single-storey frames as the page takes it.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns; may be opened lazily, a record is read when it is asked for. Infinite
        pretensions are left out: no map has a place for them.
    name : str
        What the page calls it, such as its file's name.

    Raises
    ------
    InvalidInput
        When the cube is none of single-storey frames, or has too little to draw.
    """

    def __init__(self, cube: xr.Dataset, name: str) -> None:
        _check(cube, name)
        finite = np.flatnonzero(np.isfinite(cube["pretension"].values))
        self.cube = cube.isel(pretension=finite) if finite.size < cube.sizes["pretension"] else cube
        self.name = name
        for axis in ("pretension", "period"):
            if self.cube.sizes[axis] < 2:
                raise InvalidInput(
                    f"a map over {axis} needs at least 2 finite values, {name} has {self.cube.sizes[axis]}"
                )
        self.indices = known_indices(self.cube)
        if not self.indices:
            raise InvalidInput(
                f"{name} has none of the variables that can be shown, such as peak_acceleration"
            )
        self.records = tuple(str(record) for record in self.cube["record"].values)

    @property
    def about(self) -> dict[str, Any]:
        """Everything but the numbers of the cells; plain enough for JSON."""
        cube = self.cube
        return {
            "name": self.name,
            "cubes": [
                {
                    "name": self.name,
                    "title": str(cube.attrs.get("title", "")),
                    "made": str(cube.attrs.get("history", "")),
                    "comment": str(cube.attrs.get("comment", "")),
                    "frame": frame_of(cube),
                }
            ],
            "axes": {
                "stiffness_ratio": cube["stiffness_ratio"].values.tolist(),
                "pretension": (cube["pretension"].values / 1e3).tolist(),
                "period": cube["period"].values.tolist(),
                "slip_force": (cube["slip_force"].values / 1e3).tolist(),
            },
            "records": [about_record(cube, k) for k in range(len(self.records))],
            "indices": [
                {
                    "name": index.name,
                    "title": index.title,
                    "unit": index.unit,
                    "best": index.best,
                    "searched": bool(index.measure),
                    "colours": list(index.colours),
                    "neutral": index.neutral,
                }
                for index in self.indices
            ],
        }

    def record(self, k: int) -> bytes:
        """Return the numbers of one record, packed and compressed.

        Each index over (stiffness_ratio, pretension, period), NaN where a history did not end well;
        ``best INDEX``, the position along pretension of its best over (stiffness_ratio, period), NaN where
        there is none; ``bare`` (period) and ``braced`` (stiffness_ratio, period), the two limits of
        acceleration in g.
        """
        one = loaded(self.cube.isel(record=[k]), self.name)
        arrays: dict[str, NDArray[np.float64]] = {}
        for index in self.indices:
            values = index.values(one).isel(record=0).transpose(*AXES)
            arrays[index.name] = values.values
            if index.best:
                arrays[f"best {index.name}"] = _best(values, index)
        for name, variable, dims in (
            ("bare", "elastic_acceleration", ("period",)),
            ("braced", "braced_acceleration", ("stiffness_ratio", "period")),
        ):
            if variable in one:
                arrays[name] = one[variable].isel(record=0).transpose(*dims).values / G
        # Level 6 takes three times as long for a twentieth less.
        return gzip.compress(pack({"record": self.records[k]}, arrays), compresslevel=1, mtime=0)


def about_record(cube: xr.Dataset, k: int) -> dict[str, Any]:
    """Return what a cube tells of its k-th record; its ``cube`` is the first of the page's."""
    one = cube.isel(record=k)
    name = str(one["record"].item())
    told: dict[str, Any] = {"name": name, "record": name, "cube": 0}
    for key in ("source", "event"):
        told[key] = str(one[key].item()) if key in one.coords else ""
    for key, factor in (("pga", 1.0 / G), ("duration", 1.0), ("scale_factor", 1.0)):
        value = float(one[key].item()) * factor if key in one.coords else float("nan")
        told[key] = value if np.isfinite(value) else None
    return told


FRAME: Final = (
    ("floor_mass", "floor mass", "t", 1e-3),
    ("brace_mass", "brace mass", "kg", 1.0),
    ("damping_ratio", "damping ratio", "", 1.0),
    ("friction_coefficient", "friction coefficient", "", 1.0),
    ("normal_force_factor", "normal force over pretension", "", 1.0),
)
"""What a reader must know of the frame: parameter, words, the page's unit, factor to it."""


def frame_of(cube: xr.Dataset) -> list[dict[str, Any]]:
    """Return name, words, unit and value of the frame's constants, as far as the cube tells them."""
    try:
        told = json.loads(str(cube.attrs.get("parameters", "{}")))
    except json.JSONDecodeError:
        return []
    if not isinstance(told, dict):
        return []
    return [
        {"name": name, "title": title, "unit": unit, "value": told[name] * factor}
        for name, title, unit, factor in FRAME
        if isinstance(told.get(name), int | float)
    ]


def _best(values: xr.DataArray, index: Index) -> NDArray[np.float64]:
    """Position of the best along pretension, the first where several are equal; NaN where none is known."""
    best = best_on_grid(values if index.best == "least" else -values)["pretension"].values
    place = np.searchsorted(values["pretension"].values, best).astype(np.float64)
    return np.where(np.isfinite(best), place, np.nan)


def _check(cube: xr.Dataset, name: str) -> None:
    dims = {str(dim) for dim in cube.dims}
    if "building" in dims:
        raise InvalidInput(
            f"{name} is a cube of buildings, over {', '.join(BUILDING_DIMS)}; BuildingContent "
            "takes it, this takes cubes of single-storey frames"
        )
    if "time" in dims:
        raise InvalidInput(f"{name} is a history; the page shows cubes, as fdspec sweep makes them")
    lacking = [dim for dim in STUDY_DIMS if dim not in dims]
    if lacking:
        raise InvalidInput(
            f"{name} lacks the dimension {', '.join(lacking)}; "
            f"the page shows cubes over {', '.join(STUDY_DIMS)}"
        )
    empty = [dim for dim in STUDY_DIMS if cube.sizes[dim] == 0]
    if empty:
        raise InvalidInput(f"{name} has no {empty[0]}; there is nothing to show")
    if "slip_force" not in cube.coords:
        raise InvalidInput(f"{name} lacks slip_force over pretension; the page shows cubes of fdspec sweep")


def embedded(about: dict[str, Any]) -> str:
    """Return JSON that may stand in a script element, whatever the texts in it hold."""
    text = json.dumps(about, allow_nan=False, ensure_ascii=True)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
