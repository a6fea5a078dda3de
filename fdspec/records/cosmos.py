"""COSMOS V1 and V2, also CESMD's V1C and V2C: text, integers, reals and values, a channel a block.

COSMOS, "Strong-Motion Data Format", version 1.20 (2001).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "COSMOS V1 or V2"
STEP: Final = 61  # real header value 62: step of the series, in ms; value 34 is the raw record's
LENGTH: Final = 62  # real header value 63: length of the series, s
UNKNOWN: Final = -999.0

_TITLE: Final = re.compile(
    r"\s*(Raw|Uncorrected|Corrected)\b.*\(Format v0?1\.\d\d with\s+(\d{1,3}) text lines\)", re.IGNORECASE
)
_COUNT: Final = re.compile(
    r"\s*(\d{1,5})\s+(Integer-header values|Real-header values|Comment line\(s\)) follow"
    r"(?:\s+on\s+(\d{1,5})\s+lines,\s*Format\s*=\s*\(\s*(\d{1,2})[IF](\d{1,2}))?",
    re.IGNORECASE,
)
_DATA: Final = re.compile(
    r"\s*(\d{1,9})\s+(raw accel|accel|veloc|displ)\S*\s+pts,.*units=\s*([^\s(,]*)\s*\(\s*\d+\)\s*,?\s*"
    r"Format\s*=\s*\(\s*(\d{1,2})[FEI](\d{1,2})",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class _Header:
    """Counts of one header section, and where the next one starts."""

    count: int
    lines: int
    width: int
    following: int


def recognises(text: TextFile) -> bool:
    """Say whether the first line is a COSMOS title."""
    return _TITLE.match(text.head(1)) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read all acceleration channels; velocities and displacements beside them are passed over."""
    channels = []
    number = 1
    while number <= len(text.lines):
        if not text.lines[number - 1].strip():
            number += 1
            continue
        channel, number = _read_block(text, number)
        if channel is not None:
            channels.append(channel)
    if not channels:
        raise text.refusal(None, "there is no acceleration channel in the file")
    return tuple(channels)


def _read_block(text: TextFile, first: int) -> tuple[Channel | None, int]:
    title = _TITLE.match(text.head(first))
    if title is None:
        raise text.refusal(
            first, f"expected the title of a COSMOS block, found {text.lines[first - 1][:60]!r}"
        )
    integers = _section(text, first + int(title[2]), "Integer-header values")
    reals = _section(text, integers.following, "Real-header values")
    values = parse_columns(text, reals.following - reals.lines, reals.following - 1, reals.width, reals.count)
    comments = _section(text, reals.following, "Comment line(s)")
    line = comments.following
    data = _DATA.match(text.line(line, "the line with the number of points"))
    if data is None:
        raise text.refusal(line, "expected 'n acceleration pts, ... units=..., Format=(...)'")
    count, a_line, width = int(data[1]), int(data[4]), int(data[5])
    if count < 2 or a_line < 1 or width < 2:
        raise text.refusal(
            line, f"expected at least 2 points and a Fortran format, found {data[0].strip()!r}"
        )
    last = line + -(-count // a_line)
    following = _after_end(text, last + 1)
    if not data[2].lower().endswith(("accel", "raw accel")):
        return None, following
    unit = _unit(text, line, data[3])
    samples = to_si(parse_columns(text, line + 1, last, width, count), unit)
    return _channel(text, first, samples, _step(text, line, values, count), unit), following


def _section(text: TextFile, line: int, title: str) -> _Header:
    match = _COUNT.match(text.line(line, f"'{title} follow'"))
    if match is None or match[2].lower() != title.lower():
        raise text.refusal(line, f"expected '{title} follow', found {text.lines[line - 1].strip()[:60]!r}")
    count = int(match[1])
    if match[3] is None:
        if "Comment" not in title:
            raise text.refusal(line, "expected the number of lines and a Fortran format behind the count")
        return _Header(count, count, 0, line + 1 + count)
    lines, width = int(match[3]), int(match[5])
    if count < 1 or width < 1 or lines != -(-count // max(int(match[4]), 1)):
        raise text.refusal(line, f"{count} values in rows of {match[4]} do not fill {lines} lines")
    text.line(line + lines, f"the end of the {title.lower()}")
    return _Header(count, lines, width, line + 1 + lines)


def _after_end(text: TextFile, line: int) -> int:
    """Return the line after the end-of-data mark."""
    if line > len(text.lines):
        return line
    if "end" not in text.head(line).lower():
        raise text.refusal(line, f"expected the end of data, found {text.lines[line - 1].strip()[:60]!r}")
    return line + 1


def _unit(text: TextFile, line: int, spelling: str) -> str:
    unit = acceleration_unit(spelling)
    if unit is None:
        reason = "raw counts are no acceleration" if "count" in spelling.lower() else "this unit is not known"
        raise text.refusal(line, f"expected units=g or cm/sec2, found {spelling!r}: {reason}")
    return unit


def _step(text: TextFile, line: int, reals: NDArray[np.float64], count: int) -> float:
    if reals.size <= LENGTH:
        raise text.refusal(line, f"expected {LENGTH + 1} real-header values or more, found {reals.size}")
    dt, length = float(reals[STEP]) / 1000.0, float(reals[LENGTH])
    if dt <= 0.0:
        raise text.refusal(
            line, f"expected the time step in ms as real-header value {STEP + 1}, found {reals[STEP]:g}"
        )
    if length != UNKNOWN and abs(count * dt - length) > 0.01 * length + 2.0 * dt:
        raise text.refusal(
            line, f"{count} points of {dt:g} s do not make {length:g} s, real-header value {LENGTH + 1}"
        )
    return dt


def _channel(text: TextFile, first: int, samples: NDArray[np.float64], dt: float, unit: str) -> Channel:
    lines = text.heads(first, first + 12)
    event = re.sub(r"^\s*(Rcrd|Record) of\s+", "", lines[1]) if len(lines) > 1 else ""
    station = re.search(r"Code:\s*\S+\s+(.*\S)", lines[4]) if len(lines) > 4 else None
    channel = re.search(r"Sta Chan?:?\s*(\S+?)\s*:\s*(.*?)\s*\(", lines[8]) if len(lines) > 8 else None
    filtered = lines[11].strip() if len(lines) > 11 else ""
    direction = channel[2] if channel else ""
    return Channel(
        name=direction or (channel[1] if channel else ""),
        acceleration=samples,
        dt=dt,
        units=unit,
        event=" ".join(event.split()),
        station=" ".join(station[1].split()) if station else "",
        component=direction,
        # An unprocessed channel has the sentence without its numbers.
        processing=(filtered,) if re.search(r"(?<!not )filtered\b.*\d", filtered) else (),
    )
