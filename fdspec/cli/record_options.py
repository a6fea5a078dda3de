"""The options that say which ground motion is meant; shared by the commands that take one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import click

if TYPE_CHECKING:
    from fdspec.runs.study import RecordFile

P = ParamSpec("P")
R = TypeVar("R")

ABOUT_FILE = (
    click.option(
        "--units", metavar="UNIT", help="Unit of a file that does not say it: g, m/s2, cm/s2, mm/s2."
    ),
    click.option("--dt", type=float, metavar="S", help="Time step of a file that does not say it, s."),
    click.option("--channel", metavar="NAME", help="Channel of a file with several."),
)


def file_options(command: Callable[P, R]) -> Callable[P, R]:
    """Add the options that tell what a record file does not say of itself."""
    for option in reversed(ABOUT_FILE):
        command = option(command)
    return command


def named_record(record: str, units: str | None, dt: float | None, channel: str | None) -> str | RecordFile:
    """Return what `fdspec.runs.study` takes for one record: a name, or a file with what the options tell."""
    (named,) = _named([record], units, dt, channel)
    return named


def named_records(
    records: Iterable[str], units: str | None, dt: float | None, channel: str | None
) -> tuple[str | RecordFile, ...]:
    """Return the same for several; `FSR1,FSR2` is taken for two, unless there is a file of that name."""
    names = [
        name
        for given in records
        for name in ([given] if Path(given).exists() else filter(None, given.split(",")))
    ]
    return _named(names, units, dt, channel)


def _named(
    names: list[str], units: str | None, dt: float | None, channel: str | None
) -> tuple[str | RecordFile, ...]:
    from fdspec.runs.study import RecordFile, is_catalogued

    if not names or not all(name.strip() for name in names):
        raise click.UsageError("A record has a name or is a file: give one.")
    if units is None and dt is None and channel is None:
        return tuple(names)
    if all(map(is_catalogued, names)):
        raise click.UsageError(
            f"--units, --dt and --channel tell about a file; the catalogue knows {', '.join(names)}."
        )
    return tuple(
        name if is_catalogued(name) else RecordFile(name, units=units, dt=dt, channel=channel)
        for name in names
    )
