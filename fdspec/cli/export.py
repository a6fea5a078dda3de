"""`fdspec export`: cubes, histories and buildings for other programs, or a cube as a page."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free
from fdspec.cli.select_option import selected
from fdspec.errors import InvalidInput

PAGES = (".html", ".htm")

FORMS: Final = {
    "netcdf": ".nc",
    "csv": ".csv",
    "excel": ".xlsx",
    "matlab": ".mat",
    "pelicun": ".csv",
    "opensees": ".py",
    "simcenter": ".py",
}
"""Form -> what its file ends with."""

OF_BUILDINGS: Final = ("opensees", "simcenter")
"""Forms that are made of a building file, not of a cube."""


@click.command()
@click.argument("cube", metavar="CUBE.nc|B.toml")
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="What to write; .nc, .csv, .xlsx, .mat or .html says the form.  [default with --format: a name "
    "after what is exported]",
)
@click.option(
    "--html",
    "page",
    is_flag=True,
    help="Write a page for the browser, all records in it unless --record names one; CUBE.html without -o.",
)
@click.option(
    "--record",
    metavar="NAME|FILE",
    help="The record; left out, all of the cube, but one for .nc. With --format opensees the ground motion.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(list(FORMS)),
    help="pelicun: the demands of a building, a row for each record, as Pelicun reads them. opensees: a "
    "building file and a record as a script of OpenSeesPy. simcenter: a building file as the script of a "
    "custom analysis.",
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
    """Write a cube for other programs, or as a page, or a building as another program's script.

    FILE.csv has a row for each cell and a column for each axis, below lines with # that tell units and
    origin; of a history, a row for each time, and FILE-transitions.csv one for each change of phase.
    FILE.xlsx holds the same as a workbook (fdspec[excel]), FILE.mat the arrays for Matlab and Octave. FILE.nc
    holds one record over stiffness ratio, pretension and period, for ParaView, CDO and others that take three
    axes. FILE.html shows maps, surfaces and the best pretension in any browser, without a server; histories
    need `fdspec explore`.

    \b
    Examples:
        fdspec export study.nc -o study.xlsx
        fdspec export six.nc --format pelicun --at slip_scale=1 --storey-height 3.2
        fdspec export six.toml --format opensees --record FSR1
    """
    if storey_height is not None and form != "pelicun":
        raise click.UsageError("--storey-height is for --format pelicun.")
    if page and (form or chosen):
        raise click.UsageError("--html goes without --format and --at.")
    if page or (output is not None and form is None and Path(output).suffix.lower() in PAGES):
        path = free(output or f"{Path(cube).stem}.html", force=force, suffixes=PAGES)
        _write_page(cube, path, record)
        echo(str(path))
    elif form in OF_BUILDINGS:
        if chosen:
            raise click.UsageError(
                f"--at selects along a cube's dims; --format {form} takes a building file."
            )
        _write_script(cube, output, record, str(form), force)
    elif output is None and form is None:
        raise click.UsageError("Give -o FILE.nc, .csv, .xlsx or .mat, or --format, or --html.")
    else:
        _write_cube(cube, output, record, form, chosen, storey_height, force)


def _write_cube(
    cube: str,
    output: str | None,
    record: str | None,
    form: str | None,
    chosen: tuple[str, ...],
    storey_height: float | None,
    force: bool,
) -> None:
    from fdspec import store
    from fdspec.store.export import EXPORT_SUFFIXES
    from fdspec.store.history_csv import CSV_SUFFIXES, transitions_file
    from fdspec.store.pelicun import write_pelicun
    from fdspec.store.suitable import require_sound

    suffixes = (*EXPORT_SUFFIXES, *PAGES) if form is None else (FORMS[form],)
    mark = "-pelicun" if form == "pelicun" else "-export" if form == "netcdf" else ""
    path = free(output or f"{Path(cube).stem}{mark}{suffixes[0]}", force=force, suffixes=suffixes)
    if not path.suffix and form is not None:
        raise click.UsageError(f"-o {output}: the name should end in {FORMS[form]} for --format {form}.")
    opened = store.open(cube)
    require_sound(opened, cube)
    for choice in chosen:
        opened = selected(opened, choice)
    if form == "pelicun":
        write_pelicun(opened, path, storey_height=storey_height)
        echo(str(path))
        return
    beside: list[Path] = []
    if path.suffix.lower() in CSV_SUFFIXES and "transition" in opened.dims:
        beside = [free(transitions_file(path), force=force, suffixes=CSV_SUFFIXES)]
    store.export(opened, path, record=record)
    echo("\n".join(map(str, [path, *beside])))


def _write_script(source: str, output: str | None, record: str | None, form: str, force: bool) -> None:
    if Path(source).suffix.lower() != ".toml":
        raise click.UsageError(f"--format {form} takes a building file, B.toml, got {source}.")
    if form == "opensees" and record is None:
        raise click.UsageError("--format opensees needs --record: the ground motion stands in the script.")
    if form == "simcenter" and record is not None:
        raise click.UsageError(
            "--record is not for --format simcenter: its workflow gives the ground motion."
        )
    path = free(output or f"{Path(source).stem}-{form}.py", force=force, suffixes=(".py",))

    from fdspec.model.building_file import read_building
    from fdspec.store.replacing import replacing

    name = Path(source).stem
    building = read_building(source, design=True)
    if form == "opensees":
        from fdspec.exchange.opensees import opensees_script
        from fdspec.runs.study_records import find_record

        text = opensees_script(building, find_record(str(record)), name=name)
    else:
        from fdspec.exchange.simcenter import simcenter_script

        text = simcenter_script(Path(source).read_text(encoding="utf-8"), name=name)
    with replacing(path, suffixes=(".py",)) as part:
        part.write_text(text, encoding="utf-8")
    echo(str(path))


def _write_page(cube: str, path: Path, record: str | None) -> None:
    from fdspec import store

    try:
        from fdspec.explore.opened import content_of
        from fdspec.explore.page import write_page
    except ModuleNotFoundError as error:
        raise InvalidInput(f"a page needs {error.name}: pip install 'fdspec[explore]'") from None
    opened = store.open(cube)
    if record is not None and "record" in opened.dims:
        names = [str(name) for name in opened["record"].values]
        if record not in names:
            raise InvalidInput(f"{cube} has no record {record!r}; it has {', '.join(names)}")
        opened = opened.isel(record=[names.index(record)])
    write_page(content_of(opened, cube, Path(cube).name), path)
