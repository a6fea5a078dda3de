"""`fdspec records`: what the catalogue holds."""

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
}


@click.group(cls=LazyGroup, lazy=COMMANDS)
def records() -> None:
    """List and show the records of the catalogue.

    The study's own files cannot be shipped. Under each of its names stands a real record of the same
    earthquake, by default scaled to the peak ground acceleration that the study prints.
    """
