"""The one way to stdout and stderr: nothing that a file holds reaches the terminal as a command to it."""

from __future__ import annotations

import click

from fdspec.printable import printable


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text of any origin."""
    click.echo(printable(str(text)), err=err, nl=nl)  # noqa: TID251 (the one place)


def status(text: str) -> None:
    """Put a text in the place of the last one on stderr; an empty one clears the line."""
    click.echo(f"\r\033[K{printable(text)}", err=True, nl=False)  # noqa: TID251 (the one place)
