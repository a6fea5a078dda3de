"""One panel of peak acceleration over pretension and period: a surface in space, and a map to read off."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import patheffects
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from fdspec.figures.acceleration import COLOURS, Acceleration, FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMALL = 7.0
"""Points of the numbers at the axes, the least that reads well in print."""

HEIGHT = "height: acceleration, g"

BEST = "pretension of the smallest acceleration at each period"

BAND = "within 5 % of it"

LABEL = 6.0
"""Points of the values at lines."""

LABELLED = 4
"""Every fourth step of colour has a line with its value."""

STRIP = 0.06
"""Height of the limits' strips, share of the map's."""

EDGE = 0.06
"""Half the room that such a value takes, share of the map."""

GAP = 0.05
"""Between map and strip, share of the map's height: room for their labels one above the other."""


def draw_surface(axis: Any, data: Acceleration, k: int) -> None:
    """Draw one stiffness ratio as a surface; height, colour and ticks are those of its map."""
    top = float(data.levels[-1])
    along = np.log10(data.pretension) if data.logarithmic else data.pretension
    period, pretension = np.meshgrid(data.period, along)
    axis.plot_surface(
        period,
        pretension,
        data.peak[k],
        cmap=COLOURS,
        norm=Normalize(0.0, top),
        rcount=24,
        ccount=60,
        linewidth=0.15,
        edgecolor="0.25",
    )
    axis.set_xlim(0.0, float(data.period[-1]))
    axis.set_ylim(float(along[0]) if data.logarithmic else 0.0, float(along[-1]))
    axis.set_zlim(0.0, top)
    axis.set_xlabel("period, s", fontsize=SMALL, labelpad=-7)
    axis.set_ylabel("pretension, kN", fontsize=SMALL, labelpad=-5)
    axis.tick_params(labelsize=SMALL, pad=-3)
    # Both axes begin in one corner, where their first numbers would stand over each other.
    axis.xaxis.set_major_locator(FixedLocator(period_ticks(data)[1:]))
    ticks = pretension_ticks(data)
    ticks = [tick for tick in ticks if tick > 1.3 * data.pretension[0]]
    places = np.log10(ticks) if data.logarithmic else ticks
    axis.yaxis.set_major_locator(FixedLocator(list(places)))
    axis.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
    axis.zaxis.set_major_locator(FixedLocator(list(data.levels[::LABELLED])))
    for one in (axis.xaxis, axis.yaxis, axis.zaxis):
        one.set_pane_color((1.0, 1.0, 1.0, 0.0))
        one._axinfo["grid"].update(linewidth=0.3, color="0.8")  # noqa: SLF001  no public way
    axis.view_init(elev=26, azim=-128)


def draw_map(axis: Axes, data: Acceleration, k: int, below: float = -0.31) -> None:
    """Draw one stiffness ratio as a map: the limits as strips, the best pretension and its band."""
    frame_map(axis, data, below)
    _fill(axis, data, data.period, data.pretension, data.peak[k])
    lines = axis.contour(
        data.period,
        data.pretension,
        np.ma.masked_invalid(data.peak[k]),
        levels=data.levels[LABELLED::LABELLED],
        colors="white",
        linewidths=0.5,
    )
    labels = axis.clabel(lines, fontsize=LABEL, inline=False)
    draw_best(axis, data.best(k), data.band(k))
    space_labels(axis, labels, data.best(k))
    for name, values, low in (("free", data.free, -GAP - STRIP), ("braced", data.braced[k], 1.0 + GAP)):
        if np.isfinite(values).any():
            _strip(axis, data, name, values, low)


def frame_map(axis: Axes, data: Acceleration, below: float = -0.31) -> None:
    """Set up axes of period and pretension, logarithmic where the latter spans much.

    `below` is where the name of the period stands, in heights of the map.
    """
    if data.logarithmic:
        axis.set_yscale("log")
    axis.set_xlim(float(data.period[0]), float(data.period[-1]))
    axis.set_ylim(float(data.pretension[0]), float(data.pretension[-1]))
    axis.yaxis.set_major_locator(FixedLocator(pretension_ticks(data)))
    axis.yaxis.set_minor_locator(NullLocator())
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.tick_params(labelsize=SMALL, length=2.5, pad=2)
    axis.set_ylabel("pretension, kN", fontsize=SMALL, labelpad=6)
    axis.text(0.5, below, "period without brace, s", transform=axis.transAxes, fontsize=SMALL, ha="center")
    axis.xaxis.set_major_locator(FixedLocator(period_ticks(data)))


