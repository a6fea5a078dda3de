"""CSMIP V1, as RENADIC still writes it: uncorrected acceleration in g/10, in pairs of time and value."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "CSMIP V1"
TEXT_LINES: Final = 13
HEADER_LINES: Final = 27  # with 7 lines of integers and 7 of reals
PAIRS_A_LINE: Final = 5
WIDTH: Final = 7

_TITLE: Final = re.compile(r"\s*UNCORRECTED ACCELEROGRAM DATA\s+PROCESSED", re.IGNORECASE)
_POINTS: Final = re.compile(
    r"NO\. OF POINTS\s*=\s*(\d{1,9})\s+RECORD LENGTH\s*=\s*([\d.]{1,12})\s*SEC", re.IGNORECASE
)
_UNITS: Final = re.compile(r"UNITS.*\bG/10\b", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether the first line is the title of uncorrected data."""
    return _TITLE.match(text.lines[0]) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read each channel of the file."""
    channels = []
    number = 1
    while number <= len(text.lines):
        if _TITLE.match(text.lines[number - 1]) is None:
            raise text.refusal(
                number, f"expected the title of a channel, found {text.lines[number - 1][:60]!r}"
            )
        channel, number = _read_block(text, number)
        channels.append(channel)
    return tuple(channels)


def _read_block(text: TextFile, first: int) -> tuple[Channel, int]:
    points = _POINTS.search(text.line(first + 10, "the number of points"))
    if points is None:
        raise text.refusal(first + 10, "expected 'NO. OF POINTS = n  RECORD LENGTH = t SEC'")
    if _UNITS.search(text.line(first + 11, "the units")) is None:
        raise text.refusal(first + 11, "expected 'UNITS OF UNCOR ACCEL ARE SEC AND G/10'")
    count = int(points[1])
    if count < 2:
        raise text.refusal(first + 10, f"expected at least 2 points, found {count}")
    start = first + HEADER_LINES
    last = start - 1 + -(-count // PAIRS_A_LINE)
    text.line(last, f"the last of {count} points")
    pairs = parse_columns(text, start, last, WIDTH, 2 * count).reshape(-1, 2)
    step = float(pairs[-1, 0] - pairs[0, 0]) / (count - 1)
    # Times are printed to 1 ms: enough to see a lost or a doubled pair.
    if step <= 0.0 or np.abs(pairs[:, 0] - pairs[0, 0] - np.arange(count) * step).max() > min(
        0.0011, 0.4 * step
    ):
        raise text.refusal(start, "expected equal time steps in the pairs of time and acceleration")
    end = text.line(last + 1, "the end of data")
    if "end of data" not in end.lower():
        raise text.refusal(last + 1, f"expected the end of data, found {end.strip()[:60]!r}")
    lines = [line.strip() for line in text.lines[first - 1 : first + TEXT_LINES]]
    direction = re.sub(r"^CHAN\s*\w+:\s*|\s*\(.*$", "", lines[6])
    channel = Channel(
        name=direction,
        acceleration=to_si(pairs[:, 1] / 10.0, "g"),
        dt=round(step, 6),
        units="g",
        event=" ".join(lines[2].split("(")[0].split()),
        station=lines[5],
        component=direction,
    )
    return channel, last + 2
