"""`fdspec export`: one record of a cube, for programs that want less than a cube."""

from __future__ import annotations

import click

from fdspec.cli.output import force_option, free


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option(
    "-o", "--output", required=True, metavar="FILE", help="What to write; .nc or .csv says the form."
)
@click.option("--record", metavar="NAME", help="The record; may be left out where the cube has one.")
@force_option
def export(cube: str, output: str, record: str | None, force: bool) -> None:
    """Write one record of a cube for other programs.

    FILE.nc holds it over stiffness ratio, pretension and period, for ParaView, CDO and others that take three
    axes. FILE.csv has a row for each cell, below lines with # that tell units and origin.
    """
    from fdspec import store

    path = free(output, force=force, suffixes=(".nc", ".csv"))
    store.export(store.open(cube), path, record=record)
    click.echo(f"{path}")
