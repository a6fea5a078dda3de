"""USGS files of the eighties: acceleration, velocity and displacement, each under seven lines of words."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.keyed import split_key
from fdspec.records.numbers import parse_block
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "USGS blocks"
HEADER_LINES: Final = 7

_RATE: Final = re.compile(r"SAMPLES/SEC\s{0,9}=\s{0,9}(\d{1,6}(?:\.\d{0,6})?)", re.IGNORECASE)
_TYPE: Final = re.compile(r"DATA TYPE\s{0,9}=\s{0,9}([A-Z]{2})", re.IGNORECASE)
_POINTS: Final = re.compile(
    r"\s{0,20}NO\.? OF POINTS\s{0,9}=\s{0,9}(\d{1,9})\s{0,9},\s{0,9}UNITS\s{0,9}=\s{0,9}([^,]{1,30})",
    re.IGNORECASE,
)
_COMPONENT: Final = re.compile(r"COMPONENT\s{0,9}=\s{0,9}(\S{1,20})", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether sixth and seventh line have the keys of a block."""
    return len(text.lines) > HEADER_LINES and _is_header(text, 1)


def _is_header(text: TextFile, first: int) -> bool:
    return (
        first + HEADER_LINES <= len(text.lines)
        and _RATE.search(text.head(first + 5)) is not None
        and _POINTS.match(text.head(first + 6)) is not None
    )


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the blocks of acceleration; others must be whole and are passed over."""
    channels = []
    first = 1
    while first <= len(text.lines):
        if not _is_header(text, first):
            raise text.refusal(
                first, f"expected the seven header lines of a block, found {text.head(first).strip()[:60]!r}"
            )
        channel, first = _read_block(text, first)
        if channel is not None:
            channels.append(channel)
    if not channels:
        raise text.refusal(None, "there is no block of acceleration, DATA TYPE=AC, in the file")
    return tuple(channels)


def _read_block(text: TextFile, first: int) -> tuple[Channel | None, int]:
    rate, points = _RATE.search(text.head(first + 5)), _POINTS.match(text.head(first + 6))
    kind = _TYPE.search(text.head(first + 5))
    if rate is None or points is None or kind is None:
        raise text.refusal(first + 5, "expected SAMPLES/SEC and DATA TYPE")
    count, per_second = int(points[1]), float(rate[1])
    if count < 2 or per_second <= 0.0:
        raise text.refusal(first + 6, "expected at least 2 points and a positive rate")
    start = first + HEADER_LINES
    a_line = len(text.line(start, "the first values").split())
    if a_line < 1:
        raise text.refusal(start, "expected values in the line behind the header")
    last = start - 1 + -(-count // a_line)
    text.line(last, f"the last of {count} values")
    values = parse_block(text, start, last)
    if values.size != count:
        raise text.refusal(last, f"expected {count} values up to here, found {values.size}")
    if kind[1].upper() != "AC":
        text.take(start, f"to line {last}: DATA TYPE={kind[1]}, passed over")
        return None, last + 1
    unit = acceleration_unit(points[2])
    if unit is None:
        raise text.refusal(first + 6, f"expected UNITS=CM/SEC**2, found {points[2].strip()!r}")
    text.take(start, f"to line {last}: DATA TYPE=AC, {count} values in {unit}, {per_second:g} a second")
    heads = [" ".join(line.split()) for line in text.heads(first, first + 4)]
    named = _COMPONENT.search(heads[4])
    component = named[1] if named else heads[1]
    about = split_key(heads[3], "=")
    filtered = heads[3] if about is None and "BUTTERWORTH" in heads[3].upper() else ""
    channel = Channel(
        name=component,
        acceleration=to_si(values, unit),
        dt=1.0 / per_second,
        units=unit,
        event=heads[2],
        station=heads[0],
        component=component,
        processing=(f"filtered by the agency: {filtered}",) if filtered else (),
    )
    return channel, last + 1
