"""The reference of the command line, written from the commands themselves."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator

import click

from fdspec.cli.commands import fdspec


def commands() -> str:
    """Return every command with its usage, its words and its options, as Markdown."""
    return "\n\n".join(_sections(fdspec, click.Context(fdspec, info_name="fdspec"), 2))


def _sections(group: click.Group, context: click.Context, level: int) -> Iterator[str]:
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if command is None:
            raise LookupError(f"{name} is listed and not there")
        inner = click.Context(command, info_name=name, parent=context)
        yield _section(command, inner, level)
        if isinstance(command, click.Group):
            yield from _sections(command, inner, level + 1)


def _section(command: click.Command, context: click.Context, level: int) -> str:
    usage = " ".join([context.command_path, *command.collect_usage_pieces(context)])
    parts = [f"{'#' * level} `{context.command_path}`", f"```text\n{usage}\n```", *_words(command)]
    rows = [row for parameter in command.get_params(context) if (row := _row(parameter, context))]
    if rows and not isinstance(command, click.Group):
        parts.append("\n".join(["| option | meaning |", "|---|---|", *rows]))
    return "\n\n".join(parts)


def _words(command: click.Command) -> Iterator[str]:
    """Give the help's paragraphs; one behind the mark of verbatim text stays as it is."""
    for paragraph in inspect.cleandoc(command.help or "").split("\n\n"):
        if paragraph.startswith("\b"):
            yield "```text\n" + inspect.cleandoc(paragraph.removeprefix("\b").strip("\n")) + "\n```"
        elif paragraph.strip():
            yield _escaped(" ".join(paragraph.split()))


def _row(parameter: click.Parameter, context: click.Context) -> str | None:
    record = parameter.get_help_record(context)
    if record is None:
        return None
    option, meaning = record
    return f"| `{option.replace('|', chr(92) + '|')}` | {_escaped(' '.join(meaning.split()))} |"


def _escaped(text: str) -> str:
    """Keep what Markdown would take for its own; code between backticks stays code."""
    return re.sub(r"([*_<>\[\]|])(?=(?:[^`]*`[^`]*`)*[^`]*$)", r"\\\1", text)
