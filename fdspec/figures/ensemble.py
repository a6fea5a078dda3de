"""Ground motions side by side: their histories, and their elastic acceleration spectra."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.caption import add_caption
from fdspec.figures.page import Figure
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

    from fdspec.model.motion import GroundMotion

COLOURS: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
"""Of Okabe and Ito's palette, which colour-blind eyes can tell apart."""

DASHES: Final = ("-", "--", ":")
"""Records come three to a colour: in the study, that is one soil."""

COLUMNS: Final = 3

LETTERS_PER_INCH: Final = 13
"""Of matplotlib's own font at the size of a note."""


def plot_histories(
    motions: Sequence[GroundMotion],
    *,
    title: str = "Ground accelerations, all on one scale of time and of acceleration",
    note: str = "",
    caption: str = "",
) -> Figure:
    """Draw ground accelerations, a panel a motion, all on one scale of acceleration: the study's Figure 8.

    Parameters
    ----------
    motions : sequence of GroundMotion
    title : str
    note : str
        A line below the title, such as where the motions come from.
    caption : str
        Words below the picture.

    Returns
    -------
    matplotlib.figure.Figure
        Acceleration in g over time in s, three panels a row, each with a dot at its peak, all on the
        time of the longest: where a line ends the motion ends.

    Raises
    ------
    InvalidInput
        When there is nothing to draw.
    """
    if not motions:
        raise InvalidInput("motions must be one or more, not none")
    columns = min(COLUMNS, len(motions))
    rows = math.ceil(len(motions) / columns)
    width = max(6.5, 4.2 * columns)
    figure = Figure(figsize=(width, 1.4 + 2.15 * rows), layout="constrained", dpi=150)
    axes = figure.subplots(rows, columns, sharey=True, squeeze=False)
    longest = max(motion.duration for motion in motions)
    for axis in axes.flat[len(motions) :]:
        axis.remove()
    reach = 1.15 * max(motion.pga for motion in motions) / G
    for k, (axis, motion) in enumerate(zip(axes.flat, motions, strict=False)):
        axis.set_xlim(0.0, longest)
        _history(axis, motion, COLOURS[k // COLUMNS % len(COLOURS)])
        if reach > 0.0:
            axis.set_ylim(-reach, reach)
        if k % columns == 0:
            axis.set_ylabel("acceleration, g")
        if k + columns >= len(motions):
            axis.set_xlabel("time, s")
    _head(figure, title, note, width)
    add_caption(figure, caption)
    return figure


def plot_spectra(
    spectra: xr.Dataset,
    *,
    quantity: str = "absolute_acceleration",
    title: str | None = None,
    note: str = "",
    caption: str = "",
    labels: Mapping[str, str] | None = None,
) -> Figure:
    """Draw elastic acceleration spectra, a line a record, and their mean: the study's Figure 9.

    Parameters
    ----------
    spectra : xarray.Dataset
        What `fdspec.signals.spectra.elastic_spectra` returns; a panel a damping ratio.
    quantity : {"absolute_acceleration", "pseudo_acceleration"}
    title : str
        By default what is drawn.
    note : str
        A line below the title, such as where the motions come from.
    caption : str
        Words below the picture.
    labels : mapping of str to str, optional
        What the legend calls a record, such as its name and soil; its name unless given.

    Returns
    -------
    matplotlib.figure.Figure
        Acceleration in g over period in s.

    Raises
    ------
    InvalidInput
        For another quantity, or fewer than two periods.
    """
    known = ("absolute_acceleration", "pseudo_acceleration")
    if quantity not in known:
        raise InvalidInput(f"quantity must be one of {', '.join(known)}, not {quantity!r}")
    if spectra.sizes["period"] < 2:
        raise InvalidInput(f"a spectrum needs at least 2 periods, not {spectra.sizes['period']}")
    ratios = spectra["damping_ratio"].values
    width = max(8.5, 5.0 * ratios.size + 1.5)
    figure = Figure(figsize=(width, 5.5), layout="constrained", dpi=150)
    axes = np.ravel(figure.subplots(1, ratios.size, sharey=True, squeeze=False))
    period = spectra["period"].values
    for axis, ratio in zip(axes, ratios, strict=True):
        values = spectra[quantity].sel(damping_ratio=ratio).transpose("record", "period").values / G
        names = [str(name) for name in spectra["record"].values]
        _ensemble(axis, period, values, [(labels or {}).get(name, name) for name in names])
        axis.set_xlim(0.0, float(period[-1]))
        axis.set_ylim(bottom=0.0)
        axis.grid(visible=True, color="0.9", linewidth=0.6)
        axis.set_xlabel("period, s")
        axis.set_title(f"damping ratio {ratio:.3g}", fontsize="medium")
    what = quantity.replace("_", " ")
    axes[0].set_ylabel(f"peak {what}, g")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside right center", frameon=False)
    _head(figure, f"Elastic spectra of {what}" if title is None else title, note, width)
    add_caption(figure, caption)
    return figure


def _history(axis: Axes, motion: GroundMotion, colour: str) -> None:
    samples = motion.acceleration / G
    peak = int(np.argmax(np.abs(samples)))
    axis.plot(motion.time, samples, color=colour, linewidth=0.5)
    axis.plot(motion.time[peak], samples[peak], "o", color="black", markersize=3, zorder=5)
    axis.axhline(0.0, color="0.6", linewidth=0.4, zorder=1)
    axis.set_title(motion.name, loc="left", fontsize="medium", fontweight="bold")
    # In two lines, so that a long name leaves the motion's alone in print too.
    axis.set_title(",\n".join(filter(None, (motion.event, motion.station))), loc="right", fontsize="small")
    axis.text(0.985, 0.94, f"{motion.pga / G:.3f} g", transform=axis.transAxes, ha="right", va="top")


def _ensemble(axis: Axes, period: np.ndarray, values: np.ndarray, names: Sequence[str]) -> None:
    for k, (name, line) in enumerate(zip(names, values, strict=True)):
        colour = COLOURS[k // len(DASHES) % len(COLOURS)]
        axis.plot(period, line, DASHES[k % len(DASHES)], color=colour, linewidth=1.0, label=name)
    if len(names) > 1:
        axis.plot(period, values.mean(axis=0), color="black", linewidth=2.2, label="mean")


def _head(figure: Figure, title: str, note: str, width: float) -> None:
    lines = textwrap.wrap(note, int(LETTERS_PER_INCH * width), break_on_hyphens=False)
    figure.suptitle("\n".join([title, *lines]), fontsize="medium")