def draw_best(
    axis: Axes,
    best: tuple[FloatArray, FloatArray],
    band: tuple[FloatArray, FloatArray, FloatArray],
    hatching: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 0.85),
) -> None:
    """Draw the best pretension at each period, and hatch what is within 5 % of it."""
    period, pretension = best
    axis.plot(
        period,
        pretension,
        color="black",
        linewidth=1.2,
        clip_on=False,
        zorder=5,
        label=BEST,
        path_effects=[patheffects.withStroke(linewidth=2.6, foreground="white")],
    )
    period, start, end = band
    axis.fill_between(
        period,
        start,
        end,
        facecolor="none",
        edgecolor=hatching,
        hatch="//////",
        linewidth=0.0,
        zorder=3,
        label=BAND,
    )


def period_ticks(data: Acceleration) -> list[float]:
    """Return the ticks of period that map and surface share."""
    ticks = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, float(data.period[-1]))
    return [float(tick) for tick in ticks if tick <= data.period[-1] * (1.0 + 1e-9)]


def pretension_ticks(data: Acceleration) -> list[float]:
    """Return the ticks of pretension that map and surface share: round ones, or values of the grid."""
    if not data.logarithmic:
        return _ticks(data.pretension)
    low, high = float(data.pretension[0]), float(data.pretension[-1])
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    round_ones = [step * 10.0**decade for decade in decades for step in (1.0, 3.0)]
    return [tick for tick in round_ones if low * (1.0 - 1e-9) <= tick <= high * (1.0 + 1e-9)]


def space_labels(axis: Axes, labels: list[Any], best: tuple[FloatArray, FloatArray]) -> None:
    """Drop labels of lines that an edge would cut, that stand on another, or on the best pretension."""
    to_axes = axis.transData + axis.transAxes.inverted()
    line = to_axes.transform(np.column_stack(best))
    kept: list[tuple[float, float]] = []
    for label in labels:
        x, y = to_axes.transform(label.get_position())
        inside = EDGE < x < 1.0 - EDGE and EDGE < y < 1.0 - EDGE
        near = [abs(x - a) < 2.0 * EDGE and abs(y - b) < 2.0 * EDGE for a, b in kept]
        on_best = (np.abs(line - (x, y)) < EDGE).all(axis=1)
        if not inside or any(near) or on_best.any():
            label.remove()
            continue
        kept.append((x, y))
        label.set_path_effects([patheffects.withStroke(linewidth=1.5, foreground="0.25")])


def _strip(axis: Axes, data: Acceleration, name: str, values: FloatArray, low: float) -> None:
    """Draw a limit along an edge of the map, in the map's colours."""
    strip = axis.inset_axes((0.0, low, 1.0, STRIP))
    strip.set_label(name)
    _fill(strip, data, data.period, np.array([0.0, 1.0]), np.stack([values, values]))
    strip.set_xlim(axis.get_xlim())
    strip.set_ylim(0.0, 1.0)
    strip.set_yticks([0.5], [name], fontsize=SMALL)
    strip.tick_params(length=0, pad=3)
    if low < 0.0:
        strip.tick_params(axis="x", labelsize=SMALL, length=2.5, pad=2)
        strip.xaxis.set_major_locator(FixedLocator(period_ticks(data)))
        axis.tick_params(axis="x", length=0, labelbottom=False)
    else:
        strip.set_xticks([])


def draw_scale(figure: Figure, data: Acceleration, left: float, bottom: float, tall: float) -> None:
    """Draw the colours' scale in a place given in inches."""
    place = at(figure, left, bottom, 0.14, tall)
    bar = figure.colorbar(
        ScalarMappable(BoundaryNorm(data.levels, 256), COLOURS), cax=place, ticks=data.levels[::2]
    )
    bar.set_label("peak absolute acceleration, g", fontsize=SMALL + 1)
    bar.ax.tick_params(labelsize=SMALL, length=2)


def at(figure: Figure, left: float, bottom: float, width: float, height: float, **options: Any) -> Any:
    """Add axes in a place given in inches from the figure's lower left corner; in space, they are no Axes."""
    across, tall = figure.get_size_inches()
    return figure.add_axes((left / across, bottom / tall, width / across, height / tall), **options)


def _fill(axis: Axes, data: Acceleration, x: FloatArray, y: FloatArray, values: FloatArray) -> None:
    masked = np.ma.masked_invalid(values)
    filled = axis.contourf(x, y, masked, levels=data.levels, cmap=COLOURS)
    # Edges of the face's own colour hide the seams that viewers of PDF show between fields.
    filled.set_edgecolor("face")
    filled.set_linewidth(0.2)


def _ticks(pretension: FloatArray) -> list[float]:
    """Return values of the grid itself, at most six, the first and last among them where they fit."""
    return [float(value) for value in pretension[:: max(1, -(-pretension.size // 6))]]
