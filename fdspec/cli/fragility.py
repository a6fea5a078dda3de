"""`fdspec fragility`: the probability that a demand exceeds its limit, and its annual rate."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from fdspec.cli.echo import echo
from fdspec.cli.output import PICTURES, force_option, free, save_picture
from fdspec.cli.select_option import selected
from fdspec.cli.table import table as aligned
from fdspec.printable import in_words

if TYPE_CHECKING:
    import xarray as xr

LABELS: Final = {
    "median_error": "error of ln median",
    "dispersion_error": "error of dispersion",
    "annual_rate": "rate a year",
    "probability_50_years": "in 50 years",
}
"""Variable -> head of its column, where its name does not do."""


@click.command()
@click.argument("cube", metavar="CUBE.nc")
@click.option("--demand", required=True, metavar="NAME", help="A variable of the cube, such as peak_drift.")
@click.option("--limit", required=True, type=float, metavar="X", help="Its limit, in the variable's units.")
@click.option(
    "--measure",
    metavar="NAME",
    help="A variable of each record, such as pga, to multiply the intensity with.",
)
@click.option(
    "--at", "chosen", multiple=True, metavar="DIM=VALUE", help="Select along a dim of the cube; repeat it."
)
@click.option("--hazard", metavar="FILE.csv", help="Hazard curve, intensity and annual rate: gives the risk.")
@click.option("-o", "--output", metavar="FILE", help="A .nc or .csv file, or a picture: .png, .pdf, .svg.")
@force_option
def fragility(
    cube: str,
    demand: str,
    limit: float,
    measure: str | None,
    chosen: tuple[str, ...],
    hazard: str | None,
    output: str | None,
    force: bool,
) -> None:
    """Fit a lognormal fragility curve to a cube over intensity.

    Prints median and dispersion with their standard errors, and with --hazard the annual rate and its
    deaggregation over intensity, for every frame that the cube holds beside record and intensity.
    """
    from fdspec import store
    from fdspec.figures.inelastic import plot_fragility
    from fdspec.measures.fragility import fragility as fit_of
    from fdspec.measures.risk import read_hazard, risk

    path = None if output is None else free(output, force=force, suffixes=(".nc", ".csv", *PICTURES))
    curve = None if hazard is None else read_hazard(hazard)
    opened = store.open(cube)
    for choice in chosen:
        opened = selected(opened, choice)
    fit = fit_of(opened, demand=demand, limit=limit, measure=measure)
    shown = fit[["median", "dispersion", "median_error", "dispersion_error"]]
    rates = None if curve is None else risk(fit, curve)
    if rates is not None:
        shown = shown.merge(rates[["annual_rate", "probability_50_years"]])
        fit = fit.merge(rates, combine_attrs="override")
    frame = shown.reset_coords(drop=True).expand_dims("curve").to_dataframe()
    table = frame.reset_index().drop(columns="curve")
    echo(_for_people(table, shown))
    if rates is not None and rates["annual_rate"].size == 1:
        echo(f"\n{_segments(rates)}")
    if path is None:
        return
    if path.suffix.lower() in PICTURES:
        save_picture(plot_fragility(fit), path)
    else:
        _write(fit, table, path)
    echo(f"{path}")


def _for_people(numbers: Any, shown: xr.Dataset) -> str:
    """Return a line for each frame, words and units above it."""
    head = [LABELS.get(str(name), in_words(str(name))) for name in numbers.columns]
    for k, name in enumerate(map(str, numbers.columns)):
        unit = str(shown[name].attrs.get("units", "1"))
        head[k] += "" if unit in ("1", "") or name in LABELS else f" {unit}"
    rows = [
        [f"{value:.4g}" if isinstance(value, float) else str(value) for value in row]
        for row in numbers.itertuples(index=False)
    ]
    return aligned(head, rows)


def _segments(rates: xr.Dataset) -> str:
    """Return which intensities the rate comes from."""
    rows = [
        [f"{row.segment_from:.4g}", f"{row.segment_to:.4g}", f"{100.0 * row.deaggregation:.1f} %"]
        for _, row in rates["deaggregation"].squeeze().to_dataframe().iterrows()
    ]
    return aligned(["intensity from", "to", "share of the rate"], rows)


def _write(fit: xr.Dataset, table: Any, path: Path) -> None:
    from fdspec.store.replacing import replacing

    with replacing(path, suffixes=(path.suffix,)) as part:
        if path.suffix.lower() == ".csv":
            table.to_csv(part, index=False, lineterminator="\n")
        else:
            fit.to_netcdf(part)
