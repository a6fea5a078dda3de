"""One block of rows with the lines above it: its headings, and what its header states."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from fdspec.records import vocabulary as words
from fdspec.records.headings import Heading, heading_of, is_unit_row, row_of
from fdspec.records.numbers import parse_number
from fdspec.records.rows import Dialect, Table, first_row, rises, runs_on, table_from
from fdspec.records.statements import Statements, is_note, statements
from fdspec.records.textfile import TextFile
from fdspec.records.units import unit_of

MAX_NUMERIC: Final = 3
"""Lines of numbers alone above the rows: count and step."""

_LOOK_UP: Final = 5
"""Lines above the rows among which headings stand."""

_RULE: Final = re.compile(r"[\s\-=_*#+|.~]*")
_BRACKET_ENDS: Final = re.compile(r"[^()\[\]]{0,80}[(\[][^()\[\]]{0,40}[)\]]")
_ABSCISSAE: Final = frozenset({words.TIME, words.PERIOD, words.FREQUENCY})
_LIKE_ROW: Final = re.compile(r"\s*(?:[+-]?(?:[\d.]|nan\b|inf\b)|\*\*\*+(?!\s*\w))", re.IGNORECASE)
_EXPLICIT: Final = frozenset(
    {
        words.TIME, words.ACCELERATION, words.VELOCITY, words.DISPLACEMENT, words.PERIOD, words.FREQUENCY,
        words.SPECTRAL, words.SAMPLE,
    }
)  # fmt: skip


@dataclass(frozen=True)
class Block:
    """Rows, the line where the lines above them begin, headings with their line, and what is stated."""

    start: int
    table: Table
    headings: list[Heading] | None
    heading_line: int
    stated: Statements

    @property
    def header(self) -> range:
        """The numbers of the lines above the rows."""
        return range(self.start, self.table.first)


def block_from(text: TextFile, start: int, dialect: Dialect, told: bool = False) -> tuple[Block, int] | None:
    """Return the next block from line `start` on and the line behind it; None when no rows follow.

    `told`: the rows begin in line `start`, whatever stands above; headings above are still looked for.
    """
    first = first_row(text, dialect, start, told=told)
    if first is None:
        return None
    numeric = 0 if told else _numeric_lines(text, first, dialect)
    table, behind = table_from(text, first + numeric, dialect)
    top = 1 if told else start
    _refuse_lone_rows(text, start, first, table)
    stated = Statements()
    for number in range(first, first + numeric):
        _read_numeric(text, number, dialect, stated)
    table = _without_count(table, stated)
    headings, line, table = _headings(text, top, first, table)
    if not told:
        lines = [
            (number, text.lines[number - 1])
            for number in range(max(start, first - 200), first)
            if not (headings and line - 1 <= number <= line and number != line - 1)
        ]
        more = statements(lines, decimal_comma=dialect.comma or dialect.halves)
        more.counts += stated.counts
        more.steps += stated.steps
        stated = more
    else:
        stated = Statements()
    return Block(top, table, headings, line, stated), behind


def _refuse_lone_rows(text: TextFile, start: int, first: int, table: Table) -> None:
    """Refuse a line among the words above that is like the rows below: it may be the first of them."""
    for number in range(start, first):
        found = table.dialect.numbers(text.lines[number - 1])
        if found is not None and len(found) == table.width > 1:
            raise text.refusal(
                number,
                f"{table.width} numbers as in the rows below line {first}, apart from them: expected words",
            )
        if found is None and _LIKE_ROW.match(text.head(number)):
            _refuse_damaged_row(text, number, table)


def _refuse_damaged_row(text: TextFile, number: int, table: Table) -> None:
    """Refuse a line that is a row but for a cell or two, where words are expected."""
    line = text.head(number)
    cells = [cell for cell in table.dialect.words(line) if cell]
    odd = [cell for cell in cells if parse_number(cell) is None]
    few = 2 * len(odd) <= len(cells) or table.width == len(cells) == 1
    said = statements([(number, line)])
    if odd and few and len(cells) >= table.width and not (said.counts or said.steps):
        raise text.refusal(number, f"expected a finite number, found {odd[0][:40]!r}")


def _numeric_lines(text: TextFile, first: int, dialect: Dialect) -> int:
    """Return how many lines of numbers differ from the rows below them: count and step, no samples."""
    widths: list[int] = []
    number = first
    while number <= len(text.lines) and len(widths) < MAX_NUMERIC + 3:
        found = dialect.numbers(text.lines[number - 1])
        if found is None:
            break
        widths.append(len(found))
        number += 1
    if len(widths) < 3:
        return 0
    usual = widths[-1] if len(widths) > MAX_NUMERIC + 2 else widths[-2]
    lead = next((k for k, width in enumerate(widths) if width == usual), 0)
    return lead if lead <= MAX_NUMERIC and widths[lead] == usual else 0


def _read_numeric(text: TextFile, number: int, dialect: Dialect, stated: Statements) -> None:
    """Take a line of numbers above the rows for count and step, in either order; refuse any other."""
    line = text.lines[number - 1]
    cells = dialect.cells(line)
    counts = [cell for cell in cells if cell.isdigit() and int(cell) >= 2]
    steps = [cell for cell in cells if not cell.isdigit() and 0.0 < (parse_number(cell) or 0.0) < 1.0]
    if len(counts) > 1 or len(steps) > 1 or len(counts) + len(steps) != len(cells):
        raise text.refusal(
            number, f"expected rows like those below, or count and step, found {line.strip()[:60]!r}"
        )
    stated.counts += [(number, int(cell), cell) for cell in counts]
    stated.steps += [(number, parse_number(cell), cell) for cell in steps]


def _without_count(table: Table, stated: Statements) -> Table:
    """Take a first row that counts the rows or values behind it for a header: 1500 0.005."""
    values = table.values
    if table.rows < 4 or table.skipped or table.ragged is not None:
        return table
    rest = values.size - table.width
    if table.width == 2 and values[0] in {table.rows - 1, rest} and 0.0 < values[1] < 1.0:
        count, step, rows = values[0], values[1], 1
    elif table.width == 2 and values[1] in {table.rows - 1, rest} and 0.0 < values[0] < 1.0:
        count, step, rows = values[1], values[0], 1
    elif table.width == 1 and values[0] == table.rows - 2 and 0.0 < values[1] < 1.0:
        count, step, rows = values[0], values[1], 2
    elif table.width == 1 and values[1] == table.rows - 2 and 0.0 < values[0] < 1.0:
        count, step, rows = values[1], values[0], 2
    elif table.width == 1 and values[0] == table.rows - 1 and table.rows > 10:
        count, step, rows = values[0], None, 1
    else:
        return table
    if count < 3:
        return table
    stated.counts.append((table.first, int(count), f"{count:g}"))
    if step is not None:
        stated.steps.append((table.first, float(step), f"{step:g}"))
    return table.without_first(rows)


def _headings(
    text: TextFile, start: int, first: int, table: Table
) -> tuple[list[Heading] | None, int, Table]:
    """Return the headings above the rows, their line, and the table: cells may be halves."""
    looked = 0
    units: list[str] | None = None
    for number in range(first - 1, max(start, first - 20) - 1, -1):
        line = text.lines[number - 1]
        if not line.strip() or _RULE.fullmatch(line) or table.dialect.numbers(line) is not None:
            continue
        looked += 1
        if looked > _LOOK_UP:
            break
        halves = table.dialect.separator == "," and _may_be_halves(table)
        for width in (table.width, table.width // 2) if halves else (table.width,):
            cells = _heading_cells(line, table.dialect, width)
            if cells is None:
                continue
            place = number
            if units is None and width > 1 and is_unit_row(cells) and number > start:
                above = _heading_cells(text.lines[number - 2], table.dialect, width)
                if above is not None and not is_unit_row(above):
                    units = [cell.strip().strip("()[]{}<>") for cell in cells]
                    cells = [
                        f"{name} ({unit})" if unit else name for name, unit in zip(above, units, strict=True)
                    ]
                    place = number - 1
            headings = row_of(cells)
            said = statements([(number, line)])
            if said.counts or said.steps or is_note(line):
                continue
            if cells[0] == "" and (table.ragged or not rises(table.first_column)):
                continue
            abscissae = [k for k, heading in enumerate(headings) if heading.quantity in _ABSCISSAE]
            if not abscissae and not _without_abscissa(line, headings, table):
                continue
            weak = abscissae and headings[abscissae[0]].unit is None and cells == _grouped(line.split())
            if weak and not _rises_in(table, abscissae[0], width):
                continue  # "acceleration time series"
            if _is_heading(headings, width, looked == 1):
                if width < table.width:
                    table = _merged(text, table)
                return headings, place, table
    return None, 0, table


def _heading_cells(line: str, dialect: Dialect, width: int) -> list[str] | None:
    """Split a line into one cell a column, by whatever parts it so; the first column may have none."""
    stripped = line[:2000].strip().lstrip("#%!*;/").rstrip()
    if width == 1:
        return [stripped]
    splits = []
    if dialect.separator is not None:
        splits.append(dialect.raw_cells(line.strip().lstrip("#%!*/")))
        leading = dialect.raw_cells(line.lstrip("#%!*/"))
        if leading and not leading[0]:
            splits.insert(0, leading)
    splits += [
        [cell.strip() for cell in stripped.rstrip(mark).split(mark)]
        for mark in ("\t", ";", "|", ",")
        if mark in stripped
    ]
    splits.append(re.split(r"\s{2,20}", stripped))
    splits.append(_grouped(stripped.split()))
    splits.append(_bracketed(stripped))
    for cells in splits:
        if len(cells) == width:
            return cells
    for cells in splits:
        if len(cells) == 2 * width and all(unit_of(cell.strip("()[] ")) for cell in cells[1::2]):
            return [
                f"{name} ({unit.strip('()[] ')})" for name, unit in zip(cells[0::2], cells[1::2], strict=True)
            ]
    for cells in splits:
        if len(cells) == width - 1 and width > 1 and all(cells):
            return ["", *cells]
    return None


def _bracketed(line: str) -> list[str]:
    """Return the parts of a line that end in brackets: Zeit [s] Beschleunigung EW [g] makes two."""
    cells: list[str] = []
    for part in _BRACKET_ENDS.findall(line):
        cell = part.strip(" ,;\t")
        if cells and cell.startswith(("(", "[")):
            cells[-1] += f" {cell}"
        else:
            cells.append(cell)
    return cells


def _grouped(found: list[str]) -> list[str]:
    """Return words with the units behind them: Time (ms) Acc (g), time s acc m s-2, Time in s."""
    cells: list[str] = []
    for k, word in enumerate(found):
        following = found[k + 1] if k + 1 < len(found) else ""
        bracket = word.startswith(("(", "[", "{", "<")) or (
            cells and cells[-1].count("(") > cells[-1].count(")")
        )
        joins = word in {"/", "in", "-"} and unit_of(following.strip("()[]")) is not None
        if cells and (bracket or joins or _extends(cells[-1], word)):
            cells[-1] += f" {word}"
        else:
            cells.append(word)
    return cells


def _extends(cell: str, word: str) -> bool:
    """Say whether a word is the unit behind a heading that has none, or a further part of its unit."""
    if unit_of(word) is None:
        return False
    heading = heading_of(cell)
    if heading.unit is None and unit_of(cell) is None:
        return heading.quantity not in {words.UNKNOWN, words.DIRECTION} or cell.endswith((" in", " /", ","))
    longer = heading_of(f"{cell} {word}")
    return longer.unit is not None and longer.unit != heading.unit and not longer.contradiction


def _is_heading(headings: list[Heading], width: int, nearest: bool) -> bool:
    """Say whether a row of cells is a row of headings, and no sentence that happens to have as many parts."""
    if width == 1:
        (one,) = headings
        return one.quantity in _EXPLICIT - {words.SAMPLE} and _is_short(one)
    known = [h for h in headings if h.quantity in _EXPLICIT or h.unit is not None]
    odd = [h for h in headings if h.quantity == words.UNKNOWN and h.unit is None and h.text]
    if any(len(h.text) > 60 or re.search(r"\d{2}:\d{2}|=\s*[\d.-]", h.text) for h in headings):
        return False
    if known:
        return not odd or nearest
    directions = [h for h in headings if h.quantity == words.DIRECTION]
    return nearest and len(directions) >= width - 1 and len({h.text for h in directions}) == len(directions)


def _without_abscissa(line: str, headings: list[Heading], table: Table) -> bool:
    """Say whether headings that name no time are headings all the same, and no sentence of as many words."""
    if len(headings) == 1:
        return True
    if ":" in line or "=" in line or any(h.name == h.text and unit_of(h.text) is not None for h in headings):
        return False
    named = [h for h in headings if h.text]
    if any(h.quantity == words.UNKNOWN and h.unit is None for h in named):
        return False
    return table.dialect.separator is not None or not runs_on(table)


def _rises_in(table: Table, column: int, width: int) -> bool:
    """Say whether a column of a full table rises as times and periods do."""
    if column == 0 and table.ragged is None and width == table.width:
        return rises(table.first_column)
    full = table.ragged is None and not table.short_last and width == table.width
    return full and rises(table.columns[:, column])


def _is_short(heading: Heading) -> bool:
    """Say whether the heading of a single column is one, and no title that mentions a quantity."""
    return len(heading.text.split()) <= 5 and not re.search(r"[:=;]|\d{3}", heading.text)


def _may_be_halves(table: Table) -> bool:
    """Say whether all cells are whole numbers: their commas may be decimal marks as well."""
    values = table.values
    return (
        table.width % 2 == 0
        and table.ragged is None
        and not table.short_last
        and bool((values == values.round()).all())
    )


def _merged(text: TextFile, table: Table) -> Table:
    """Read rows whose commas are decimal marks too: 0,01,-0,5 is 0.01 and -0.5."""
    first = table.dialect.raw_cells(text.lines[table.first - 1])
    digits = [len(cell) for cell in first[1::2]]
    for number in range(table.first, table.last + 1):
        cells = table.dialect.raw_cells(text.lines[number - 1])
        fractions = cells[1::2]
        if len(cells) == table.width and not (
            all(cell.isdigit() for cell in fractions) and [len(cell) for cell in fractions] == digits
        ):
            raise text.refusal(number, "commas part the cells and the decimals alike: write decimal points")
    return table_from(text, table.first, Dialect(",", halves=True))[0]
