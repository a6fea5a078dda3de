"""A progress bar fed by completions: on stderr, only on a terminal, only for work over a second."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

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
    if not shown or not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
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
    try:
        yield lambda pieces: bar.advance(task, pieces)
    finally:
        timer.cancel()
        timer.join()
        bar.stop()
