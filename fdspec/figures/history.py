"""One history: what moves, what holds it, and when the damper slips."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fdspec.figures.page import Figure
from fdspec.figures.storeys import (
    BRACE,
    FLOOR,
    GROUND,
    FloatArray,
    draw_limits,
    draw_phases,
    storey_of,
    title_of,
)
from fdspec.measures import hysteresis
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def plot_history(history: xr.Dataset, storey: int = 1) -> Figure:
    """Draw one storey of a history over time, and its hysteresis loop.

    Parameters
    ----------
    history : xarray.Dataset
        What `fdspec.simulate` returns.
    storey : int
        The storey, counted from 1 at the ground.

    Returns
    -------
    matplotlib.figure.Figure
        Displacement of floor and brace (mm), friction force (kN) with a dot at each change of phase, phase of
        the damper and absolute acceleration (g) over time (s); friction force over slip, with the corners
        that `fdspec.measures.hysteresis` finds.

    Raises
    ------
    InvalidInput
        When the history has no such storey.
    """
    one = storey_of(history, storey)
    time = one["time"].values
    force = one["friction_force"].values / 1e3
    figure = Figure(figsize=(11.0, 6.5), layout="constrained", dpi=150)
    left, right = np.ravel(figure.subfigures(1, 2, squeeze=False, width_ratios=(2.3, 1.0)))
    displaced, held, phase, accelerated = left.subplots(4, sharex=True, height_ratios=(1.0, 1.0, 0.12, 1.0))
    loop, words = right.subplots(2, height_ratios=(1.4, 1.0))

    _displacement(displaced, time, one)
    held.plot(time, force, color=FLOOR, linewidth=0.8)
    draw_limits(held, one)
    _transitions(held, history, storey, time, force)
    held.set_ylabel("friction force, kN")
    draw_phases(phase, history, storey)
    _acceleration(accelerated, time, one)
    accelerated.set_xlabel("time, s")
    accelerated.set_xlim(time[0], time[-1])

    corners = hysteresis(history, storey)
    loop.plot(corners["slip"].values * 1e3, corners["force"].values / 1e3, color=FLOOR, linewidth=0.8)
    loop.set_xlabel("slip, floor less brace, mm")
    loop.set_ylabel("friction force, kN")
    words.set_axis_off()
    handles, labels = phase.get_legend_handles_labels()
    dots, named = held.get_legend_handles_labels()
    words.legend(handles + dots, labels + named, loc="upper left", frameon=False)
    words.text(0.05, 0.62, _summary(history, one), va="top", transform=words.transAxes)
    figure.suptitle(title_of(history, "Response to", storey), fontsize="medium")
    return figure


def _displacement(axis: Axes, time: FloatArray, one: xr.Dataset) -> None:
    axis.plot(time, one["displacement"].values * 1e3, color=FLOOR, linewidth=0.8, label="floor")
    axis.plot(time, one["brace_displacement"].values * 1e3, color=BRACE, linewidth=0.6, label="brace")
    axis.set_ylabel("displacement, mm")
    _legend_above(axis)


def _acceleration(axis: Axes, time: FloatArray, one: xr.Dataset) -> None:
    axis.plot(time, one["acceleration"].values / G, color=FLOOR, linewidth=0.8, label="floor")
    axis.plot(time, one["ground_acceleration"].values / G, color=GROUND, linewidth=0.6, label="ground")
    axis.set_ylabel("absolute acceleration, g")
    _legend_above(axis)


def _legend_above(axis: Axes) -> None:
    """Put the legend above the axes, where no data are."""
    axis.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 0.97),
        ncols=2,
        frameon=False,
        borderaxespad=0.0,
        fontsize="small",
    )


def _transitions(axis: Axes, history: xr.Dataset, storey: int, time: FloatArray, force: FloatArray) -> None:
    """Put a dot at each change of phase; the force there is that of the samples around it."""
    instants = history["transition_time"].values[history["transition_storey"].values == storey]
    axis.plot(
        instants,
        np.interp(instants, time, force),
        linestyle="none",
        marker="o",
        markersize=2.0,
        color="black",
        label="change of phase",
    )


def _summary(history: xr.Dataset, one: xr.Dataset) -> str:
    lines = [
        f"peak acceleration {one['peak_acceleration'].item() / G:.4g} g",
        f"peak displacement {one['peak_displacement'].item() * 1e3:.4g} mm",
        f"left at the end {one['residual_displacement'].item() * 1e3:.3g} mm",
        f"slip force {one['slip_force'].item() / 1e3:.4g} kN",
        f"changes of phase {one['storey_transitions'].item()}",
    ]
    if "pga" in history.coords:
        lines.insert(0, f"PGA {history['pga'].item() / G:.3g} g")
    return "\n".join(lines)
