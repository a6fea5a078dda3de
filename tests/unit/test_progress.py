"""The progress bar: only on a terminal, only for long work, and gone when the work is done."""

import io
import sys
import time

import pytest

from fdspec.scheduling.progress import progress


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
