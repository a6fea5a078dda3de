"""Fragility and risk: fits against an independent maximum of the likelihood, closed forms, clear messages."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import minimize
from scipy.stats import lognorm, norm

from fdspec.errors import InvalidInput
from fdspec.measures.dynamic_curves import ida_curves
from fdspec.measures.fragility import fragility, fragility_curve
from fdspec.measures.risk import hazard_curve, least_risk, read_hazard, risk

LEVELS = np.array([0.25, 0.5, 1.0, 1.5, 2.0, 3.0])


def _cube(demand, status=None, levels=LEVELS):
    demand = np.asarray(demand, dtype=float)
    data = {"peak_drift": (("record", "intensity"), demand, {"units": "m"})}
    if status is not None:
        flags = {"flag_values": np.arange(3, dtype=np.int8), "flag_meanings": "ok collapsed non_finite_state"}
        data["status"] = (("record", "intensity"), np.asarray(status, np.int8), flags)
    names = [f"r{k}" for k in range(demand.shape[0])]
    cube = xr.Dataset(data, coords={"record": names, "intensity": levels})
    cube["pga"] = ("record", np.linspace(1.0, 4.0, demand.shape[0]), {"units": "m/s^2"})
    return cube


def _random_cube(seed, records=20):
    rng = np.random.default_rng(seed)
    capacity = 1.2 * np.exp(0.4 * rng.normal(size=records))
    return _cube(0.02 * LEVELS / capacity[:, np.newaxis])


def _independent(x, yes):
    """The same maximum by Nelder and Mead on the distribution of scipy, in median and dispersion."""

    def cost(theta):
        p = lognorm.cdf(x, s=math.exp(theta[1]), scale=math.exp(theta[0]))
        p = np.clip(p, 1e-300, 1.0 - 1e-16)
        return -np.sum(np.where(yes, np.log(p), np.log1p(-p)))

    found = minimize(
        cost, [0.0, -1.0], method="Nelder-Mead", options={"xatol": 1e-11, "fatol": 1e-14, "maxiter": 20_000}
    )
    return np.exp(found.x), -found.fun


@pytest.mark.parametrize("seed", range(8))
def test_the_fit_is_the_maximum_of_the_likelihood(seed):
    cube = _random_cube(seed)
    fit = fragility(cube, demand="peak_drift", limit=0.02)
    x = np.broadcast_to(LEVELS, cube.peak_drift.shape).ravel()
    (median, dispersion), likelihood = _independent(x, cube.peak_drift.values.ravel() > 0.02)
    assert fit["median"].item() == pytest.approx(median, rel=1e-6)
    assert fit["dispersion"].item() == pytest.approx(dispersion, rel=1e-6)
    assert fit["log_likelihood"].item() == pytest.approx(likelihood, rel=1e-9)
    assert fit["exceedances"].values.tolist() == (cube.peak_drift.values > 0.02).sum(0).tolist()


def test_a_measure_of_each_record():
    cube = _random_cube(3)
    fit = fragility(cube, demand="peak_drift", limit=0.02, measure="pga")
    x = np.outer(cube.pga.values, LEVELS).ravel()
    (median, dispersion), _ = _independent(x, cube.peak_drift.values.ravel() > 0.02)
    assert fit["median"].item() == pytest.approx(median, rel=1e-6)
    assert fit["dispersion"].item() == pytest.approx(dispersion, rel=1e-6)
    assert fit["median"].attrs["units"] == "m/s^2"


def test_a_collapse_exceeds_and_a_failure_is_left_out():
    cube = _random_cube(1)
    plain = fragility(cube, demand="peak_drift", limit=0.02)
    status = np.zeros(cube.peak_drift.shape)
    drift = cube.peak_drift.values.copy()
    beyond = drift > 0.02
    status[beyond], drift[beyond] = 1, 0.001  # what was reached when collapse was called is below the limit
    collapsed = fragility(_cube(drift, status), demand="peak_drift", limit=0.02)
    assert collapsed["median"].item() == plain["median"].item()
    status[0] = 2
    fewer = fragility(_cube(drift, status), demand="peak_drift", limit=0.02)
    without = fragility(_cube(drift[1:], status[1:]), demand="peak_drift", limit=0.02)
    assert fewer["median"].item() == pytest.approx(without["median"].item(), rel=1e-12)
    assert fewer["histories"].values.tolist() == [19] * LEVELS.size


@pytest.mark.parametrize(
    ("limit", "message"),
    [
        (10.0, "no history exceeds it: sweep higher intensities"),
        (1e-6, "every history exceeds it: sweep lower"),
    ],
)
def test_none_and_all(limit, message):
    with pytest.raises(InvalidInput, match=message):
        fragility(_random_cube(0), demand="peak_drift", limit=limit)


def test_a_step_has_no_dispersion():
    with pytest.raises(InvalidInput, match="above one intensity and none below"):
        fragility(_cube(np.tile(LEVELS, (4, 1))), demand="peak_drift", limit=1.2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"demand": "no_such"}, "the cube has no no_such"),
        ({"limit": -1.0}, "limit must be positive and finite, in m, not -1.0"),
        ({"measure": "dt"}, "measure must be a variable over record, such as pga, not 'dt'"),
        ({"intensity": "factor"}, "a fragility needs a cube over factor"),
    ],
)
def test_what_cannot_be_used(change, message):
    with pytest.raises(InvalidInput, match=message):
        fragility(_random_cube(0), **{"demand": "peak_drift", "limit": 0.02, **change})


def test_other_dims_have_a_curve_each():
    cubes = [_random_cube(seed) for seed in (0, 1)]
    cube = xr.concat([c[["peak_drift"]] for c in cubes], dim="pretension").assign_coords(
        pretension=[1e4, 2e4]
    )
    fit = fragility(cube, demand="peak_drift", limit=0.02)
    for k, one in enumerate(cubes):
        assert fit["median"].values[k] == fragility(one, demand="peak_drift", limit=0.02)["median"].item()


def test_the_band_is_the_delta_method_on_the_probit():
    fit = fragility(_random_cube(2), demand="peak_drift", limit=0.02)
    curve = fragility_curve(fit, LEVELS, confidence=0.9)
    b = 1.0 / fit.dispersion.item()
    a = -math.log(fit["median"].item()) * b
    at = np.log(LEVELS)
    error = np.sqrt(fit.variance_a.item() + 2 * at * fit.covariance_ab.item() + at**2 * fit.variance_b.item())
    assert curve.probability.values == pytest.approx(norm.cdf(a + b * at), rel=1e-12)
    assert curve.low.values == pytest.approx(norm.cdf(a + b * at - norm.ppf(0.95) * error), rel=1e-9)
    assert (curve.low <= curve.probability).all()
    assert (curve.probability <= curve.high).all()


def test_the_band_holds_what_it_promises():
    """Of 200 samples of a known curve the 90 % band at its median holds one half in 90 %, give or take four
    standard errors."""
    inside = 0
    for seed in range(200):
        curve = fragility_curve(
            fragility(_random_cube(1000 + seed, 40), demand="peak_drift", limit=0.02), [1.2], confidence=0.9
        )
        inside += bool(curve.low.item() <= 0.5 <= curve.high.item())
    assert abs(inside / 200 - 0.9) < 4 * math.sqrt(0.9 * 0.1 / 200)


def test_risk_in_closed_form():
    """Over a hazard k0 im^-k the rate is k0 median^-k exp(k^2 dispersion^2 / 2) (Cornell et al., 2002)."""
    k0, k = 1e-3, 2.5
    levels = np.geomspace(1e-4, 1e4, 30)
    fit = fragility(_random_cube(4), demand="peak_drift", limit=0.02)
    rates = risk(fit, hazard_curve(levels, k0 * levels**-k))
    median, beta = fit["median"].item(), fit["dispersion"].item()
    assert rates.annual_rate.item() == pytest.approx(
        k0 * median**-k * math.exp(0.5 * (k * beta) ** 2), rel=1e-9
    )
    assert rates.deaggregation.sum().item() + rates.beyond.item() == pytest.approx(1.0, rel=1e-12)
    assert rates.probability_50_years.item() == pytest.approx(-math.expm1(-50 * rates.annual_rate.item()))


def test_a_hazard_file(tmp_path):
    file = tmp_path / "hazard.csv"
    file.write_text("# site A\nsa,rate\n0.1,0.01\n0.2,0.002\n1.0,0.0001\n", encoding="utf-8")
    assert read_hazard(file).rate.tolist() == [0.01, 0.002, 0.0001]
    fit = fragility(_random_cube(4), demand="peak_drift", limit=0.02)
    assert risk(fit, file).annual_rate.item() > 0.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.1,0.01\n0.2,0.02\n", "annual rates must fall"),
        ("0.2,0.01\n0.1,0.001\n", "intensities must rise"),
        ("0.1,0.01\nx,y\n", "line 2: 'x,y' is not an intensity"),
        ("sa,rate\n", "holds no rows"),
        ("0.1,0.01\n", "two or more points"),
    ],
)
def test_hazard_files_that_cannot_be_used(tmp_path, text, message):
    file = tmp_path / "hazard.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InvalidInput, match=message):
        read_hazard(file)


def test_least_risk_beside_the_scenario():
    cubes = []
    for factor in (1.3, 0.8, 1.0):
        cube = _random_cube(7)[["peak_drift"]]
        cube["peak_drift"] = cube.peak_drift * factor
        cubes.append(cube)
    cube = xr.concat(cubes, dim="pretension").assign_coords(pretension=[1e4, 2e4, 4e4])
    cube["peak_drift"].attrs["units"] = "m"
    fit = fragility(cube, demand="peak_drift", limit=0.02)
    levels = np.geomspace(0.01, 10, 20)
    found = least_risk(cube, fit, hazard_curve(levels, 1e-3 * levels**-2.0))
    assert found.by_risk.item() == 2e4
    assert found.by_scenario.item() == 2e4
    assert found.apart.item() == 1.0
    with pytest.raises(InvalidInput, match="scenario must be one of the intensities"):
        least_risk(cube, fit, hazard_curve(levels, levels**-1.0), scenario=0.7)


def test_curves_over_intensity():
    cube = _random_cube(0, records=25)
    status = np.zeros(cube.peak_drift.shape)
    status[:15, -1] = 1
    curves = ida_curves(_cube(cube.peak_drift.values, status), demand="peak_drift")
    ordered = np.sort(cube.peak_drift.values[:, 0])
    assert curves.fractile_demand.sel(fractile=0.5).values[0] == ordered[12]
    assert np.isinf(curves.fractile_demand.sel(fractile=0.5).values[-1])
    assert np.isinf(curves.demand.values[:15, -1]).all()
