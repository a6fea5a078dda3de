"""`fdspec combine`: cubes of parts as one."""

from __future__ import annotations

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free
from fdspec.printable import in_words


@click.command()
@click.argument("cubes", metavar="CUBE.nc CUBE.nc...", nargs=-1, required=True)
@click.option("-o", "--output", required=True, metavar="FILE", help="The whole, netCDF.")
@click.option(
    "--along",
    default="record",
    show_default=True,
    metavar="DIM",
    help="record, building, or an axis: stiffness_ratio, pretension, period, stiffness_scale, slip_scale.",
)
@force_option
def combine(cubes: tuple[str, ...], output: str, along: str, force: bool) -> None:
    """Join cubes along records, or another dim, into what one sweep over all would have given.

    Parameters, records, numbers and version must agree in all but what is joined.
    """
    from fdspec import store

    path = free(output, force=force)
    joined = store.combine([store.open(cube) for cube in cubes], along)
    store.save(joined, path, overwrite=force)
    echo(
        f"{path}: {' x '.join(f'{joined.sizes[dim]} {in_words(str(dim))}' for dim in joined['status'].dims)}"
    )
