"""`fdspec verify`: the verification table, computed anew."""

from __future__ import annotations

import json
import math
import sys
from typing import TYPE_CHECKING, Final, Self

import click

from fdspec.cli.echo import echo, status
from fdspec.cli.table import BAD, GOOD, counted, seconds, table
from fdspec.errors import FdspecError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fdspec.verification import Row

HEAD: Final = ("case", "quantity", "reference", "computed", "error", "limit", "verdict")
LEFT: Final = ("case", "quantity", "verdict")


@click.command()
@click.option("--full", is_flag=True, help="With the slow cases: minutes instead of less than one.")
@click.option("--only", multiple=True, metavar="FAMILY", help="One family of cases; may be repeated.")
@click.option("--markdown", "form", flag_value="markdown", help="Print the table in Markdown.")
@click.option("--json", "form", flag_value="json", help="Print the rows as JSON.")
def verify(full: bool, only: tuple[str, ...], form: str | None) -> None:
    """Verify this installation: compute what has a known answer, and print both, their difference, its limit.

    Every figure is computed in this run, nothing is stored. The exit code is 1 when a row fails.

    \b
    Families: closed-forms, devices, steady-states, linear-limits,
    engines, general-solver, fixed-step, energy, symmetry, methods.
    """
    from time import perf_counter

    from fdspec.verification import verify as run

    began = perf_counter()
    with _Telling() as tell:
        rows = run(only or None, full=full, on_family=tell.waits, on_row=tell)
    elapsed = perf_counter() - began
    failed = [row for row in rows if not row.passed]
    if form == "json":
        echo(_as_json(rows, elapsed))
    else:
        echo(
            _as_markdown(rows)
            if form == "markdown"
            else table(HEAD, map(_cells, rows), left=LEFT, colours={"pass": GOOD, "FAIL": BAD})
        )
        said = f"{len(failed)} failed" if failed else "all passed"
        echo(f"\n{counted(len(rows), 'row')}, {said}, in {seconds(elapsed)}")
    if failed:
        raise FdspecError(f"{counted(len(failed), 'row')} of {len(rows)} failed; first: {failed[0].case}")


class _Telling:
    """Say on a terminal's stderr what is waited for and which case was the last; take it back at the end."""

    family = ""

    def __enter__(self) -> Self:
        return self

    def waits(self, family: str) -> None:
        """Say which family of cases is being computed."""
        self.family = family
        self._say("")

    def __call__(self, row: Row) -> None:
        self._say(f", after {row.case}")

    def __exit__(self, *_: object) -> None:
        if sys.stderr.isatty():
            status("")

    def _say(self, more: str) -> None:
        if sys.stderr.isatty():
            status(f"{f'computing {self.family}{more}':.100}")


def _cells(row: Row) -> list[str]:
    """Return the cells of a row, as text."""
    return [
        row.case,
        row.quantity,
        _number(row.reference),
        _number(row.computed),
        f"{row.error:.1e}",
        f"{row.limit:.2g}",
        "pass" if row.passed else "FAIL",
    ]


def _number(value: float) -> str:
    """Write whole numbers whole, others with ten digits, or few where they are tiny."""
    if not math.isfinite(value):
        return str(value)
    if value == round(value) and abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.10g}" if abs(value) > 1e-6 else f"{value:.1e}"


def _as_markdown(rows: Sequence[Row]) -> str:
    lines = [HEAD, tuple(":--" if name in LEFT else "--:" for name in HEAD), *map(_cells, rows)]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def _as_json(rows: Sequence[Row], elapsed: float) -> str:
    from fdspec.version import __version__

    def plain(value: float) -> float | None:
        return value if math.isfinite(value) else None

    return json.dumps(
        {
            "version": __version__,
            "seconds": round(elapsed, 2),
            "passed": all(row.passed for row in rows),
            "rows": [
                {
                    "case": row.case,
                    "quantity": row.quantity,
                    "reference": plain(row.reference),
                    "computed": plain(row.computed),
                    "error": plain(row.error),
                    "limit": row.limit,
                    "verdict": "pass" if row.passed else "fail",
                }
                for row in rows
            ],
        },
        indent=2,
    )
