"""What a choice of pretension rests on: the index over pretension, each record before and after."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.page import Figure
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

BARE, BRACED, CHOSEN, BAND = "#595959", "#D55E00", "#0072B2", "#009E73"
"""Of Okabe and Ito's palette, which colour-blind eyes can tell apart; markers differ as well."""

WORDS: Final = "#005a94"
"""The same blue, darker: letters in it reach a contrast of 4.5 on white."""

MARKS: Final = {
    "bare": ("o", BARE, "bare frame"),
    "braced": ("s", BRACED, "braced, never slips"),
    "chosen": ("D", CHOSEN, "recommended"),
}

BEYOND: Final = 3.0
"""Pretensions are drawn up to this many times the upper end of what matters."""


def plot_choice_index(choice: xr.Dataset) -> Figure:
    """Draw the index of all records together, and of each, over pretension.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returns.

    Returns
    -------
    matplotlib.figure.Figure
        Index (1, the bare frame being 1) over pretension (kN; of many storeys, of the storey with the most)
        with the recommendation, its band and the bounds of friction.
    """
    storey = int(choice["pretension"].values.argmax()) if choice["pretension"].max() > 0.0 else 0
    trial = choice["trial_pretension"].values[:, storey] / 1e3
    best = float(choice["pretension"][storey]) / 1e3
    start, end = choice["band_pretension"].values[:, storey] / 1e3
    least = float(choice["index"].sel(case="chosen"))
    figure = Figure(figsize=(8.0, 4.4), layout="constrained", dpi=150)
    axis = figure.subplots()
    for k, line in enumerate(choice["trial_index_of_record"].values.T):
        axis.plot(trial, line, color="0.75", linewidth=0.8, label="each record" if k == 0 else None)
    together = "all records together" if choice.sizes["record"] > 1 else "the record"
    axis.plot(trial, choice["trial_index"].values, color=CHOSEN, linewidth=2.2, label=together)
    reach = min(max(trial[-1], best), BEYOND * max(best, end if np.isfinite(end) else best)) or trial[-1]
    limited = "limits" in _parameters(choice)
    near = "all limits met"
    if not limited:
        near = f"within {100.0 * _parameters(choice)['band']:.3g} % of the best"
    if np.isfinite(start):
        axis.axvspan(start, min(end, trial[-1]), color=BAND, alpha=0.2, linewidth=0, label=near)
    axis.plot(best, least, "D", color=CHOSEN, markersize=8, markeredgecolor="white", zorder=5)
    for case, dash in (("lower", "--"), ("upper", ":")):
        share = float(choice["index"].sel(case=case))
        at = _parameters(choice)[case] * best
        axis.plot(
            [at, at], [0.0, share], dash, color=BRACED, linewidth=1.4, label=f"{case} bound of friction"
        )
    axis.axhline(1.0, color=BARE, linewidth=0.8, linestyle="-.")
    axis.set_xlim(0.0, reach)
    shown = choice["trial_index_of_record"].values[trial <= reach]
    axis.set_ylim(0.0, 1.08 * min(max(1.0, float(shown.max())), 2.5))
    axis.text(0.99 * reach, 1.0, "bare frame", color=BARE, fontsize="small", ha="right", va="bottom")
    axis.annotate(
        f"{'recommended' if limited else 'best'}: {best:.3g} kN, "
        f"{abs(100.0 * (1.0 - least)):.0f} % {'less' if least <= 1.0 else 'more'}",
        (best, least),
        (12, 0.05),
        textcoords=("offset points", "axes fraction"),
        color=WORDS,
        fontweight="bold",
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )
    which = f" of storey {storey + 1}" if choice.sizes["storey"] > 1 else ""
    axis.set_xlabel(f"pretension{which}, kN")
    axis.set_ylabel(f"{_response(choice)}, bare frame 1")
    axis.spines[["top", "right"]].set_visible(False)
    figure.legend(*axis.get_legend_handles_labels(), loc="outside lower center", frameon=False, ncols=3)
    return figure


