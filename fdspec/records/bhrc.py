"""Iran's network (BHRC), VOL1DS: header, then uncorrected acceleration in g/10, a component a block."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.blocks import read_blocks
from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "BHRC (Iran)"
HEADER_LINES: Final = 27
A_LINE, WIDTH = 10, 13

_TITLE: Final = re.compile(r"\* VOL1DS FILE:")
_POINTS: Final = re.compile(r"NO\. OF POINTS\s*=\s*(\d{1,9})\s+DURATION\s*=\s*([\d.]{1,12})")


def recognises(text: TextFile) -> bool:
    """Say whether the first line is the title of a block."""
    return _TITLE.match(text.head(1)) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read all components."""
    return read_blocks(text, _TITLE, "'* VOL1DS FILE'", _read_block)


def _read_block(text: TextFile, first: int) -> tuple[Channel, int]:
    points = _POINTS.match(text.line(first + 10, "the number of points"))
    duration = parse_number(points[2]) if points else None
    if points is None or duration is None or duration <= 0.0 or int(points[1]) < 2:
        raise text.refusal(first + 10, "expected 'NO. OF POINTS = n  DURATION = t'")
    if "G/10" not in text.line(first + 11, "the units"):
        raise text.refusal(first + 11, "expected 'UNITS ARE SECONDS AND G/10'")
    count = int(points[1])
    start = first + HEADER_LINES
    last = start - 1 + -(-count // A_LINE)
    values = parse_columns(text, start, last, WIDTH, count)
    end = text.line(last + 1, "the end of data")
    if end.strip() != "/&":
        raise text.refusal(last + 1, f"expected the end of data, '/&', found {end.strip()[:60]!r}")
    lines = [line.strip() for line in text.heads(first, first + HEADER_LINES)]
    component = lines[6].removeprefix("COMP").strip()
    channel = Channel(
        name=component,
        acceleration=to_si(values / 10.0, "g"),
        dt=duration / count,
        units="g",
        event=" ".join(lines[2].removeprefix("Origin Time :").split()),
        station=lines[7].split("Station")[0].strip(),
        component=component,
    )
    return channel, last + 2
