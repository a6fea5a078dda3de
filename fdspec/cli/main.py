"""The entry point: runs a command and turns what goes wrong into one line and an exit code."""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from collections.abc import Sequence
from contextlib import suppress
from typing import Final, NoReturn

import click

from fdspec.cli.commands import fdspec
from fdspec.cli.echo import echo
from fdspec.errors import DiskError, FdspecError, InvalidInput, StoreError
from fdspec.stopping import STOPPING, Stopped, stopped_by_signals

DONE: Final = 0
FAILED: Final = 1
WRONG_USAGE: Final = 2
SIGNALLED: Final = 128
"""Plus the number of the signal that ended it, as shells have it."""

INTERRUPTED: Final = SIGNALLED + signal.SIGINT


def run() -> NoReturn:
    """Run the command line of this process, and end the process.

    One that was told to stop, again after it began to, does not wait for threads that are still at work.
    """
    code = main()
    if code > SIGNALLED:
        for number in STOPPING:
            signal.signal(number, signal.SIG_IGN)
    if any(thread.name.startswith("fdspec") for thread in threading.enumerate()):
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)
    sys.exit(code)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return its exit code.

    When the reader of stdout has gone, as `head` does, click ends the process without a word.

    Parameters
    ----------
    arguments : sequence of str, optional
        Without the program's name; those of the process by default.
    """
    with warnings.catch_warnings(), stopped_by_signals():
        warnings.simplefilter("default", UserWarning)
        warnings.showwarning = _show_warning
        try:
            code = fdspec.main(arguments, prog_name="fdspec", standalone_mode=False)
            if sys.stdout is not None:
                sys.stdout.flush()  # a full disk behind it is told here, not as Python ends
        except click.exceptions.NoArgsIsHelpError as error:
            error.show()
            return WRONG_USAGE
        except click.UsageError as error:
            path = error.ctx.command_path if error.ctx else "fdspec"
            return _fail(f"{error.format_message()} (fdspec: see '{path} --help')", WRONG_USAGE)
        except click.ClickException as error:
            return _fail(error.format_message(), WRONG_USAGE)
        except DiskError as error:
            return _fail(str(error), FAILED)
        except (InvalidInput, StoreError) as error:
            return _fail(str(error), WRONG_USAGE)
        except FdspecError as error:
            return _fail(str(error), FAILED)
        except MemoryError as error:
            return _fail(f"not enough memory: {error}", FAILED)
        except (click.Abort, KeyboardInterrupt) as error:
            # click raises Abort from what it caught.
            cause = error if isinstance(error, Stopped) else error.__cause__
            if isinstance(cause, Stopped):
                number = signal.Signals(cause.args[0])
                _tell(f"fdspec: stopped by {number.name}")
                return SIGNALLED + number
            _tell("fdspec: interrupted")
            return INTERRUPTED
        except BrokenPipeError:
            _forget_stdout()  # the reader has gone
            return FAILED
        except OSError as error:
            _forget_stdout()
            return _fail(f"cannot write to standard output: {error.strerror or 'it is closed'}", FAILED)
    return code if isinstance(code, int) else DONE


def _fail(text: str, code: int) -> int:
    for line in text.splitlines():
        _tell(f"fdspec: error: {line}")
    return code


def _tell(line: str) -> None:
    """Write to stderr, where there is one that can be written to; the exit code says the rest."""
    with suppress(OSError, ValueError):
        echo(line, err=True)


def _forget_stdout() -> None:
    """Keep Python from writing once more, as it ends, what could not be written."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    text = " ".join(str(message).split())
    _tell(f"fdspec: warning: {text}")
