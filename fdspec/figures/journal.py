"""Peak acceleration of one record as a journal prints it: maps or surfaces alone, at its columns' width."""

from __future__ import annotations

import math
from string import ascii_lowercase
from typing import TYPE_CHECKING, Final

from fdspec.errors import InvalidInput
from fdspec.figures.acceleration import of_record
from fdspec.figures.page import Figure
from fdspec.figures.panels import SMALL, at, draw_map, draw_scale, draw_surface
from fdspec.figures.surfaces import panels_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

MM: Final = 1.0 / 25.4

NARROWEST, WIDEST = 60.0, 400.0
"""mm."""

KINDS: Final = ("maps", "surfaces")

LEFT, RIGHT, GAP = 0.57, 0.72, 0.57
"""Margins and room between maps, in: numbers and names of axes at 7 pt need so much."""

LEAST: Final = 1.15
"""Width of a panel, in, that can be read."""


def plot_acceleration_print(
    cube: xr.Dataset,
    record: str,
    *,
    width: float = 180.0,
    kind: str = "maps",
    stiffness_ratios: Sequence[float] | None = None,
) -> Figure:
    """Draw the panels of `plot_acceleration` for print: no title, no caption, letters of 7 points.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    record : str
    width : float, mm
        Of the printed figure: 85 to 90 is usual for one column, 170 to 190 for two.
    kind : {"maps", "surfaces"}
    stiffness_ratios : sequence of float, optional
        As for `plot_acceleration`.

    Returns
    -------
    matplotlib.figure.Figure
        Panels (a), (b) and so on with one scale of colours; 600 dots per inch.

    Raises
    ------
    InvalidInput
        When the cube does not hold what is to be drawn, or for a width or kind that cannot be.
    """
    if kind not in KINDS:
        raise InvalidInput(f"kind must be one of {', '.join(KINDS)}, not {kind!r}")
    if not NARROWEST <= width <= WIDEST:
        raise InvalidInput(f"width must be from {NARROWEST:g} to {WIDEST:g} mm, got {width:g}")
    data = of_record(cube, record)
    panels = panels_of(data, stiffness_ratios)
    wide = width * MM
    gap = GAP if kind == "maps" else 0.12
    left = LEFT if kind == "maps" else 0.05
    columns = max(1, min(3, len(panels), int((wide - left - RIGHT + gap) / (LEAST + gap))))
    across = (wide - left - RIGHT - (columns - 1) * gap) / columns
    shape = 0.5 if columns == 1 else 0.78
    high = shape * across if kind == "maps" else 0.92 * across
    step = high + (0.90 if kind == "maps" else 0.34)
    rows = math.ceil(len(panels) / columns)
    figure = Figure(figsize=(wide, rows * step + 0.05), dpi=600)
    figure.set_label(f"Peak absolute acceleration of the floor, record {record}")
    for place, k in enumerate(panels):
        row, column = divmod(place, columns)
        x, bottom = left + column * (across + gap), (rows - 1 - row) * step
        if kind == "maps":
            draw_map(at(figure, x, bottom + 0.50, across, high), data, k, -0.44 / high)
        else:
            space = at(figure, x, bottom + 0.12, across, high, projection="3d")
            draw_surface(space, data, k)
            space.set_box_aspect((4, 4, 3), zoom=0.98)
        figure.text(
            x / wide,
            (bottom + step - 0.07) / (rows * step + 0.05),
            f"({ascii_lowercase[place]}) SR = {data.stiffness_ratio[k]:g}",
            fontsize=SMALL + 1,
            va="center",
        )
    bar = min(rows * step - 0.5, 3.2)
    draw_scale(figure, data, wide - RIGHT + 0.10, 0.5 * (rows * step - bar), bar)
    return figure
