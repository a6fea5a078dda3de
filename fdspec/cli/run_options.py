"""Where a sweep runs, where it goes on its way, and what it writes about itself."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final, ParamSpec, TypeVar

import click

from fdspec.cli.echo import echo
from fdspec.errors import BusyError, ClusterError, DiskError, FdspecError
from fdspec.printable import printable

if TYPE_CHECKING:
    from fdspec.scheduling.task import Client

P = ParamSpec("P")
R = TypeVar("R")

STORE_SUFFIX: Final = ".zarr"

LONG: Final = 60.0
"""s; a sweep that is expected to take longer goes through a store, from which it can be resumed."""


def run_options(command: Callable[P, R]) -> Callable[P, R]:
    """Add the options of a sweep that is long, or runs elsewhere."""
    for option in (
        click.option("--log", metavar="FILE", help="Append what happens, with times, to this file."),
        click.option("--restart", is_flag=True, help="Compute everything anew, also what is finished."),
        click.option(
            "--resumable/--not-resumable",
            default=None,
            help="Keep what is finished in a store beside the output until the file is written, so that the "
            "same command goes on where it was stopped.  [default: when over a minute is expected]",
        ),
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Run on a cluster: the scheduler of dask.distributed, such as tcp://host:8786.",
        ),
        click.option(
            "--workers", type=click.IntRange(min=1), metavar="N", help="Run in N worker processes here."
        ),
        click.option(
            "--threads", type=click.IntRange(min=1), metavar="N", help="Threads.  [default: one a core]"
        ),
    ):
        command = option(command)
    return command


def store_of(output: Path, *, resumable: bool | None, expected: Callable[[], float]) -> Path | None:
    """Return the store that the sweep goes through, if any; expected: gives the seconds that it will take."""
    if output.suffix == STORE_SUFFIX:
        return output
    store = output.with_suffix(".unfinished.zarr")
    if resumable is None:
        resumable = store.exists() or expected() > LONG
    return store if resumable else None


@contextmanager
def client_of(workers: int | None, scheduler: str | None) -> Iterator[Client | None]:
    """Give the cluster that was asked for, None for threads here."""
    if workers is None and scheduler is None:
        yield None
        return
    from fdspec.scheduling.cluster import connected, processes

    if scheduler is not None:
        with connected(scheduler) as client:
            yield client
    elif workers is not None:
        with processes(workers) as client:
            yield client


class _OneLine(logging.Formatter):
    """What a file says of itself stays text also in a log that somebody prints."""

    def format(self, record: logging.LogRecord) -> str:
        return printable(super().format(record))


@contextmanager
def logged(path: str | None) -> Iterator[None]:
    """Append to a file what fdspec, and the cluster where it is worth a warning, have to say."""
    if path is None:
        yield
        return
    try:
        handler = logging.FileHandler(path, encoding="utf-8")
    except OSError as error:
        raise DiskError(f"cannot write {path}: {error.strerror}") from error
    handler.setFormatter(_OneLine("%(asctime)s %(levelname)-7s %(name)s: %(message)s"))
    ours, theirs = logging.getLogger("fdspec"), logging.getLogger("distributed")
    before = ours.level
    ours.setLevel(logging.INFO)
    for logger in (ours, theirs):
        logger.addHandler(handler)
    try:
        yield
    except (FdspecError, OSError, KeyboardInterrupt) as error:
        ours.error("%s: %s", type(error).__name__, error)
        raise
    finally:
        for logger in (ours, theirs):
            logger.removeHandler(handler)
        ours.setLevel(before)
        handler.close()


@contextmanager
def kept(store: Path | None) -> Iterator[None]:
    """When the work stops early, say where what is finished is kept."""
    try:
        yield
    except BusyError:
        raise  # another's work, not ours
    except (ClusterError, DiskError, KeyboardInterrupt):
        if store is not None and store.exists():
            echo(f"fdspec: {store} keeps what is finished; the same command goes on from there", err=True)
        raise
