"""A cube or a history as a workbook: rows as in the CSV, and a sheet that says what the columns are."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from fdspec.errors import StoreError
from fdspec.store.history_csv import changes_of, course_of, fixed, meaning_of
from fdspec.store.table import blocks, columns_of, dims_of, heading, links_in_columns, origin

if TYPE_CHECKING:
    import xarray as xr

EXCEL_SUFFIXES: Final = (".xlsx",)

ROWS: Final = 1_048_576
"""Of a sheet, the head among them."""

COLUMNS: Final = 16_384

LETTERS: Final = 32_767
"""Of a cell."""


def write_excel(one: xr.Dataset, part: Path) -> None:
    """Write the rows to a workbook.

    Raises
    ------
    StoreError
        Where openpyxl is missing, or a sheet has too little room.
    """
    try:
        from openpyxl import Workbook
    except ModuleNotFoundError as error:
        raise StoreError(f"a workbook needs {error.name}: pip install 'fdspec[excel]'") from None
    sheets, about = _sheets(one)
    book = Workbook(write_only=True)
    for title, (head, rows, count) in sheets.items():
        if count + 1 > ROWS or len(head) > COLUMNS:
            raise StoreError(
                f"{count} rows of {len(head)} columns do not fit a sheet, which holds {ROWS - 1} and "
                f"{COLUMNS}: export to .csv or .mat, or name one record"
            )
        _fill(book.create_sheet(title), [head], rows)
    _fill(book.create_sheet("about"), ([line] for line in about), ())
    with part.open("wb") as file:
        book.save(file)


Sheet = tuple[Sequence[str], Iterable[Sequence[Any]], int]


def _sheets(one: xr.Dataset) -> tuple[dict[str, Sheet], list[str]]:
    """Return head, rows and number of rows of each sheet, and the lines of the last."""
    if "time" not in one.dims:
        one = links_in_columns(one)
        dims = dims_of(one)
        columns = columns_of(one, dims)
        count = math.prod(one.sizes[dim] for dim in dims)
        rows = (row for block in blocks(one, dims, columns) for row in block)
        return {"cube": (columns, rows, count)}, list(heading(one, columns))
    names, course = course_of(one)
    changes = changes_of(one)
    sheets: dict[str, Sheet] = {"history": _of_columns(course)}
    if changes:
        sheets["transitions"] = _of_columns(changes)
    told = [meaning_of(name, one[name].attrs) for name in (*names, *changes)]
    return sheets, [*origin(one), *told, *fixed(one)]


def _of_columns(columns: dict[str, Any]) -> Sheet:
    values = [array.tolist() for array in columns.values()]
    return list(columns), zip(*values, strict=True), len(values[0])


def _fill(sheet: Any, *parts: Iterable[Sequence[Any]]) -> None:
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    def cell(value: Any) -> Any:
        if isinstance(value, float) and not math.isfinite(value):
            return None if math.isnan(value) else str(value)
        if isinstance(value, str):  # as text, also where it looks like a formula
            made = WriteOnlyCell(sheet, ILLEGAL_CHARACTERS_RE.sub(" ", value)[:LETTERS])
            made.data_type = "s"
            return made
        return value

    for rows in parts:
        for row in rows:
            sheet.append([cell(value) for value in row])
