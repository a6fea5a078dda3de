"""`fdspec records show`."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import PICTURES, force_option, free, save_picture
from fdspec.cli.record_options import AboutFile, reading_options, record_about
from fdspec.errors import RecordError
from fdspec.printable import in_words, rounded

if TYPE_CHECKING:
    from fdspec.model.motion import GroundMotion
    from fdspec.records import CatalogueEntry

DAMPING: Final = (0.02, 0.05, 0.10)
"""Damping ratios of the picture's spectra."""

LABELS: Final = {
    "study_pga_g": ("PGA in the study", "g"),
    "study_duration_s": ("duration in the study", "s"),
    "vs30_m_per_s": ("shear wave velocity, upper 30 m", "m/s"),
    "pga_g": ("PGA", "g"),
    "pgv_m_per_s": ("PGV", "m/s"),
    "pgd_m": ("PGD", "m"),
    "arias_m_per_s": ("Arias intensity", "m/s"),
    "significant_duration_s": ("significant duration", "s"),
    "cav_m_per_s": ("cumulative absolute velocity", "m/s"),
    "dt_s": ("time step", "s"),
    "duration_s": ("duration", "s"),
}
"""Name in JSON -> words and unit for people; names that are words already are left out."""


@click.command("show")
@click.argument("record", metavar="NAME|FILE")
@reading_options
@click.option("--raw", is_flag=True, help="As recorded, not scaled to the study's PGA.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
@click.option(
    "--figure",
    metavar="FILE",
    help="A picture too: history, Husid plot and elastic spectra; .png, .pdf or .svg.",
)
@force_option
def show_record(
    record: str,
    about: AboutFile,
    raw: bool,
    as_json: bool,
    figure: str | None,
    force: bool,
) -> None:
    """Show what is known of one record, of the catalogue or in a file: origin, numbers, what was done to it.

    Of a file it says too what each column and each statement of the header was taken for, also when the
    file is refused.

    PGV and PGD are integrated from rest without correction; the significant duration is from 5 to 95 % of the
    Arias intensity.
    """
    picture = None if figure is None else free(figure, force=force, suffixes=PICTURES)

    from fdspec.records import catalogue
    from fdspec.runs.study_records import find_record, is_catalogued
    from fdspec.units import G

    named = record_about(record, about)
    taken = [] if is_catalogued(record) or not Path(record).is_file() else _taken(record, about, as_json)
    motion = find_record(named, scaled=not raw)
    shown: dict[str, object] = {
        "name": motion.name,
        "event": motion.event,
        "station": motion.station,
        "component": motion.component,
        "source": motion.source,
    }
    for entry in catalogue():
        if isinstance(named, str) and named.upper() == entry.name:
            shown |= _catalogued(entry)
    shown |= {"pga_g": motion.pga / G, **_intensity(motion)}
    shown |= {
        "scale_factor": motion.scale_factor,
        "dt_s": motion.dt,
        "samples": motion.n,
        "duration_s": motion.duration,
        "history": list(motion.history),
        "checksum": motion.checksum,
    }
    if taken:
        shown["taken_for"] = taken
    if picture is not None:
        _draw(motion, picture)
        shown["figure"] = str(picture)
    echo(json.dumps(shown, indent=2) if as_json else _lines(shown))


def _catalogued(entry: CatalogueEntry) -> dict[str, object]:
    """Return what the study says of its record, and what stands under the name here."""
    from fdspec.records.links import linked

    link = linked(entry.name)
    study = {
        "soil": entry.soil,
        "magnitude": entry.magnitude,
        "study_pga_g": entry.pga_g,
        "study_duration_s": entry.duration,
    }
    if link is not None:
        return {**study, "file": str(link.path)}
    stand_in = entry.stand_in
    return {
        **study,
        "site_class": stand_in.site_class,
        "vs30_m_per_s": stand_in.vs30,
        "file": str(stand_in.path),
    }


def _intensity(motion: GroundMotion) -> dict[str, object]:
    """Return the intensity measures; none of a motion that is zero throughout, which has no duration."""
    from fdspec.signals.intensity import intensity

    if motion.pga == 0.0:
        return {}
    found = intensity(motion)
    return {
        "pgv_m_per_s": found.pgv,
        "pgd_m": found.pgd,
        "arias_m_per_s": found.arias,
        "significant_duration_s": found.significant_duration,
        "cav_m_per_s": found.cav,
    }


def _draw(motion: GroundMotion, path: Path) -> None:
    from fdspec.cli.record_spectra import drawn_spectra
    from fdspec.figures import plot_record

    save_picture(plot_record(motion, drawn_spectra([motion], DAMPING)), path)


def _taken(record: str, about: AboutFile, as_json: bool) -> list[str]:
    """Return what each column and header of a file is taken for; of a refused one, print what was."""
    from fdspec.records.reading import read_file

    options = {key: value for key, value in about.given.items() if key not in {"channel", "name"}}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # they are given when the motion is read
            reading = read_file(record, **options)
    except RecordError as error:
        notes = getattr(error, "__notes__", [])
        if notes and not as_json:
            echo(_lines({"taken_for": notes}))
        raise
    if about.channel is None and len(reading.motions) > 1 and not as_json:
        echo(_lines({"taken_for": list(reading.taken)}))
    return list(reading.taken)


def _lines(shown: dict[str, object]) -> str:
    """Return a line for each thing that is known, its unit behind it."""
    told = []
    width = max(len(_label(key)) for key in shown)
    for key, value in shown.items():
        lines = _written(key, value)
        told += [
            f"{head:<{width}}  {line}".rstrip()
            for head, line in zip([_label(key), *[""] * len(lines)], lines, strict=False)
        ]
    return "\n".join(told)


def _label(key: str) -> str:
    return LABELS[key][0] if key in LABELS else in_words(key)


def _written(key: str, value: object) -> list[str]:
    if isinstance(value, list):
        # What a file says of itself is quoted as it stands; the steps of a history carry every digit.
        return [rounded(line) if key == "history" else line for line in value]
    number = f"{value:.6g}" if isinstance(value, float) else f"{value}"
    return [f"{number} {LABELS[key][1]}" if key in LABELS else number]
