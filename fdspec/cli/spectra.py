"""`fdspec spectra`: elastic and inelastic response spectra of records."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.numbers_option import Numbers
from fdspec.cli.output import PICTURES, force_option, free, save_picture
from fdspec.cli.record_options import file_options, named_records

if TYPE_CHECKING:
    import xarray as xr

PERIODS: Final = "0,0.05:5:100"
"""Period 0, and a hundred from 0.05 to 5 s."""


@click.command()
@click.argument("records", nargs=-1, metavar="[RECORD|FILE]...")
@file_options
@click.option("--raw", is_flag=True, help="The catalogue's as recorded, not scaled to the study's PGA.")
@click.option(
    "--period",
    "periods",
    type=Numbers(),
    default=PERIODS,
    show_default=True,
    metavar="S",
    help="Periods: numbers, or LOW:HIGH:COUNT on a logarithmic scale, or both with commas.",
)
@click.option("--damping-ratio", type=float, default=0.05, show_default=True, metavar="X")
@click.option(
    "--ductility", type=Numbers(), metavar="MU", help="Spectra of constant ductility, such as 2,4,8."
)
@click.option("--reduction-factor", type=Numbers(), metavar="R", help="Elastic strength over yield strength.")
@click.option("--strength", type=Numbers(), metavar="M/S2", help="Yield strength over mass, m/s2.")
@click.option(
    "--hardening-ratio",
    type=float,
    default=0.0,
    show_default=True,
    metavar="X",
    help="Stiffness after yield over stiffness before; negative softens.",
)
@click.option(
    "-o",
    "--output",
    default="spectra.nc",
    show_default=True,
    metavar="FILE",
    help="A .nc or .csv file, or a picture: .png, .pdf, .svg.",
)
@force_option
def spectra(
    records: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    periods: list[float],
    damping_ratio: float,
    ductility: list[float] | None,
    reduction_factor: list[float] | None,
    strength: list[float] | None,
    hardening_ratio: float,
    output: str,
    force: bool,
) -> None:
    """Compute response spectra: elastic ones, or those of a spring that yields.

    Without records, of the study's nine. Without --ductility, --reduction-factor or --strength, elastic
    spectra. Peaks are those of the continuous motion, free vibration after the record included.
    """
    from fdspec.runs.inelastic_spectra import inelastic_spectra
    from fdspec.runs.study_records import STUDY_RECORDS, find_record
    from fdspec.signals.spectra import elastic_spectra

    path = free(output, force=force, suffixes=(".nc", ".csv", *PICTURES))
    if not records and (units or dt or channel):
        raise click.UsageError("--units, --dt and --channel tell about a file: name one")
    motions = [
        find_record(record, scaled=not raw)
        for record in named_records(records or STUDY_RECORDS, units, dt, channel)
    ]
    inelastic = any(values is not None for values in (ductility, reduction_factor, strength))
    if inelastic:
        found = inelastic_spectra(
            motions,
            periods,
            damping_ratio=damping_ratio,
            hardening_ratio=hardening_ratio,
            ductility=ductility,
            reduction_factor=reduction_factor,
            strength=strength,
            progress=True,
        )
    else:
        if hardening_ratio != 0.0:
            raise click.UsageError("--hardening-ratio needs --ductility, --reduction-factor or --strength")
        found = elastic_spectra(motions, periods, damping_ratio, after="peak")
    write_table_or_picture(found, path, inelastic=inelastic)
    echo(f"{path}")


def write_table_or_picture(found: xr.Dataset, path: Path, *, inelastic: bool) -> None:
    """Write spectra in the form that the name asks for."""
    from fdspec import store
    from fdspec.figures import plot_spectra
    from fdspec.figures.inelastic import plot_inelastic_spectra
    from fdspec.store.replacing import replacing

    suffix = path.suffix.lower()
    if suffix == ".nc":
        store.save(found, path)
    elif suffix == ".csv":
        wanted = [name for name in found.data_vars if "root" not in found[name].dims]
        table = found[wanted].reset_coords(drop=True).to_dataframe().reset_index()
        with replacing(path, suffixes=(".csv",)) as part:
            table.to_csv(part, index=False, lineterminator="\n")
    else:
        save_picture(plot_inelastic_spectra(found) if inelastic else plot_spectra(found), path)
