"""`fdspec records show`."""

from __future__ import annotations

import json

import click

from fdspec.cli.record_options import file_options, named_records


@click.command("show")
@click.argument("record", metavar="NAME|FILE")
@file_options
@click.option("--raw", is_flag=True, help="As recorded, not scaled to the study's PGA.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def show_record(
    record: str, units: str | None, dt: float | None, channel: str | None, raw: bool, as_json: bool
) -> None:
    """Show what is known of one record, of the catalogue or in a file, and what was done to it."""
    from fdspec.records import catalogue
    from fdspec.study import find_record
    from fdspec.units import G

    (named,) = named_records([record], units, dt, channel)
    motion = find_record(named, scaled=not raw)
    about: dict[str, object] = {
        "name": motion.name,
        "event": motion.event,
        "station": motion.station,
        "component": motion.component,
        "source": motion.source,
    }
    about |= {
        key: value
        for entry in catalogue()
        if isinstance(named, str) and named.upper() == entry.name
        for key, value in {
            "soil": entry.soil,
            "magnitude": entry.magnitude,
            "study_pga_g": entry.pga_g,
            "study_duration_s": entry.duration,
            "site_class": entry.stand_in.site_class,
            "vs30_m_per_s": entry.stand_in.vs30,
            "file": str(entry.stand_in.path),
        }.items()
    }
    about |= {
        "pga_g": motion.pga / G,
        "scale_factor": motion.scale_factor,
        "dt_s": motion.dt,
        "samples": motion.n,
        "duration_s": motion.duration,
        "history": list(motion.history),
        "checksum": motion.checksum,
    }
    if as_json:
        click.echo(json.dumps(about, indent=2))
        return
    width = max(map(len, about))
    for key, value in about.items():
        lines = value if isinstance(value, list) else [f"{value:.6g}" if isinstance(value, float) else value]
        for head, line in zip([key, *[""] * len(lines)], lines, strict=False):
            click.echo(f"{head:<{width}}  {line}".rstrip())
