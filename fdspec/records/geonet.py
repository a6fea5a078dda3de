"""GeoNet V1A and V2A: 26 lines of header, then values in mm/s2; V2A adds velocity and displacement."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.blocks import read_blocks
from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "GeoNet V1A or V2A"
TEXT_LINES, INTEGER_LINES, REAL_LINES = 16, 4, 6
A_LINE, WIDTH = 10, 8
COUNTS: Final = slice(33, 36)  # integers 34 to 36: values of acceleration, velocity, displacement
STEP: Final = 25  # real 26: step of the series, s; real 25 is the raw record's

_TITLE: Final = re.compile(r"(Uncorrected|Corrected) accelerogram \S+ GNS Science")
_POINTS: Final = re.compile(r"Number of points\s+(\d{1,9})\s+Duration")


def recognises(text: TextFile) -> bool:
    """Say whether the first line is GeoNet's title."""
    return _TITLE.match(text.head(1)) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the acceleration of each channel."""
    return read_blocks(text, _TITLE, "GeoNet's title", _read_block)


def _read_block(text: TextFile, first: int) -> tuple[Channel, int]:
    line = first + TEXT_LINES
    integers = parse_columns(text, line, line + INTEGER_LINES - 1, WIDTH, INTEGER_LINES * A_LINE)
    line += INTEGER_LINES
    reals = parse_columns(text, line, line + REAL_LINES - 1, WIDTH, REAL_LINES * A_LINE)
    line += REAL_LINES
    counts = [int(value) for value in integers[COUNTS]]
    points = _POINTS.match(text.line(first + 9, "the number of points"))
    if points is None or int(points[1]) != counts[0] or counts[0] < 2 or min(counts) < 0:
        raise text.refusal(first + 9, f"expected 'Number of points {counts[0]}', as integer 34 says")
    dt = float(reals[STEP])
    if dt <= 0.0:
        raise text.refusal(first + 22, f"expected the time step as real 26, found {dt:g}")
    values = None
    for count in counts:
        last = line - 1 + -(-count // A_LINE)
        if count:
            series = parse_columns(text, line, last, WIDTH, count)
            values = series if values is None else values
        line = last + 1
    assert values is not None  # noqa: S101  the first count is 2 or more
    lines = [entry.strip() for entry in text.heads(first, first + TEXT_LINES)]
    direction = re.sub(r"^Component\s+", "", lines[12])
    channel = Channel(
        name=direction.split()[0] if direction else "",
        acceleration=to_si(values, "mm/s2"),
        dt=dt,
        units="mm/s2",
        event=" ".join(f"{lines[6]}, {lines[7]}".split()),
        station=lines[1].split()[1] if len(lines[1].split()) > 1 else "",
        component=direction,
        processing=(lines[11],) if "filter" in lines[11] and "unfiltered" not in lines[11] else (),
    )
    return channel, line
