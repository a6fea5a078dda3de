"""The one way to stdout and stderr: nothing that a file holds reaches the terminal as a command to it."""

from __future__ import annotations

from typing import Final

import click

from fdspec.printable import printable

MARKS: Final = {"green": "\ue000", "yellow": "\ue001", "red": "\ue002"}
"""A letter of no language that stands before what is to be coloured, until the text has been made safe."""

END: Final = "\ue003"


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text of any origin."""
    click.echo(coloured(printable(str(text))), err=err, nl=nl)  # noqa: TID251 (the one place)


def coloured(text: str) -> str:
    """Put colours in the place of their marks; click takes them out again where there is no terminal."""
    for colour, mark in MARKS.items():
        text = text.replace(mark, click.style("", fg=colour, reset=False))
    return text.replace(END, click.style("", reset=True))


def status(text: str) -> None:
    """Put a text in the place of the last one on stderr; an empty one clears the line."""
    click.echo(f"\r\033[K{printable(text)}", err=True, nl=False)  # noqa: TID251 (the one place)
