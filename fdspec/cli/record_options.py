"""The options that say which ground motion is meant; shared by the commands that take one."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from glob import glob, has_magic
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import click

if TYPE_CHECKING:
    from fdspec.runs.study_records import RecordFile

P = ParamSpec("P")
R = TypeVar("R")

ABOUT_FILE = (
    click.option(
        "--units",
        metavar="UNIT",
        help="Unit of a file that does not say it: g, m/s2, cm/s2, mm/s2, gal, mgal, mg, %g, ft/s2, in/s2.",
    ),
    click.option("--dt", type=float, metavar="S", help="Time step of a file that does not say it, s."),
    click.option("--channel", metavar="NAME", help="Channel of a file with several."),
)

HOW_TO_READ = (
    click.option(
        "--skip", type=click.IntRange(min=0), metavar="N", help="Lines above the first row of numbers."
    ),
    click.option(
        "--layout",
        type=click.Choice(["columns", "rows"]),
        help="Whether several numbers a row are columns, or one series along the rows.",
    ),
    click.option(
        "--resample-to", type=float, metavar="S", help="Interpolate samples at unequal times to this step, s."
    ),
    click.option(
        "--name", metavar="NAME", help="Name of the motion.  [default: the file's, without its ending]"
    ),
)


@dataclass(frozen=True)
class AboutFile:
    """What the options tell of a record file."""

    units: str | None = None
    dt: float | None = None
    channel: str | None = None
    skip: int | None = None
    layout: str | None = None
    resample_to: float | None = None
    name: str | None = None

    @property
    def given(self) -> dict[str, Any]:
        """The options that were given, by name."""
        return {key: value for key, value in asdict(self).items() if value is not None}


class RecordsOption(click.Option):
    """An option that takes every argument up to the next option, so that `--record *.AT2` needs no quotes."""

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        """Take what the shell made of a pattern, but for a study file."""
        super().add_to_parser(parser, ctx)
        for opt in self.opts:
            registered = parser._long_opt.get(opt) or parser._short_opt.get(opt)  # noqa: SLF001  click has no other door
            if registered is not None:
                registered.process = _taking_all(registered.process)


def _taking_all(take: Callable[[str, Any], None]) -> Callable[[str, Any], None]:
    def process(value: str, state: Any) -> None:
        take(value, state)
        while state.rargs and not state.rargs[0].startswith("-") and not state.rargs[0].endswith(".toml"):
            take(state.rargs.pop(0), state)

    return process


def file_options(command: Callable[P, R]) -> Callable[P, R]:
    """Add the options that tell what a record file does not say of itself."""
    for option in reversed(ABOUT_FILE):
        command = option(command)
    return command


def reading_options(command: Callable[..., R]) -> Callable[..., R]:
    """Add all options of `fdspec.read_record`; the command gets them as one `about`, an AboutFile."""

    @functools.wraps(command)
    def called(**arguments: Any) -> R:
        about = AboutFile(**{key: arguments.pop(key) for key in AboutFile.__dataclass_fields__})
        return command(about=about, **arguments)

    for option in reversed((*ABOUT_FILE, *HOW_TO_READ)):
        called = option(called)
    return called


def record_about(record: str, about: AboutFile) -> str | RecordFile:
    """Return what `fdspec.runs.study` takes for one record: a name, or a file with what the options tell."""
    (named,) = _named([record], about)
    return named


def named_record(record: str, units: str | None, dt: float | None, channel: str | None) -> str | RecordFile:
    """Return the same where a command has the three options alone."""
    return record_about(record, AboutFile(units, dt, channel))


def named_records(
    records: Iterable[str], units: str | None, dt: float | None, channel: str | None
) -> tuple[str | RecordFile, ...]:
    """Return the same for several; `FSR1,FSR2` is taken for two, and `*.AT2` for all files that match."""
    names = [
        name
        for given in records
        for name in ([given] if Path(given).exists() else filter(None, given.split(",")))
    ]
    return _named([name for given in names for name in _matching(given)], AboutFile(units, dt, channel))


def _matching(given: str) -> list[str]:
    """Return the files that a pattern matches, in order; a name or path as it is."""
    if not has_magic(given) or Path(given).exists():
        return [given]
    found = sorted(name for name in glob(given, recursive=True) if Path(name).is_file())  # noqa: PTH207  keeps what was typed
    if not found:
        raise click.UsageError(f"No file matches {given!r}.")
    return found


def _named(names: list[str], about: AboutFile) -> tuple[str | RecordFile, ...]:
    from fdspec.runs.study_records import RecordFile, is_catalogued

    if not names or not all(name.strip() for name in names):
        raise click.UsageError("A record has a name or is a file: give one.")
    if not about.given:
        return tuple(names)
    if all(map(is_catalogued, names)):
        raise click.UsageError(f"{_listed(about)} about a file; the catalogue knows {', '.join(names)}.")
    return tuple(name if is_catalogued(name) else RecordFile(name, **about.given) for name in names)


def _listed(about: AboutFile) -> str:
    if {"units", "dt", "channel"} >= set(about.given):
        return "--units, --dt and --channel tell"
    return f"{', '.join('--' + key.replace('_', '-') for key in about.given)} tell"
