"""`fdspec records`: the catalogue, and the user's own files."""

import click

from fdspec.cli.lazy import LazyGroup

COMMANDS = {
    "list": (
        "fdspec.cli.records_list:list_records",
        "List the study's nine records and what stands in for them.",
    ),
    "show": (
        "fdspec.cli.records_show:show_record",
        "Show all that is known of one record, of the catalogue or a file.",
    ),
    "check": (
        "fdspec.cli.records_check:check_records",
        "Look for the study's records among your own files, and link them.",
    ),
    "link": (
        "fdspec.cli.records_link:link_record",
        "Load one file of your own in place of a stand-in.",
    ),
    "unlink": (
        "fdspec.cli.records_link:unlink_records",
        "Load the stand-ins again.",
    ),
    "convert": (
        "fdspec.cli.records_convert:convert_record",
        "Write a record of any format as PEER AT2 or as two columns.",
    ),
    "figures": (
        "fdspec.cli.records_figures:draw_records",
        "Draw records together: histories and elastic spectra.",
    ),
}


@click.group(cls=LazyGroup, lazy=COMMANDS)
def records() -> None:
    """List, show, check, link, convert and draw records.

    The study's own files cannot be shipped. Under each of its names stands a real record of the same
    earthquake, by default scaled to the peak ground acceleration that the study prints, until `check --link`
    or `link` puts a file of your own in its place.
    """
