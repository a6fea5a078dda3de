"""Risk: the annual rate at which a limit is exceeded, a fragility integrated over a seismic hazard curve."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

NODES: Final = 16
"""Gauss points in each part of a segment of the hazard curve."""

PARTS: Final = 8
"""Parts of a segment: the fragility may rise within one."""

LIFE: Final = 50.0
"""Years, over which a probability of exceedance is usually told."""


class Hazard(NamedTuple):
    """Annual rates (n,) at which intensities (n,) are exceeded: intensities rise, rates fall, all
    positive."""

    intensity: FloatArray
    rate: FloatArray


def read_hazard(path: str | Path) -> Hazard:
    """Read a hazard curve from a CSV file of two columns, intensity and annual rate, with or without a
    heading."""
    rows: list[tuple[float, float]] = []
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            for number, row in enumerate(csv.reader(file), start=1):
                cells = [cell.strip() for cell in row]
                if not any(cells) or cells[0].startswith("#"):
                    continue
                try:
                    first, second = (float(cell) for cell in cells)
                except ValueError:
                    if rows:
                        raise InvalidInput(
                            f"{path}, line {number}: {','.join(row)!r} is not an intensity and an annual rate"
                        ) from None
                    continue
                rows.append((first, second))
    except OSError as error:
        raise InvalidInput(f"cannot read {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path} is not UTF-8 text") from None
    if not rows:
        raise InvalidInput(f"{path} holds no rows of intensity, annual rate")
    table = np.array(rows)
    return hazard_curve(table[:, 0], table[:, 1])


def hazard_curve(intensity: FloatArray, rate: FloatArray) -> Hazard:
    """Return a hazard curve, checked: at least two points, intensities rising, rates falling, all
    positive."""
    x, y = np.asarray(intensity, dtype=float), np.asarray(rate, dtype=float)
    if x.ndim != 1 or x.shape != y.shape or x.size < 2:
        raise InvalidInput(
            f"a hazard curve needs two or more points, intensity and rate alike, got {x.shape}, {y.shape}"
        )
    if not (np.isfinite(x).all() and np.isfinite(y).all() and x[0] > 0.0 and y[-1] > 0.0):
        raise InvalidInput("intensities and annual rates of a hazard curve must be positive and finite")
    for k in range(x.size - 1):
        if x[k + 1] <= x[k]:
            raise InvalidInput(
                f"intensities must rise along a hazard curve, but {x[k + 1]:g} follows {x[k]:g}"
            )
        if y[k + 1] >= y[k]:
            raise InvalidInput(
                f"annual rates must fall along a hazard curve, but {y[k + 1]:g} follows {y[k]:g}"
            )
    return Hazard(x, y)


def risk(fit: xr.Dataset, hazard: Hazard | str | Path) -> xr.Dataset:
    """Integrate fragility curves over a hazard curve.

    Parameters
    ----------
    fit : xarray.Dataset
        What `fragility` returns; a rate is computed for each of its curves.
    hazard : Hazard or path
        Annual rates of exceedance over the same measure of intensity, in its units.

    Returns
    -------
    xarray.Dataset
        ``annual_rate``, 1/year, with ``probability_50_years``; ``deaggregation`` over ``segment``: the share
        of the rate from each segment of the hazard curve; ``beyond``: the part of the rate that comes from
        beyond its last point.

    Notes
    -----
    The rate is the integral of the probability of exceedance over the fall of the hazard curve, which is a
    power of the intensity between two points: straight on double-logarithmic paper.  Beyond the last point
    the fragility there is taken, which is a lower bound; intensities below the first point are left out.
    """
    import xarray as xr
    from scipy.special import ndtr

    hazard = hazard_curve(*hazard) if isinstance(hazard, Hazard) else read_hazard(hazard)
    points, weights = np.polynomial.legendre.leggauss(NODES)
    x, y = np.log(hazard.intensity), np.log(hazard.rate)
    slope = np.diff(y) / np.diff(x)
    # Nodes (segment, node): each segment in equal parts, Gauss's points in each.
    inside = ((np.arange(PARTS)[:, np.newaxis] + 0.5 * (1.0 + points)) / PARTS).ravel()
    at = x[:-1, np.newaxis] + np.diff(x)[:, np.newaxis] * inside
    fall = -slope[:, np.newaxis] * np.exp(
        y[:-1, np.newaxis] + slope[:, np.newaxis] * (at - x[:-1, np.newaxis])
    )
    density = fall * np.tile(0.5 * weights / PARTS, PARTS) * np.diff(x)[:, np.newaxis]
    ln_median, dispersion = np.log(fit["median"]), fit["dispersion"]
    nodes = xr.DataArray(at, dims=("segment", "node"))
    exceeds = xr.apply_ufunc(ndtr, (nodes - ln_median) / dispersion)
    parts = (exceeds * xr.DataArray(density, dims=("segment", "node"))).sum("node", skipna=False)
    beyond = hazard.rate[-1] * xr.apply_ufunc(ndtr, (x[-1] - ln_median) / dispersion)
    rate = parts.sum("segment", skipna=False) + beyond
    result = xr.Dataset(
        {
            "annual_rate": rate,
            "probability_50_years": -np.expm1(-LIFE * rate),
            "deaggregation": parts / rate,
            "beyond": beyond / rate,
        }
    ).assign_coords(
        segment=np.arange(1, hazard.intensity.size),
        segment_from=("segment", hazard.intensity[:-1]),
        segment_to=("segment", hazard.intensity[1:]),
    )
    result["annual_rate"].attrs = {
        "long_name": "annual rate at which the limit is exceeded",
        "units": "1/year",
    }
    result["probability_50_years"].attrs = {"long_name": "probability of that in 50 years", "units": "1"}
    result["deaggregation"].attrs = {"long_name": "share of the rate from this segment", "units": "1"}
    result["beyond"].attrs = {
        "long_name": "share of the rate from beyond the hazard curve's end",
        "units": "1",
    }
    result.attrs = {
        "title": "Annual rate of exceedance",
        **{k: v for k, v in fit.attrs.items() if k != "title"},
    }
    return result


def least_risk(
    cube: xr.Dataset,
    fit: xr.Dataset,
    hazard: Hazard | str | Path,
    *,
    over: str = "pretension",
    scenario: float = 1.0,
) -> xr.Dataset:
    """Find where along a dim the annual rate is least, beside where the scenario's mean demand is.

    Parameters
    ----------
    cube, fit : xarray.Dataset
        A cube and its `fragility`, over ``over``.
    hazard : Hazard or path
        As for `risk`.
    over : str
        The dim to choose from: ``pretension``, ``slip_scale``.
    scenario : float
        The intensity whose mean demand over the records is minimised.

    Returns
    -------
    xarray.Dataset
        ``by_risk`` and ``by_scenario``, values of the dim; ``apart``, their quotient; the annual rate at
        both.
    """
    import xarray as xr

    if over not in fit["median"].dims:
        raise InvalidInput(
            f"the fragility has no dim {over}; it has {', '.join(map(str, fit['median'].dims)) or 'none'}"
        )
    dim = "intensity"
    if scenario not in cube[dim].values:
        known = ", ".join(f"{value:g}" for value in cube[dim].values)
        raise InvalidInput(f"scenario must be one of the intensities {known}, not {scenario:g}")
    rate = risk(fit, hazard)["annual_rate"]
    demand = abs(cube[str(fit.attrs["demand"])].sel({dim: scenario}))
    if "storey" in demand.dims:
        demand = demand.max("storey")
    mean = demand.mean("record")
    by_risk, by_scenario = rate.idxmin(over), mean.idxmin(over)
    result = xr.Dataset(
        {
            "by_risk": by_risk,
            "by_scenario": by_scenario,
            "apart": by_risk / by_scenario,
            "least_rate": rate.min(over),
            "rate_by_scenario": rate.sel({over: by_scenario}, drop=True),
        }
    )
    for name, text in (
        ("by_risk", f"{over} of the least annual rate"),
        ("by_scenario", f"{over} of the least mean demand of the scenario"),
    ):
        result[name].attrs = {"long_name": text, "units": str(cube[over].attrs.get("units", "1"))}
    return result
