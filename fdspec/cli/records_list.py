"""`fdspec records list`."""

from __future__ import annotations

import dataclasses
import json

import click

from fdspec.cli.table import table

HEAD = ("name", "event", "date", "soil", "M", "PGA g", "s", "stand-in", "site", "scaled by")
LEFT = ("name", "event", "date", "soil", "stand-in", "site")


@click.command("list")
@click.option("--json", "as_json", is_flag=True, help="Everything the catalogue says, as JSON.")
def list_records(as_json: bool) -> None:
    """List the study's nine records and what stands in for them.

    Event, date, soil, magnitude, PGA and duration are the study's. The stand-in is station and component of
    the real record, with the site class of its station and the factor that brings it to the study's PGA.
    """
    from fdspec.records import catalogue

    entries = catalogue()
    if as_json:
        click.echo(json.dumps([dataclasses.asdict(entry) for entry in entries], indent=2, default=str))
        return
    rows = [
        (
            entry.name,
            entry.event,
            entry.date.isoformat(),
            entry.soil,
            f"{entry.magnitude:.1f}",
            f"{entry.pga_g:.3f}",
            f"{entry.duration:.0f}",
            f"{entry.stand_in.station} {entry.stand_in.component}",
            entry.stand_in.site_class,
            f"{entry.pga_g / entry.stand_in.pga_g:.3f}",
        )
        for entry in entries
    ]
    click.echo(table(HEAD, rows, left=LEFT))
