"""One panel of peak acceleration over pretension and period: a surface in space, and a map to read off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import patheffects
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.ticker import FixedLocator, MaxNLocator

from fdspec.figures.acceleration import COLOURS, Acceleration, FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMALL = 7.0
"""Points of the numbers at the axes, the least that reads well in print."""

HEIGHT = "height: acceleration, g"

BEST = "pretension of the smallest acceleration at each period"

LABELLED = 4
"""Every fourth step of colour has a line with its value."""

STRIP = 0.06
"""Height of the limits' strips, share of the map's."""

EDGE = 0.06
"""Half the room that such a value takes, share of the map."""

GAP = 0.05
"""Between map and strip, share of the map's height: room for their labels one above the other."""


def draw_surface(axis: Any, data: Acceleration, k: int) -> None:
    """Draw one stiffness ratio as a surface; height and colour mean the same in every panel."""
    top = float(data.levels[-1])
    period, pretension = np.meshgrid(data.period, data.pretension)
    axis.plot_surface(
        period,
        pretension,
        data.peak[k],
        cmap=COLOURS,
        norm=Normalize(0.0, top),
        rcount=100,
        ccount=100,
        linewidth=0.15,
        edgecolor="0.25",
    )
    axis.set_xlim(0.0, float(data.period[-1]))
    axis.set_ylim(0.0, float(data.pretension[-1]))
    axis.set_zlim(0.0, top)
    axis.set_xlabel("period, s", fontsize=SMALL, labelpad=-7)
    axis.set_ylabel("pretension, kN", fontsize=SMALL, labelpad=-5)
    axis.tick_params(labelsize=SMALL, pad=-3)
    # Both axes begin in one corner, where their zeros would stand over each other.
    axis.xaxis.set_major_locator(MaxNLocator(4, prune="lower"))
    axis.yaxis.set_major_locator(MaxNLocator(5, prune="lower"))
    axis.zaxis.set_major_locator(MaxNLocator(5))
    for one in (axis.xaxis, axis.yaxis, axis.zaxis):
        one.set_pane_color((1.0, 1.0, 1.0, 0.0))
        one._axinfo["grid"].update(linewidth=0.3, color="0.8")  # noqa: SLF001  no public way
    axis.view_init(elev=26, azim=-128)


def draw_map(axis: Axes, data: Acceleration, k: int) -> None:
    """Draw one stiffness ratio as a map, the limits as strips below and above it, and the best pretension."""
    _fill(axis, data, data.period, data.pretension, data.peak[k])
    axis.set_xlim(float(data.period[0]), float(data.period[-1]))
    axis.set_ylim(float(data.pretension[0]), float(data.pretension[-1]))
    lines = axis.contour(
        data.period,
        data.pretension,
        np.ma.masked_invalid(data.peak[k]),
        levels=data.levels[LABELLED::LABELLED],
        colors="white",
        linewidths=0.5,
    )
    _space(axis, axis.clabel(lines, fontsize=5.5, inline=False))
    axis.yaxis.set_major_locator(FixedLocator(_ticks(data.pretension)))
    axis.tick_params(labelsize=SMALL, length=2.5, pad=2)
    period, best = data.best(k)
    axis.plot(
        period,
        best,
        color="black",
        linewidth=1.2,
        drawstyle="steps-mid",
        clip_on=False,
        zorder=5,
        label=BEST,
        path_effects=[patheffects.withStroke(linewidth=2.6, foreground="white")],
    )
    axis.set_ylabel("pretension, kN", fontsize=SMALL, labelpad=9)
    axis.text(0.5, -0.31, "period without brace, s", transform=axis.transAxes, fontsize=SMALL, ha="center")
    axis.xaxis.set_major_locator(MaxNLocator(6))
    for name, values, low in (("free", data.free, -GAP - STRIP), ("braced", data.braced[k], 1.0 + GAP)):
        if np.isfinite(values).any():
            _strip(axis, data, name, values, low)


def _space(axis: Axes, labels: list[Any]) -> None:
    """Drop labels of lines that an edge would cut or that stand on another."""
    (x0, x1), (y0, y1) = axis.get_xlim(), axis.get_ylim()
    kept: list[tuple[float, float]] = []
    for label in labels:
        x, y = (label.get_position()[0] - x0) / (x1 - x0), (label.get_position()[1] - y0) / (y1 - y0)
        inside = EDGE < x < 1.0 - EDGE and EDGE < y < 1.0 - EDGE
        if not inside or any(abs(x - a) < 2.0 * EDGE and abs(y - b) < 2.0 * EDGE for a, b in kept):
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
        strip.xaxis.set_major_locator(MaxNLocator(6))
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
