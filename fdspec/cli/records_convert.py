"""`fdspec records convert`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free
from fdspec.cli.record_options import AboutFile, reading_options, record_about
from fdspec.printable import rounded

if TYPE_CHECKING:
    from fdspec.model.motion import GroundMotion


@click.command("convert")
@click.argument("record", metavar="FILE|NAME")
@click.option(
    "-o",
    "--output",
    required=True,
    metavar="FILE",
    help="What to write: .at2 is PEER's layout in g, .txt two columns, s and m/s2.",
)
@reading_options
@click.option("--raw", is_flag=True, help="A catalogue's record as recorded, not scaled to the study's PGA.")
@click.option("--trim", type=float, nargs=2, metavar="S S", help="Keep from one time to another, s.")
@click.option(
    "--trim-arias",
    type=float,
    nargs=2,
    metavar="X X",
    help="Keep from one share of the Arias intensity to another.",
)
@click.option("--baseline", type=int, metavar="ORDER", help="Take out a polynomial that fits the velocity.")
@click.option("--band-pass", type=float, nargs=2, metavar="HZ HZ", help="Butterworth of order 4, no delay.")
@click.option("--resample", type=float, metavar="S", help="Another time step, s.")
@click.option("--pad", type=float, nargs=2, metavar="S S", help="Zeros before and after, s.")
@click.option("--factor", type=float, metavar="X", help="Scale by a factor; -1 mirrors.")
@click.option("--pga", type=float, metavar="M/S2", help="Scale to a peak, m/s2.")
@click.option("--pga-g", type=float, metavar="G", help="Scale to a peak, g.")
@force_option
def convert_record(
    record: str,
    output: str,
    about: AboutFile,
    raw: bool,
    trim: tuple[float, float] | None,
    trim_arias: tuple[float, float] | None,
    baseline: int | None,
    band_pass: tuple[float, float] | None,
    resample: float | None,
    pad: tuple[float, float] | None,
    factor: float | None,
    pga: float | None,
    pga_g: float | None,
    force: bool,
) -> None:
    """Write a record of any format as PEER AT2 or as two columns, changed on the way where an option says so.

    The steps are taken in the order of the options below, whatever their order on the command line.

    \b
    Example:
        fdspec records convert CE58667.V2 --channel H1 --trim 10 60 -o H1.at2
    """
    if sum(given is not None for given in (factor, pga, pga_g)) > 1:
        raise click.UsageError("Give one of --factor, --pga and --pga-g.")
    path = free(output, force=force, suffixes=(".at2", ".txt"))

    from fdspec.records.writing import write_record
    from fdspec.runs.study_records import find_record
    from fdspec.signals import processing
    from fdspec.units import G

    named = record_about(record, about)
    motion = find_record(named, scaled=not raw)
    if trim is not None:
        motion = processing.trimmed(motion, *trim)
    if trim_arias is not None:
        motion = processing.trimmed_by_arias(motion, *trim_arias)
    if baseline is not None:
        motion = processing.baseline_corrected(motion, baseline)
    if band_pass is not None:
        motion = processing.band_passed(motion, *band_pass)
    if resample is not None:
        motion = processing.resampled(motion, resample)
    if pad is not None:
        motion = processing.padded(motion, *pad)
    if factor is not None:
        motion = motion.scaled(factor)
    if pga is not None:
        motion = motion.scaled_to_pga(pga)
    if pga_g is not None:
        motion = motion.scaled_to_pga(pga_g * G)
    write_record(motion, path)
    echo(_written(motion, str(path)))


def _written(motion: GroundMotion, path: str) -> str:
    from fdspec.units import G

    numbers = f"{motion.n} samples, dt {motion.dt:g} s, PGA {motion.pga / G:.4g} g"
    return "\n".join([f"{path}: {numbers}", *(f"  {rounded(step)}" for step in motion.history)])
