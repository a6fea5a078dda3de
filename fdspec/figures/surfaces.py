"""Peak acceleration of one record as the study's Figures 10 to 18 have it, each surface beside its map."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.acceleration import Acceleration, FloatArray, of_record
from fdspec.figures.caption import SIZE, height, wrapped
from fdspec.figures.page import Figure
from fdspec.figures.panels import BAND, BEST, HEIGHT, SMALL, at, draw_map, draw_scale, draw_surface

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

STUDY_PANELS: Final = (0.5, 1.0, 2.0, 4.0, 8.0, 10.0)
"""Stiffness ratios that the study shows; it computed 6 as well."""

PAIRS: Final = 2
"""Panels in a row, each a surface and a map."""

SURFACE, MAP, TALL = 2.4, 1.95, 1.5
"""Width of a surface, width and height of a map, in."""

LEFT, BETWEEN, APART, RIGHT, TOP, STEP = 0.2, 0.5, 0.24, 0.88, 0.36, 2.3
"""Margins and the height of a row, in: the whole fits A4 across."""


def plot_acceleration(
    cube: xr.Dataset,
    record: str,
    *,
    stiffness_ratios: Sequence[float] | None = None,
    title: str | None = None,
    caption: str = "",
) -> Figure:
    """Draw peak absolute acceleration over period and pretension: a surface and a map a stiffness ratio.

    Height and colour mean the same in all panels. Strips below and above each map are the limits, the damper
    that slides without friction (free) and the one that never slips (braced); the line on a map marks the
    pretension with the smallest acceleration at each period among the cube's, and hatching what is within
    5 % of it. Where the cube spans much, pretension is drawn on a logarithmic axis, in both: the response
    changes below a fifth of the study's largest, and a linear axis would leave it no room.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    record : str
        Name of one of its records.
    stiffness_ratios : sequence of float, optional
        The panels; those of the study's figures that the cube has, or else all of the cube's.
    title : str, optional
        The first line, by default what is drawn and under which record.
    caption : str
        Words below the picture, such as `acceleration_caption`.

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
    panels = panels_of(data, stiffness_ratios)
    rows = math.ceil(len(panels) / PAIRS)
    across = min(PAIRS, len(panels))
    width = LEFT + across * (SURFACE + BETWEEN + MAP) + (across - 1) * APART + RIGHT
    below = height(caption, width) + 0.12
    tall = TOP + rows * STEP + below
    figure = Figure(figsize=(width, tall), dpi=150)
    for place, k in enumerate(panels):
        row, column = divmod(place, PAIRS)
        left = LEFT + column * (SURFACE + BETWEEN + MAP + APART)
        bottom = below + (rows - 1 - row) * STEP
        space = at(figure, left, bottom + 0.02, SURFACE, STEP - 0.14, projection="3d")
        draw_surface(space, data, k)
        space.set_box_aspect((4, 4, 3), zoom=1.08)
        draw_map(at(figure, left + SURFACE + BETWEEN, bottom + 0.45, MAP, TALL), data, k)
        line = (bottom + STEP - 0.16) / tall
        name = f"SR = {data.stiffness_ratio[k]:g}"
        figure.text((left - 0.08) / width, line, name, fontsize=9.5, fontweight="bold", va="center")
        figure.text((left + 0.85) / width, line, HEIGHT, fontsize=SMALL, va="center")
    high = min(rows * STEP - 0.5, 4.5)
    draw_scale(figure, data, width - 0.66, below + 0.5 * (rows * STEP - high), high)
    heading = title or f"Peak absolute acceleration of the floor, record {record}"
    figure.suptitle(heading, x=0.5, y=1.0 - 0.2 / tall, fontsize=11, va="center")
    if caption:
        figure.text(
            0.15 / width, 0.1 / tall, wrapped(caption, width), fontsize=SIZE, va="bottom", linespacing=1.3
        )
    return figure


def panels_of(
    data: Acceleration, wanted: Sequence[float] | None, usual: Sequence[float] | FloatArray = STUDY_PANELS
) -> list[int]:
    """Return the indices of the stiffness ratios to draw, the usual ones unless some are wanted."""
    ratios = data.stiffness_ratio
    if wanted is None:
        shown = [k for k, ratio in enumerate(ratios) if np.isclose(ratio, usual).any()]
        return shown or list(range(ratios.size))
    found = [np.flatnonzero(np.isclose(ratios, ratio)) for ratio in wanted]
    for ratio, places in zip(wanted, found, strict=True):
        if places.size == 0:
            have = ", ".join(f"{one:g}" for one in ratios)
            raise InvalidInput(f"the cube has no stiffness_ratio {ratio:g}; it has {have}")
    if not found:
        raise InvalidInput("stiffness_ratios must name one or more, not none")
    return [int(places[0]) for places in found]


def acceleration_caption(cube: xr.Dataset, record: str, *, pretensions: int | None = None) -> str:
    """Return the words below `plot_acceleration`: what is drawn, with which record, and of which frame.

    `pretensions` is how many the picture was computed at; the cube's unless given.
    """
    data = of_record(cube, record)
    frame = f" Frame: {data.frame}." if data.frame else ""
    used = "; ".join(data.words)
    count = pretensions or data.pretension.size
    return (
        f"Peak absolute acceleration of the floor at different pretension forces, ground motion {record}"
        f"{f' ({used})' if used else ''}.{frame} SR: stiffness of the brace over that of the frame. Left of "
        f"each pair the surface, right the same as a map; line: {BEST}, of the {count} "
        f"computed; hatched: {BAND}; strips: the damper that "
        "slides without friction (free) and the one that never slips (braced)."
    )
