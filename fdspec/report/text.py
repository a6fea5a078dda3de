"""The report of a choice as plain text."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Final

from fdspec.report.findings import CASES, assumptions, recommendation
from fdspec.report.rows import record_rows

if TYPE_CHECKING:
    import xarray as xr

WIDTH: Final = 110


def text(choice: xr.Dataset) -> str:
    """Write what `fdspec.choose` recommends, why, and what it assumes.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returns.

    Returns
    -------
    str
        Lines of at most 110 characters.
    """
    told = recommendation(choice)
    indent = max(len(head) for head, _ in told) + 2
    lines = [
        line
        for head, sentence in told
        for line in textwrap.wrap(
            sentence,
            WIDTH,
            initial_indent=head.ljust(indent),
            subsequent_indent=" " * indent,
            break_on_hyphens=False,
        )
    ]
    head, rows = record_rows(choice)
    widths = [max(len(row[column]) for row in [head, *rows]) for column in range(len(head))]
    lines.append("")
    for row in [head, *rows]:
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append("  ".join(cells).rstrip())
    lines += ["", f"Accelerations in g, drifts in mm. lower, upper: {CASES['lower']}, {CASES['upper']}.", ""]
    lines.append("Assumed:")
    for sentence in assumptions(choice):
        lines += textwrap.wrap(
            sentence, WIDTH, initial_indent="- ", subsequent_indent="  ", break_on_hyphens=False
        )
    return "\n".join(lines)
