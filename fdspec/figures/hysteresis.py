"""Hysteresis loops: the friction force of each damper over its slip."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from fdspec.figures.page import Figure
from fdspec.figures.storeys import FLOOR, draw_limits, title_of
from fdspec.measures import hysteresis

if TYPE_CHECKING:
    import xarray as xr

COLUMNS: Final = 4


def plot_hysteresis(history: xr.Dataset) -> Figure:
    """Draw friction force over slip, a panel a storey; a loop's area is the energy that it burns.

    Parameters
    ----------
    history : xarray.Dataset
        What `fdspec.simulate` returns.

    Returns
    -------
    matplotlib.figure.Figure
        Friction force in kN over slip in mm on scales that all storeys share, the slip force dashed, and the
        energy that each damper burned in kJ.
    """
    storeys = [int(storey) for storey in history["storey"].values]
    columns = min(COLUMNS, len(storeys))
    rows = math.ceil(len(storeys) / columns)
    figure = Figure(figsize=(1.2 + 2.6 * max(columns, 2), 1.3 + 2.4 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for axis in axes.flat[len(storeys) :]:
        axis.remove()
    for k, (axis, storey) in enumerate(zip(axes.flat, storeys, strict=False)):
        one = history.sel(storey=storey)
        loop = hysteresis(history, storey)
        axis.plot(loop["slip"].values * 1e3, loop["force"].values / 1e3, color=FLOOR, linewidth=0.7)
        draw_limits(axis, one)
        burned = float(one["storey_friction_energy"].values[-1]) / 1e3
        axis.set_title(f"storey {storey}: {burned:.3g} kJ", fontsize="medium")
        if k % columns == 0:
            axis.set_ylabel("friction force, kN")
        if k + columns >= len(storeys):
            axis.set_xlabel("slip, floor less brace, mm")
            axis.tick_params(labelbottom=True)
    figure.suptitle(
        title_of(history, "Hysteresis under", letters=int(10.5 * figure.get_figwidth())), fontsize="medium"
    )
    return figure
