"""A chart to choose by: acceleration over slip force in units of floor mass and ground peak."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib import colormaps
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from fdspec.errors import InvalidInput
from fdspec.figures.acceleration import told_parameters
from fdspec.figures.caption import add_caption
from fdspec.figures.page import Figure

if TYPE_CHECKING:
    import xarray as xr

COLUMNS: Final = 3

SHADES: Final = "viridis"

SHADED: Final = 0.5
"""s; the period whose spread over the records is shown is the nearest to it."""


def plot_chart(cube: xr.Dataset, *, title: str | None = None, caption: str = "") -> Figure:
    """Draw peak acceleration over PGA against slip force over floor mass times PGA.

    Divided so, the numbers hold for any floor mass and any loudness of the ground: the equations of motion
    know the slip force only as F / (m PGA).

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns for records that all have one PGA; few periods make a clear chart.
    title, caption : str
    Returns
    -------
    matplotlib.figure.Figure
        A line a period, the median over the records, with a dot at the least of it; for the period nearest
        0.5 s also the band from the 16th to the 84th percentile of the records.

    Raises
    ------
    InvalidInput
        When the records differ in PGA, or the cube does not tell its floor mass.
    """
    mass = told_parameters(cube).get("floor_mass")
    if not isinstance(mass, int | float):
        raise InvalidInput("the cube does not tell its floor_mass; make it with fdspec.sweep")
    pga = cube["pga"].values
    if not np.allclose(pga, pga[0], rtol=1e-9):
        raise InvalidInput("a chart needs records of one PGA; scale them with GroundMotion.scaled_to_pga")
    share = cube["slip_force"].values / (mass * pga[0])
    peak = cube["peak_acceleration"].where(cube["status"] == 0) / pga[0]
    values = peak.transpose("stiffness_ratio", "period", "record", "pretension").values
    count = cube.sizes["stiffness_ratio"]
    columns = min(COLUMNS, count)
    rows = math.ceil(count / columns)
    figure = Figure(figsize=(1.6 + 2.75 * columns, 1.1 + 2.35 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axis in axes.flat[count:]:
        axis.remove()
    periods = cube["period"].values
    shaded = int(np.abs(periods - SHADED).argmin())
    # Beyond what the bare frame does no pretension is of use.
    top = 1.25 * float(np.nanmax(np.quantile(values[:, :, :, 0], 0.84, axis=2)))
    colours = colormaps[SHADES](np.linspace(0.0, 0.88, periods.size))
    for k, axis in enumerate(axes.flat[:count]):
        for t, period in enumerate(periods):
            line = np.median(values[k, t], axis=0)
            axis.plot(share, line, color=colours[t], linewidth=1.3, label=f"{period:g} s")
            best = int(np.nanargmin(line))
            axis.plot(
                share[best],
                line[best],
                "o",
                color=colours[t],
                markersize=4,
                markeredgecolor="white",
                zorder=5,
            )
        low, high = np.quantile(values[k, shaded], [0.16, 0.84], axis=0)
        axis.fill_between(share, low, high, color=colours[shaded], alpha=0.18, linewidth=0)
        axis.set_xscale("log")
        axis.set_xlim(share[0], share[-1])
        axis.set_ylim(0.0, top)
        axis.xaxis.set_major_locator(FixedLocator([0.03, 0.1, 0.3, 1.0, 3.0]))
        axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.axhline(1.0, color="0.4", linewidth=0.6, linestyle="--", zorder=1)
        axis.grid(visible=True, color="0.92", linewidth=0.5)
        axis.set_title(
            f"SR = {cube['stiffness_ratio'].values[k]:g}", loc="left", fontsize="medium", fontweight="bold"
        )
    figure.supxlabel("slip force over floor mass times PGA, $F / (m_f\\,PGA)$", fontsize="medium")
    figure.supylabel("peak acceleration over PGA", fontsize="medium")
    figure.legend(
        *axes.flat[0].get_legend_handles_labels(), loc="outside right center", frameon=False, title="period"
    )
    if title:
        figure.suptitle(title, fontsize="medium")
    if caption:
        figure.supxlabel("")
        for axis in axes[-1]:
            axis.set_xlabel("$F / (m_f\\,PGA)$")
        add_caption(figure, caption)
    return figure
