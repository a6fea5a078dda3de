"""USGS SMC: eleven lines of text, 48 integers, 50 reals, comments, then values in columns of ten."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "USGS SMC"
TEXT_LINES: Final = 11
INTEGER_LINES, INTEGERS, INTEGER_WIDTH = 6, 48, 10
REAL_LINES, REALS, REAL_WIDTH = 10, 50, 15
COMMENTS: Final = 15  # integer 16: how many lines of comment
COUNT: Final = 16  # integer 17: how many values
RATE: Final = 1  # real 2: samples a second
A_LINE, WIDTH = 8, 10
LONG_A_LINE, LONG_WIDTH = 5, 14  # with eight digits, as PEA2SMC writes them
NO_REAL: Final = 1.69e38
"""What stands for an unknown number is 1.7e38, in single precision."""

_TITLE: Final = re.compile(
    r"\s*([0-6])\s+(UNCORRECTED|CORRECTED|VELOCITY|DISPLACEMENT|RESPONSE|FOURIER|UNKNOWN)", re.IGNORECASE
)
_ACCELERATION: Final = re.compile(r"\bacceleration time (?:history|series)", re.IGNORECASE)
_PLACE: Final = re.compile(r"\s*station\s*=\s*(.*?)component\s*=\s*(.*\S)", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether the first line is a title of SMC and its header has SMC's marks."""
    return _TITLE.match(text.head(1)) is not None and len(text.lines) > 1 and text.head(2).startswith("*")


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file."""
    title = _TITLE.match(text.head(1))
    if title is None or title[1] not in "012":
        raise text.refusal(1, f"expected an accelerogram (type 1 or 2), found {text.head(1).strip()[:60]!r}")
    first = TEXT_LINES + 1
    integers = parse_columns(text, first, first + INTEGER_LINES - 1, INTEGER_WIDTH, INTEGERS)
    first += INTEGER_LINES
    reals = parse_columns(text, first, first + REAL_LINES - 1, REAL_WIDTH, REALS)
    first += REAL_LINES
    count, comments, rate = int(integers[COUNT]), int(integers[COMMENTS]), float(reals[RATE])
    if count < 2:
        raise text.refusal(
            TEXT_LINES + 1 + COUNT // 8, f"expected at least 2 points as integer 17, found {count}"
        )
    if rate >= NO_REAL:
        problem = (
            "expected samples a second as real 2, found none: digitised from film, at unequal time steps"
        )
        raise text.refusal(TEXT_LINES + 1 + INTEGER_LINES, problem)
    if rate <= 0.0:
        raise text.refusal(
            TEXT_LINES + 1 + INTEGER_LINES, f"expected samples a second as real 2, found {rate:g}"
        )
    if not 0 <= comments <= len(text.lines):
        raise text.refusal(TEXT_LINES + 2, f"expected the number of comments as integer 16, found {comments}")
    start = first + comments
    if title[1] == "0" and not any(_ACCELERATION.search(line) for line in text.heads(first, start - 1)):
        raise text.refusal(
            1, "the title says UNKNOWN, and no comment that this is an acceleration time history"
        )
    a_line, width = A_LINE, WIDTH
    if start - 1 + -(-count // LONG_A_LINE) == len(text.lines) != start - 1 + -(-count // A_LINE):
        a_line, width = LONG_A_LINE, LONG_WIDTH
    last = start - 1 + -(-count // a_line)
    if last != len(text.lines):
        raise text.refusal(
            len(text.lines), f"expected {count} values up to line {last}, but this is the last line"
        )
    values = parse_columns(text, start, last, width, count)
    text.take(start, f"to line {last}: {count} values in cm/s2, {rate:g} a second")
    place = _PLACE.match(text.head(6))
    channel = Channel(
        name=place[2] if place else "",
        acceleration=to_si(values, "cm/s2"),
        dt=1.0 / rate,
        units="cm/s2",
        event=" ".join(text.head(4).split()),
        station=place[1].strip(", ") if place else "",
        component=place[2] if place else "",
    )
    return (channel,)
