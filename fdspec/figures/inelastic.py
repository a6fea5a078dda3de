"""Pictures of inelastic spectra, of fragility and of demand over intensity."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from fdspec.errors import InvalidInput
from fdspec.figures.caption import add_caption
from fdspec.figures.labels import axis_label
from fdspec.figures.page import Figure
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

LINES: Final = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Of Okabe and Ito's palette."""

LEVELS: Final[dict[str, tuple[str, Callable[[float], str]]]] = {
    "strength": ("strength", lambda value: f"{value / G:.3g} g"),
    "ductility_target": ("ductility", lambda value: f"{value:g}"),
    "reduction_factor": ("R", lambda value: f"{value:g}"),
}
"""Name and text of each kind of level."""


def plot_inelastic_spectra(spectra: xr.Dataset, *, title: str = "", caption: str = "") -> Figure:
    """Draw inelastic spectra over period: what was searched or found, and the peak displacement.

    A line is the median over the records, its band runs from the 16 % to the 84 % fractile.

    Parameters
    ----------
    spectra : xarray.Dataset
        What `fdspec.inelastic_spectra` returns, over two periods or more.
    title, caption : str
        Words above and below.

    Returns
    -------
    matplotlib.figure.Figure
        Strength in g (of spectra at constant strength the ductility), and displacement in mm.
    """
    kind = next((name for name in LEVELS if name in spectra.dims), None)
    if kind is None or spectra.sizes.get("period", 0) < 2:
        raise InvalidInput(f"inelastic spectra need one of {', '.join(LEVELS)}, and two periods or more")
    figure = Figure(figsize=(9.0, 4.4), layout="constrained", dpi=150)
    left, right = figure.subplots(1, 2)
    period = spectra["period"].values
    shown = "ductility" if kind == "strength" else "strength"
    unit = 1.0 if shown == "ductility" else G
    name, text = LEVELS[kind]
    for k, level in enumerate(spectra[kind].values):
        colour = LINES[k % len(LINES)]
        one = spectra.sel({kind: level})
        found = one[shown].transpose("record", "period").values / unit
        displacement = one["peak_displacement"].transpose("record", "period").values * 1e3
        _band(left, period, found, colour, text(float(level)))
        _band(right, period, displacement, colour, "")
    what = "ductility" if shown == "ductility" else "yield strength, g"
    for axis, label in ((left, what), (right, "peak displacement, mm")):
        axis.set_xscale("log")
        axis.set_xlim(period[period > 0.0][0], period[-1])
        axis.set_xlabel("period, s")
        axis.set_ylabel(label)
        axis.grid(visible=True, which="both", color="0.92", linewidth=0.5)
        _plain_ticks(axis)
    if shown == "ductility":
        left.set_yscale("log")
    else:
        left.set_ylim(bottom=0.0)
    right.set_ylim(bottom=0.0)
    left.legend(title=name, frameon=False)
    count = spectra.sizes["record"]
    of = "one record" if count == 1 else f"{count} records: median, and 16 to 84 %"
    figure.suptitle(title or f"Inelastic spectra of {of}", fontsize="medium")
    add_caption(figure, caption)
    return figure


