"""Signals that ask a program to end, made an exception: what is half done is cleared away."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final, NoReturn

STOPPING: Final = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


class Stopped(KeyboardInterrupt):
    """A signal other than Ctrl-C's that asks to end; its number is the argument."""


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Raise Stopped in this block for signals that would else end the process at once.

    Those that somebody handles or ignores, as nohup does, stay as they are.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, _: FrameType | None) -> NoReturn:
        raise Stopped(number)

    fatal = [number for number in STOPPING if signal.getsignal(number) is signal.SIG_DFL]
    for number in fatal:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in fatal:
            signal.signal(number, signal.SIG_DFL)
