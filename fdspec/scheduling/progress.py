"""A progress bar fed by completions: on stderr, only on a terminal, only for work over a second."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

log = logging.getLogger(__name__)

EVERY: Final = 10.0
"""s between two lines of a log."""

DELAY: Final = 1.0
"""s; what is done sooner shows no bar."""


@contextmanager
def progress(
    total: int, what: str, *, shown: bool = True, delay: float = DELAY, finished: int = 0
) -> Iterator[Callable[[int], None]]:
    """Show how much of `total` is done while the block runs.

    Parameters
    ----------
    total : int
        Pieces of work, such as histories.
    what : str
        What they are, for the head of the bar.
    shown : bool
        False shows nothing, as does a stderr that is no terminal.
    delay : float, s
        The bar appears when the block has run this long, whether or not a piece is done.
    finished : int
        Pieces done before; they do not count in the rate.

    Yields
    ------
    callable
        Takes the number of pieces just completed; may be called from any thread.
    """
    logged = _logged(total - finished, what) if log.isEnabledFor(logging.INFO) else lambda _: None
    if not shown or not sys.stderr.isatty():
        yield logged
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        ProgressColumn,
        Task,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.text import Text

    class Rate(ProgressColumn):
        """Pieces in a second."""

        def render(self, task: Task) -> Text:
            speed = task.finished_speed or task.speed
            return Text("" if speed is None else f"{speed:,.0f}/s".replace(",", " "))

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        Rate(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task(what, total=total, completed=finished)
    timer = threading.Timer(delay, bar.start)
    timer.daemon = True
    timer.start()

    def advance(pieces: int) -> None:
        bar.advance(task, pieces)
        logged(pieces)

    try:
        yield advance
    finally:
        timer.cancel()
        timer.join()
        bar.stop()


def _logged(left: int, what: str) -> Callable[[int], None]:
    """Return what logs, now and then, how much of what was left is done, how fast, and the time left."""
    lock = threading.Lock()
    started = last = time.monotonic()
    done = 0

    def advance(pieces: int) -> None:
        nonlocal done, last
        with lock:
            done += pieces
            now = time.monotonic()
            if now - last < EVERY and done < left:
                return
            last = now
            rate = done / max(now - started, 1e-9)
            log.info("%d of %d %s, %.0f/s, %.0f s left", done, left, what, rate, (left - done) / rate)

    return advance
