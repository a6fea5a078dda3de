"""The options that say which ground motion is meant; shared by the commands that take one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import click

if TYPE_CHECKING:
    from fdspec.study import RecordFile

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


def named_records(
    records: Iterable[str], units: str | None, dt: float | None, channel: str | None
) -> tuple[str | RecordFile, ...]:
    """Return what `fdspec.study` takes for records: names, or files with what the options tell.

    `FSR1,FSR2` is taken for two, unless there is a file of that name.
    """
    from fdspec.study import RecordFile

    names = [
        name
        for given in records
        for name in ([given] if Path(given).exists() else filter(None, given.split(",")))
    ]
    if units is None and dt is None and channel is None:
        return tuple(names)
    return tuple(RecordFile(name, units=units, dt=dt, channel=channel) for name in names)
