"""Rows of numbers in a text: what parts the cells, where the rows begin and end, what stands between them."""

from __future__ import annotations

import csv
import math
import re
from array import array
from collections import Counter
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.records.numbers import CHUNK, parse_number, stuck_words
from fdspec.records.textfile import TextFile
from fdspec.records.time_step import PrintedTimes, precision

MAX_HEADER: Final = 200
"""Lines above the first row."""

MAX_BETWEEN: Final = 1000
"""Lines without numbers between two rows; more end the rows."""

RISING: Final = 0.8
"""Share of steps upward that makes a first column times, if damaged ones; half of a motion's rise."""

CLEARLY: Final = 0.7
"""Neighbours in a series differ less than values a row apart, by this factor, or nothing is concluded."""

OVER_ENDS: Final = 1.3
"""A series differs from one row's end to the next one's begin as it does within rows, up to this factor."""

_SAMPLE: Final = 40
"""Lines looked at, in each of three places, to tell what parts the cells."""

_MARKS: Final = ("#", "%", "!", "//", "/&", "--", "==", "$", "&", "@")
_WORDS: Final = re.compile(r"\s*[\W_]{0,12}[^\W\d_]{2,}")
_NO_NUMBER: Final = re.compile(r"\s*[+-]?(?:nan|inf|infinity|null|none|na|n/a)\b", re.IGNORECASE)
_NUMERIC: Final = re.compile(r"[0-9+\-.EeDd,;|\s\"']*", re.ASCII)


