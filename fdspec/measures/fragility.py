"""Fragility: the probability that a demand exceeds its limit, over the intensity of the ground motion."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from fdspec.errors import InvalidInput
from fdspec.measures.lognormal import FIT_STATUSES, FITTED, Fit, fit_lognormal

if TYPE_CHECKING:
    import xarray as xr

COLLAPSED: Final = "collapsed"
"""The status that counts as an exceedance, whatever the demand was until then."""

ATTRIBUTES: Final[Mapping[str, Mapping[str, object]]] = MappingProxyType(
    {
        "median": {"long_name": "intensity at which half of the histories exceed the limit"},
        "dispersion": {"long_name": "standard deviation of the logarithm of the capacity", "units": "1"},
        "median_error": {"long_name": "standard error of the logarithm of the median", "units": "1"},
        "dispersion_error": {"long_name": "standard error of the dispersion", "units": "1"},
        "variance_a": {"long_name": "variance of a in the probit a + b ln(intensity)", "units": "1"},
        "covariance_ab": {"long_name": "covariance of a and b", "units": "1"},
        "variance_b": {"long_name": "variance of b", "units": "1"},
        "log_likelihood": {"long_name": "logarithm of the likelihood at its maximum", "units": "1"},
        "histories": {"long_name": "number of histories at this intensity", "units": "1"},
        "exceedances": {"long_name": "number of them that exceed the limit or collapse", "units": "1"},
        "fit_status": {
            "long_name": "how the fit ended",
            "flag_values": np.arange(len(FIT_STATUSES), dtype=np.int8),
            "flag_meanings": " ".join(FIT_STATUSES),
        },
    }
)


def fragility(
    cube: xr.Dataset, *, demand: str, limit: float, intensity: str = "intensity", measure: str | None = None
) -> xr.Dataset:
    """Fit a lognormal fragility curve to a cube over intensity, by maximum likelihood.

    Parameters
    ----------
    cube : xarray.Dataset
        With dims ``record`` and ``intensity``; curves are fitted for each value of all others.  Of a demand
        that each storey has of its own, the largest over the storeys counts.
    demand : str
        The variable whose magnitude must not exceed the limit.
    limit : float
        In the demand's units.
    intensity : str
        The dim of intensities.
    measure : str, optional
        A variable over ``record``, such as ``pga``, whose product with the intensity is the measure of each
        history; without it the intensity itself is.

    Returns
    -------
    xarray.Dataset
        ``median``, ``dispersion``, their standard errors, the covariance from which `fragility_curve` makes
        its band, ``histories`` and ``exceedances`` at each intensity, ``log_likelihood`` and ``fit_status``.

    Raises
    ------
    InvalidInput
        Where the cube lacks what is asked for, or no curve can be fitted at all; the message says why.

    Notes
    -----
    A history that collapsed exceeds every limit.  One that failed otherwise is left out, and not counted
    among ``histories``.  The errors count records, not histories: those of one record at several
    intensities are not independent.
    """
    import xarray as xr

    for dim in ("record", intensity):
        if dim not in cube.dims:
            raise InvalidInput(
                f"a fragility needs a cube over {dim}, this one has {', '.join(map(str, cube.dims))}"
            )
    if demand not in cube:
        raise InvalidInput(f"the cube has no {demand}; sweep with it among the outputs")
    if not limit > 0.0 or not np.isfinite(limit):
        raise InvalidInput(f"limit must be positive and finite, in {_units(cube[demand])}, not {limit!r}")
    values = abs(cube[demand])
    if "storey" in values.dims:
        values = values.max("storey")
    exceeds, counts = (values > limit), xr.ones_like(values, dtype=bool)
    if "status" in cube:
        status = cube["status"]
        names = str(status.attrs.get("flag_meanings", "")).split()
        collapsed = (
            status == names.index(COLLAPSED) if COLLAPSED in names else xr.zeros_like(status, dtype=bool)
        )
        exceeds, counts = exceeds | collapsed, (status == 0) | collapsed
    levels = _positive(cube[intensity].values, intensity)
    base = xr.ones_like(cube["record"], dtype=float) if measure is None else _measure(cube, measure)
    at = (base * xr.DataArray(levels, dims=intensity, coords={intensity: cube[intensity]})).transpose(
        "record", intensity
    )
    rest = [dim for dim in values.dims if dim not in ("record", intensity)]
    order = (*rest, "record", intensity)
    exceeds, counts = (array.broadcast_like(values).transpose(*order) for array in (exceeds, counts))
    shape = tuple(values.sizes[dim] for dim in rest)
    record = np.repeat(np.arange(at.sizes["record"]), at.sizes[intensity])
    fits = [
        fit_lognormal(at.values.ravel(), yes.ravel(), record, kept.ravel().astype(float))
        for yes, kept in zip(
            exceeds.values.reshape(-1, *at.shape), counts.values.reshape(-1, *at.shape), strict=True
        )
    ]
    _require_one(fits, demand, limit, _units(cube[demand]))
    columns = np.array(fits, dtype=float).T.reshape(len(Fit._fields), *shape)
    median, dispersion, variance_a, covariance, variance_b, likelihood, status_code = columns
    a_over_b, b = -np.log(median), 1.0 / dispersion
    ln_median_variance = (variance_a + 2.0 * covariance * -a_over_b + variance_b * a_over_b**2) / b**2
    found = {
        "median": median,
        "dispersion": dispersion,
        "median_error": np.sqrt(ln_median_variance),
        "dispersion_error": np.sqrt(variance_b) / b**2,
        "variance_a": variance_a,
        "covariance_ab": covariance,
        "variance_b": variance_b,
        "log_likelihood": likelihood,
        "fit_status": status_code.astype(np.int8),
    }
    result = xr.Dataset(
        {name: (rest, array) for name, array in found.items()},
        coords={dim: cube[dim] for dim in rest if dim in cube.coords},
    )
    result = result.assign_coords({intensity: cube[intensity]})
    result["histories"] = counts.sum("record").astype(np.int64)
    result["exceedances"] = (exceeds & counts).sum("record").astype(np.int64)
    for name in result.data_vars:
        result[name].attrs = dict(ATTRIBUTES[str(name)])
    result["median"].attrs["units"] = _units(at) if measure is None else _units(cube[measure])
    result.attrs = {
        "title": "Lognormal fragility by maximum likelihood",
        "demand": demand,
        "limit": float(limit),
        "limit_units": _units(cube[demand]),
        "measure": measure or intensity,
    }
    return result


def fragility_curve(fit: xr.Dataset, intensity: ArrayLike, *, confidence: float = 0.9) -> xr.Dataset:
    """Evaluate fragility curves: ``probability`` and its band ``low``, ``high`` at intensities.

    Parameters
    ----------
    fit : xarray.Dataset
        What `fragility` returns.
    intensity : array_like
        In the measure's units, positive.
    confidence : float
        Of the band: pointwise, from the covariance of a and b in the probit a + b ln(intensity).
    """
    import xarray as xr
    from scipy.special import ndtr, ndtri

    if not 0.0 < confidence < 1.0:
        raise InvalidInput(f"confidence must be between 0 and 1, not {confidence!r}")
    levels = _positive(np.atleast_1d(np.asarray(intensity, dtype=float)), "intensity")
    x = xr.DataArray(np.log(levels), dims="at", coords={"at": levels})
    b = 1.0 / fit["dispersion"]
    probit = (x - np.log(fit["median"])) * b
    error = np.sqrt(fit["variance_a"] + 2.0 * x * fit["covariance_ab"] + x * x * fit["variance_b"])
    reach = float(ndtri(0.5 + 0.5 * confidence)) * error
    curves = {"probability": probit, "low": probit - reach, "high": probit + reach}
    return xr.Dataset({name: xr.apply_ufunc(ndtr, curve) for name, curve in curves.items()})


def _require_one(fits: list[Fit], demand: str, limit: float, units: str) -> None:
    codes = {fit.status for fit in fits}
    if FITTED in codes:
        return
    remedy = {
        "none_exceeds": "no history exceeds it: sweep higher intensities, or lower the limit",
        "all_exceed": "every history exceeds it: sweep lower intensities, or raise the limit",
        "separated": "every history exceeds it above one intensity and none below: sweep finer intensities",
        "not_increasing": "exceedance does not grow with intensity: sweep more intensities, or more records",
    }
    told = "; ".join(remedy[FIT_STATUSES[code]] for code in sorted(codes))
    raise InvalidInput(f"no fragility of {demand} beyond {limit:g} {units}: {told}")


def _measure(cube: xr.Dataset, name: str) -> xr.DataArray:
    if name not in cube.variables or cube[name].dims != ("record",):
        raise InvalidInput(f"measure must be a variable over record, such as pga, not {name!r}")
    _positive(cube[name].values, name)
    return cube[name]


def _positive(values: np.ndarray, name: str) -> np.ndarray:
    if not (np.isfinite(values).all() and (values > 0.0).all()):
        raise InvalidInput(f"{name} must be positive for a lognormal curve, not {values.min():g}")
    return values


def _units(array: xr.DataArray) -> str:
    return str(array.attrs.get("units", "1"))
