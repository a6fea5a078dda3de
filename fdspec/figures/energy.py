"""Where the energy of the ground motion goes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.figures.page import Figure
from fdspec.figures.storeys import title_of

if TYPE_CHECKING:
    import xarray as xr

TERMS: Final = (
    ("friction_energy", "#0072B2", "friction"),
    ("viscous_energy", "#56B4E9", "viscous damping"),
    ("strain_energy", "#E69F00", "strain"),
    ("kinetic_energy", "#D55E00", "motion"),
)
"""Of Okabe and Ito's palette; what is gone for good lies below what still moves."""

LEAST: Final = 0.01
"""Share of the largest input below which shares say nothing."""


def plot_energy(history: xr.Dataset) -> Figure:
    """Draw the terms of the energy balance over time, stacked, and their shares.

    Parameters
    ----------
    history : xarray.Dataset
        What `fdspec.simulate` returns.

    Returns
    -------
    matplotlib.figure.Figure
        Above, energy in kJ, the terms stacked and the input as a line, each computed on its own, so that the
        line lies on the top of the stack where the balance closes. Below, each term's share in % of their
        sum, from when that stays over 1 % of its largest.
    """
    time = history["time"].values
    terms = np.array([history[name].values for name, _, _ in TERMS]) / 1e3
    given = history["input_energy"].values / 1e3
    total = terms.sum(axis=0)
    little = np.flatnonzero(total <= LEAST * total.max(initial=0.0))
    said = np.arange(time.size) > (little[-1] if little.size else -1)
    shares = 100.0 * np.divide(terms, total, out=np.zeros_like(terms), where=said)
    figure = Figure(figsize=(9.0, 5.6), layout="constrained", dpi=150)
    energy, share = figure.subplots(2, sharex=True)
    colours, labels = [colour for _, colour, _ in TERMS], [label for _, _, label in TERMS]
    energy.stackplot(time, terms, colors=colours, labels=labels, linewidth=0.0)
    energy.plot(time, given, color="black", linewidth=1.0, label="input")
    energy.set_ylabel("energy, kJ")
    energy.set_ylim(bottom=0.0)
    share.stackplot(time, shares, colors=colours, linewidth=0.0)
    share.set_ylabel("share, %")
    share.set_ylim(0.0, 100.0)
    share.set_xlabel("time, s")
    share.set_xlim(time[0], time[-1])
    handles, named = energy.get_legend_handles_labels()
    figure.legend(handles[::-1], named[::-1], loc="outside right center", frameon=False)
    error = f"terms and input differ by {history['energy_error'].item():.0e} of the input"
    figure.suptitle(f"{title_of(history, 'Energy under', letters=95)}\n{error}", fontsize="medium")
    return figure