@dataclass(frozen=True)
class Dialect:
    """What parts the cells of a row: a mark, or blanks when None; whether the comma is the decimal mark.

    `halves`: comma for both, so that two cells make a number. `width`: characters of a cell, where nothing
    parts them.
    """

    separator: str | None = None
    comma: bool = False
    halves: bool = False
    width: int = 0

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line, with decimal points."""
        cells = self.raw_cells(line)
        if self.halves and len(cells) % 2 == 0:
            cells = [f"{whole}.{part}" for whole, part in zip(cells[0::2], cells[1::2], strict=True)]
        return [cell.replace(",", ".") for cell in cells] if self.comma else cells

    def raw_cells(self, line: str) -> list[str]:
        """Return the cells of a line as written, without quotes; empty ones at the end do not count."""
        if self.width:
            line = line.rstrip()
            return [line[k : k + self.width].strip() for k in range(0, len(line), self.width)]
        if self.separator is None:
            return line.replace('"', " ").split()
        if '"' in line:
            try:
                cells = next(csv.reader([line], delimiter=self.separator, skipinitialspace=True), [])
            except csv.Error:
                cells = line.split(self.separator)
        else:
            cells = line.strip(" \r").split(self.separator)
        cells = [cell.strip() for cell in cells]
        while cells and not cells[-1]:
            cells.pop()
        return cells

    def numbers(self, line: str) -> list[float] | None:
        """Return the numbers of a row, None when the line is none; values that touch are parted by signs."""
        values: list[float] = []
        for word in self.words(line):
            value = parse_number(word)
            if value is None:
                return None
            values.append(value)
        return values or None

    def words(self, line: str) -> list[str]:
        """Return the cells of a row, those that touch parted."""
        cells = self.cells(line)
        if self.separator is not None or self.comma or self.width:
            return cells
        words: list[str] = []
        for cell in cells:
            if parse_number(cell) is None and (stuck := stuck_words(cell)) is not None:
                words += stuck
            else:
                words.append(cell)
        return words

    @property
    def said(self) -> str:
        """What parts the cells, in words."""
        if self.width:
            return f"columns of {self.width} characters"
        names = {None: "blanks", "\t": "tabs", ",": "commas", ";": "semicolons", "|": "bars"}
        return names[self.separator] + (", decimal commas" if self.comma or self.halves else "")


_DIALECTS: Final = tuple(
    Dialect(separator, comma) for separator in (";", "\t", ",", "|", None) for comma in (False, True)
)  # fmt: skip


@dataclass(frozen=True)
class Table:
    """Rows of numbers: `values` run along the rows, `width` a row, the last row may be shorter.

    `ragged` is the first line with another number of cells, None when there is none. `remarks` are lines
    between the rows, each with its number; `skipped` the numbers of all lines between that are no rows.
    """

    dialect: Dialect
    first: int
    last: int
    width: int
    rows: int
    values: NDArray[np.float64]
    ragged: int | None
    short_last: bool
    remarks: tuple[tuple[int, str], ...]
    skipped: tuple[int, ...]
    blank: int | None = None

    @property
    def columns(self) -> NDArray[np.float64]:
        """The values as rows and columns; only of a table that is full."""
        return self.values.reshape(self.rows, self.width)

    @property
    def first_column(self) -> NDArray[np.float64]:
        """The first value of each row, the last row's left out when it is short."""
        return self.values[: self.values.size // self.width * self.width : self.width]

    def line(self, row: int) -> int:
        """Return the number of the line that a row stands in."""
        return PrintedTimes(self.values, 0, 0, self.first, self.skipped).line(row)

    def without_first(self, rows: int) -> Table:
        """Return the table less its first rows."""
        return replace(
            self,
            first=self.line(rows),
            rows=self.rows - rows,
            values=self.values[rows * self.width :],
            skipped=tuple(line for line in self.skipped if line > self.line(rows)),
        )


def dialect_of(text: TextFile, start: int = 1) -> Dialect | None:
    """Return what parts the cells of most rows; None when nothing looks like rows of numbers.

    Raises
    ------
    RecordError
        When 0,15 may be two whole numbers or one with a decimal comma.
    """
    last = len(text.lines)
    lines = _sample(text, start, last)
    scores: Counter[Dialect] = Counter()
    for line in lines:
        for dialect in _DIALECTS:
            if dialect.separator is not None and dialect.separator not in line:
                continue
            if dialect.comma and "," not in line:
                continue
            if dialect.comma and dialect.separator == "," and '"' not in line:
                continue  # only quotes tell its commas apart
            if dialect.numbers(line) is not None:
                scores[dialect] += 1
    if not scores:
        return None
    most = max(scores.values())
    best = [dialect for dialect in _DIALECTS if scores[dialect] == most]
    if best[0].separator == "\t":  # blanks and tabs are often mixed; only empty cells need the tabs
        by_blanks = replace(best[0], separator=None)
        if by_blanks in best and all(
            len(by_blanks.words(line)) == len(best[0].cells(line)) for line in lines if "\t" in line
        ):
            best.insert(0, by_blanks)
    one_comma = Dialect(",")
    if one_comma in best and Dialect(None, comma=True) in best:
        return _settle_commas(text, lines)
    if scores[Dialect(None, comma=True)] and not best[0].comma and best[0].separator is None:
        # Whole numbers beside decimal commas: 0 and 0,5.
        mixed = [line for line in lines if "," in line]
        if mixed and all(Dialect(None, comma=True).numbers(line) is not None for line in lines):
            return Dialect(None, comma=True)
    for dialect in best:
        twin = replace(dialect, comma=True)
        if not dialect.comma and twin in scores and all(twin.numbers(line) is not None for line in lines):
            return twin
    return best[0]


def fixed_width_of(text: TextFile, start: int = 1) -> Dialect | None:
    """Return the width of cells that touch without a sign between them, from their decimal points.

    In columns of one width,
    all numbers have their points at one place and equally many decimals. A width that
    shows this in every line, and is the only one that does, is believed.
    """
    lines = [line.rstrip() for line in _sample(text, start, len(text.lines))]
    lines = [line for line in lines if line.count(".") >= 2]
    if len(lines) < 2:
        return None
    widths = [width for width in range(3, 26) if _fits(lines, width)]
    return Dialect(width=widths[0]) if len(widths) == 1 else None


def _fits(lines: list[str], width: int) -> bool:
    places = set()
    for line in lines:
        cells = [line[k : k + width] for k in range(0, len(line), width)]
        if len(cells) < 2 or any(
            len(cell) != width or cell.count(".") != 1 or parse_number(cell.strip()) is None for cell in cells
        ):
            return False
        places |= {cell.index(".") for cell in cells}
    return len(places) == 1


def _sample(text: TextFile, start: int, last: int) -> list[str]:
    chosen: dict[int, None] = {}
    for middle in (start + (last - start) // 2, start + (last - start) * 4 // 5, start):
        first = max(start, middle - _SAMPLE // 2)
        chosen.update(dict.fromkeys(range(first, min(first + _SAMPLE, last + 1))))
    lines = [text.lines[number - 1][:2000] for number in sorted(chosen)]
    return [line for line in lines if line.strip() and _NUMERIC.fullmatch(line)]


def _settle_commas(text: TextFile, lines: list[str]) -> Dialect:
    """Say what a single comma in each line is: it parts two cells, or the decimals."""
    behind = [line.partition(",")[2].strip() for line in lines if "," in line]
    if any(part.startswith(("-", "+")) for part in behind):
        return Dialect(",")
    if any(len(part) > 1 and part.startswith("0") for part in behind):
        return Dialect(None, comma=True)
    if any(len(line.split()) > 1 for line in lines):
        return Dialect(None, comma=True)
    raise text.refusal(
        None,
        f"{lines[0].strip()!r} may be two whole numbers or one with a decimal comma: write decimal points",
    )


def first_row(text: TextFile, dialect: Dialect, start: int = 1, *, told: bool = False) -> int | None:
    """Return the line of the first row from line `start`: one that another row follows.

    `told`: the caller says that the rows begin in line `start`.
    """
    last = len(text.lines)
    for number in range(start, min(start + MAX_HEADER, last) + 1):
        if dialect.numbers(text.lines[number - 1]) is not None:
            following = number + 1
            while following <= last and (
                not text.lines[following - 1].strip() or is_remark(text.lines[following - 1])
            ):
                following += 1
            if following <= last and dialect.numbers(text.lines[following - 1]) is not None:
                return number
        elif told and text.lines[number - 1].strip():
            return None
    return None


def is_remark(line: str) -> bool:
    """Say whether a line is marked as a comment or is a rule; what a # stands before is no row."""
    stripped = line.strip()
    if stripped.startswith("*"):  # a run of stars may be a number that overflowed its column
        return not any(char.isdigit() for char in stripped) and (
            len(stripped) > 20 or stripped.strip("* ") != ""
        )
    return stripped.startswith(_MARKS)


def is_words(line: str) -> bool:
    """Say whether a line begins with a word, which no row does."""
    return _WORDS.match(line) is not None and _NO_NUMBER.match(line) is None and "__" not in line


def table_from(text: TextFile, first: int, dialect: Dialect) -> tuple[Table, int]:
    """Read rows from line `first` on, until words or the end; return them and the line behind."""
    values = array("d")
    width = 0
    lengths: Counter[int] = Counter()
    odd_rows: list[tuple[int, int]] = []  # the first two rows with another number of cells than the first
    remarks: list[tuple[int, str]] = []
    skipped = array("I")
    pending: list[int] = []
    blank: int | None = None
    rows = 0
    last_row = first
    stopped = len(text.lines) + 1
    start = first
    while start < stopped:
        end = min(start + CHUNK - 1, len(text.lines))
        quick = _quick(text.block(start, end), dialect, width) if width else None
        if quick is not None and not pending:
            values.frombytes(quick.tobytes())
            lengths[width] += end - start + 1
            rows += end - start + 1
            last_row = end
            start = end + 1
            continue
        for number in range(start, end + 1):
            line = text.lines[number - 1]
            found = dialect.numbers(line)
            if found is not None:
                for between in pending:
                    skipped.append(between)
                    if text.lines[between - 1].strip():
                        remarks.append((between, " ".join(text.lines[between - 1].split())[:80]))
                    elif blank is None:
                        blank = between
                pending = []
                width = width or len(found)
                if len(found) != width and len(odd_rows) < 2:
                    odd_rows.append((number, len(found)))
                lengths[len(found)] += 1
                values.extend(found)
                rows += 1
                last_row = number
            elif not line.strip() or is_remark(line):
                pending.append(number)
                if len(pending) > MAX_BETWEEN:
                    stopped = pending[0]
                    break
            elif is_words(line):
                stopped = number
                break
            else:
                raise _odd_line(text, number, dialect, first, width)
        start = end + 1
    usual = lengths.most_common(1)[0][0] if lengths else 0
    short_last = False
    odd: int | None = None
    if len(lengths) > 1:
        odd = odd_rows[0][0] if usual == width else first
        if usual == width and len(odd_rows) == 1 and odd_rows[0][0] == last_row and odd_rows[0][1] < width:
            short_last, odd = True, None
    table = Table(
        dialect,
        first,
        last_row,
        usual,
        rows,
        np.frombuffer(values),
        odd,
        short_last,
        tuple(remarks),
        tuple(skipped),
        blank,
    )
    if pending and stopped > len(text.lines):
        stopped = pending[0]
    return table, stopped


def _quick(block: str, dialect: Dialect, width: int) -> NDArray[np.float64] | None:
    """Return the values of lines that are rows of `width` plain numbers, all of them; else None."""
    if dialect.halves or dialect.width or '"' in block or not _NUMERIC.fullmatch(block):
        return None
    separator = dialect.separator
    lines = block.split("\n")
    if separator is None:
        if any(len(line.split()) != width for line in lines):
            return None
    else:
        expected = width - 1
        if any(line.strip(" ").count(separator) != expected for line in lines):
            return None
    found = _plain_words(block, dialect)
    if len(found) != width * len(lines):
        return None
    try:
        values = np.array([float(word) for word in found])
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def _plain_words(block: str, dialect: Dialect) -> list[str]:
    """Return the words of rows without quotes and empty cells."""
    if dialect.separator is not None:
        block = block.replace(dialect.separator, " ")
    return (block.replace(",", ".") if dialect.comma else block).split()


def _odd_line(text: TextFile, number: int, dialect: Dialect, first: int, width: int) -> Exception:
    for cell in dialect.words(text.lines[number - 1]):
        if parse_number(cell) is None:
            return text.refusal(number, f"expected a finite number, found {cell[:40]!r}")
    return text.refusal(number, f"expected {width} columns as in line {first}, found none")


def printed_times(text: TextFile, table: Table, column: int) -> PrintedTimes:
    """Return one column of a full table with how exactly it is printed."""
    decimals, digits = -400, 0
    skipped = set(table.skipped)
    for start in range(table.first, table.last + 1, CHUNK):
        end = min(start + CHUNK - 1, table.last)
        block = text.block(start, end)
        if _quick(block, table.dialect, table.width) is not None:
            found = _plain_words(block, table.dialect)[column :: table.width]
        else:
            found = [
                table.dialect.words(text.lines[number - 1])[column]
                for number in range(start, end + 1)
                if number not in skipped
            ]
        if found:
            more = precision(found)
            decimals, digits = max(decimals, more[0]), max(digits, more[1])
    return PrintedTimes(
        np.ascontiguousarray(table.columns[:, column]), decimals, digits, table.first, table.skipped
    )


def rises(column: NDArray[np.float64]) -> bool:
    """Say whether a column goes upward as times do."""
    steps = np.diff(column)
    half = column.size // 2
    later = (
        column[half:] > column[: column.size - half]
    )  # a sawtooth goes upward most of the time, and nowhere
    upward = np.count_nonzero(steps > 0.0)
    level = np.count_nonzero(steps == 0.0)
    return bool(
        upward >= 0.3 * steps.size and upward + level >= RISING * steps.size and later.mean() >= RISING
    )


def always_rises(column: NDArray[np.float64]) -> bool:
    """Say whether a column never goes back and ends above where it begins."""
    return bool((np.diff(column) >= 0.0).all() and column[-1] > column[0])


def roughness(table: Table) -> tuple[float, float]:
    """Return the mean difference of neighbours in a row, and of values below each other."""
    whole = table.values[: table.values.size // table.width * table.width].reshape(-1, table.width)
    return _mean(np.abs(np.diff(whole, axis=1))), _mean(np.abs(np.diff(whole, axis=0)))


def runs_on(table: Table) -> bool:
    """Say whether the values clearly run on along the rows, over the ends of the rows too.

    Channels that resemble each other, such as two floors, have like neighbours in a row, but no such ends.
    """
    along, across = roughness(table)
    whole = table.values[: table.values.size // table.width * table.width].reshape(-1, table.width)
    over = _mean(np.abs(whole[1:, 0] - whole[:-1, -1]))
    return along < CLEARLY * across and over < OVER_ENDS * along


def _mean(values: NDArray[np.float64]) -> float:
    """The mean, or infinity of nothing: one row or one column alone says nothing of smoothness."""
    return float(values.mean()) if values.size else math.inf
