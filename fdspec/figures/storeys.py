"""What pictures of histories share: colours, one storey's stretches of phase, words."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

FLOOR, BRACE, GROUND = "#0072B2", "#D55E00", "#E69F00"
"""Of Okabe and Ito's palette, which colour-blind eyes can tell apart."""

BANDS: Final = ((1, "#009E73", "slips forward"), (-1, "#CC79A7", "slips backward"))


def storey_of(history: xr.Dataset, storey: int) -> xr.Dataset:
    """Return one storey of a history, or raise InvalidInput."""
    if storey not in history["storey"].values:
        count = history.sizes["storey"]
        raise InvalidInput(f"storey must be from 1 to {count}, got {storey}")
    return history.sel(storey=storey)


def sliding_velocity(one: xr.Dataset) -> FloatArray:
    """Return the sliding velocity of one storey or of all, floor less brace, mm/s."""
    return np.asarray(one["velocity"].values - one["brace_velocity"].values) * 1e3


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


def draw_phases(axis: Axes, history: xr.Dataset, storey: int) -> None:
    """Colour the times of slip, from the exact instants of change, in a strip."""
    spans = list(phase_spans(history, storey))
    for phase, colour, label in BANDS:
        bars = [(start, stop - start) for start, stop, found in spans if found == phase]
        axis.broken_barh(bars, (0.0, 1.0), facecolors=colour, edgecolors=colour, linewidth=0.5, label=label)
    axis.set_ylim(0.0, 1.0)
    axis.set_yticks([])
    axis.set_ylabel("slip", rotation=0, ha="right", va="center")


def draw_limits(axis: Axes, one: xr.Dataset, unit: float = 1e3) -> None:
    """Draw the force at which slip starts, where there is one."""
    limit = float(one["slip_force"].item()) / unit
    if np.isfinite(limit):
        for sign in (-1.0, 1.0):
            axis.axhline(sign * limit, color="0.4", linewidth=0.6, linestyle="--", zorder=1)


def title_of(history: xr.Dataset, what: str, storey: int | None = None, letters: int = 115) -> str:
    """Say what is drawn, under which ground motion, of which storey, and where the motion comes from."""
    name = str(history["record"].item()) if "record" in history.coords else "a ground motion"
    source = str(history["source"].item()) if "source" in history.coords else ""
    which = (
        f", storey {storey} of {history.sizes['storey']}" if storey and history.sizes["storey"] > 1 else ""
    )
    return "\n".join([f"{what} {name}{which}", *textwrap.wrap(source, letters, break_on_hyphens=False)])