RESPONSES: Final = {
    "acceleration": "peak floor acceleration",
    "displacement": "peak drift",
    "base_shear": "peak base shear",
}


def _response(choice: xr.Dataset) -> str:
    """What an index is of, in few words."""
    weights = _parameters(choice)["index"]
    return RESPONSES.get(next(iter(weights)), "index") if len(weights) == 1 else "index"


def plot_choice_records(choice: xr.Dataset) -> Figure:
    """Draw the peak acceleration and drift of each record: bare, braced, recommended, and its bounds.

    Parameters
    ----------
    choice : xarray.Dataset
        What `fdspec.choose` returns.

    Returns
    -------
    matplotlib.figure.Figure
        Acceleration in g and drift in mm, a row a record; a bar joins the bounds of friction.
    """
    names = [str(name) for name in choice["record"].values]
    rows = np.arange(len(names))
    figure = Figure(figsize=(9.0, 1.6 + 0.36 * len(names)), layout="constrained", dpi=130)
    left, right = figure.subplots(1, 2, sharey=True)
    for axis, name, scale, label in (
        (left, "peak_acceleration", 1.0 / G, "peak absolute acceleration, g"),
        (right, "peak_drift", 1e3, "peak drift, mm"),
    ):
        values = choice[name] * scale
        bounds = np.sort([values.sel(case=case).values for case in ("lower", "chosen", "upper")], axis=0)
        axis.hlines(
            rows, bounds[0], bounds[-1], color=CHOSEN, linewidth=5.0, alpha=0.35, label="bounds of friction"
        )
        for case, (marker, colour, said) in MARKS.items():
            axis.plot(values.sel(case=case).values, rows, marker, color=colour, markersize=6, label=said)
        axis.set_xlim(left=0.0)
        axis.set_xlabel(label)
        axis.grid(visible=True, axis="y", color="0.92", linewidth=0.6)
    left.set_yticks(rows, names)
    left.set_ylim(len(names) - 0.5, -0.5)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False)
    return figure


def plot_before_after(bare: Sequence[xr.Dataset], damped: Sequence[xr.Dataset]) -> Figure:
    """Draw the displacement of the top floor under each record, without and with the damper.

    Parameters
    ----------
    bare, damped : sequence of xarray.Dataset
        What `fdspec.simulate` returns, record by record.

    Returns
    -------
    matplotlib.figure.Figure
        Displacement in mm over time in s, a panel a record.

    Raises
    ------
    InvalidInput
        When there is nothing to draw, or not two of each.
    """
    if not bare or len(bare) != len(damped):
        raise InvalidInput(f"each record needs two histories, got {len(bare)} bare and {len(damped)} damped")
    columns = min(3, len(bare))
    rows = -(-len(bare) // columns)
    figure = Figure(figsize=(4.0 * columns, 0.8 + 1.9 * rows), layout="constrained", dpi=130)
    axes = figure.subplots(rows, columns, squeeze=False)
    for axis in axes.flat[len(bare) :]:
        axis.remove()
    for k, (axis, before, after) in enumerate(zip(axes.flat, bare, damped, strict=False)):
        _displacements(axis, before, after)
        if k % columns == 0:
            axis.set_ylabel("displacement, mm")
        if k + columns >= len(bare):
            axis.set_xlabel("time, s")
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False)
    return figure


def _displacements(axis: Axes, bare: xr.Dataset, damped: xr.Dataset) -> None:
    for history, colour, width, label in (
        (bare, "0.6", 0.7, "bare frame"),
        (damped, CHOSEN, 0.9, "recommended"),
    ):
        top = history["displacement"].values[:, -1] * 1e3
        axis.plot(history["time"].values, top, color=colour, linewidth=width, label=label)
    axis.set_title(str(bare["record"].item()), loc="left", fontsize="medium", fontweight="bold")
    axis.set_xlim(0.0, float(bare["time"].values[-1]))


def _parameters(choice: xr.Dataset) -> dict[str, Any]:
    told: dict[str, Any] = json.loads(choice.attrs["parameters"])
    return told
