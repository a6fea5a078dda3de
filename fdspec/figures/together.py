"""Many records in one picture: what they agree on, how far they differ, and the one pretension for all."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm

from fdspec.errors import InvalidInput
from fdspec.figures.acceleration import NEAR, Acceleration, FloatArray, band_of, of_record
from fdspec.figures.caption import SIZE, height, wrapped
from fdspec.figures.page import Figure
from fdspec.figures.panels import SMALL, at, draw_best, frame_map
from fdspec.figures.surfaces import panels_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr
    from matplotlib.axes import Axes

SIGNED: Final = "RdBu"
"""Two colours that part at zero, safe for colour-blind eyes."""

REDUCTION: Final = np.arange(-100.0, 100.1, 10.0)
"""Bounds of the colours, %: what is worse than twice the bare frame is nobody's choice."""

SPREAD: Final = np.arange(0.0, 100.1, 10.0)

GREY, WHITE = (0.25, 0.25, 0.25, 0.6), (1.0, 1.0, 1.0, 0.85)
"""Of the hatching, on light colours and on dark ones."""

PAIRS: Final = 2

NARROWEST: Final = 120.0
"""mm."""

MAP, TALL, STEP, LEFT, BETWEEN, APART, RIGHT, TOP = 1.9, 1.5, 2.2, 0.62, 0.55, 0.75, 1.5, 0.4
"""In."""


def plot_ensemble(
    cube: xr.Dataset,
    *,
    title: str | None = None,
    caption: str = "",
    width: float | None = None,
    stiffness_ratios: Sequence[float] | None = None,
) -> Figure:
    """Draw what dampers gain under all records of a cube together, and how far the records differ.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, of two records or more, with elastic_acceleration.
    title, caption : str
    width : float, mm, optional
        For print: one pair in a row at this width, without title and caption; 120 mm or more.
    stiffness_ratios : sequence of float, optional
        The panels; all of the cube's unless given.

    Returns
    -------
    matplotlib.figure.Figure
        For each stiffness ratio, over period (s) and pretension (kN): left the median over the records of
        the reduction of peak acceleration against the bare frame, %, white at zero and zero as a line; right
        the spread of that reduction, from the 16th to the 84th percentile of the records, in points of per
        cent. On both the one pretension whose mean over the records is least, and its 5 % band.

    Raises
    ------
    InvalidInput
        When the cube has fewer than two records, or not the variables.
    """
    if cube.sizes.get("record", 0) < 2:
        raise InvalidInput(f"an ensemble needs 2 records or more, the cube has {cube.sizes.get('record', 0)}")
    if "elastic_acceleration" not in cube:
        raise InvalidInput("the cube has no elastic_acceleration; sweep with it among the outputs")
    names = [str(name) for name in cube["record"].values]
    each = [of_record(cube, name) for name in names]
    data = each[0]
    shares = np.stack([one.peak / one.free for one in each])  # (records, n_sr, n_f, n_t)
    median = 100.0 * (1.0 - np.median(shares, axis=0))
    low, high = np.quantile(shares, [0.16, 0.84], axis=0)
    spread, mean = 100.0 * (high - low), shares.mean(axis=0)
    panels = panels_of(data, stiffness_ratios, data.stiffness_ratio)
    if width is not None and width < NARROWEST:
        raise InvalidInput(f"width must be {NARROWEST:g} mm or more, got {width:g}")
    in_row = min(PAIRS, len(panels)) if width is None else 1
    rows = math.ceil(len(panels) / in_row)
    size = MAP if width is None else 0.5 * (width / 25.4 - LEFT - RIGHT - BETWEEN)
    pair = 2.0 * size + BETWEEN
    wide = LEFT + in_row * pair + (in_row - 1) * APART + RIGHT
    below = height(caption, wide) + 0.12
    top = TOP if width is None else 0.05
    tall = top + rows * STEP + below
    figure = Figure(figsize=(wide, tall), dpi=150 if width is None else 600)
    figure.set_label(f"{len(names)} records together")
    for n, k in enumerate(panels):
        row, column = divmod(n, in_row)
        left, bottom = LEFT + column * (pair + APART), below + (rows - 1 - row) * STEP + 0.45
        best = _best_of(data, mean[k])
        band = band_of(data.period, data.pretension, mean[k], NEAR)
        for place, (values, levels, colours) in enumerate(
            ((median[k], REDUCTION, SIGNED), (spread[k], SPREAD, "cividis"))
        ):
            axis = at(figure, left + place * (size + BETWEEN), bottom, size, TALL)
            _draw(axis, data, values, levels, colours)
            draw_best(axis, best, band, GREY if place == 0 else WHITE)
            if place == 0:
                _zero(axis, data, values)
            else:
                axis.set_ylabel("")
        line = (bottom + TALL + 0.14) / tall
        ratio = f"SR = {data.stiffness_ratio[k]:g}"
        figure.text(left / wide, line, ratio, fontsize=9.0, fontweight="bold", va="center")
        for end, words in ((size, "median reduction"), (pair, "spread, 16 to 84 %")):
            figure.text((left + end) / wide, line, words, fontsize=SMALL, va="center", ha="right")
    tall_of = 0.46 * rows * STEP
    middle = below + 0.5 * rows * STEP
    label = "median reduction against bare frame, %"
    _scale(figure, wide, middle + 0.12, tall_of, REDUCTION, SIGNED, label, zero=True)
    _scale(figure, wide, middle - 0.12 - tall_of, tall_of, SPREAD, "cividis", "spread, points of %")
    if width is None:
        heading = title or f"{len(names)} records together: reduction of peak acceleration"
        figure.suptitle(heading, x=0.5, y=1.0 - 0.2 / tall, fontsize=11, va="center")
    if caption and width is None:
        figure.text(
            0.15 / wide, 0.1 / tall, wrapped(caption, wide), fontsize=SIZE, va="bottom", linespacing=1.3
        )
    return figure


