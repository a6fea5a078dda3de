"""How the histories of a cube ended, record by record, so that a cube larger than memory can be asked."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.measures.cells import require
from fdspec.printable import in_words
from fdspec.variables import NOT_COMPUTED

if TYPE_CHECKING:
    import xarray as xr


class Cell(NamedTuple):
    """A history and how it ended; coordinates in their units."""

    status: str
    coordinates: dict[str, Any]

    def __str__(self) -> str:
        return f"{in_words(self.status)}: " + ", ".join(
            f"{in_words(dim)} {value:.6g}" if isinstance(value, float) else f"{in_words(dim)} {value}"
            for dim, value in self.coordinates.items()
        )


def status_counts(cube: xr.Dataset) -> dict[str, int]:
    """Count the histories of a cube by how they ended: ``{"ok": 41580}``."""
    require(cube, ("status",), dims=())
    counts: dict[str, int] = {}
    meanings = meanings_of(cube)
    for status in _by_record(cube):
        codes, numbers = np.unique(status.values, return_counts=True)
        for code, number in zip(codes.tolist(), numbers.tolist(), strict=True):
            meaning = meanings.get(code, f"status {code}")
            counts[meaning] = counts.get(meaning, 0) + number
    return counts


def failed_cells(cube: xr.Dataset) -> Iterator[Cell]:
    """Give every history that did not end well, by its coordinates."""
    require(cube, ("status",), dims=())
    meanings = meanings_of(cube)
    for status in _by_record(cube):
        for index in np.argwhere(status.values != 0):
            cell = status[tuple(index)]
            code = int(cell)
            coordinates = {str(dim): cell[dim].item() for dim in status.dims}
            yield Cell(meanings.get(code, f"status {code}"), coordinates)


def _by_record(cube: xr.Dataset) -> Iterator[xr.DataArray]:
    status = cube["status"].reset_coords(drop=True)
    if "record" not in status.dims:
        yield status.load()
        return
    for record in range(status.sizes["record"]):
        yield status.isel(record=slice(record, record + 1)).load()


def meanings_of(cube: xr.Dataset) -> dict[int, str]:
    """Return what each status code of a cube means."""
    about = cube["status"].attrs
    codes = np.atleast_1d(about.get("flag_values", ())).tolist()
    meanings = str(about.get("flag_meanings", "")).split()
    if len(codes) != len(meanings):
        raise InvalidInput(
            f"status has {len(codes)} codes and {len(meanings)} meanings; its attributes are damaged"
        )
    return {NOT_COMPUTED: "not_computed", **dict(zip(codes, meanings, strict=True))}
