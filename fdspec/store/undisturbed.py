"""Hold Ctrl-C and its like back where they would leave a lock behind."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from fdspec.stopping import STOPPING


@contextmanager
def undisturbed() -> Iterator[None]:
    """Deliver a Ctrl-C, or another signal that asks to end, when this block ends.

    xarray guards the netCDF library with locks written in Python. A KeyboardInterrupt raised between a write
    and the release of its lock leaves the lock held, and closing the file then waits for it for ever. As
    Python looks for signals exactly there, on return from a long write, this is the rule and no accident.
    """
    handled = {number: handler for number in STOPPING if callable(handler := signal.getsignal(number))}
    if threading.current_thread() is not threading.main_thread() or not handled:
        # Only the main thread is interrupted, and only where somebody handles the signal.
        yield
        return
    came: list[tuple[signal.Signals, FrameType | None]] = []

    def remember(number: int, frame: FrameType | None) -> None:
        came.append((signal.Signals(number), frame))

    for number in handled:
        signal.signal(number, remember)
    try:
        yield
    finally:
        for number, handler in handled.items():
            signal.signal(number, handler)
        if came:
            number, frame = came[0]
            handled[number](number, frame)
