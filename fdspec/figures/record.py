"""One ground motion: its history, how its energy arrives, what it asks of elastic oscillators."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.figures.fonts import give_glyphs
from fdspec.figures.page import Figure
from fdspec.signals.intensity import arias_time, husid, intensity
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

    from fdspec.model.motion import GroundMotion

LINE: Final = "#0072B2"
"""Of Okabe and Ito's palette, which colour-blind eyes can tell apart."""

LINES: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")

SHARES: Final = (0.05, 0.95)
"""Of the Arias intensity, the bounds of the significant duration."""

LETTERS: Final = 125
"""Of a line of the title, at its size and the figure's width."""


def plot_record(motion: GroundMotion, spectra: xr.Dataset) -> Figure:
    """Draw one ground motion: acceleration, Husid plot, and its elastic spectra.

    Parameters
    ----------
    motion : GroundMotion
    spectra : xarray.Dataset
        What `fdspec.signals.spectra.elastic_spectra` returns, this motion among its records.

    Returns
    -------
    matplotlib.figure.Figure
        Left, over time in s: acceleration in g with its peak; share of the Arias intensity in %, with the
        significant duration shaded in both. Right, over period in s, a line a damping ratio: largest absolute
        acceleration in g, largest displacement relative to the ground in mm.

    Raises
    ------
    InvalidInput
        When the spectra are not of this motion, or the motion is zero throughout.
    """
    if motion.name not in spectra["record"].values:
        names = ", ".join(map(str, spectra["record"].values))
        raise InvalidInput(f"spectra must hold the record {motion.name!r}; they hold {names}")
    one = spectra.sel(record=motion.name)
    bounds = [arias_time(motion, share) for share in SHARES]
    figure = Figure(figsize=(11.0, 6.0), layout="constrained", dpi=150)
    (history, acceleration), (arrival, displacement) = figure.subplots(
        2, 2, sharex="col", width_ratios=(1.7, 1.0)
    )
    _history(history, motion)
    _husid(arrival, motion, bounds)
    for axis in (history, arrival):
        axis.axvspan(*bounds, color="0.93", zorder=0)
        axis.set_xlim(0.0, motion.duration)
    arrival.set_xlabel("time, s")
    _spectra(acceleration, one, "absolute_acceleration", G)
    acceleration.plot(0.0, motion.pga / G, "o", color="black", markersize=4, clip_on=False, label="PGA")
    acceleration.set_ylabel("peak absolute acceleration, g")
    acceleration.legend(frameon=False, title="damping ratio")
    _spectra(displacement, one, "spectral_displacement", 1e-3)
    displacement.set_ylabel("peak displacement, mm")
    displacement.set_xlabel("period, s")
    figure.suptitle(_title(motion), fontsize="medium")
    give_glyphs(figure)
    return figure


def _history(axis: Axes, motion: GroundMotion) -> None:
    samples = motion.acceleration / G
    peak = int(np.argmax(np.abs(samples)))
    axis.plot(motion.time, samples, color=LINE, linewidth=0.6)
    axis.plot(motion.time[peak], samples[peak], "o", color="black", markersize=4, zorder=5)
    axis.axhline(0.0, color="0.6", linewidth=0.5, zorder=1)
    reach = 1.1 * motion.pga / G
    axis.set_ylim(-reach, reach)
    axis.set_ylabel("ground acceleration, g")


def _husid(axis: Axes, motion: GroundMotion, bounds: list[float]) -> None:
    arrived = husid(motion)
    axis.plot(motion.time, 100.0 * arrived / arrived[-1], color=LINE, linewidth=1.2)
    for time, share in zip(bounds, SHARES, strict=True):
        axis.plot(time, 100.0 * share, "o", color="black", markersize=4, zorder=5)
    first, last = SHARES
    middle, y = 0.5 * (bounds[0] + bounds[1]), 3.0
    axis.annotate(
        "", (bounds[0], y), (bounds[1], y), arrowprops={"arrowstyle": "<->", "linewidth": 0.8, "color": "0.3"}
    )
    axis.annotate(
        f"{bounds[1] - bounds[0]:.3g} s ({first:.0%} to {last:.0%})".replace("%", " %"),
        (middle, y),
        xytext=(0.0, 4.0),
        textcoords="offset points",
        ha="center",
        fontsize="small",
    )
    axis.set_ylim(0.0, 102.0)
    axis.set_ylabel("share of Arias intensity, %")


def _spectra(axis: Axes, one: xr.Dataset, name: str, unit: float) -> None:
    for k, ratio in enumerate(one["damping_ratio"].values):
        values = one[name].sel(damping_ratio=ratio).values / unit
        axis.plot(
            one["period"].values, values, color=LINES[k % len(LINES)], linewidth=1.0, label=f"{ratio:.3g}"
        )
    axis.set_xlim(0.0, float(one["period"].values[-1]))
    axis.set_ylim(bottom=0.0)
    axis.grid(visible=True, color="0.9", linewidth=0.6)


def _title(motion: GroundMotion) -> str:
    found = intensity(motion, *SHARES)
    numbers = (
        f"PGA {found.pga / G:.3g} g",
        f"PGV {found.pgv:.3g} m/s",
        f"PGD {found.pgd:.3g} m",
        f"Arias intensity {found.arias:.3g} m/s",
        f"CAV {found.cav:.3g} m/s",
        f"dt {motion.dt:g} s",
        f"{motion.n} samples",
    )
    head = ": ".join(
        filter(None, (motion.name, ", ".join(filter(None, (motion.event, motion.station, motion.component)))))
    )
    lines = [head, motion.source, "   ".join(numbers)]
    return "\n".join(
        part for line in lines if line for part in textwrap.wrap(line, LETTERS, break_on_hyphens=False)
    )
