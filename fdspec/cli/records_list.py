"""`fdspec records list`."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING

import click

from fdspec.cli.echo import echo
from fdspec.cli.table import table

if TYPE_CHECKING:
    from fdspec.records import CatalogueEntry
    from fdspec.records.links import Link

HEAD = ("name", "event", "date", "soil", "M", "PGA g", "s", "loaded", "site", "scaled by")
LEFT = ("name", "event", "date", "soil", "loaded", "site")


@click.command("list")
@click.option("--json", "as_json", is_flag=True, help="Everything the catalogue says, as JSON.")
def list_records(as_json: bool) -> None:
    """List the study's nine records and what is loaded for each.

    Event, date, soil, magnitude, PGA and duration are the study's. Loaded is a stand-in, with station and
    component of the real record, the site class of its station and the factor that brings it to the study's
    PGA, or a file of your own that was linked.
    """
    from fdspec.cli.records_link import linked_lines
    from fdspec.records import catalogue
    from fdspec.records.links import links

    known = links()
    if as_json:
        content = [
            {
                **dataclasses.asdict(entry),
                "linked": dataclasses.asdict(known[entry.name]) if entry.name in known else None,
            }
            for entry in catalogue()
        ]
        echo(json.dumps(content, indent=2, default=str))
        return
    rows = [(*_of_study(entry), *_loaded(entry, known.get(entry.name))) for entry in catalogue()]
    echo("\n".join([table(HEAD, rows, left=LEFT), *linked_lines(known)]))


def _of_study(entry: CatalogueEntry) -> tuple[str, ...]:
    return (
        entry.name,
        entry.event,
        entry.date.isoformat(),
        entry.soil,
        f"{entry.magnitude:.1f}",
        f"{entry.pga_g:.3f}",
        f"{entry.duration:.0f}",
    )


def _loaded(entry: CatalogueEntry, link: Link | None) -> tuple[str, str, str]:
    """Return what is loaded, its site class and its factor; a linked file that cannot be has neither."""
    from fdspec.errors import FdspecError
    from fdspec.records import load_record

    if link is None:
        stand_in = entry.stand_in
        factor = entry.pga_g / stand_in.pga_g
        return f"{stand_in.station} {stand_in.component}", stand_in.site_class, f"{factor:.3f}"
    try:
        factor = load_record(entry.name).scale_factor
    except FdspecError:
        return f"own: {link.path.name}, refused", "", ""
    return f"own: {link.path.name}", "", f"{factor:.3f}"
