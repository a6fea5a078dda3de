"""CSMIP (CGS, CDMG) V1: uncorrected acceleration, a channel a block.

CGS writes values at equal steps below a line with their rate and unit. Older files, and RENADIC still, have
pairs of time and value in g/10.
"""

from __future__ import annotations

import re
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.blocks import read_blocks
from fdspec.records.channel import Channel
from fdspec.records.channel_names import channel_name
from fdspec.records.numbers import parse_columns
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "CSMIP V1"
TEXT_LINES: Final = 13
HEADER_LINES: Final = 27  # with 7 lines of integers and 7 of reals
PAIRS_A_LINE: Final = 5
WIDTH: Final = 7

_TITLE: Final = re.compile(r"\s*UNCORRECTED ACCELEROGRAM DATA\s+PROCESSED", re.IGNORECASE)
_POINTS: Final = re.compile(
    r"NO\. OF POINTS\s*=\s*(\d{1,9})\s+RECORD LENGTH\s*=\s*(\d{1,6}\.?\d{0,6}|\.\d{1,6})\s*SEC", re.IGNORECASE
)
_UNITS: Final = re.compile(r"UNITS.*\bG/10\b", re.IGNORECASE)
_EVEN: Final = re.compile(
    r"\s*(\d{1,9}) accelerogram points at\s+(\d{1,6}(?:\.\d{1,6})?) pts/sec in units of (\S+?)\s*\.?\s+"
    r"Format:\s*\(\s*(\d{1,2})F(\d{1,2})\.\d+\)",
    re.IGNORECASE,
)


_EVEN_OF_CDMG: Final = re.compile(
    r"\s*(\d{1,9}) points of accel data equally spaced at\s{0,9}(\d{0,3}\.\d{1,6}) sec\.?"
    r"\s{1,9}\(units:\s{0,9}([^)]{1,20})\)",
    re.IGNORECASE,
)
A_LINE_OF_CDMG: Final = 8


def recognises(text: TextFile) -> bool:
    """Say whether the first line is the title of uncorrected data."""
    return _TITLE.match(text.head(1)) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read each channel of the file."""
    return read_blocks(text, _TITLE, "the title of a channel", _read_block)


def _read_block(text: TextFile, first: int) -> tuple[Channel, int]:
    points = _POINTS.search(text.line(first + 10, "the number of points"))
    if points is None:
        raise text.refusal(first + 10, "expected 'NO. OF POINTS = n  RECORD LENGTH = t SEC'")
    count, length = int(points[1]), float(points[2])
    if count < 2:
        raise text.refusal(first + 10, f"expected at least 2 points, found {count}")
    start = first + HEADER_LINES
    even = _EVEN.match(text.line(start, f"the first of {count} points"))
    times, refusal = None, ""
    if even is not None:
        acceleration, dt, unit, last = _values(text, start, even, count, length)
    elif cdmg := _EVEN_OF_CDMG.match(text.head(start)):
        acceleration, dt, unit, last = _values_of_cdmg(text, start, cdmg, count, length)
    else:
        acceleration, dt, times, refusal = _pairs(text, first, count)
        unit, last = "g", start - 1 + -(-count // PAIRS_A_LINE)
    end = text.line(last + 1, "the end of data")
    if "end of data" not in end.lower():
        raise text.refusal(last + 1, f"expected the end of data, found {end.strip()[:60]!r}")
    lines = [line.strip() for line in text.heads(first, first + TEXT_LINES)]
    direction = channel_name(lines[6])
    event = re.sub(r"^(Rcrd|Record) of\s+", "", lines[2 if even is None else 1].split("(")[0])
    channel = Channel(
        name=direction,
        acceleration=acceleration,
        dt=dt,
        units=unit,
        event=" ".join(event.split()),
        station=" ".join(re.split(r"\s{3,}", lines[5])[0].split()),
        component=direction,
        times=times,
        refusal=refusal,
    )
    text.take(start, f"channel {direction!r}: {count} values of acceleration in {unit}, step {dt:.10g} s")
    return channel, last + 2


def _values(
    text: TextFile, heading: int, even: re.Match[str], count: int, length: float
) -> tuple[NDArray[np.float64], float, str, int]:
    """Read values at equal steps; return them in m/s2, with step, unit and last line."""
    if int(even[1]) != count:
        raise text.refusal(heading, f"expected {count} points, as the header says, found {even[1]}")
    unit = acceleration_unit(even[3])
    if unit is None:
        raise text.refusal(heading, f"expected units of g or cm/sec2, found {even[3]!r}")
    rate, a_line, width = float(even[2]), int(even[4]), int(even[5])
    if rate <= 0.0 or a_line < 1 or width < 2:
        raise text.refusal(
            heading, f"expected a positive rate and a Fortran format, found {even[0].strip()!r}"
        )
    _refuse_other_length(text, heading, count, rate, length)
    last = heading + -(-count // a_line)
    return to_si(parse_columns(text, heading + 1, last, width, count), unit), 1.0 / rate, unit, last


def _values_of_cdmg(
    text: TextFile, heading: int, even: re.Match[str], count: int, length: float
) -> tuple[NDArray[np.float64], float, str, int]:
    """Read the same below the sentence that CDMG wrote, which has no Fortran format: eight values a line."""
    unit = acceleration_unit(even[3])
    step = float(even[2])
    if int(even[1]) != count or unit is None or step <= 0.0:
        raise text.refusal(
            heading, f"expected {count} points at a positive step, in g or cm/sec2, found {even[0].strip()!r}"
        )
    _refuse_other_length(text, heading, count, 1.0 / step, length)
    line = text.line(heading + 1, "the first values").rstrip()
    values = min(count, A_LINE_OF_CDMG)
    if not line or len(line) % values:
        raise text.refusal(heading + 1, f"expected {values} values in columns of one width")
    last = heading + -(-count // A_LINE_OF_CDMG)
    samples = parse_columns(text, heading + 1, last, len(line) // values, count)
    return to_si(samples, unit), step, unit, last


def _refuse_other_length(text: TextFile, heading: int, count: int, rate: float, length: float) -> None:
    if abs(count / rate - length) > 0.01 * length + 2.0 / rate:
        raise text.refusal(heading, f"{count} points at {rate:g} a second do not make {length:g} s")


def _pairs(
    text: TextFile, first: int, count: int
) -> tuple[NDArray[np.float64], float, NDArray[np.float64] | None, str]:
    """Read pairs of time and value in g/10: values in m/s2, step, and of film the times and a refusal."""
    if _UNITS.search(text.line(first + 11, "the units")) is None:
        raise text.refusal(first + 11, "expected 'UNITS OF UNCOR ACCEL ARE SEC AND G/10'")
    start = first + HEADER_LINES
    last = start - 1 + -(-count // PAIRS_A_LINE)
    text.line(last, f"the last of {count} points")
    pairs = parse_columns(text, start, last, WIDTH, 2 * count).reshape(-1, 2)
    times, values = np.ascontiguousarray(pairs[:, 0]), to_si(pairs[:, 1], "g/10")
    step = float(times[-1] - times[0]) / (count - 1)
    problem = "expected equal time steps in the pairs of time and acceleration"
    if step <= 0.0 or (np.diff(times) < 0.0).any():
        raise text.refusal(start, f"{problem}, and times that grow")
    # Times are printed to 1 ms: enough to see a lost or a doubled pair.
    if np.abs(times - times[0] - np.arange(count) * step).max() > min(0.0011, 0.4 * step):
        return (
            values,
            step,
            times,
            str(text.refusal(start, f"{problem}; to interpolate between them, resample_to")),
        )
    return values, round(step, 6), None, ""
