"""The report of a choice as plain text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from fdspec.printable import lines_of
from fdspec.report.findings import CASES, assumptions, recommendation
from fdspec.report.inputs import structure
from fdspec.report.rows import record_rows
from fdspec.report.storeys import storey_rows

if TYPE_CHECKING:
    import xarray as xr

WIDTH: Final = 110

GAP: Final = 2


def text(choice: xr.Dataset, *, width: int = WIDTH) -> str:
    """Write what `fdspec.choose` recommends, why, and what it assumes.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returns.
    width : int
        Characters in a line, at most; a table that is wider stands in several blocks.

    Returns
    -------
    str
    """
    told = [*recommendation(choice), ("Structure", structure(choice))]
    indent = max(len(head) for head, _ in told) + 2
    lines = [
        line
        for head, sentence in told
        for line in lines_of(sentence, width, first=head.ljust(indent), rest=" " * indent)
    ]
    if choice.sizes["storey"] > 1:
        head, rows = storey_rows(choice)
        lines += ["", *_table([head, *rows], width)]
    head, rows = record_rows(choice)
    lines += ["", *_table([head, *rows], width), ""]
    explained = f"Accelerations in g, drifts in mm. lower, upper: {CASES['lower']}, {CASES['upper']}."
    lines += [*lines_of(explained, width), ""]
    lines.append("Assumed:")
    for sentence in assumptions(choice):
        lines += lines_of(sentence, width, first="- ", rest="  ")
    return "\n".join(lines)


def _table(rows: list[list[str]], width: int) -> list[str]:
    """Return rows in columns; those that find no room stand below, the first column before them again."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines: list[str] = []
    across = max(1, (width - widths[0]) // (GAP + max(widths[1:])))
    whole = sum(widths) + GAP * (len(widths) - 1) <= width
    left = list(range(1, len(widths)))
    count = len(left) if whole else -(-len(left) // -(-len(left) // across))  # blocks of even size
    while left:
        shown, left = left[:count], left[count:]
        for row in rows:
            cells = [row[0].ljust(widths[0]), *(row[k].rjust(widths[k]) for k in shown)]
            lines.append((" " * GAP).join(cells).rstrip())
        if left:
            lines.append("")
    return lines
