"""`fdspec export`: one record of a cube, for programs that want less than a cube, or the cube as a page."""

from __future__ import annotations

from pathlib import Path

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free
from fdspec.cli.select_option import selected
from fdspec.errors import InvalidInput

PAGES = (".html", ".htm")


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option(
    "-o", "--output", metavar="FILE", help="What to write; .nc, .csv, .xlsx, .mat or .html says the form."
)
@click.option(
    "--html",
    "page",
    is_flag=True,
    help="Write a page for the browser, all records in it unless --record names one; CUBE.html without -o.",
)
@click.option("--record", metavar="NAME", help="The record; may be left out where the cube has one.")
@click.option(
    "--format",
    "form",
    type=click.Choice(["pelicun"]),
    help="pelicun: the demands of a building, a row for each record, as Pelicun reads them.",
)
@click.option(
    "--at", "chosen", multiple=True, metavar="DIM=VALUE", help="Select along a dim of the cube; repeat it."
)
@click.option(
    "--storey-height", type=float, metavar="M", help="Of every storey, m, for Pelicun's drift ratios."
)
@force_option
def export(
    cube: str,
    output: str | None,
    page: bool,
    record: str | None,
    form: str | None,
    chosen: tuple[str, ...],
    storey_height: float | None,
    force: bool,
) -> None:
    """Write one record of a cube for other programs, or a cube as a page.

    FILE.nc holds it over stiffness ratio, pretension and period, for ParaView, CDO and others that take three
    axes. FILE.csv has a row for each cell, below lines with # that tell units and origin; of a history, a row
    for each time, and FILE-transitions.csv one for each change of phase. FILE.html shows
    maps, surfaces and the best pretension in any browser, without a server; histories need `fdspec explore`.
    """
    from fdspec import store
    from fdspec.store.history_csv import CSV_SUFFIXES, transitions_file
    from fdspec.store.pelicun import write_pelicun
    from fdspec.store.suitable import require_sound

    beside: list[Path] = []
    if storey_height is not None and form is None:
        raise click.UsageError("--storey-height is for --format pelicun.")
    if page and (form or chosen):
        raise click.UsageError("--html goes without --format and --at.")
    if output is not None and Path(output).suffix.lower() in PAGES:
        page = True
    if page:
        path = free(output or f"{Path(cube).stem}.html", force=force, suffixes=PAGES)
        _write_page(cube, path, record)
    elif output is None:
        raise click.UsageError("Give -o FILE.nc or -o FILE.csv, or --html.")
    else:
        path = free(output, force=force, suffixes=(".nc", ".csv", *PAGES))
        opened = store.open(cube)
        require_sound(opened, cube)
        for choice in chosen:
            opened = selected(opened, choice)
        if form == "pelicun":
            write_pelicun(opened, path, storey_height=storey_height)
            echo(str(path))
            return
        if path.suffix.lower() in CSV_SUFFIXES and "transition" in opened.dims:
            beside = [free(transitions_file(path), force=force, suffixes=CSV_SUFFIXES)]
        store.export(opened, path, record=record)
    echo("\n".join(map(str, [path, *beside])))


def _write_page(cube: str, path: Path, record: str | None) -> None:
    from fdspec import store
    from fdspec.store.suitable import require_cube

    try:
        from fdspec.explore.content import Content
        from fdspec.explore.page import write_page
    except ModuleNotFoundError as error:
        raise InvalidInput(f"a page needs {error.name}: pip install 'fdspec[explore]'") from None
    opened = store.open(cube)
    require_cube(opened, cube, "pages")
    if record is not None and "record" in opened.dims:
        names = [str(name) for name in opened["record"].values]
        if record not in names:
            raise InvalidInput(f"{cube} has no record {record!r}; it has {', '.join(names)}")
        opened = opened.isel(record=[names.index(record)])
    write_page(Content(opened, Path(cube).name), path)
