"""`fdspec figures`: the study's figures from a cube, or the profiles of a cube of buildings."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free, made_folder, write_picture
from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.figures.page import Figure
    from fdspec.report.study_figures import Picture

KINDS: Final = ("png", "pdf", "svg")

SHEET: Final = "contact-sheet"

CAPTIONS: Final = "captions.md"

SHEET_DPI: Final = 200


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option(
    "-o", "--output", default="figures", show_default=True, metavar="DIR", help="Folder; made if absent."
)
@click.option(
    "--only",
    metavar="LIST",
    help="The study's numbers, such as 10,11, or names of records it does not know; of a cube of buildings, "
    "their names.  [default: all]",
)
@click.option(
    "--format",
    "kinds",
    multiple=True,
    type=click.Choice(KINDS),
    help="Repeat it for several.  [default: png and pdf]",
)
@click.option(
    "--study",
    "study_file",
    metavar="STUDY.toml",
    help="The file the cube was made from: figures 8 and 9 find your own records by it.",
)
@click.option(
    "--width",
    metavar="MM",
    help="For a journal: this wide, such as 180mm; no title or caption, 600 dpi, letters of 7 points.",
)
@click.option(
    "--panels",
    type=click.Choice(["maps", "surfaces"]),
    help="With --width, what to draw of each record.  [default: maps]",
)
@click.option(
    "--slip-scale", type=float, metavar="X", help="Of buildings: the factor shown.  [default: nearest to 1]"
)
@click.option("--stiffness-scale", type=float, metavar="X", help="The same on the stiffness of braces.")
@click.option("--author", default="", metavar="TEXT", help="Author that the files name.")
@click.option("--list", "listed", is_flag=True, help="Say which figures this cube gives, and stop.")
@force_option
def figures(
    cube: str,
    output: str,
    only: str | None,
    kinds: tuple[str, ...],
    study_file: str | None,
    width: str | None,
    panels: str | None,
    slip_scale: float | None,
    stiffness_scale: float | None,
    author: str,
    listed: bool,
    force: bool,
) -> None:
    """Draw the study's figures: 4 and 6 (validation), 7 (the damper), 8 and 9 (records), 10 to 18 (spectra).

    Each of 10 to 18 shows one record, a panel a stiffness ratio: the surface over pretension and period, and
    beside it a map with the best pretension. Beyond the study, `ensemble` shows all records together, `chart`
    the response over slip force in units of floor mass and ground peak. Captions name the records really
    used. All figures together come with a contact sheet and the captions as captions.md. Prints the name of
    each picture.

    Of a cube of buildings there is a picture for each building: drift, acceleration, slip and force over the
    height, each record grey, median, and 16 to 84 % of the records.
    """
    from fdspec import store
    from fdspec.figures import encode, plot_contact_sheet
    from fdspec.report.study_figures import applied_motions, chosen, study_pictures
    from fdspec.runs.study import Study
    from fdspec.scheduling.progress import progress
    from fdspec.store.suitable import require_cube

    millimetres = _millimetres(width)
    if panels is not None and width is None:
        raise click.UsageError("--panels goes with --width.")
    dataset = store.open(cube)
    scales = {"slip_scale": slip_scale, "stiffness_scale": stiffness_scale}
    if "building" in dataset.dims:
        if study_file or panels:
            raise click.UsageError(
                "--study and --panels are of the study's figures; the cube is of buildings."
            )
        names = [str(name) for name in dataset["building"].values]
        wanted = _numbers(only) or names
        for name in wanted:
            if name not in names:
                raise InvalidInput(f"--only: {cube} has no building {name!r}; it has {', '.join(names)}")
        if listed:
            echo("\n".join(wanted))
            return
        _profiles(dataset, wanted, scales, made_folder(output), kinds, millimetres, author, force)
        return
    if any(value is not None for value in scales.values()):
        raise click.UsageError("--slip-scale and --stiffness-scale are of a cube of buildings.")
    require_cube(dataset, cube, "the study's figures")
    given = Study.read(study_file).motions() if study_file else ()
    pictures = chosen(study_pictures(dataset, given), _numbers(only))
    if listed:
        echo("\n".join(f"{picture.number:8} {picture.title}" for picture in pictures))
        return
    folder = made_folder(output)
    kinds = tuple(dict.fromkeys(kinds)) or ("png", "pdf")
    whole = only is None and width is None
    paths = [[folder / f"{picture.name}.{kind}" for kind in kinds] for picture in pictures]
    sheet = [folder / f"{SHEET}.{kind}" for kind in kinds] if whole else []
    captions = folder / CAPTIONS
    for path in [*(path for files in paths for path in files), *sheet, *([captions] if whole else [])]:
        free(path, force=force, suffixes=(path.suffix,))
    _, lost = applied_motions(dataset, given)
    if lost and (only is None or {"8", "9"} & set(_numbers(only))):
        echo(
            f"fdspec: warning: figures 8 and 9 are without {', '.join(lost)}: no record found with the "
            "cube's checksum; name its study file with --study",
            err=True,
        )
    thumbnails = {}
    with progress(len(pictures) + whole, "figures") as done:
        for picture, files in zip(pictures, paths, strict=True):
            figure = (
                picture.draw() if millimetres is None else picture.draw_print(millimetres, panels or "maps")
            )
            _write(_encoded(figure, kinds, author), files)
            if whole:
                small = encode(picture.draw_small(), "png", dpi=SHEET_DPI)
                thumbnails[_short(picture.number)] = small
            done(1)
        if whole:
            title = f"The study's figures from {Path(cube).name}"
            _write(_encoded(plot_contact_sheet(thumbnails, title=title), kinds, author), sheet)
            captions.write_text(_page(pictures), encoding="utf-8")
            done(1)
    echo("\n".join(str(path) for path in [*(path for files in paths for path in files), *sheet]))


def _profiles(
    cube: xr.Dataset,
    names: Sequence[str],
    scales: dict[str, float | None],
    folder: Path,
    kinds: Sequence[str],
    millimetres: float | None,
    author: str,
    force: bool,
) -> None:
    """Draw a picture for each building, and write the captions."""
    from fdspec.figures import design_of, plot_profiles, profiles_caption
    from fdspec.figures.page import at_width
    from fdspec.store.suitable import require_sound

    require_sound(cube, str(folder))
    kinds = tuple(dict.fromkeys(kinds)) or ("png", "pdf")
    stems = {name: f"profiles-{_file_name(name)}" for name in names}
    if len(set(stems.values())) < len(stems):
        stems = {name: f"profiles-{number}-{_file_name(name)}" for number, name in enumerate(names, 1)}
    paths = {name: [folder / f"{stem}.{kind}" for kind in kinds] for name, stem in stems.items()}
    captions = folder / CAPTIONS
    for path in [*(path for files in paths.values() for path in files), captions]:
        free(path, force=force, suffixes=(path.suffix,))
    told = []
    for name, files in paths.items():
        figure = plot_profiles(cube, name, **scales)
        if millimetres is not None:
            figure.suptitle("")
            at_width(figure, millimetres)
        _write(_encoded(figure, kinds, author), files)
        told.append(f"**{stems[name]}**: {profiles_caption(design_of(cube, name, **scales))}\n")
    captions.write_text("\n".join(told), encoding="utf-8")
    echo("\n".join(str(path) for files in paths.values() for path in files))


def _file_name(name: str) -> str:
    """Return what of a building's name can stand in a file's."""
    return "".join(letter if letter.isalnum() or letter in "-_." else "-" for letter in name)[:100]


def _encoded(figure: Figure, kinds: Sequence[str], author: str) -> dict[str, bytes]:
    from fdspec.figures import encode

    # The place of everything, solved once, serves every kind: it takes as long as drawing.
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    return {kind: encode(figure, kind, author=author) for kind in kinds}


def _millimetres(width: str | None) -> float | None:
    """Take a width such as 180mm, 18cm or 180."""
    if width is None:
        return None
    number, factor = width.strip().lower(), 1.0
    for unit, per_mm in (("mm", 1.0), ("cm", 10.0), ("in", 25.4)):
        if number.endswith(unit):
            number, factor = number.removesuffix(unit), per_mm
    try:
        found = float(number) * factor
    except ValueError:
        raise InvalidInput(f"--width must be a length, such as 180mm; got {width!r}") from None
    if not 60.0 <= found <= 400.0:
        raise InvalidInput(f"--width must be from 60 to 400 mm, got {width!r}")
    return found


def _write(encoded: dict[str, bytes], paths: Sequence[Path]) -> None:
    for path in paths:
        write_picture(encoded[path.suffix.removeprefix(".")], path)


def _short(number: str) -> str:
    return f"Figure {number}" if number.isdigit() else number


def _page(pictures: Sequence[Picture]) -> str:
    """Return all captions as a page, in the figures' order."""
    return "\n".join(f"**{picture.name}**: {picture.caption}\n" for picture in pictures)


def _numbers(only: str | None) -> list[str]:
    if only is None:
        return []
    numbers = [one.strip() for one in only.split(",") if one.strip()]
    if not numbers:
        raise InvalidInput(f"--only must name figures, such as 10,11; got {only!r}")
    return numbers
