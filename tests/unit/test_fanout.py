"""A Ctrl-C while kernels load is never lost, wherever Python happens to be."""

from __future__ import annotations

import signal
from contextlib import suppress

import pytest

from fdspec.scheduling.threads import interrupted_at_last


def swallow_an_interrupt(reached: list[str]) -> None:
    """Do as a callback from C does with what is raised in it."""
    with interrupted_at_last():
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        reached.append("went on")


def test_an_interrupt_that_nobody_heard_is_raised_at_the_end() -> None:
    before = signal.getsignal(signal.SIGINT)
    reached: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        swallow_an_interrupt(reached)
    assert reached == ["went on"]
    assert signal.getsignal(signal.SIGINT) is before


def test_an_interrupt_that_is_heard_is_raised_once() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), interrupted_at_last():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_nothing_happens_without_one() -> None:
    with interrupted_at_last():
        reached = True
    assert reached
