"""The study's two validation problems: histories of displacement beside each other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import matplotlib as mpl
import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.caption import add_caption
from fdspec.figures.labels import plain
from fdspec.figures.page import Figure
from fdspec.figures.storeys import BRACE, FLOOR, FloatArray

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

BARE = "0.55"

ERRORS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#595959")
DASHES: Final = ("-", "--", ":")
"""Of the errors' lines: Okabe and Ito's palette, which colour-blind eyes can tell apart, and dashes."""

OFF: Final = "how far each is off the exact one, largest so far"

LEAST: Final = 1e-6
"""Share of the largest displacement below which no error is drawn."""


def plot_bare_and_damped(
    bare: xr.Dataset, damped: xr.Dataset, *, title: str = "", caption: str = "", end: float | None = None
) -> Figure:
    """Draw the displacement of each floor without and with dampers: the study's Figure 6.

    Parameters
    ----------
    bare, damped : xarray.Dataset
        Two histories of as many storeys, as `fdspec.simulate` returns them.
    title, caption : str
    end : float, s, optional
        Until when to draw.

    Returns
    -------
    matplotlib.figure.Figure
        Displacement relative to the ground in mm over time in s, the top floor first, on one scale.

    Raises
    ------
    InvalidInput
        When the histories have not the same storeys.
    """
    storeys = [int(storey) for storey in damped["storey"].values]
    if storeys != [int(storey) for storey in bare["storey"].values]:
        raise InvalidInput(f"bare has {bare.sizes['storey']} storeys, damped {len(storeys)}; they must agree")
    figure = Figure(figsize=(9.0, 1.2 + 1.6 * len(storeys)), layout="constrained", dpi=150)
    axes = figure.subplots(len(storeys), sharex=True, sharey=True, squeeze=False)[:, 0]
    for axis, storey in zip(axes, reversed(storeys), strict=True):
        for history, colour, label in ((bare, BARE, "bare frame"), (damped, FLOOR, "with friction dampers")):
            peak = float(history["peak_displacement"].sel(storey=storey)) * 1e3
            axis.plot(
                history["time"].values,
                history["displacement"].sel(storey=storey).values * 1e3,
                color=colour,
                linewidth=0.9,
                label=f"{label}, peak {peak:.3g} mm",
            )
        axis.set_ylabel(f"floor {storey}, mm")
        axis.legend(
            loc="lower right",
            bbox_to_anchor=(1.0, 0.98),
            ncols=2,
            frameon=False,
            borderaxespad=0.0,
            fontsize="small",
        )
    axes[-1].set_xlabel("time, s")
    axes[-1].set_xlim(0.0, float(damped["time"].values[-1]) if end is None else end)
    if title:
        figure.suptitle(title, fontsize="medium")
    add_caption(figure, caption)
    return figure


def plot_brace_displacements(
    histories: Mapping[str, xr.Dataset],
    *,
    storey: int = 1,
    title: str = "",
    caption: str = "",
    end: float | None = None,
) -> Figure:
    """Draw the displacement of a brace by several methods: the study's Figure 4.

    Parameters
    ----------
    histories : mapping of str to xarray.Dataset
        One history a method, named; the first is the measure of the others and stands behind each in grey.
    storey : int
    title, caption : str
    end : float, s, optional
        Until when to draw.

    Returns
    -------
    matplotlib.figure.Figure
        Displacement of the brace relative to the ground in mm over time in s, a panel a method, on the first
        one's scale; beside each name the largest displacement drawn and the largest difference. Below them,
        where there are several, that difference over time on a logarithmic scale, the largest so far.

    Raises
    ------
    InvalidInput
        When there is no history.
    """
    if not histories:
        raise InvalidInput("histories must name one or more, not none")
    (first, measure), *_ = histories.items()
    time = measure["time"].values
    end = float(time[-1]) if end is None else end
    exact = measure["brace_displacement"].sel(storey=storey).values * 1e3
    reach = 1.25 * float(np.abs(exact[time <= end]).max(initial=0.0))
    others = len(histories) - 1
    heights = [1.0] * len(histories) + ([3.2] if others else [])
    figure = Figure(figsize=(9.0, max(2.9, 1.4 + 0.86 * sum(heights))), layout="constrained", dpi=150)
    axes = figure.subplots(len(heights), sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    for k, (axis, (name, history)) in enumerate(zip(axes, histories.items(), strict=False)):
        at = history["time"].values
        drawn = history["brace_displacement"].sel(storey=storey).values * 1e3
        shown = at <= end
        told = f"{name}: peak {np.abs(drawn[shown]).max():.3g} mm"
        if name != first:
            axis.plot(time, exact, color="0.75", linewidth=1.6)
            apart = np.abs(drawn - np.interp(at, time, exact))
            told = f"{told}, off by up to {plain(apart[shown].max())} mm"
            _error(axes[-1], at, apart, name, k - 1)
        axis.plot(at, drawn, color=FLOOR if name == first else BRACE, linewidth=0.7)
        axis.set_title(told, loc="left", fontsize="small", pad=2)
        if reach > 0.0:
            axis.set_ylim(-reach, reach)
    figure.supylabel("displacement of the brace, mm", fontsize="medium")
    axes[-1].set_xlabel("time, s")
    axes[-1].set_xlim(0.0, end)
    if others:
        axes[-1].set_yscale("log")
        axes[-1].set_ylim(bottom=LEAST * max(reach, 1e-300))
        axes[-1].set_ylabel("off by, mm")
        axes[-1].grid(visible=True, color="0.92", linewidth=0.5)
        axes[-1].set_title(OFF, loc="left", fontsize="small", pad=2)
        # Below the numbers and the name of the axis, which take three lines and a half.
        axes[-1].legend(
            loc="upper center",
            bbox_to_anchor=(0.5, 0.0),
            borderaxespad=3.9,
            ncols=3 if mpl.rcParams["font.size"] <= 10.0 else 2,
            frameon=False,
            fontsize="small",
        )
    if title:
        figure.suptitle(title, fontsize="medium")
    add_caption(figure, caption)
    return figure


def _error(axis: Axes, time: FloatArray, apart: FloatArray, name: str, k: int) -> None:
    """Draw the largest difference so far: the difference itself comes back to zero in every swing."""
    until = np.maximum.accumulate(apart)
    seen = until > 0.0
    colour, dash = ERRORS[k % len(ERRORS)], DASHES[k // len(ERRORS) % len(DASHES)]
    axis.plot(time[seen], until[seen], color=colour, linestyle=dash, linewidth=1.2, label=name)
