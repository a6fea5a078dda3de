"""One history: what moves, what holds it, and when the damper slips."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

FLOOR, BRACE, GROUND = "#0072B2", "#D55E00", "#E69F00"
"""Of Okabe and Ito's palette, which colour-blind eyes can tell apart."""

BANDS = ((1, "#009E73", "slips forward"), (-1, "#CC79A7", "slips backward"))


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
        Displacement of floor and brace (mm), friction force (kN), phase of the damper and absolute
        acceleration (g) over time (s); friction force over slip. Lines join outputs: a smaller `dt_out`
        of the simulation sharpens the corners of the loop.

    Raises
    ------
    InvalidInput
        When the history has no such storey.
    """
    if storey not in history["storey"].values:
        count = history.sizes["storey"]
        raise InvalidInput(f"storey must be from 1 to {count}, got {storey}")
    one = history.sel(storey=storey)
    time = one["time"].values
    force = one["friction_force"].values / 1e3
    figure = Figure(figsize=(11.0, 6.5), layout="constrained", dpi=150)
    left, right = np.ravel(figure.subfigures(1, 2, squeeze=False, width_ratios=(2.3, 1.0)))
    displaced, held, phase, accelerated = left.subplots(4, sharex=True, height_ratios=(1.0, 1.0, 0.12, 1.0))
    loop, words = right.subplots(2, height_ratios=(1.4, 1.0))

    _displacement(displaced, time, one)
    held.plot(time, force, color=FLOOR, linewidth=0.8)
    _limits(held, one)
    held.set_ylabel("friction force, kN")
    _phase(phase, history, storey)
    _acceleration(accelerated, time, one)
    accelerated.set_xlabel("time, s")
    accelerated.set_xlim(time[0], time[-1])

    slip = (one["displacement"].values - one["brace_displacement"].values) * 1e3
    loop.plot(slip, force, color=FLOOR, linewidth=0.8)
    loop.set_xlabel("slip, floor less brace, mm")
    loop.set_ylabel("friction force, kN")
    words.set_axis_off()
    words.legend(*phase.get_legend_handles_labels(), loc="upper left", frameon=False)
    words.text(0.05, 0.7, _summary(history, one), va="top", transform=words.transAxes)
    figure.suptitle(_title(history, storey), fontsize="medium")
    return figure


def _displacement(axis: Axes, time: FloatArray, one: xr.Dataset) -> None:
    axis.plot(time, one["displacement"].values * 1e3, color=FLOOR, linewidth=0.8, label="floor")
    axis.plot(time, one["brace_displacement"].values * 1e3, color=BRACE, linewidth=0.6, label="brace")
    axis.set_ylabel("displacement, mm")
    axis.legend(loc="upper right", ncols=2, frameon=False)
    axis.margins(y=0.15)


def _limits(axis: Axes, one: xr.Dataset) -> None:
    """Draw the force at which slip starts, where there is one."""
    limit = float(one["slip_force"].item()) / 1e3
    if np.isfinite(limit):
        for sign in (-1.0, 1.0):
            axis.axhline(sign * limit, color="0.4", linewidth=0.6, linestyle="--")


def _acceleration(axis: Axes, time: FloatArray, one: xr.Dataset) -> None:
    axis.plot(time, one["acceleration"].values / G, color=FLOOR, linewidth=0.8, label="floor")
    axis.plot(time, one["ground_acceleration"].values / G, color=GROUND, linewidth=0.6, label="ground")
    axis.set_ylabel("absolute acceleration, g")
    axis.legend(loc="upper right", ncols=2, frameon=False)
    axis.margins(y=0.15)


def _phase(axis: Axes, history: xr.Dataset, storey: int) -> None:
    """Colour the times of slip, from the exact instants of change."""
    spans = list(phase_spans(history, storey))
    for phase, colour, label in BANDS:
        bars = [(start, stop - start) for start, stop, found in spans if found == phase]
        axis.broken_barh(bars, (0.0, 1.0), facecolors=colour, edgecolors=colour, linewidth=0.5, label=label)
    axis.set_ylim(0.0, 1.0)
    axis.set_yticks([])
    axis.set_ylabel("slip", rotation=0, ha="right", va="center")


def phase_spans(history: xr.Dataset, storey: int) -> Iterator[tuple[float, float, int]]:
    """Give (start, stop, phase) of each stretch of one phase of one storey, s."""
    here = history["transition_storey"].values == storey
    phase = int(history["phase"].sel(storey=storey).values[0])
    start, end = float(history["time"].values[0]), float(history["time"].values[-1])
    instants = history["transition_time"].values[here]
    phases = history["transition_phase"].values[here]
    for instant, after in zip(instants, phases, strict=True):
        yield start, float(instant), phase
        start, phase = float(instant), int(after)
    yield start, end, phase


def _title(history: xr.Dataset, storey: int) -> str:
    name = str(history["record"].item()) if "record" in history.coords else "a ground motion"
    source = str(history["source"].item()) if "source" in history.coords else ""
    which = f", storey {storey} of {history.sizes['storey']}" if history.sizes["storey"] > 1 else ""
    return "\n".join([f"Response to {name}{which}", *textwrap.wrap(source, 115, break_on_hyphens=False)])


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
