"""PEER AT2: three lines of words, a line with count and step, then values in rows."""

from __future__ import annotations

import re
from typing import Final

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_block, parse_number
from fdspec.records.statements import statements
from fdspec.records.textfile import TextFile
from fdspec.records.units import acceleration_unit, to_si

NAME: Final = "PEER AT2"
FIRST_VALUES: Final = 5
MAX_MOVED: Final = 9
"""The last line in which PEER's sentence is looked for."""

_QUANTITY: Final = re.compile(
    r"(ACCELERATION|VELOCITY|DISPLACEMENT) TIME (?:HISTORY|SERIES) IN UNITS OF ([^.\s,]+(?:\.\d+)?)",
    re.IGNORECASE,
)
_PUBLISHER: Final = re.compile(r"\b(?:PEER|PACIFIC ENGINEERING|STRONG[- ]MOTION)\b", re.IGNORECASE)
_FILTER: Final = re.compile(r"FILTER POINTS:\s*(.*\S)", re.IGNORECASE)
_STEP: Final = re.compile(r"\bDT\s{0,9}=\s{0,9}([0-9.EeDd+-]{1,20})", re.IGNORECASE)
_COUNT: Final = re.compile(r"\d{1,12}", re.ASCII)


def recognises(text: TextFile) -> bool:
    """Say whether the file is PEER's: by the sentence of its third line, or by one that damage has moved.

    Where the sentence stands elsewhere, or nothing below it is PEER's, but the header counts the values, the
    file is one of rows under words.
    """
    line = _sentence(text)
    if line is None:
        return False
    if line == 3 and (_PUBLISHER.search(text.head(1)) or len(text.lines) < 4 or _has_both(text.head(4))):
        return True
    counts = statements(enumerate(text.heads(1, MAX_MOVED), start=1)).counts
    return not counts and any(_has_values(head) for head in text.heads(line + 1, MAX_MOVED))


def _sentence(text: TextFile) -> int | None:
    heads = text.heads(1, MAX_MOVED)
    return next((k for k, head in enumerate(heads, start=1) if _QUANTITY.match(head.strip())), None)


def _has_values(line: str) -> bool:
    """Say whether a line is a row of several numbers."""
    words = line.split()
    return len(words) > 2 and parse_number(words[0]) is not None


def _has_both(line: str) -> bool:
    """Say whether a line has count and step, in words or as two numbers alone."""
    stated = statements([(4, line)])
    words = line.split()
    numbers = len(words) == 2 and sum(_COUNT.fullmatch(word) is not None for word in words) == 1
    return (numbers and all(parse_number(word) is not None for word in words)) or bool(
        stated.counts and stated.steps
    )


def read(text: TextFile) -> tuple[Channel, ...]:
    """Read the one channel of the file; the number of values must be the header's."""
    third = text.line(3, "the line that names quantity and units")
    if (line := _sentence(text)) != 3:
        raise text.refusal(line, "PEER's third line stands here, and no count of the values: expected NPTS")
    quantity = _QUANTITY.match(third.strip())
    unit = acceleration_unit(quantity[2]) if quantity else None
    if quantity is None or quantity[1].upper() != "ACCELERATION" or unit is None:
        raise text.refusal(
            3, f"expected ACCELERATION TIME HISTORY IN UNITS OF G, found {third.strip()[:60]!r}"
        )
    npts, dt = _npts_and_dt(text)
    values = parse_block(text, FIRST_VALUES, len(text.lines))
    if values.size != npts:
        raise text.refusal(
            len(text.lines), f"expected {npts} values, as line 4 says, but the file ends after {values.size}"
        )
    text.take(3, f"acceleration in {unit}")
    text.take(4, f"{npts} values, time step {dt:.10g} s")
    event, station, component = _origin(text.head(2))
    filtered = _FILTER.search(third)
    processing = (f"filtered by the agency: {filtered[1]}",) if filtered else ()
    channel = Channel(
        name=component,
        acceleration=to_si(values, unit),
        dt=dt,
        units=unit,
        event=event,
        station=station,
        component=component,
        processing=processing,
    )
    return (channel,)


def _npts_and_dt(text: TextFile) -> tuple[int, float]:
    """Return count and step of line 4: words in either order, words behind the numbers, or numbers alone."""
    line = text.line(4, "the line with NPTS and DT").strip()
    stated = statements([(4, line)])
    counts = [count for _, count, _ in stated.counts]
    steps = [step for _, step, _ in stated.steps]
    words = line.replace(",", " ").split()
    if len(words) == 2 and all(parse_number(word) is not None for word in words):
        if not _COUNT.fullmatch(words[0]):
            words.reverse()
        counts, steps = [int(words[0])] if _COUNT.fullmatch(words[0]) else [], [parse_number(words[1])]
    shown = _STEP.search(line)
    bad = shown[1] if shown and parse_number(shown[1]) is not None else words[-1] if steps else None
    if len(counts) != 1 or len(steps) > 1 or (not steps and bad is None):
        raise text.refusal(4, f"expected 'NPTS= n, DT= t SEC' or 'n t NPTS, DT', found {line[:60]!r}")
    if counts[0] < 2:
        raise text.refusal(4, f"expected NPTS of at least 2, found {counts[0]}")
    if not steps or steps[0] is None or steps[0] <= 0.0:
        raise text.refusal(4, f"expected a positive DT in s, found {bad}")
    return counts[0], steps[0]


def _origin(line: str) -> tuple[str, str, str]:
    """Return event, station and component from 'event date, station, component (agency)'; old files vary."""
    parts = [part.strip() for part in line.split(",")]
    if len(parts) > 1 and parts[-1].startswith("(") and parts[-1].endswith(")"):
        parts.pop()
    component = re.sub(r"\s*\([^()]*\)$", "", parts[-1]) if len(parts) > 1 else ""
    station = parts[-2] if len(parts) > 2 else ""
    event = " ".join(", ".join(parts[:-2] if len(parts) > 2 else parts[:1]).split())
    return event, station, component
