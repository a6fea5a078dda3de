"""`fdspec records figures`."""

from __future__ import annotations

from typing import Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import force_option, free, made_folder, save_picture
from fdspec.cli.record_options import RecordsOption, file_options, named_records

DAMPING: Final = 0.05
"""Of the frames in the study; it does not print that of its spectra."""


@click.command("figures")
@click.option(
    "-o", "--output", default="figures", show_default=True, metavar="DIR", help="Folder; made if absent."
)
@click.option(
    "--record",
    "records",
    cls=RecordsOption,
    multiple=True,
    metavar="NAME|FILE",
    help="A record of the catalogue or a file; repeat it.  [default: the study's nine]",
)
@file_options
@click.option("--raw", is_flag=True, help="The catalogue's as recorded, not scaled to the study's PGA.")
@click.option(
    "--damping-ratio", type=float, default=DAMPING, show_default=True, metavar="X", help="Of the spectra."
)
@click.option("--format", "kind", type=click.Choice(["png", "pdf", "svg"]), default="png", show_default=True)
@force_option
def draw_records(
    output: str,
    records: tuple[str, ...],
    units: str | None,
    dt: float | None,
    channel: str | None,
    raw: bool,
    damping_ratio: float,
    kind: str,
    force: bool,
) -> None:
    """Draw records together: histories, and elastic acceleration spectra with their mean.

    For the nine these are the study's Figures 8 and 9. Prints the name of each picture.
    """
    if not records and (units or dt or channel):
        raise click.UsageError("--units, --dt and --channel tell about a file named with --record")

    from fdspec.cli.record_spectra import drawn_spectra
    from fdspec.figures import plot_histories, plot_spectra
    from fdspec.runs.study_records import STUDY_RECORDS, find_record
    from fdspec.store.provenance import origins

    folder = made_folder(output)
    paths = [folder / f"records-{what}.{kind}" for what in ("histories", "spectra")]
    for path in paths:
        free(path, force=force, suffixes=(f".{kind}",))
    named = named_records(records or STUDY_RECORDS, units, dt, channel)
    motions = [find_record(record, scaled=not raw) for record in named]
    note = origins(motions)
    spectra = drawn_spectra(motions, [damping_ratio])
    pictures = plot_histories(motions, note=note), plot_spectra(spectra, note=note)
    for picture, path in zip(pictures, paths, strict=True):
        save_picture(picture, path)
    echo("\n".join(map(str, paths)))
