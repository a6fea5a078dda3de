"""`fdspec figures`: pictures of a cube."""

from __future__ import annotations

import click

from fdspec.cli.output import force_option, free, made_folder, save_picture
from fdspec.errors import InvalidInput


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option(
    "-o", "--output", default="figures", show_default=True, metavar="DIR", help="Folder; made if absent."
)
@click.option(
    "--record",
    "records",
    multiple=True,
    metavar="NAME",
    help="A record of the cube; repeat it.  [default: all]",
)
@click.option("--surface", is_flag=True, help="3-D surfaces, as the study has them, in place of maps.")
@click.option("--format", "kind", type=click.Choice(["png", "pdf", "svg"]), default="png", show_default=True)
@force_option
def figures(cube: str, output: str, records: tuple[str, ...], surface: bool, kind: str, force: bool) -> None:
    """Draw peak acceleration over pretension and period: a picture a record, a panel a stiffness ratio.

    Prints the name of each picture.
    """
    from fdspec import store
    from fdspec.figures import plot_acceleration_maps, plot_acceleration_surfaces
    from fdspec.progress import progress

    dataset = store.open(cube)
    known = [str(name) for name in dataset["record"].values]
    if unknown := [name for name in records if name not in known]:
        raise InvalidInput(f"{cube} has no record {unknown[0]!r}; it has {', '.join(known)}")
    chosen = list(dict.fromkeys(records)) or known
    folder = made_folder(output)
    what = "surface" if surface else "map"
    suffixes = (f".{kind}",)
    paths = [folder / f"{_file_stem(name)}-acceleration-{what}.{kind}" for name in chosen]
    for path in paths:
        free(path, force=force, suffixes=suffixes)
    plot = plot_acceleration_surfaces if surface else plot_acceleration_maps
    with progress(len(chosen), "figures") as done:
        for name, path in zip(chosen, paths, strict=True):
            save_picture(plot(dataset, name), path)
            done(1)
    click.echo("\n".join(map(str, paths)))


def _file_stem(name: str) -> str:
    """Return a record's name as part of a file's name, whatever characters it has."""
    return (
        "".join(letter if letter.isalnum() or letter in "-_.() " else "_" for letter in name).strip(" .")
        or "_"
    )
