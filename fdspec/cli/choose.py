"""`fdspec choose`: which pretension, for which brace, with what gain, and how wrong it may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fdspec.cli.as_json import echo_json, json_option, of_dataset
from fdspec.cli.device_options import device_options, given
from fdspec.cli.echo import echo
from fdspec.cli.limits import levels_of, limits_of, told
from fdspec.cli.output import force_option, free
from fdspec.cli.record_options import RecordsOption, file_options, named_records

if TYPE_CHECKING:
    from fdspec.model.building import Building

PAGES = (".html", ".htm")


@click.command()
@click.option(
    "--record",
    "records",
    cls=RecordsOption,
    multiple=True,
    metavar="NAME|FILE",
    help="A record of the catalogue, or a file; repeat it.  [default: the study's nine]",
)
@file_options
@click.option(
    "--raw", is_flag=True, help="Leave a catalogue's record as recorded, not scaled to the study's PGA."
)
@click.option(
    "--building", metavar="FILE.toml", help="A building, in place of the single-storey frame of the options."
)
@click.option(
    "--period", type=float, default=0.5, show_default=True, metavar="S", help="Of the bare frame, s."
)
@click.option(
    "--stiffness-ratio", type=float, default=4.0, show_default=True, metavar="X", help="Brace over frame."
)
@click.option("--floor-mass", type=float, default=20e3, show_default=True, metavar="KG")
@click.option("--brace-mass", type=float, default=50.0, show_default=True, metavar="KG")
@click.option("--damping-ratio", type=float, default=0.05, show_default=True, metavar="X")
@device_options
@click.option("--friction-coefficient", type=float, default=0.5, show_default=True, metavar="X")
@click.option(
    "--kinetic-friction-coefficient", type=float, metavar="X", help="[default: the friction coefficient]"
)
@click.option(
    "--normal-force-factor",
    type=float,
    default=1.0,
    show_default=True,
    metavar="X",
    help="Normal force for each newton of pretension: 2 n for the force of one of n bolts, two faces.",
)
@click.option(
    "--index",
    default="acceleration",
    show_default=True,
    metavar="NAME",
    help="acceleration, displacement, base_shear, rpi, dissipated_energy or weighted; "
    "or weights, as acceleration=0.7,rpi=0.3.",
)
@click.option(
    "--statistic",
    type=click.Choice(["mean", "median", "p84", "worst"]),
    default="mean",
    show_default=True,
    help="Of the index over the records.",
)
@click.option(
    "--distribution",
    type=click.Choice(["uniform", "shear", "free"]),
    default="uniform",
    show_default=True,
    help="Of the slip forces of a building: equal, in proportion to storey shear, or free.",
)
@click.option(
    "--lower",
    type=float,
    default=0.8,
    show_default=True,
    metavar="X",
    help="Property modification factor: least slip force over the nominal.",
)
@click.option(
    "--upper", type=float, default=1.2, show_default=True, metavar="X", help="The same of the largest."
)
@click.option(
    "--limit",
    "limits",
    multiple=True,
    metavar="NAME=X",
    help="Find the least slip force that meets this instead: acceleration=0.5g, drift=20mm, "
    "drift_ratio=0.01, base_shear=300kN, residual_drift=2mm, slip=50mm, slip_travel=1; repeat it. Exit code "
    "1 where none meets all.",
)
@click.option(
    "--level",
    "levels",
    multiple=True,
    metavar="X",
    help="Factor on the records at which the limits hold, DE (1) or MCE (1.5); repeat it.  [default: 1]",
)
@click.option("--seed", type=int, default=0, show_default=True, metavar="N", help="Of a free distribution.")
@click.option("--workers", type=int, metavar="N", help="Threads.  [default: one a core]")
@click.option("--html", metavar="FILE.html", help="Write the report as one page with pictures too.")
@click.option("--title", default="", metavar="TEXT", help="Title of the page.")
@click.option("--project", default="", metavar="TEXT", help="Project that the page names.")
@click.option("--author", default="", metavar="TEXT", help="Author that the page names.")
@click.option("-o", "--output", metavar="FILE.nc", help="Write every number of it, netCDF.")
@json_option
@force_option
def choose(
    records: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    building: str | None,
    period: float,
    stiffness_ratio: float,
    floor_mass: float,
    brace_mass: float,
    damping_ratio: float,
    friction_coefficient: float,
    kinetic_friction_coefficient: float | None,
    normal_force_factor: float,
    index: str,
    statistic: str,
    distribution: str,
    lower: float,
    upper: float,
    limits: tuple[str, ...],
    levels: tuple[str, ...],
    seed: int,
    workers: int | None,
    html: str | None,
    title: str,
    project: str,
    author: str,
    output: str | None,
    as_json: bool,
    force: bool,
    **devices: float | None,
) -> None:
    """Recommend the pretension of a friction damper for one frame or building and a set of records.

    Prints the recommendation with its band, what it gains, the worst record, what limits it, and a bounding
    analysis with friction at its lower and upper bound. Without options: the study's frame of 0.5 s and
    stiffness ratio 4 under its nine records.

    \b
    Example:
        fdspec choose --record FSR1 --record mine.AT2 --period 0.8 --html choice.html
    """
    page_path = None if html is None else free(html, force=force, suffixes=PAGES)
    if html is None and (title or project or author):
        raise click.UsageError("--title, --project and --author are of the page; give --html.")
    cube_path = None if output is None else free(output, force=force)
    if limits and distribution == "free":
        raise click.UsageError("--limit scales one distribution of slip forces: uniform or shear, not free.")
    if levels and not limits:
        raise click.UsageError("--level says where limits hold; give --limit.")
    wanted, factors = limits_of(limits), levels_of(levels)
    click_context = click.get_current_context()
    if building is not None:
        frame_options = ("period", "stiffness_ratio", "floor_mass", "brace_mass", "damping_ratio")
        for name in (*frame_options, "kinetic_friction_coefficient", *devices):
            if click_context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE:
                option = "--" + name.replace("_", "-")
                raise click.UsageError(
                    f"{option} is of the single-storey frame; {building} tells the building."
                )

    from fdspec.choice import choose as compute
    from fdspec.model.building import Building
    from fdspec.model.building_file import read_building
    from fdspec.report.text import text
    from fdspec.runs.study_records import STUDY_RECORDS, find_record

    chosen: Building = (
        read_building(building)
        if building is not None
        else Building.single_storey(
            period=period,
            stiffness_ratio=stiffness_ratio,
            slip_force=friction_coefficient,
            kinetic_slip_force=kinetic_friction_coefficient,
            floor_mass=floor_mass,
            brace_mass=brace_mass,
            damping_ratio=damping_ratio,
            **given(devices),  # type: ignore[arg-type]
        )
    )
    named = named_records(records or STUDY_RECORDS, units, dt, channel)
    motions = tuple(find_record(name, scaled=not raw) for name in named)
    if wanted and not (html or output or as_json):
        from fdspec.choice.targets import meet

        target = meet(
            chosen,
            motions,
            wanted,
            levels=factors,
            statistic=statistic,
            distribution=distribution,
            lower=lower,
            upper=upper,
            workers=workers,
            progress=True,
        )
        echo(told(target, friction_coefficient * normal_force_factor))
        if not target.met:
            click_context.exit(1)
        return
    choice = compute(
        chosen,
        motions,
        index=_index(index),
        statistic=statistic,
        distribution=distribution,
        lower=lower,
        upper=upper,
        friction_coefficient=friction_coefficient,
        normal_force_factor=normal_force_factor,
        limits=wanted,
        levels=factors,
        seed=seed,
        workers=workers,
        progress=True,
    )
    from fdspec.choice.targets import target_of
    from fdspec.cli.table import text_width

    if wanted and not as_json:
        echo(told(target_of(choice), friction_coefficient * normal_force_factor))
    elif not as_json:
        echo(text(choice, width=text_width()))
    files: list[str] = []
    if cube_path is not None:
        from fdspec.store import save

        save(choice, cube_path, overwrite=force)
        files.append(str(cube_path))
    if page_path is not None:
        from fdspec.report.page import page
        from fdspec.store.replacing import replacing

        with replacing(page_path, suffixes=PAGES) as part:
            written = page(choice, chosen, motions, title=title, project=project, author=author)
            part.write_text(written, encoding="utf-8")
        files.append(str(page_path))
    if as_json:
        echo_json({"files": files, **of_dataset(choice)})
    elif files:
        echo("\n".join(files))
    if wanted and not target_of(choice).met:
        click_context.exit(1)


def _index(given: str) -> str | dict[str, float]:
    """Take a name, or weights written as acceleration=0.7,rpi=0.3."""
    if "=" not in given:
        return given
    weights = {}
    for part in given.split(","):
        name, _, weight = part.partition("=")
        try:
            weights[name.strip()] = float(weight)
        except ValueError:
            raise click.UsageError(f"--index: the weight in {part!r} is no number.") from None
    return weights