def ensemble_caption(cube: xr.Dataset) -> str:
    """Return the words below `plot_ensemble`."""
    names = ", ".join(str(name) for name in cube["record"].values)
    frame = of_record(cube, str(cube["record"].values[0])).frame
    return (
        "Reduction of the peak absolute acceleration of the floor against the bare frame under "
        f"{names} together, by stiffness ratio SR. Left of each pair the median over the records, "
        "blue where dampers help, red "
        "where they harm, the line of zero in black; right how far the records differ, 84th less 16th "
        "percentile. Thick line: the one pretension with the least mean share of the bare frame's "
        f"acceleration; hatched: within 5 % of it.{f' Frame: {frame}.' if frame else ''}"
    )


def _best_of(data: Acceleration, mean: FloatArray) -> tuple[FloatArray, FloatArray]:
    known = np.isfinite(mean).any(axis=0)
    rows = np.argmin(np.where(np.isfinite(mean), mean, np.inf), axis=0)
    return data.period[known], data.pretension[rows[known]]


def _draw(axis: Axes, data: Acceleration, values: FloatArray, levels: FloatArray, colours: str) -> None:
    frame_map(axis, data, -0.22)
    filled = axis.contourf(
        data.period,
        data.pretension,
        np.ma.masked_invalid(np.clip(values, levels[0], levels[-1])),
        levels=levels,
        cmap=colours,
    )
    filled.set_edgecolor("face")
    filled.set_linewidth(0.2)


def _zero(axis: Axes, data: Acceleration, values: FloatArray) -> None:
    """Mark where dampers begin to harm."""
    axis.contour(
        data.period,
        data.pretension,
        np.ma.masked_invalid(values),
        levels=[0.0],
        colors="black",
        linewidths=0.7,
    )


def _scale(
    figure: Figure,
    width: float,
    bottom: float,
    tall: float,
    levels: FloatArray,
    colours: str,
    label: str,
    *,
    zero: bool = False,
) -> None:
    place = at(figure, width - RIGHT + 0.42, bottom, 0.14, tall)
    bar = figure.colorbar(
        ScalarMappable(BoundaryNorm(levels, 256), colours), cax=place, ticks=levels[:: 5 if zero else 2]
    )
    bar.set_label(label, fontsize=SMALL + 0.5)
    bar.ax.tick_params(labelsize=SMALL, length=2)
    if zero:
        bar.ax.axhline(0.0, color="black", linewidth=0.7)
