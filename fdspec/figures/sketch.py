"""What fdspec computes, drawn: a frame, its chevron brace, and the slotted friction damper between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.patches import FancyBboxPatch, Polygon, Rectangle, RegularPolygon

from fdspec.figures.caption import add_caption
from fdspec.figures.page import Figure
from fdspec.figures.storeys import FLOOR

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fdspec.model.building import Building

STEEL, DARK, PLATE = "#dfe4e8", "#30363c", "#f2c9ac"

DAMPER: Final = "#00684f"
"""Okabe and Ito's green, darker: letters in it reach a contrast of 4.5 on white."""

FRICTION: Final = "#a63f00"
"""Their vermilion, darker for the same reason."""

HEIGHT, BAY = 3.0, 4.2
"""Of a storey and between columns, in the drawing's own units."""

MOST: Final = 6
"""Storeys that are drawn; a higher building is shown by its lowest and told as such."""

SMALL: Final = 8.0


def plot_sketch(building: Building | None = None, *, title: str = "", caption: str = "") -> Figure:
    """Draw the frame with its braces and dampers, and one damper close up: the study's Figures 1 and 7.

    Parameters
    ----------
    building : Building, optional
        Whose storeys are drawn and, of a single storey, whose numbers stand beside the symbols. Without one
        the single-storey frame is drawn with symbols alone.
    title, caption : str

    Returns
    -------
    matplotlib.figure.Figure
        Left the frame: floor of mass m_f on columns of stiffness k_f, chevron brace (m_d, k_d), their
        displacements u_f and u_d relative to the ground, whose acceleration is a_g. Right the damper in
        elevation and in section: a plate with slotted holes, clamped between two others by bolts.
    """
    storeys = 1 if building is None else min(building.n_storeys, MOST)
    figure = Figure(figsize=(8.6, 3.0 + 0.95 * (storeys - 1)), layout="constrained", dpi=150)
    figure.set_label("Frame, chevron brace and slotted friction damper")
    frame, right = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
    _frame(frame, storeys, building)
    _damper(right)
    for axis in (frame, right):
        axis.set_aspect("equal")
        axis.set_axis_off()
    if title:
        figure.suptitle(title, fontsize="medium")
    add_caption(figure, caption)
    return figure


