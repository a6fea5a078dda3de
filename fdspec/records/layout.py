"""Rows without headings: a column for each quantity, or one series that runs on along the rows."""

from __future__ import annotations

from typing import Final

import numpy as np

from fdspec.records import vocabulary as words
from fdspec.records.block import Block
from fdspec.records.given import Given
from fdspec.records.rows import CLEARLY, Table, rises, roughness, runs_on
from fdspec.records.textfile import TextFile

COLUMNS: Final = "columns"
ROWS: Final = "rows"


def layout_of(text: TextFile, block: Block, given: Given) -> str:
    """Return "columns" or "rows", from the count in the header, the rows themselves, or the caller."""
    table = block.table
    totals = {count for _, count, _ in block.stated.counts}
    timed = any(heading.quantity == words.TIME for heading in block.headings or ())
    if block.headings and not timed and table.values.size in totals and table.rows not in totals:
        return ROWS  # what looks like headings is a sentence of as many words
    if block.headings:
        if given.layout == ROWS and table.width > 1:
            raise text.refusal(block.heading_line, "each column has a heading: layout cannot be 'rows'")
        return COLUMNS
    if table.width == 1:
        return COLUMNS
    if given.layout is not None:
        return given.layout
    counts = {count for _, count, _ in block.stated.counts}
    if table.values.size in counts:
        return ROWS
    if table.rows in counts and table.ragged is None and not table.short_last:
        return COLUMNS
    if table.ragged is not None:
        found = table.dialect.numbers(text.lines[table.ragged - 1]) or []
        raise text.refusal(
            table.ragged, f"expected {table.width} columns as in line {table.first}, found {len(found)}"
        )
    if counts:
        line, count, phrase = block.stated.counts[0]
        there = f"{table.rows} rows with {table.values.size} values"
        raise text.refusal(
            table.last, f"expected {count}, as line {line} says ({phrase!r}), but found {there}"
        )
    if table.short_last:
        return ROWS
    if rises(table.columns[:, 0]):
        return COLUMNS
    return _by_smoothness(text, table)


def counts_rows(table: Table, column: int, decimals: int) -> bool:
    """Say whether a column holds 0, 1, 2, ... or 1, 2, 3, ..., which number rows and are no times."""
    values = table.columns[:, column]
    return decimals <= 0 and values[0] in {0.0, 1.0} and bool((np.diff(values) == 1.0).all())


def _by_smoothness(text: TextFile, table: Table) -> str:
    along, across = roughness(table)
    if runs_on(table):
        return ROWS
    if across < CLEARLY * along:
        return COLUMNS
    raise text.refusal(
        table.first,
        f"{table.width} numbers a row, the first no time, may be as many columns or one series: "
        "give layout, 'columns' or 'rows'",
    )
