"""CSMIP (CGS, CDMG) V2: text, integers, reals, then acceleration, velocity, displacement; a channel a block.

Before the nineties the lines above the values gave their unit and no Fortran format, which was 8F10.3.
"""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.blocks import read_blocks
from fdspec.records.channel import Channel
from fdspec.records.channel_names import channel_name
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "CSMIP V2"
HEADER_LINES: Final = 45
REAL_LINES: Final = 13
REALS: Final = 100
STEP: Final = (
    52  # real header value 53: step of the corrected series, s, with more digits than the text shows
)

OLD_A_LINE, OLD_WIDTH = 8, 10

_TITLE: Final = re.compile(r"Corrected accelerogram\s+\S+\s+Chan\s*\w+:", re.IGNORECASE)
_INTERVALS: Final = re.compile(
    r"equally[- ]spaced intervals of\s{0,12}(\d{0,3}\.\d{1,6}|\d{1,3}\.?)\s{1,4}sec", re.IGNORECASE
)
_DATA: Final = re.compile(
    r"\s*(\d{1,9}) points of (accel|veloc|displ) data equally spaced at\s+([\d.]+) sec"
    r"(?:, in (?P<unit>[^\s(]+?)\.?\s*\(\s*(?P<a_line>\d{1,2})f(?P<width>\d{1,2})\.\d+\)"
    r"|\.?\s*\(units:\s*(?P<old_unit>[^\s)]+?)\.?\s*\))",
    re.IGNORECASE,
)


def recognises(text: TextFile) -> bool:
    """Say whether the first line is a CSMIP title of corrected data."""
    return _TITLE.match(text.head(1)) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the acceleration of each channel."""
    return read_blocks(text, _TITLE, "'Corrected accelerogram'", _read_block)


def _read_block(text: TextFile, first: int) -> tuple[Channel, int]:
    line = first + HEADER_LINES
    channel = None
    for quantity in ("accel", "veloc", "displ"):
        data = _DATA.match(text.line(line, f"the points of {quantity}"))
        if data is None or data[2].lower() != quantity:
            raise text.refusal(line, f"expected 'n points of {quantity} data equally spaced at t sec'")
        count = int(data[1])
        a_line, width = int(data["a_line"] or OLD_A_LINE), int(data["width"] or OLD_WIDTH)
        if count < 2 or a_line < 1 or width < 2:
            raise text.refusal(
                line, f"expected at least 2 points and a Fortran format, found {data[0].strip()!r}"
            )
        last = line + -(-count // a_line)
        values = parse_columns(text, line + 1, last, width, count)
        if quantity == "accel":
            spelling = data["unit"] or data["old_unit"]
            unit = acceleration_unit(spelling)
            if unit is None:
                raise text.refusal(line, f"expected acceleration in cm/sec2 or g, found {spelling!r}")
            channel = _channel(
                text, first, Channel("", to_si(values, unit), _step(text, line, data[3]), unit)
            )
        line = last + 1
    assert channel is not None  # noqa: S101  the loop's first turn makes it
    end = text.line(line, "the end of data")
    if "end of data" not in end.lower():
        raise text.refusal(line, f"expected the end of data, found {end.strip()[:60]!r}")
    return channel, line + 1


def _step(text: TextFile, line: int, printed: str) -> float:
    reals = parse_columns(text, line - REAL_LINES, line - 1, 10, REALS)
    exact = float(reals[STEP])
    try:
        shown = float(printed)
    except ValueError:
        shown = 0.0
    if exact > 0.0 and abs(exact - shown) <= 0.00051:
        return exact
    # Film has its step in other slots; the sentence above the values is believed where a second one agrees.
    said = next(
        (match for head in text.heads(line - HEADER_LINES, line - 1) if (match := _INTERVALS.search(head))),
        None,
    )
    if shown <= 0.0 or said is None or abs(float(said[1]) - shown) > 1e-9:
        raise text.refusal(
            line, f"expected the step of real-header value {STEP + 1}, {exact:g} s, found {printed}"
        )
    return shown


def _channel(text: TextFile, first: int, channel: Channel) -> Channel:
    lines = [line.strip() for line in text.heads(first, first + 24)]
    direction = channel_name(lines[7])
    return Channel(
        name=direction,
        acceleration=channel.acceleration,
        dt=channel.dt,
        units=channel.units,
        event=" ".join(re.sub(r"^(Rcrd|Record) of\s+", "", lines[2].split("(")[0]).split()),
        station=" ".join(re.split(r"\s{3,}", lines[6])[0].split()),
        component=direction,
        processing=(lines[14],) if "filter" in lines[14].lower() else (),
    )
