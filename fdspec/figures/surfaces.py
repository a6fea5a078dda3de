"""Peak acceleration as surfaces in space, as the study draws it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from fdspec.figures.acceleration import COLOURS, of_record

if TYPE_CHECKING:
    import xarray as xr


def plot_acceleration_surfaces(cube: xr.Dataset, record: str) -> Figure:
    """Draw peak absolute acceleration over period and pretension, one surface a stiffness ratio.

    Colour and height mean the same in all panels; maps are easier to read off.

    Parameters, result and errors are those of `plot_acceleration_maps`.
    """
    data = of_record(cube, record)
    rows, columns = data.panels
    width = max(6.5, 1.2 + 2.8 * columns)
    figure = Figure(figsize=(width, 1.0 + 2.8 * rows), layout="constrained", dpi=150)
    scale = Normalize(0.0, data.levels[-1])
    period, pretension = np.meshgrid(data.period, data.pretension)
    for index, (ratio, peak) in enumerate(zip(data.stiffness_ratio, data.peak, strict=True)):
        axis = figure.add_subplot(rows, columns, index + 1, projection="3d")
        axis.plot_surface(
            period,
            pretension,
            peak,
            cmap=COLOURS,
            norm=scale,
            rcount=100,
            ccount=100,
            linewidth=0.1,
            edgecolor="0.3",
        )
        axis.set_zlim(0.0, data.levels[-1])
        axis.set_xlabel("period, s", fontsize="small", labelpad=-4)
        axis.set_ylabel("pretension, kN", fontsize="small", labelpad=-2)
        axis.set_title(f"stiffness ratio {ratio:g}", fontsize="medium", y=0.96)
        axis.tick_params(labelsize="x-small", pad=-2)
        axis.zaxis.set_major_locator(MaxNLocator(5))
        axis.view_init(elev=28, azim=-125)
        axis.set_box_aspect(None, zoom=0.9)
    figure.suptitle(data.wrapped_title(width), fontsize="medium")
    mappable = ScalarMappable(norm=scale, cmap=COLOURS)
    figure.colorbar(
        mappable, ax=figure.axes, label="height: peak absolute acceleration, g", aspect=35, pad=0.04
    )
    return figure