def _frame(axis: Axes, storeys: int, building: Building | None) -> None:
    left, right = 0.0, BAY
    axis.add_patch(
        Rectangle((-1.0, -0.28), BAY + 2.0, 0.28, facecolor="white", edgecolor="0.45", hatch="////")
    )
    axis.plot([-1.0, BAY + 1.0], [0.0, 0.0], color=DARK, linewidth=1.4)
    for k in range(storeys):
        base, top = k * HEIGHT, (k + 1) * HEIGHT
        for x in (left, right):
            axis.add_patch(Rectangle((x - 0.11, base), 0.22, HEIGHT, facecolor=STEEL, edgecolor=DARK))
        apex = top - 0.62
        for foot, side in ((left + 0.14, -1.0), (right - 0.14, 1.0)):
            _bar(axis, (foot, base + 0.1), (0.5 * BAY + 0.28 * side, apex - 0.05))
        axis.add_patch(
            Rectangle(
                (0.5 * BAY - 0.5, apex - 0.14), 1.0, 0.32, facecolor=PLATE, edgecolor=FRICTION, zorder=4
            )
        )
        axis.add_patch(
            Rectangle((0.5 * BAY - 0.3, apex), 0.6, 0.42, facecolor=STEEL, edgecolor=DARK, zorder=5)
        )
        for x in (-0.14, 0.14):
            axis.add_patch(
                RegularPolygon((0.5 * BAY + x, apex + 0.09), 6, radius=0.065, facecolor=DARK, zorder=6)
            )
        axis.add_patch(
            Rectangle((left - 0.45, top - 0.2), BAY + 0.9, 0.4, facecolor=STEEL, edgecolor=DARK, zorder=3)
        )
    top = storeys * HEIGHT
    told = _numbers(building)
    say = {
        "floor": (0.5 * BAY, top + 0.36, f"floor, mass $m_f${told['floor']}", DARK),
        "column": (-0.28, top - 1.55, f"columns\n$k_f$, $\\zeta${told['column']}", DARK),
        "brace": (right + 0.28, top - 1.55, f"brace\n$k_d$, $m_d${told['brace']}", FRICTION),
    }
    for name, (at, height, words, colour) in say.items():
        align = {"floor": "center", "column": "right", "brace": "left"}[name]
        axis.text(
            at,
            height,
            words,
            color=colour,
            fontsize=SMALL + 1,
            ha=align,
            va="bottom" if name == "floor" else "center",
        )
    axis.annotate(
        "friction damper",
        (0.5 * BAY + 0.5, top - 0.6),
        (right + 0.28, top - 0.62),
        color=DAMPER,
        fontsize=SMALL + 1,
        va="center",
        arrowprops={"arrowstyle": "-", "color": DAMPER, "linewidth": 0.9, "shrinkA": 1, "shrinkB": 1},
        zorder=7,
    )
    _arrow(axis, (right + 0.5, top), (right + 1.35, top), "$u_f$", FLOOR)
    _arrow(axis, (0.5 * BAY - 0.35, top - 1.15), (0.5 * BAY + 0.5, top - 1.15), "$u_d$", FRICTION, below=True)
    _arrow(axis, (-0.9, -0.62), (0.2, -0.62), "$a_g(t)$", DARK)
    if building is not None and building.n_storeys > storeys:
        axis.text(
            BAY + 1.0,
            -0.62,
            f"the lowest {storeys} of {building.n_storeys} storeys",
            fontsize=SMALL,
            ha="right",
            va="center",
        )
    axis.set_xlim(-2.6, BAY + 2.6)
    axis.set_ylim(-1.15, top + 0.95)


def _numbers(building: Building | None) -> dict[str, str]:
    """Words with the numbers of a single storey, empty where there is none."""
    if building is None or building.n_storeys != 1:
        return {"floor": "", "column": "", "brace": ""}
    return {
        "floor": f" = {building.floor_mass[0] / 1e3:.4g} t",
        "column": f"\n{building.storey_stiffness[0] / 1e6:.3g} MN/m",
        "brace": f"\n{building.brace_stiffness[0] / 1e6:.3g} MN/m\n{building.brace_mass[0]:.4g} kg",
    }


def _bar(axis: Axes, start: tuple[float, float], end: tuple[float, float], width: float = 0.13) -> None:
    """Draw a member of the brace, from its foot to the damper."""
    a, b = np.array(start), np.array(end)
    across = np.array([a[1] - b[1], b[0] - a[0]])
    across *= 0.5 * width / np.hypot(*across)
    axis.add_patch(
        Polygon(
            [a + across, b + across, b - across, a - across], facecolor=PLATE, edgecolor=FRICTION, zorder=2
        )
    )


def _arrow(
    axis: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    name: str,
    colour: str,
    *,
    below: bool = False,
) -> None:
    axis.annotate(
        "", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.3}, zorder=8
    )
    if below:
        axis.text(
            0.5 * (start[0] + end[0]),
            end[1] - 0.12,
            name,
            color=colour,
            fontsize=SMALL + 2,
            ha="center",
            va="top",
        )
    else:
        axis.text(end[0] + 0.1, end[1], name, color=colour, fontsize=SMALL + 2, ha="left", va="center")


def _damper(axis: Axes) -> None:
    _elevation(axis, 0.0)
    _section(axis, 5.6)
    axis.set_xlim(-2.9, 7.9)
    axis.set_ylim(-3.2, 3.5)


