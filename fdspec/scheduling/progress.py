"""A progress bar fed by completions: on stderr, on a terminal or in a notebook, for work over a second."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Final

log = logging.getLogger(__name__)

EVERY: Final = 10.0
"""s between two lines of a log."""

NOTEBOOK_EVERY: Final = 0.5
"""s between two states of the line in a notebook."""

SETTLED: Final = 0.5
"""s of work before a rate is told: that of the first pieces says nothing."""

DELAY: Final = 1.0
"""s; what is done sooner shows no bar."""


Shown = bool | Callable[[int, int], None]
"""Whether to show a bar; or what is told (done, total) in its place, from any thread."""


class Pace:
    """Count pieces and tell how fast they come, from when the first was begun."""

    def __init__(self, total: int, finished: int) -> None:
        self.total, self.finished, self.done = total, finished, finished
        self.began = time.monotonic()
        self.lock = threading.Lock()

    def advance(self, pieces: int) -> int:
        """Count pieces, return all that are done; none, before the first, starts the clock."""
        with self.lock:
            if self.done == self.finished and not pieces:
                self.began = time.monotonic()
            self.done += pieces
            return self.done

    @property
    def rate(self) -> float | None:
        """Pieces a second; None while too little is known."""
        elapsed = time.monotonic() - self.began
        new = self.done - self.finished
        return new / elapsed if new and elapsed >= SETTLED else None

    def text(self) -> str:
        """Rate and the time left."""
        if (rate := self.rate) is None:
            return ""
        minutes, seconds = divmod(round((self.total - self.done) / rate), 60)
        speed = f"{rate:,.0f}".replace(",", " ")
        return f"{speed}/s, {minutes}:{seconds:02d} left"


@contextmanager
def progress(
    total: int, what: str, *, shown: Shown = True, delay: float = DELAY, finished: int = 0
) -> Iterator[Callable[[int], None]]:
    """Show how much of `total` is done while the block runs.

    Parameters
    ----------
    total : int
        Pieces of work, such as histories.
    what : str
        What they are, for the head of the bar.
    shown : bool or callable
        False shows nothing, as does a stderr that is neither a terminal nor a notebook's. A callable is told
        (done, total) instead, at the start and after every piece, from any thread but never by two at once.
    delay : float, s
        The bar appears when the block has run this long, whether or not a piece is done.
    finished : int
        Pieces done before; they do not count in the rate.

    Yields
    ------
    callable
        Takes the number of pieces just completed, 0 when the first is begun; may be called from any thread.
    """
    logged = _logged(total - finished, what) if log.isEnabledFor(logging.INFO) else lambda _: None
    pace = Pace(total, finished)
    if callable(shown):
        show: AbstractContextManager[Callable[[], None]] = _told(shown, pace)
    elif shown and sys.stderr.isatty():
        show = _bar(pace, what, delay)
    elif shown and in_notebook():
        show = _line(pace, what, delay)
    else:
        show = nullcontext(lambda: None)
    with show as update:

        def advance(pieces: int) -> None:
            pace.advance(pieces)
            update()
            if pieces:
                logged(pieces)

        yield advance


def in_notebook() -> bool:
    """Say whether this process is a notebook's kernel, whose stderr is shown though it is no terminal."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return type(shell).__name__ == "ZMQInteractiveShell"


@contextmanager
def _told(listener: Callable[[int, int], None], pace: Pace) -> Iterator[Callable[[], None]]:
    lock = threading.Lock()

    def update() -> None:
        with lock:
            listener(pace.done, pace.total)

    update()
    yield update


@contextmanager
def _bar(pace: Pace, what: str, delay: float) -> Iterator[Callable[[], None]]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        ProgressColumn,
        Task,
        TextColumn,
        TimeElapsedColumn,
    )
    from rich.text import Text

    class Speed(ProgressColumn):
        """Pieces in a second and time left, both from the first piece on: rich's own jump at the start."""

        def render(self, task: Task) -> Text:  # noqa: ARG002
            return Text(pace.text())

    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        Speed(),
        console=Console(stderr=True),
        transient=True,
    )
    task = bar.add_task(what, total=pace.total, completed=pace.finished)
    timer = threading.Timer(delay, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda: bar.update(task, completed=pace.done)
    finally:
        timer.cancel()
        timer.join()
        bar.stop()


@contextmanager
def _line(pace: Pace, what: str, delay: float) -> Iterator[Callable[[], None]]:
    """Keep one line of a notebook's output up to date: a bar there would need ipywidgets."""
    lock = threading.Lock()
    next_at = time.monotonic() + delay
    width = 0

    def update() -> None:
        nonlocal next_at, width
        with lock:
            if time.monotonic() < next_at:
                return
            next_at = time.monotonic() + NOTEBOOK_EVERY
            text = f"{what} {pace.done}/{pace.total}  {pace.text()}"
            width = max(width, len(text))
            print(f"\r{text:{width}s}", end="", file=sys.stderr, flush=True)  # noqa: T201

    try:
        yield update
    finally:
        if width:
            print("\r" + " " * width, end="\r", file=sys.stderr, flush=True)  # noqa: T201


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
