"""Peak acceleration of one record as maps that can be read off, every stiffness ratio of a cube."""

from __future__ import annotations

import math
import textwrap
from typing import TYPE_CHECKING, Final

from fdspec.figures.acceleration import of_record
from fdspec.figures.page import Figure
from fdspec.figures.panels import at, draw_map, draw_scale

if TYPE_CHECKING:
    import xarray as xr

COLUMNS: Final = 4

LEFT, RIGHT, BOTTOM, STEP, ACROSS = 0.75, 0.75, 0.3, 2.55, 2.65
"""Margins, height and width of a panel with its labels, in."""

MAP, TALL = 2.05, 1.6
"""Width and height of a map, in."""

HATCHED: Final = "#21918c"
"""Of the middle of the colours."""

LINE: Final = 0.19
"""Height of a title's line, in."""

LETTERS_PER_INCH: Final = 11
"""Of matplotlib's own font at the title's size, less a margin."""


def plot_acceleration_maps(cube: xr.Dataset, record: str) -> Figure:
    """Draw peak absolute acceleration over period and pretension, one map a stiffness ratio.

    The colours mean the same in all panels. Strips below and above each map are the limits, the damper that
    slides without friction (free) and the one that never slips (braced); the line marks the pretension with
    the smallest acceleration at each period.

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
    count = data.stiffness_ratio.size
    rows = math.ceil(count / COLUMNS)
    columns = math.ceil(count / rows)
    width = LEFT + columns * ACROSS + RIGHT
    lines = [f"Peak absolute acceleration of the floor, record {record}", *data.words]
    title = [
        part
        for line in lines
        for part in textwrap.wrap(line, int(LETTERS_PER_INCH * width), break_on_hyphens=False)
    ]
    top = 0.2 + LINE * len(title)
    room = BOTTOM if columns > 2 else BOTTOM + LINE  # for line and hatching in one row, or in two
    tall = room + rows * STEP + top
    figure = Figure(figsize=(width, tall), dpi=150)
    for k in range(count):
        row, column = divmod(k, columns)
        bottom = room + (rows - 1 - row) * STEP
        axis = at(figure, LEFT + column * ACROSS, bottom + 0.5, MAP, TALL)
        draw_map(axis, data, k)
        axis.set_title(f"stiffness ratio {data.stiffness_ratio[k]:g}", fontsize=9, pad=18)
    high = min(rows * STEP - 0.5, 4.5)
    draw_scale(figure, data, width - RIGHT + 0.05, room + 0.5 * (rows * STEP - high), high)
    figure.suptitle("\n".join(title), y=1.0 - 0.1 / tall, fontsize=10, va="top")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    across = 2 if columns > 2 else 1
    # White hatching needs a ground to be seen on.
    legend = figure.legend(handles, labels, loc="lower center", frameon=False, fontsize=9, ncols=across)
    for patch in legend.get_patches():
        patch.set_facecolor(HATCHED)
    return figure
