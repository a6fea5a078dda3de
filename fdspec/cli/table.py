"""Tables and numbers for people: as wide as the terminal, whole in a pipe."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from fdspec.cli.echo import END, MARKS
from fdspec.printable import lines_of

READABLE: Final = 110
"""Letters in a line of running text, at most: longer ones are hard to follow."""

NARROWEST: Final = 40

GAP: Final = 2
"""Blanks between two columns."""

FOLDED: Final = 28
"""Letters that a folded last column gets at least; where there is less room the table is split."""

GOOD, FAIR, BAD = "green", "yellow", "red"


def on_terminal() -> bool:
    """Say whether a person reads stdout."""
    return sys.stdout.isatty()


def terminal_width() -> int | None:
    """Return the letters in a line of the terminal; None where stdout is none, and lines stay whole."""
    return shutil.get_terminal_size().columns if on_terminal() else None


def text_width() -> int:
    """Return the letters in a line of running text: the terminal's, within what reads well."""
    return max(NARROWEST, min(READABLE, terminal_width() or READABLE))


def filled(text: str, *, first: str = "", rest: str = "") -> str:
    """Return running text in lines that fit; `first` and `rest` begin the lines."""
    return "\n".join(lines_of(text, text_width(), first=first, rest=rest))


def table(
    head: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    left: Sequence[str] = (),
    colours: Mapping[str, str] | None = None,
) -> str:
    """Return lines with a head that fit the terminal.

    Columns named in `left` are aligned to the left, others to the right. On a terminal that is too narrow
    the last column is folded where it is text, or else the columns stand in several blocks, the first
    repeated in each. `colours` names the colour of cells by their text, on a terminal alone and not where
    NO_COLOR is set.
    """
    lines = [list(head), *(list(row) for row in rows)]
    width = terminal_width()
    widths = _widths(lines)
    if width is None or sum(widths) + GAP * (len(widths) - 1) <= width:
        return "\n".join(_aligned(head, lines, left, colours))
    room = width - sum(widths[:-1]) - GAP * (len(widths) - 1)
    if head[-1] in left and room >= FOLDED:
        return "\n".join(_aligned(head, _folded(lines, room), left, colours))
    blocks = [
        "\n".join(
            _aligned([head[k] for k in block], [[line[k] for k in block] for line in lines], left, colours)
        )
        for block in _blocks(widths, width)
    ]
    return "\n\n".join(blocks)


def _widths(lines: Sequence[Sequence[str]]) -> list[int]:
    return [max(map(len, column)) for column in zip(*lines, strict=True)]


def _blocks(widths: Sequence[int], width: int) -> list[list[int]]:
    """Return the columns of each block, as even as may be; every block begins with the first column."""
    across = max(1, (width - widths[0]) // (GAP + max(widths[1:])))
    others = len(widths) - 1
    count = -(-others // -(-others // across))
    return [[0, *range(k, min(k + count, others + 1))] for k in range(1, others + 1, count)]


def _folded(lines: Sequence[Sequence[str]], room: int) -> list[list[str]]:
    folded = []
    for line in lines:
        parts = lines_of(line[-1], room) or [""]
        folded.append([*line[:-1], parts[0]])
        folded += [[*([""] * (len(line) - 1)), part] for part in parts[1:]]
    return folded


def _aligned(
    head: Sequence[str],
    lines: Sequence[Sequence[str]],
    left: Sequence[str],
    colours: Mapping[str, str] | None,
) -> list[str]:
    widths = _widths(lines)

    def cell(text: str, name: str, width: int) -> str:
        padded = text.ljust(width) if name in left else text.rjust(width)
        return styled(padded, (colours or {}).get(text))

    return [
        (" " * GAP)
        .join(cell(text, name, width) for name, text, width in zip(head, line, widths, strict=True))
        .rstrip()
        for line in lines
    ]


def styled(text: str, colour: str | None) -> str:
    """Return text marked for `echo` to colour, on a terminal and where NO_COLOR (no-color.org) is not set."""
    if colour is None or os.environ.get("NO_COLOR") or not on_terminal():
        return text
    return f"{MARKS[colour]}{text}{END}"


def grouped(number: float) -> str:
    """Write a whole number with its thousands apart, as 41 580."""
    return f"{number:,.0f}".replace(",", " ")


def counted(number: int, one: str, many: str = "") -> str:
    """Write a number of things: 1 record, 9 records."""
    return f"{grouped(number)} {one if number == 1 else many or one + 's'}"


def seconds(time: float) -> str:
    """Write a time for a person."""
    if time < 9.95:
        return f"{time:.1f} s"
    if time < 120:
        return f"{time:.0f} s"
    if time < 7200:
        return f"{time / 60:.0f} min"
    return f"{time / 3600:.1f} h"


def size(n_bytes: float) -> str:
    """Write a size for a person, in decimal units."""
    for unit in ("bytes", "kB", "MB"):
        if n_bytes < 1000:
            return f"{n_bytes:.3g} {unit}"
        n_bytes /= 1000
    return f"{n_bytes:.3g} GB"
