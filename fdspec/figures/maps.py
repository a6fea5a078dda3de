"""Peak acceleration as maps that can be read off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fdspec.figures.acceleration import COLOURS, of_record

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]


def plot_acceleration_maps(cube: xr.Dataset, record: str) -> Figure:
    """Draw peak absolute acceleration over period and pretension, one map a stiffness ratio.

    The colours mean the same in all panels. A dot at each period marks the pretension with the smallest
    acceleration.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    record : str
        Name of one of its records.

    Returns
    -------
    matplotlib.figure.Figure
        Period in s, pretension in kN, acceleration in g.

    Raises
    ------
    InvalidInput
        When the cube does not hold what is to be drawn.
    """
    data = of_record(cube, record)
    rows, columns = data.panels
    width = max(6.5, 1.1 + 2.5 * columns)
    figure = Figure(figsize=(width, 2.0 + 2.2 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axis in axes.flat[data.stiffness_ratio.size :]:
        axis.remove()
    for axis, ratio, peak in zip(axes.flat, data.stiffness_ratio, data.peak, strict=False):
        masked = np.ma.masked_invalid(peak)
        axis.contourf(data.period, data.pretension, masked, levels=data.levels, cmap=COLOURS)
        axis.contour(data.period, data.pretension, masked, levels=data.levels, colors="white", linewidths=0.3)
        _mark_best(axis, data.period, data.pretension, peak)
        axis.set_title(f"stiffness ratio {ratio:g}", fontsize="medium")
    for axis in axes.flat[: data.stiffness_ratio.size]:
        place = axis.get_subplotspec()
        if place.is_first_col():
            axis.set_ylabel("pretension, kN")
        if place.is_last_row() or axes[-1, place.colspan.start].figure is None:
            axis.set_xlabel("period without brace, s")
            axis.tick_params(labelbottom=True)
    figure.suptitle(data.wrapped_title(width), fontsize="medium")
    colours = ScalarMappable(BoundaryNorm(data.levels, 256), COLOURS)
    figure.colorbar(
        colours, ax=figure.axes, label="peak absolute acceleration, g", ticks=data.levels[::2], aspect=35
    )
    figure.legend(
        *axes[0, 0].get_legend_handles_labels(), loc="outside lower center", frameon=False, markerscale=2
    )
    return figure


def _mark_best(axis: Axes, period: FloatArray, pretension: FloatArray, peak: FloatArray) -> None:
    """Put a dot at each period where acceleration is smallest; dots on the edge stay whole."""
    known = np.isfinite(peak).any(axis=0)
    best = pretension[np.argmin(np.where(np.isnan(peak), np.inf, peak), axis=0)]
    axis.plot(
        period[known],
        best[known],
        linestyle="none",
        marker="o",
        markersize=2.5,
        markerfacecolor="white",
        markeredgecolor="black",
        markeredgewidth=0.4,
        clip_on=False,
        zorder=5,
        label="pretension of the smallest acceleration at each period",
    )
