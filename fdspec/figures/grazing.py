"""One instant at which sliding comes to a halt and goes on: what a step sees of it, and what it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Patch

from fdspec.errors import InvalidInput
from fdspec.figures.page import Figure
from fdspec.figures.storeys import (
    BANDS,
    BRACE,
    FLOOR,
    FloatArray,
    phase_spans,
    sliding_velocity,
    storey_of,
    title_of,
)
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def _force(one: xr.Dataset) -> FloatArray:
    return np.asarray(one["friction_force"].values) / 1e3


def _acceleration(one: xr.Dataset) -> FloatArray:
    return np.asarray(one["acceleration"].values) / G


QUANTITIES = (
    (sliding_velocity, "sliding velocity, mm/s"),
    (_force, "friction force, kN"),
    (_acceleration, "acceleration, g"),
)


def shortest_stick(history: xr.Dataset, storey: int = 1) -> tuple[float, float]:
    """Return start and end, s, of the shortest stick between two slips of the same direction.

    Raises
    ------
    InvalidInput
        When the history has none, or no such storey.
    """
    storey_of(history, storey)
    spans = list(phase_spans(history, storey))
    found = [
        (stop - start, start, stop)
        for (_, _, before), (start, stop, phase), (_, _, after) in zip(
            spans, spans[1:], spans[2:], strict=False
        )
        if phase == 0 and before == after != 0
    ]
    if not found:
        raise InvalidInput(f"the history has no stick between two slips of one direction in storey {storey}")
    _, start, stop = min(found)
    return start, stop


def plot_grazing(
    history: xr.Dataset,
    halt: tuple[float, float],
    *,
    before: float,
    after: float,
    stepped: xr.Dataset | None = None,
    storey: int = 1,
) -> Figure:
    """Draw a stretch of time around a short stick, and the stick itself at its own scale.

    Parameters
    ----------
    history : xarray.Dataset
        What `fdspec.simulate` returns, with a `dt_out` fine enough for the stick.
    halt : tuple of float, s
        Start and end of the stick, such as `shortest_stick` finds.
    before, after : float, s
        How much to show around it.
    stepped : xarray.Dataset, optional
        The same history by a fixed step, its outputs at the step's ends: drawn as dots.
    storey : int
        The storey, counted from 1 at the ground.

    Returns
    -------
    matplotlib.figure.Figure
        Over time in ms from the start of the stick: sliding velocity (mm/s), friction force (kN), absolute
        acceleration (g); left the stretch, right the stick.

    Raises
    ------
    InvalidInput
        When the history has no such storey, or fewer than ten outputs in the stick.
    """
    start, stop = halt
    one = storey_of(history, storey)
    time = one["time"].values
    count = int(np.count_nonzero((time >= start) & (time <= stop)))
    if count < 10:
        raise InvalidInput(
            f"the stick of {1e6 * (stop - start):.3g} us has {count} outputs, and 10 are needed; "
            f"simulate with a dt_out of {(stop - start) / 20:.1g} s"
        )
    inner = 2.0 * (stop - start)
    figure = Figure(figsize=(10.0, 6.6), layout="constrained", dpi=150)
    axes = figure.subplots(3, 2, sharex="col", width_ratios=(1.7, 1.0))
    other = None if stepped is None else storey_of(stepped, storey)
    windows = ((start - before, start + after), (start - inner, stop + inner))
    shown_spans = [
        span for span in phase_spans(history, storey) if span[1] > windows[0][0] and span[0] < windows[0][1]
    ]
    for row, (of, label) in zip(axes, QUANTITIES, strict=True):
        for axis, (low, high) in zip(row, windows, strict=True):
            for begin, end, phase in shown_spans:
                if colour := {code: colour for code, colour, _ in BANDS}.get(phase):
                    axis.axvspan(1e3 * (begin - start), 1e3 * (end - start), color=colour, alpha=0.15, lw=0)
            shown = (time >= low) & (time <= high)
            axis.plot(1e3 * (time[shown] - start), of(one)[shown], color=FLOOR, linewidth=1.0, label="exact")
            if other is not None:
                at = other["time"].values
                seen = (at >= low) & (at <= high)
                axis.plot(
                    1e3 * (at[seen] - start),
                    of(other)[seen],
                    "o",
                    color=BRACE,
                    markersize=2.5,
                    label="fixed step",
                )
            axis.set_xlim(1e3 * (low - start), 1e3 * (high - start))
            if axis is row[1]:
                _frame(axis, of(one)[shown])
            axis.grid(visible=True, color="0.92", linewidth=0.5)
        row[0].set_ylabel(label)
    for axis in axes[0]:
        axis.axhline(0.0, color="0.4", linewidth=0.6, linestyle="--", zorder=1)
    limit = np.copysign(float(one["slip_force"].item()) / 1e3, np.interp(start, time, one["friction_force"]))
    for axis in axes[1]:
        axis.axhline(limit, color="0.4", linewidth=0.6, linestyle="--", zorder=1)
    axes[0, 0].set_title("the stretch around it", fontsize="medium")
    axes[0, 1].set_title(f"the stick, {1e6 * (stop - start):.0f} µs", fontsize="medium")
    for axis in axes[2]:
        axis.set_xlabel(f"time from {start:.4f} s, ms")
    _legend(figure, axes[0, 0], {phase for *_, phase in shown_spans})
    figure.suptitle(title_of(history, "A halt of the damper under", storey), fontsize="medium")
    return figure


def _frame(axis: Axes, exact: FloatArray) -> None:
    """Scale an axis by the exact values; a step may lie far off."""
    low, high = float(exact.min()), float(exact.max())
    room = 0.08 * (high - low) or 1.0
    axis.set_ylim(low - room, high + room)


def _legend(figure: Figure, axis: Axes, met: set[int]) -> None:
    patches = [Patch(color=colour, alpha=0.15, label=label) for code, colour, label in BANDS if code in met]
    handles, _ = axis.get_legend_handles_labels()
    figure.legend(handles=[*handles, *patches], loc="outside lower center", ncols=4, frameon=False)
