"""Intensity measures against integrals on paper."""

import math

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.signals.intensity import arias_time, displacement, husid, intensity, mean_period, velocity
from fdspec.units import G

RAMP = GroundMotion(np.arange(5.0), 0.5)  # a = 2 t up to t = 2


def test_integrals_of_a_ramp_are_exact():
    t = RAMP.time
    np.testing.assert_allclose(velocity(RAMP), t**2, rtol=1e-15)
    np.testing.assert_allclose(displacement(RAMP), t**3 / 3.0, rtol=1e-15)
    np.testing.assert_allclose(husid(RAMP), math.pi / (2.0 * G) * 4.0 * t**3 / 3.0, rtol=1e-15)


def test_measures_of_a_ramp():
    found = intensity(RAMP)
    assert (found.pga, found.pgv, found.cav) == (4.0, 4.0, 4.0)
    assert found.pgd == pytest.approx(8.0 / 3.0, rel=1e-15)
    assert found.arias == pytest.approx(math.pi / (2.0 * G) * 32.0 / 3.0, rel=1e-15)


def test_cav_takes_both_triangles_where_the_sign_changes():
    assert intensity(GroundMotion([-1.0, 3.0], 0.4)).cav == pytest.approx(0.5 * (0.1 + 3.0 * 0.3), rel=1e-15)
    assert intensity(GroundMotion([0.0, -2.0, 0.0], 1.0)).cav == 2.0


def test_a_sine_has_textbook_measures():
    """One second of a sine of 1 Hz and 1 m/s2, sampled finely enough for straight lines."""
    motion = GroundMotion(np.sin(2.0 * np.pi * np.linspace(0.0, 1.0, 20_001)), 1.0 / 20_000)
    found = intensity(motion)
    assert found.arias == pytest.approx(math.pi / (2.0 * G) * 0.5, rel=1e-7)
    assert found.pgv == pytest.approx(1.0 / math.pi, rel=1e-7)
    assert found.cav == pytest.approx(2.0 / math.pi, rel=1e-7)
    assert found.pgd == pytest.approx(1.0 / (2.0 * math.pi), rel=1e-7)


def test_significant_duration_of_a_constant():
    """Arias intensity of a constant grows evenly: 5 to 95 % is nine tenths of the whole."""
    constant = GroundMotion(np.ones(101), 0.1)
    assert intensity(constant).significant_duration == pytest.approx(9.0, rel=1e-12)
    assert intensity(constant, 0.05, 0.75).significant_duration == pytest.approx(7.0, rel=1e-12)
    assert arias_time(constant, 0.0) == 0.0
    assert arias_time(constant, 1.0) == pytest.approx(10.0, rel=1e-15)


def test_peaks_between_samples_count():
    """From rest under a = 2 - 4 t, v = 2 t - 2 t^2 is largest at 0.5 s, where there is no sample."""
    assert intensity(GroundMotion([2.0, -2.0], 1.0)).pgv == pytest.approx(0.5, rel=1e-15)
    coarse = GroundMotion([2.0, -2.0, -2.0, 3.0, 1.0, -4.0, 0.5], 1.0)
    fine = GroundMotion(np.interp(np.arange(60_001) / 1e4, coarse.time, coarse.acceleration), 1e-4)
    assert intensity(coarse).pgv == pytest.approx(np.abs(velocity(fine)).max(), rel=1e-7)
    assert intensity(coarse).pgd == pytest.approx(np.abs(displacement(fine)).max(), rel=1e-7)
    # v = 1 - 1.25 t^2 after the first second: the displacement turns within the next.
    swing = GroundMotion([2.0, 0.0, -2.5, -2.5], 1.0)
    fine = GroundMotion(np.interp(np.arange(30_001) / 1e4, swing.time, swing.acceleration), 1e-4)
    assert intensity(swing).pgd == pytest.approx(np.abs(displacement(fine)).max(), rel=1e-7)
    assert intensity(swing).pgd > np.abs(displacement(swing)).max()


def test_all_of_the_arias_intensity_has_arrived_where_the_shaking_ends():
    quiet = GroundMotion(np.concatenate([np.zeros(5), np.ones(11), np.zeros(50)]), 0.1)
    assert arias_time(quiet, 1.0) == pytest.approx(1.6, rel=1e-12)
    assert arias_time(quiet, 0.0) == 0.0


def test_refusals():
    with pytest.raises(InvalidInput, match="share must be from 0 to 1, not 1.5"):
        arias_time(RAMP, 1.5)
    with pytest.raises(InvalidInput, match="zero throughout has no Arias intensity"):
        arias_time(GroundMotion([0.0, 0.0], 0.1), 0.5)
    with pytest.raises(InvalidInput, match="start must be below end, not 0.9 and 0.1"):
        intensity(RAMP, 0.9, 0.1)


def test_the_mean_period_lies_between_those_of_two_sines_by_their_power():
    time = np.arange(0.0, 40.0, 0.01)
    both = 3.0 * np.sin(2.0 * np.pi * time / 0.5) + np.sin(2.0 * np.pi * time / 2.0)
    assert mean_period(GroundMotion(both, 0.01)) == pytest.approx((9.0 * 0.5 + 2.0) / 10.0, rel=1e-3)
    with pytest.raises(InvalidInput, match="wave has nothing between 0.25 and 20 Hz"):
        mean_period(GroundMotion(np.zeros(100), 0.01, name="wave"))
