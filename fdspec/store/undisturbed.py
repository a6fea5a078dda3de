"""Hold Ctrl-C back where it would leave a lock behind."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def undisturbed() -> Iterator[None]:
    """Deliver a Ctrl-C that comes in this block when the block ends.

    xarray guards the netCDF library with locks written in Python. A KeyboardInterrupt raised between a write
    and the release of its lock leaves the lock held, and closing the file then waits for it for ever. As
    Python looks for signals exactly there, on return from a long write, this is the rule and no accident.
    """
    previous = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(previous):
        # Only the main thread is interrupted, and only where somebody handles the signal.
        yield
        return
    came: list[FrameType | None] = []
    signal.signal(signal.SIGINT, lambda _, frame: came.append(frame))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
        if came:
            previous(signal.SIGINT, came[0])
