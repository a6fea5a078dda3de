"""Rows of numbers under words: columns with or without headings, or values that run on along the rows."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from fdspec.errors import RecordError
from fdspec.records import vocabulary as words
from fdspec.records.block import Block, block_from
from fdspec.records.channel import Channel
from fdspec.records.columns import read_columns
from fdspec.records.given import Given
from fdspec.records.layout import ROWS, layout_of
from fdspec.records.rows import MAX_HEADER, Dialect, dialect_of, first_row, fixed_width_of
from fdspec.records.running import read_running
from fdspec.records.textfile import TextFile

NAME: Final = "columns of text"
MAX_BLOCKS: Final = 60
TRAILER: Final = 3
"""Lines behind the rows that the history shows."""

NOTHING: Final = Given()


def recognises(text: TextFile) -> bool:
    """Say whether rows of numbers follow after at most 200 header lines."""
    dialect = dialect_of(text) or fixed_width_of(text)
    return dialect is not None and first_row(text, dialect) is not None


def read(text: TextFile, given: Given = NOTHING) -> tuple[Channel, ...]:
    """Read the accelerations. What the file does not say must be given."""
    start = 1 if given.skip is None else given.skip + 1
    if start > len(text.lines):
        raise text.refusal(None, f"skip is given as {given.skip}, but the file has {len(text.lines)} lines")
    dialect = dialect_of(text, start) or fixed_width_of(text, start)
    try:
        return _read(text, start, dialect, given)
    except RecordError:
        # Values may touch in a few rows alone, where they are largest.
        touching = fixed_width_of(text, start) if dialect == Dialect() else None
        if touching is None:
            raise
        return _read(text, start, touching, given)


def _read(text: TextFile, start: int, dialect: Dialect | None, given: Given) -> tuple[Channel, ...]:
    if dialect is None:
        raise text.refusal(None, f"expected rows of numbers after at most {MAX_HEADER} header lines")
    text.take(None, f"rows of numbers parted by {dialect.said}")
    told = given.skip is not None
    found = block_from(text, start, dialect, told)
    if found is None:
        where = f"in line {start}, as skip says" if told else f"after at most {MAX_HEADER} header lines"
        raise text.refusal(start if told else None, f"expected rows of numbers {where}")
    block, behind = found
    channels = list(_channels(text, block, given))
    later, behind = _later_blocks(text, dialect, behind)
    for other in later:
        channels += _later_channels(text, other, given)
    trailer = _trailer(text, behind)
    return tuple(replace(channel, processing=(*channel.processing, *trailer)) for channel in channels)


def _channels(text: TextFile, block: Block, given: Given) -> tuple[Channel, ...]:
    if layout_of(text, block, given) == ROWS:
        return (read_running(text, block, given),)
    return read_columns(text, block, given)


def _later_blocks(text: TextFile, dialect: Dialect, behind: int) -> tuple[list[Block], int]:
    """Return blocks of rows behind the first, each under words of its own, and the line behind the last."""
    blocks: list[Block] = []
    while behind <= len(text.lines):
        found = block_from(text, behind, dialect)
        if found is None:
            further = _any_rows(text, dialect, behind)
            if further is None:
                break
            raise text.refusal(further, "more rows of numbers, far behind the others: expected one block")
        blocks.append(found[0])
        behind = found[1]
        if len(blocks) > MAX_BLOCKS:
            raise text.refusal(behind, f"expected at most {MAX_BLOCKS} blocks of rows")
    return blocks, behind


def _any_rows(text: TextFile, dialect: Dialect, start: int) -> int | None:
    number = start + MAX_HEADER
    while number < len(text.lines):
        first = first_row(text, dialect, number)
        if first is not None:
            return first
        number += MAX_HEADER
    return None


def _later_channels(text: TextFile, block: Block, given: Given) -> tuple[Channel, ...]:
    """Read a later block; one of velocity or displacement is passed over, one that says nothing refused."""
    said = block.stated.mentioned
    measured = {unit.quantity for _, unit, _ in block.stated.units}
    headed = {heading.quantity for heading in block.headings or ()}
    if words.ACCELERATION in said or words.ACCELERATION in measured or words.ACCELERATION in headed:
        return _channels(text, block, given)
    others = (words.VELOCITY, words.DISPLACEMENT, words.SPECTRAL, words.PERIOD, words.FREQUENCY)
    for quantity in others:
        if quantity in said or quantity in measured or quantity in headed:
            text.take(block.table.first, f"to line {block.table.last}: {quantity}, passed over")
            return ()
    raise text.refusal(
        block.table.first, "a further block of rows, and no word above it says of what: expected one block"
    )


def _trailer(text: TextFile, behind: int) -> tuple[str, ...]:
    lines = [
        (n, " ".join(text.lines[n - 1][:200].split()))
        for n in range(behind, min(len(text.lines), behind + 50) + 1)
    ]
    lines = [(number, line) for number, line in lines if line]
    if not lines:
        return ()
    shown = "; ".join(f"line {number}: {line[:80]!r}" for number, line in lines[:TRAILER])
    more = f" and {len(lines) - TRAILER} more" if len(lines) > TRAILER else ""
    text.take(lines[0][0], "and below: a trailer, passed over")
    return (f"on reading, lines behind the rows were passed over: {shown}{more}",)
