"""The progress bar: only on a terminal, only for long work, and gone when the work is done."""

import io
import sys
import time
import types
from pathlib import Path
from typing import Any

import pytest

import fdspec
from fdspec.compiler import cache
from fdspec.scheduling.progress import Pace, progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def on_terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Make stderr a terminal; called in the test itself, as pytest sets stderr anew after fixtures."""
    stderr = Terminal()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    return stderr


def test_a_bar_counts_what_is_done_and_goes_away(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    with progress(7, "histories", delay=0.0) as done:
        done(3)
        deadline = time.monotonic() + 10.0
        while "3/7" not in terminal.getvalue() and time.monotonic() < deadline:
            time.sleep(0.02)
    text = terminal.getvalue()
    assert "histories" in text
    assert "3/7" in text
    assert text.endswith("\x1b[2K")  # the line it stood on is cleared


def test_short_work_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    with progress(7, "histories", delay=60.0) as done:
        done(7)
    assert terminal.getvalue() == ""


def test_nothing_is_shown_when_not_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    with progress(7, "histories", shown=False, delay=0.0) as done:
        done(7)
        time.sleep(0.05)
    assert terminal.getvalue() == ""


def test_nothing_is_shown_where_stderr_is_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with progress(7, "histories", delay=0.0) as done:
        done(7)
        time.sleep(0.05)
    assert capsys.readouterr() == ("", "")


def test_an_error_in_the_work_comes_through_and_clears_the_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)

    def work() -> None:
        with progress(7, "histories", delay=0.0):
            time.sleep(0.1)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        work()
    assert terminal.getvalue().endswith("\x1b[2K")


def test_a_program_is_told_instead(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    told: list[tuple[int, int]] = []
    with progress(
        7, "histories", shown=lambda done, total: told.append((done, total)), delay=0.0, finished=2
    ) as done:
        done(0)
        done(3)
        done(2)
    assert told == [(2, 7), (2, 7), (5, 7), (7, 7)]
    assert terminal.getvalue() == ""


def test_a_sweep_tells_a_program_and_stops_where_that_raises() -> None:
    motion = fdspec.GroundMotion([0.0, 3.0, -2.0, 1.0], 0.1, "m")
    axes: dict[str, Any] = {"period": [0.5, 1.0], "pretension": [2e4, 5e4], "stiffness_ratio": [1.0, 4.0]}
    told: list[tuple[int, int]] = []
    fdspec.sweep(motion, **axes, columns_per_task=1, progress=lambda *both: told.append(both))
    assert told[0] == (0, 8)
    assert told[-1] == (8, 8)
    assert [done for done, _ in told] == sorted(done for done, _ in told)

    def enough(done: int, total: int) -> None:
        if done:
            raise LookupError(f"{done} of {total}")

    with pytest.raises(LookupError, match="2 of 8"):
        fdspec.sweep(motion, **axes, columns_per_task=1, workers=1, progress=enough)


class ZMQInteractiveShell:
    """What IPython calls a notebook's shell."""


def test_a_notebook_shows_a_line_that_goes_away(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ipython = types.SimpleNamespace(get_ipython=ZMQInteractiveShell)
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setattr("fdspec.scheduling.progress.NOTEBOOK_EVERY", 0.0)
    with progress(7, "histories", delay=0.0) as done:
        done(3)
        done(4)
    _, err = capsys.readouterr()
    assert [part.split()[:2] for part in err.split("\r") if part.strip()] == [
        ["histories", "3/7"],
        ["histories", "7/7"],
    ]
    assert err.endswith(" \r")


def test_the_first_rate_is_no_guess(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loading the kernels does not count, and a rate is told when half a second of work is behind it."""
    now = 100.0
    monkeypatch.setattr("fdspec.scheduling.progress.time.monotonic", lambda: now)
    pace = Pace(1100, 100)
    now += 30.0
    pace.advance(0)
    now += 0.001
    pace.advance(50)
    assert pace.text() == ""
    now += 0.999
    assert pace.rate == pytest.approx(50.0)
    assert pace.text() == "50/s, 0:19 left"
    pace.advance(0)
    assert pace.rate == pytest.approx(50.0)


def test_compiling_is_told_on_a_terminal_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cache.say_once.cache_clear()
    with cache.compiling(tmp_path, "quiet"):
        pass
    assert capsys.readouterr().err == ""
    cache.say_once.cache_clear()
    terminal = on_terminal(monkeypatch)
    for kernel in ("one", "two", "one"):
        with cache.compiling(tmp_path, kernel):
            pass
    said = "fdspec: compiling kernels, once for this version and processor: about a quarter of a minute\n"
    assert terminal.getvalue() == said
