"""A history as tables: a row for each time, and a file of its own with a row for each change of phase."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fdspec.store.layout import is_text
from fdspec.store.replacing import replacing

if TYPE_CHECKING:
    import xarray as xr

CSV_SUFFIXES = (".csv",)


def transitions_file(path: Path) -> Path:
    """Return the file of the changes of phase beside a history's table."""
    return path.with_name(f"{path.stem}-transitions{path.suffix}")


def write_history(history: xr.Dataset, part: Path, path: Path, heading: list[str]) -> None:
    """Write the time series to `part`; the changes of phase to the file beside `path`, as a whole.

    What each storey or link has of its own is a column for each, ``drift_1``, ``drift_2`` and so on where
    there are several; what has one value, or one for each storey, stands in the heading.
    """
    names, columns = course_of(history)
    about = [*heading, *_told(history, names), *fixed(history)]
    _write(part, about, columns)
    changes = changes_of(history)
    if changes:
        with replacing(transitions_file(path), suffixes=CSV_SUFFIXES) as other:
            _write(other, [*heading, *_told(history, list(changes))], changes)


def course_of(history: xr.Dataset) -> tuple[list[str], dict[str, Any]]:
    """Return the variables over time, time first, and their columns: one for each storey or link."""
    names = [str(name) for name, array in history.variables.items() if array.dims[:1] == ("time",)]
    columns: dict[str, Any] = {}
    for name in sorted(names, key=lambda name: name != "time"):
        array = history[name]
        if array.ndim == 1:
            columns[name] = array.values
        else:
            dim = str(array.dims[1])
            many = array.sizes[dim]
            labels = history[dim].values.tolist() if dim in history.coords else range(1, many + 1)
            for k, label in enumerate(labels):
                columns[f"{name}_{label}" if many > 1 else name] = array.values[:, k]
    return names, columns


def changes_of(history: xr.Dataset) -> dict[str, Any]:
    """Return the columns of the changes of phase."""
    return {
        str(name): array.values for name, array in history.variables.items() if array.dims == ("transition",)
    }


def _write(part: Path, heading: list[str], columns: dict[str, Any]) -> None:
    with part.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {line}\n" for line in heading)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*(values.tolist() for values in columns.values()), strict=True))


def _told(history: xr.Dataset, names: list[str]) -> Iterator[str]:
    for name in names:
        yield meaning_of(name, history[name].attrs)


def fixed(history: xr.Dataset) -> Iterator[str]:
    """Give what does not change in time, with its values."""
    for key, array in history.variables.items():
        name = str(key)
        of_each = array.dims in {("storey",), ("link",)} and name not in array.dims
        if (not array.dims or of_each) and not is_text(array):
            values = ", ".join(repr(value) for value in np.atleast_1d(array.values).tolist())
            yield f"{meaning_of(name, array.attrs)}: {values}"


def meaning_of(name: str, attrs: dict[Any, Any]) -> str:
    """Say a variable's unit and meaning, and what its codes stand for."""
    meaning = f"{name} [{attrs.get('units', '-')}] {attrs.get('long_name', '')}".rstrip()
    if "flag_values" in attrs:
        codes = zip(np.atleast_1d(attrs["flag_values"]), str(attrs["flag_meanings"]).split(), strict=True)
        meaning += f" ({', '.join(f'{code} {word}' for code, word in codes)})"
    return meaning
