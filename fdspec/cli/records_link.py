"""`fdspec records link` and `unlink`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING

import click

from fdspec.cli.echo import echo
from fdspec.cli.record_options import file_options

if TYPE_CHECKING:
    from fdspec.records.links import Link


@click.command("link")
@click.argument("name")
@click.argument("file")
@file_options
def link_record(name: str, file: str, units: str | None, dt: float | None, channel: str | None) -> None:
    """Load a file of your own in place of the stand-in NAME from now on.

    `check DIR --link` does so with what it found for certain; this is for a candidate that you know to be the
    record, and for a file that says too little of itself to be found.

    \b
    Example:
        fdspec records link FMR3 CHY035-N.AT2
    """
    from fdspec.records.check import link_file

    match = link_file(name, file, channel=channel, units=units, dt=dt)
    echo(f"{match.name} is {match.path} from now on: {match.reason}")


@click.command("unlink")
@click.argument("names", metavar="[NAME]...", nargs=-1)
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def unlink_records(names: tuple[str, ...], as_json: bool) -> None:
    """Load the stand-ins again, of the records named or of all; the files themselves are left alone."""
    from fdspec.errors import RecordError
    from fdspec.records.catalogue import catalogue_entry
    from fdspec.records.links import links, links_file, remove_links

    chosen = {catalogue_entry(name).name for name in names}
    try:
        gone = [name for name in links() if name in chosen or not names]
    except RecordError:
        if names:
            raise
        gone = []  # a damaged file of links goes as a whole
    remove_links(tuple(chosen) if names else None)
    if as_json:
        echo(json.dumps({"unlinked": gone, "links_file": str(links_file())}, indent=2))
    else:
        echo(f"unlinked: {', '.join(gone) or 'nothing'}; the stand-ins are loaded")


def linked_lines(known: Mapping[str, Link]) -> list[str]:
    """Return the lines that tell which records are the user's own; none when all are stand-ins."""
    from fdspec.errors import RecordError
    from fdspec.records.links import linked

    if not known:
        return []
    lines = ["", "Linked, and loaded in place of the stand-ins:"]
    for name, link in sorted(known.items()):
        try:
            linked(name)
        except RecordError as error:
            lines.append(f"  {error}")
        else:
            lines.append(f"  {name}  {link.path}")
    return lines