def _elevation(axis: Axes, x: float) -> None:
    axis.add_patch(Rectangle((x - 2.6, 2.0), 5.2, 0.7, facecolor=STEEL, edgecolor=DARK))
    axis.text(x, 2.35, "beam", fontsize=SMALL, ha="center", va="center", color=DARK)
    axis.add_patch(Rectangle((x - 1.7, -0.75), 3.4, 2.75, facecolor="white", edgecolor=DARK, linewidth=1.2))
    for side, foot in ((-1.0, -2.6), (1.0, 2.6)):
        _bar(axis, (x + foot, -2.9), (x + 0.5 * side, -1.0), 0.5)
    axis.add_patch(
        Rectangle((x - 1.3, -1.15), 2.6, 1.75, facecolor=PLATE, edgecolor=FRICTION, alpha=0.75, zorder=3)
    )
    for hole in (-0.62, 0.62):
        axis.add_patch(
            FancyBboxPatch(
                (x + hole - 0.28, -0.42),
                0.56,
                0.0,
                boxstyle="round,pad=0.17",
                facecolor="white",
                edgecolor=DARK,
                zorder=4,
            )
        )
        axis.add_patch(RegularPolygon((x + hole + 0.08, -0.42), 6, radius=0.19, facecolor=DARK, zorder=5))
    axis.annotate(
        "",
        (x + 1.05, 1.25),
        (x - 1.05, 1.25),
        arrowprops={"arrowstyle": "<|-|>", "color": FLOOR, "linewidth": 1.3},
    )
    axis.text(x, 1.36, "slips", color=FLOOR, fontsize=SMALL, ha="center", va="bottom")
    axis.text(x, 0.86, "slotted plate", color=DARK, fontsize=SMALL, ha="center", va="center")
    axis.text(x, 3.1, "the damper from the side", fontsize=SMALL, ha="center", va="center", fontweight="bold")
    axis.text(
        x, -2.62, "clamping plates\non the brace", color=FRICTION, fontsize=SMALL, ha="center", va="center"
    )


def _section(axis: Axes, x: float) -> None:
    axis.add_patch(Rectangle((x - 0.75, 2.0), 1.5, 0.7, facecolor=STEEL, edgecolor=DARK))
    axis.add_patch(Rectangle((x - 0.13, -0.75), 0.26, 2.75, facecolor="white", edgecolor=DARK, linewidth=1.2))
    for side in (-1.0, 1.0):
        axis.add_patch(
            Rectangle(
                (x + 0.26 * side - 0.13, -1.6), 0.26, 2.2, facecolor=PLATE, edgecolor=FRICTION, linewidth=1.2
            )
        )
        axis.add_patch(Rectangle((x + 0.51 * side - 0.12, -0.66), 0.24, 0.48, facecolor=DARK))
        axis.annotate(
            "",
            (x + 0.68 * side, -0.42),
            (x + 1.55 * side, -0.42),
            arrowprops={"arrowstyle": "-|>", "color": DAMPER, "linewidth": 1.4},
        )
    axis.add_patch(Rectangle((x - 0.6, -0.48), 1.2, 0.12, facecolor=DARK))
    axis.text(x + 1.2, -0.2, "$F_N$", color=DAMPER, fontsize=SMALL + 2, ha="center", va="bottom")
    axis.text(x - 1.2, -0.2, "$F_N$", color=DAMPER, fontsize=SMALL + 2, ha="center", va="bottom")
    axis.text(x, 3.1, "cut through a bolt", fontsize=SMALL, ha="center", va="center", fontweight="bold")
    axis.text(
        x,
        -2.62,
        "bolts clamp: pretension $F_N$\nslip force $F = \\mu F_N$",
        color=DAMPER,
        fontsize=SMALL,
        ha="center",
        va="center",
    )


def sketch_caption() -> str:
    """Return the words below `plot_sketch`."""
    return (
        "A floor on columns, a chevron brace below it, and between them the friction damper: a plate with "
        "slotted holes under the beam, clamped by pretensioned bolts between two plates on the brace. It "
        "sticks until the force through it reaches friction, then slides and dissipates energy."
    )
