"""Columns of numbers: time and one or more accelerations, or accelerations alone with dt given.

Header lines may stand above; they are searched for the unit, and for the names of the columns.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_number
from fdspec.records.textfile import TextFile
from fdspec.records.time_step import uniform_step
from fdspec.records.units import UNITS, to_si

NAME: Final = "columns of text"
MAX_HEADER: Final = 60

_BRACKETED: Final = re.compile(r"[\[(]\s*([A-Za-z]+(?:/[A-Za-z]+(?:/[A-Za-z]+|\^?2)?)?)\s*[\])]")
_STATION: Final = re.compile(r"\bstation\s*[:=]\s*(\S[^\r]*?)\s*$", re.IGNORECASE)


def recognises(text: TextFile) -> bool:
    """Say whether numbers in columns follow after at most 60 header lines."""
    return _first_row(text) is not None


def read(text: TextFile, *, units: str | None = None, dt: float | None = None) -> tuple[Channel, ...]:
    """Read one channel a column. `units` and `dt` must be given when the file does not say them."""
    first = _first_row(text)
    if first is None:
        raise text.refusal(None, f"expected columns of numbers after at most {MAX_HEADER} header lines")
    table, words = _table(text, first)
    unit = _unit(text, first, units)
    if table.shape[1] == 1:
        if dt is None:
            raise text.refusal(None, "one column has no times: give dt, in s")
        step = dt
    else:
        step = uniform_step(text, first, words, dt)
        table = table[:, 1:]
    names = _names(text, first, table.shape[1])
    event, station = _origin(text, first)
    return tuple(
        Channel(
            name,
            to_si(np.ascontiguousarray(column), unit),
            step,
            unit,
            event=event,
            station=station,
            component=name if len(names) > 1 else "",
        )
        for name, column in zip(names, table.T, strict=True)
    )


def _cells(line: str) -> list[str]:
    """Split at semicolons (decimal commas allowed then), else at commas, else at blanks."""
    if ";" in line:
        return [cell.strip().replace(",", ".") for cell in line.strip().strip(";").split(";")]
    if "," in line:
        return [cell.strip() for cell in line.strip().rstrip(",").split(",")]
    return line.split()


def _is_row(line: str) -> bool:
    cells = _cells(line)
    return bool(cells) and all(parse_number(cell) is not None for cell in cells)


def _first_row(text: TextFile) -> int | None:
    """Return the number of the first row of numbers: one that the next row resembles."""
    lines = text.lines
    for number, (line, following) in enumerate(pairwise(lines[: MAX_HEADER + 2]), start=1):
        if _is_row(line) and _is_row(following) and len(_cells(line)) == len(_cells(following)):
            return number
    return None


def _table(text: TextFile, first: int) -> tuple[NDArray[np.float64], list[str]]:
    """Return all rows, and the words of the first column, whose digits say how exact the times are."""
    width = len(_cells(text.lines[first - 1]))
    rows: list[list[float]] = []
    words: list[str] = []
    for number, line in enumerate(text.lines[first - 1 :], start=first):
        cells = _cells(line)
        if len(cells) != width:
            raise text.refusal(number, f"expected {width} columns as in line {first}, found {len(cells)}")
        row = []
        for cell in cells:
            value = parse_number(cell)
            if value is None:
                raise text.refusal(number, f"expected a finite number, found {cell[:40]!r}")
            row.append(value)
        rows.append(row)
        words.append(cells[0])
    return np.array(rows, dtype=np.float64), words


def _unit(text: TextFile, first: int, given: str | None) -> str:
    """Return the unit that header or caller name; they must not contradict each other."""
    header = "\n".join(text.lines[: first - 1])
    found = {UNITS[word.lower()] for word in _BRACKETED.findall(header) if word.lower() in UNITS}
    if given is not None:
        if found and given not in found:
            says = " and ".join(sorted(found))
            raise text.refusal(None, f"units are given as {given}, but the header says {says}")
        return given
    if len(found) != 1:
        says = "does not say" if not found else "contradicts itself on"
        choice = "give units, one of g, m/s2, cm/s2, mm/s2"
        raise text.refusal(None, f"the file {says} the unit of acceleration: {choice}")
    return found.pop()


def _origin(text: TextFile, first: int) -> tuple[str, str]:
    """Return event and station: the first line above the headings, and what follows the word station."""
    header = text.lines[: max(first - 2, 0)]
    event = header[0].strip(" #.\t") if header else ""
    stations = [match[1] for line in header if (match := _STATION.search(line))]
    return event, stations[0] if stations else ""


def _names(text: TextFile, first: int, count: int) -> list[str]:
    """Return the names of the acceleration columns: those of the line above when it has one each."""
    cells = _cells(text.lines[first - 2]) if first > 1 else []
    if len(cells) in {count, count + 1}:
        names = [re.sub(r"\s*[\[(].*", "", cell).strip(" #\"'") for cell in cells[-count:]]
        if all(names) and len(set(names)) == count:
            return names
    return [str(k + 1) for k in range(count)]
