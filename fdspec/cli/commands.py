"""The group `fdspec` and the table of its commands."""

import click

from fdspec.cli.lazy import LazyGroup
from fdspec.version import __version__

COMMANDS = {
    "sweep": (
        "fdspec.cli.sweep:sweep",
        "Compute the cube of a study; without a file, the study of the nine records.",
    ),
    "simulate": (
        "fdspec.cli.simulate:simulate",
        "Compute the history of one frame or building under one record.",
    ),
    "choose": ("fdspec.cli.choose:choose", "Recommend a pretension, with its gain and its bounds."),
    "spectra": ("fdspec.cli.spectra:spectra", "Compute elastic and inelastic response spectra of records."),
    "fragility": (
        "fdspec.cli.fragility:fragility",
        "Fit the probability that a demand exceeds its limit, and its annual rate.",
    ),
    "records": ("fdspec.cli.records:records", "List, show, check, convert and draw ground motions."),
    "figures": ("fdspec.cli.figures:figures", "Draw the study's figures, or the profiles of buildings."),
    "claims": ("fdspec.cli.claims:claims", "Check the study's conclusions against a cube."),
    "verify": ("fdspec.cli.verify:verify", "Verify this installation: known answers beside computed ones."),
    "explore": ("fdspec.cli.explore:explore", "Show a cube in the browser, with histories at a click."),
    "export": (
        "fdspec.cli.export:export",
        "Write a cube for other programs (netCDF, CSV) or as a page (HTML).",
    ),
    "summary": ("fdspec.cli.summary:summary", "Sum up a cube over its records: median, percentiles, worst."),
    "combine": ("fdspec.cli.combine:combine", "Join cubes along records, or another dim."),
    "check": ("fdspec.cli.check:check_cube", "Verify a cube: schema, CF, checksums, statuses, energy."),
}


@click.group(
    cls=LazyGroup,
    lazy=COMMANDS,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(__version__, message="fdspec %(version)s")
def fdspec() -> None:
    """Compute the seismic response of buildings with friction dampers, exactly.

    Units are SI. Results go to stdout, progress, warnings and errors to stderr. Exit codes: 0 done, 1 failed,
    2 wrong usage or input, 130 interrupted.
    """
