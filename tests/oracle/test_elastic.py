"""Elastic spectra against matrix exponentials, closed forms, scipy and the peers."""

import math

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

from fdspec.model.motion import GroundMotion
from fdspec.records import load_record
from fdspec.signals.spectra import elastic_spectra
from tests.oracle.elastic_exponential import elastic_peaks


def noise(seed, count, dt):
    chance = np.random.default_rng(seed)
    return GroundMotion(chance.normal(size=count) * np.hanning(count), dt, f"noise {seed}")


@pytest.mark.parametrize("dt", [0.005, 0.02])
@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.05, 0.3, 0.999, 1.0, 1.5])
def test_matrix_exponential(dt, zeta):
    motion = noise(7, 60, dt)
    periods = np.array([0.06 * dt, dt, 6.3 * dt, 10.0 * dt, 0.3, 20.0])
    spectra = elastic_spectra(motion, periods, zeta).isel(record=0, damping_ratio=0)
    for period in periods:
        expected = elastic_peaks(motion.acceleration, dt, period, zeta)
        found = spectra.sel(period=period)
        assert float(found.spectral_displacement) == pytest.approx(expected[0], rel=1e-9)
        assert float(found.absolute_acceleration) == pytest.approx(expected[1], rel=1e-9)


@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_the_first_steps_of_long_periods(zeta):
    """From rest the acceleration of a slow oscillator begins with the fifth power of the phase."""
    motion = GroundMotion([0.0, 1.0, -0.5], 0.01, "short")
    for period in (20.0, 70.0, 300.0):
        spectra = elastic_spectra(motion, [period], zeta).squeeze()
        expected = elastic_peaks(motion.acceleration, 0.01, period, zeta)
        assert float(spectra.absolute_acceleration) == pytest.approx(expected[1], rel=1e-12)


def test_a_real_record_at_its_samples():
    """Take samples alone from lsim: the largest is a lower bound, and close to the peak."""
    motion = load_record("FMR1")
    for period, close in ((0.06, 0.2), (0.5, 3e-3), (2.0, 2e-4)):
        w = 2.0 * math.pi / period
        system = StateSpace([[0.0, 1.0], [-w * w, -0.1 * w]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
        _, x, _ = lsim(system, motion.acceleration, motion.time)
        sampled = np.abs(x).max()
        peak = float(elastic_spectra(motion, period).spectral_displacement.squeeze())
        assert sampled * (1.0 - 1e-12) <= peak <= sampled * (1.0 + close)


def test_resonance_under_a_step():
    """A step of a_g = 1 that lasts, undamped: twice the static displacement, twice a_g."""
    step = GroundMotion(np.ones(2_000), 0.001, "step")
    spectra = elastic_spectra(step, [0.5, 1.0, 3.0], 0.0).squeeze()
    static = (spectra.period / (2.0 * math.pi)) ** 2
    np.testing.assert_allclose(spectra.spectral_displacement, 2.0 * static, rtol=1e-12)
    np.testing.assert_allclose(spectra.absolute_acceleration, 2.0, rtol=1e-12)


def test_limits_of_period():
    strong = load_record("FSR2").acceleration[1400:1600]
    motion = GroundMotion(strong, 0.01)
    spectra = elastic_spectra(motion, [0.05 * motion.dt, 1000.0], 0.05).squeeze()
    assert float(spectra.absolute_acceleration[0]) == pytest.approx(motion.pga, rel=1e-3)
    moved = np.cumsum(np.cumsum(motion.acceleration)) * motion.dt**2
    assert float(spectra.spectral_displacement[1]) == pytest.approx(np.abs(moved).max(), rel=0.05)


def test_undamped_pseudo_and_absolute_acceleration_are_one():
    spectra = elastic_spectra(noise(3, 500, 0.01), np.linspace(0.02, 3.0, 40), 0.0)
    np.testing.assert_allclose(spectra.pseudo_acceleration, spectra.absolute_acceleration, rtol=1e-12)


def test_subdividing_the_record_changes_nothing():
    motion = noise(5, 300, 0.01)
    finer = GroundMotion(
        np.interp(np.arange(299 * 4 + 1) / 4.0, np.arange(300), motion.acceleration), 0.0025, "f"
    )
    periods = np.geomspace(0.02, 5.0, 60)
    one = elastic_spectra(motion, periods, [0.0, 0.05, 0.2])
    other = elastic_spectra(finer, periods, [0.0, 0.05, 0.2])
    for name in ("spectral_displacement", "absolute_acceleration"):
        np.testing.assert_allclose(one[name].values, other[name].values, rtol=1e-11)


def test_order_and_company_of_periods_change_no_bit():
    motions = [noise(1, 200, 0.01), noise(2, 333, 0.005)]
    periods = np.geomspace(0.011, 4.0, 37)
    whole = elastic_spectra(motions, periods, [0.02, 0.05])
    backwards = elastic_spectra(motions[::-1], periods[::-1], [0.05, 0.02])
    for name in ("spectral_displacement", "pseudo_acceleration", "absolute_acceleration"):
        assert np.array_equal(whole[name].values, backwards[name].values[::-1, ::-1, ::-1])
        alone = elastic_spectra(motions[1], periods[5], 0.05)[name]
        assert float(alone.squeeze()) == float(whole[name][1, 1, 5])


# Tolerances are the peers' own errors: pyrotd works in the frequency domain, where the record repeats itself,
# and eqsig takes the largest sample.
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["FSR1", "FHR1"])
def test_pyrotd(name):
    pyrotd = pytest.importorskip("pyrotd")
    motion = load_record(name)
    periods = np.geomspace(0.2, 2.0, 20)
    theirs = pyrotd.calc_spec_accels(motion.dt, motion.acceleration, 1.0 / periods[::-1], 0.05).spec_accel[
        ::-1
    ]
    ours = elastic_spectra(motion, periods).pseudo_acceleration.squeeze().values
    np.testing.assert_allclose(theirs, ours, rtol=0.06)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["FSR1", "FHR1"])
def test_eqsig(name):
    eqsig = pytest.importorskip("eqsig.sdof")
    motion = load_record(name)
    periods = np.geomspace(0.2, 3.0, 20)
    theirs = eqsig.pseudo_response_spectra(motion.acceleration, motion.dt, periods, 0.05)
    ours = elastic_spectra(motion, periods).squeeze()
    np.testing.assert_allclose(theirs[0], ours.spectral_displacement, rtol=0.02)
