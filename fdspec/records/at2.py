"""PEER AT2: four header lines, then values in g, in rows; the fourth line is written in four ways."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_block, parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.units import to_si

NAME: Final = "PEER AT2"
FIRST_VALUES: Final = 5

_QUANTITY: Final = re.compile(
    r"(ACCELERATION|VELOCITY|DISPLACEMENT) TIME (?:HISTORY|SERIES) IN UNITS OF (\S+)", re.IGNORECASE
)
_FILTER: Final = re.compile(r"FILTER POINTS:\s*(.*\S)", re.IGNORECASE)
_NPTS_FIRST: Final = re.compile(
    r"\s*NPTS\s*=\s*(\d+)\s*,\s*DT\s*=\s*([0-9.EeDd+-]+)\s*(?:SEC)?\s*(?:,.*)?", re.IGNORECASE
)
_NUMBERS_FIRST: Final = re.compile(r"\s*(\d+)\s+([0-9.EeDd+-]+)\s+NPTS\s*,\s*DT\s*", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether the file is PEER's, from its third line."""
    return len(text.lines) > 2 and _QUANTITY.match(text.lines[2].strip()) is not None


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file; the number of values must be the header's."""
    third = text.line(3, "the line that names quantity and units")
    quantity = _QUANTITY.match(third.strip())
    if quantity is None or quantity[1].upper() != "ACCELERATION" or quantity[2].rstrip(".,").upper() != "G":
        raise text.refusal(
            3, f"expected ACCELERATION TIME HISTORY IN UNITS OF G, found {third.strip()[:60]!r}"
        )
    npts, dt = _npts_and_dt(text)
    values = parse_block(text, FIRST_VALUES, len(text.lines))
    if values.size != npts:
        raise text.refusal(
            len(text.lines), f"expected {npts} values, as line 4 says, but the file ends after {values.size}"
        )
    event, station, component = _origin(text.lines[1])
    filtered = _FILTER.search(third)
    processing = (f"filtered by the agency: {filtered[1]}",) if filtered else ()
    channel = Channel(
        name=component,
        acceleration=to_si(values, "g"),
        dt=dt,
        units="g",
        event=event,
        station=station,
        component=component,
        processing=processing,
    )
    return (channel,)


def _npts_and_dt(text: TextFile) -> tuple[int, float]:
    line = text.line(4, "the line with NPTS and DT")
    match = _NPTS_FIRST.fullmatch(line) or _NUMBERS_FIRST.fullmatch(line)
    dt = parse_number(match[2]) if match else None
    if match is None or dt is None or len(match[1]) > 12:
        raise text.refusal(4, f"expected 'NPTS= n, DT= t SEC' or 'n t NPTS, DT', found {line.strip()[:60]!r}")
    npts = int(match[1])
    if npts < 2:
        raise text.refusal(4, f"expected NPTS of at least 2, found {npts}")
    if dt <= 0.0:
        raise text.refusal(4, f"expected a positive DT in s, found {match[2]}")
    return npts, dt


def _origin(line: str) -> tuple[str, str, str]:
    """Return event, station and component from 'event date, station, component (agency)'; old files vary."""
    parts = [part.strip() for part in line.split(",")]
    if len(parts) > 1 and re.fullmatch(r"\(.*\)", parts[-1]):
        parts.pop()
    component = re.sub(r"\s*\([^()]*\)$", "", parts[-1]) if len(parts) > 1 else ""
    station = parts[-2] if len(parts) > 2 else ""
    event = " ".join(", ".join(parts[:-2] if len(parts) > 2 else parts[:1]).split())
    return event, station, component