def plot_fragility(fit: xr.Dataset, *, confidence: float = 0.9, title: str = "", caption: str = "") -> Figure:
    """Draw one fragility curve, its band, and the shares of histories that exceeded the limit.

    Parameters
    ----------
    fit : xarray.Dataset
        What `fdspec.fragility` returns, of one curve: select along the other dims first.
    confidence : float
        Of the band.
    title, caption : str
        Words above and below.
    """
    from fdspec.measures.fragility import fragility_curve

    if fit["median"].size != 1:
        raise InvalidInput(
            f"a picture shows one curve; select along {', '.join(map(str, fit['median'].dims))} first"
        )
    fit = fit.squeeze()
    counted = fit["histories"].values > 0
    dim = str(fit["histories"].dims[0])
    levels = fit[dim].values[counted]
    share = fit["exceedances"].values[counted] / fit["histories"].values[counted]
    figure = Figure(figsize=(6.0, 4.4), layout="constrained", dpi=150)
    axis = figure.subplots()
    median = float(fit["median"])
    own = fit.attrs.get("measure", dim) == dim
    low, high = (levels.min(), levels.max()) if own else (median / 4.0, median * 4.0)
    x = np.geomspace(min(low, median / 3.0), max(high, median * 3.0), 200)
    curve = fragility_curve(fit, x, confidence=confidence)
    axis.fill_between(
        x,
        curve["low"],
        curve["high"],
        color=LINES[0],
        alpha=0.18,
        linewidth=0,
        label=f"{100.0 * confidence:.0f} % band",
    )
    spread = float(fit["dispersion"])
    axis.plot(x, curve["probability"], color=LINES[0], label=f"median {median:.3g}, dispersion {spread:.2f}")
    if own:
        axis.plot(levels, share, "o", color="black", markersize=4, label="histories")
    axis.set_xscale("log")
    _plain_ticks(axis)
    axis.set_ylim(0.0, 1.0)
    unit = str(fit["median"].attrs.get("units", "1"))
    axis.set_xlabel(axis_label(str(fit.attrs.get("measure", dim)), unit))
    axis.set_ylabel("probability of exceedance")
    axis.grid(visible=True, which="both", color="0.92", linewidth=0.5)
    axis.legend(frameon=False, loc="upper left", fontsize="small")
    what = axis_label(str(fit.attrs.get("demand", "demand")))
    limit, units = fit.attrs.get("limit", 0.0), str(fit.attrs.get("limit_units", ""))
    beyond = f"{what} beyond {limit:g} {units if units != '1' else ''}".rstrip()
    axis.set_title(title or beyond, fontsize="medium")
    add_caption(figure, caption)
    return figure


def plot_ida(curves: xr.Dataset, *, limit: float | None = None, title: str = "", caption: str = "") -> Figure:
    """Draw demand over intensity: each record grey, the 16, 50 and 84 % fractiles in colour.

    Parameters
    ----------
    curves : xarray.Dataset
        What `fdspec.measures.ida_curves` returns, over record and intensity alone.
    limit : float, optional
        Drawn as a line, in the demand's units.
    title, caption : str
        Words above and below.
    """
    if set(curves["demand"].dims) - {"record", "intensity"}:
        others = [str(dim) for dim in curves["demand"].dims if dim not in ("record", "intensity")]
        raise InvalidInput(f"a picture shows one frame; select along {', '.join(others)} first")
    figure = Figure(figsize=(6.0, 4.6), layout="constrained", dpi=150)
    axis = figure.subplots()
    intensity = curves["intensity"].values
    for line in curves["demand"].transpose("record", "intensity").values:
        axis.plot(_finite(line), intensity, color="0.75", linewidth=0.8)
    for k, fractile in enumerate(curves["fractile"].values):
        values = _finite(curves["fractile_demand"].sel(fractile=fractile).values)
        style = "-" if fractile == 0.5 else "--"
        axis.plot(values, intensity, style, color=LINES[k], linewidth=2.0, label=f"{100.0 * fractile:.0f} %")
    if limit is not None:
        axis.axvline(limit, color="0.3", linewidth=0.8, linestyle=":", label="limit")
    unit = str(curves["fractile_demand"].attrs.get("units", "1"))
    name = str(curves.attrs.get("demand_variable", "demand"))
    axis.set_xlabel(axis_label(name, unit))
    axis.set_ylabel("intensity")
    axis.set_xlim(left=0.0)
    axis.set_ylim(0.0, float(intensity[-1]))
    axis.grid(visible=True, color="0.92", linewidth=0.5)
    axis.legend(frameon=False, loc="lower right")
    axis.set_title(
        title or f"{axis_label(name)} over intensity, {curves.sizes['record']} records", fontsize="medium"
    )
    add_caption(figure, caption)
    return figure


def _plain_ticks(axis: Axes) -> None:
    """Label 1, 2 and 5 in each decade of a logarithmic axis, as plain numbers."""
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.xaxis.set_major_formatter("{x:g}")
    axis.xaxis.set_minor_formatter(NullFormatter())


def _finite(values: np.ndarray) -> np.ndarray:
    return np.where(np.isfinite(values), values, np.nan)


def _band(axis: Axes, x: np.ndarray, values: np.ndarray, colour: str, label: str) -> None:
    finite = _finite(values)
    if not np.isfinite(finite).all(axis=0).any():
        return
    if values.shape[0] > 1:
        low, high = np.nanquantile(finite, [0.16, 0.84], axis=0)
        axis.fill_between(x, low, high, color=colour, alpha=0.15, linewidth=0)
    axis.plot(x, np.nanmedian(finite, axis=0), color=colour, linewidth=1.6, label=label)
