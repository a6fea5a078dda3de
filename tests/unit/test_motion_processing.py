"""Signal steps: what each does, that it is told in the history, and what it refuses."""

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.signals.intensity import husid, velocity
from fdspec.signals.processing import (
    band_passed,
    baseline_corrected,
    padded,
    resampled,
    rotated,
    trimmed,
    trimmed_by_arias,
)

COUNT = GroundMotion(np.arange(11.0), 0.1, "count", event="E", source="S")


def sine(frequency, n=4001, dt=0.005):
    return GroundMotion(np.sin(2.0 * np.pi * frequency * dt * np.arange(n)), dt)


@pytest.mark.parametrize(
    ("start", "end", "kept"),
    [(0.0, None, range(11)), (0.3, 0.7, range(3, 8)), (0.25, 0.75, range(3, 8)), (-1.0, 9.0, range(11))],
)
def test_trimmed_keeps_whole_samples(start, end, kept):
    motion = trimmed(COUNT, start, end)
    assert motion.acceleration.tolist() == list(kept)
    assert motion.dt == 0.1
    assert (motion.event, motion.source) == ("E", "S")


def test_steps_leave_a_trace():
    motion = padded(trimmed(COUNT, 0.3, 0.7), after=0.2).scaled(2.0)
    assert motion.history == (
        "trimmed to 0.3 to 0.7 s",
        "padded with 0 s of zeros before and 0.2 s after",
        "scaled by 2.0",
    )
    assert COUNT.history == ()


def test_trimming_to_nothing_is_refused():
    with pytest.raises(InvalidInput, match="must keep 2 samples or more, not 0.5 to 0.5 s"):
        trimmed(COUNT, 0.5, 0.5)
    with pytest.raises(InvalidInput, match="start must be a number, not 'now'"):
        trimmed(COUNT, "now")


def test_trimmed_by_arias_keeps_at_least_the_share():
    motion = GroundMotion(np.random.default_rng(4).normal(size=500) * np.hanning(500), 0.01)
    kept = trimmed_by_arias(motion)
    assert 0.9 * husid(motion)[-1] <= husid(kept)[-1] < 0.91 * husid(motion)[-1]
    assert kept.history == ("trimmed to 0.05 to 0.95 of the Arias intensity",)
    assert trimmed_by_arias(motion, 0.0, 1.0).n == motion.n
    with pytest.raises(InvalidInput, match="0 <= start < end <= 1"):
        trimmed_by_arias(motion, 0.9, 0.1)


def test_padded():
    assert padded(GroundMotion([1.0, 2.0], 0.1), 0.2, 0.1).acceleration.tolist() == [0.0, 0.0, 1.0, 2.0, 0.0]
    with pytest.raises(InvalidInput, match="before must be 0 s or more, not -1"):
        padded(COUNT, -1)
    with pytest.raises(InvalidInput, match=r"after must be at most 1e\+06 s, not 1e\+300"):
        padded(COUNT, after=1e300)


@pytest.mark.parametrize("dt", [0.0025, 0.01, 0.02, 0.0075])
def test_resampled_keeps_what_both_steps_carry(dt):
    motion = resampled(sine(1.0), dt)
    assert motion.dt == dt
    inner = slice(len(motion) // 10, -len(motion) // 10)  # the filter knows nothing beyond the ends
    np.testing.assert_allclose(
        motion.acceleration[inner], np.sin(2.0 * np.pi * motion.time)[inner], atol=2e-3
    )
    assert motion.history == (f"resampled from 0.005 to {dt:g} s",)


@pytest.mark.parametrize("dt", [0.0025, 0.01, 0.0075, 0.004, 0.00488])
@pytest.mark.parametrize("n", [2, 3, 100, 257])
def test_resampled_neither_fades_at_the_ends_nor_lengthens(dt, n):
    constant = GroundMotion(np.full(n, 2.5), 0.005)
    line = GroundMotion(np.linspace(-1.0, 3.0, n), 0.005)
    if constant.duration < dt:
        with pytest.raises(InvalidInput, match="dt must leave 2 samples or more"):
            resampled(constant, dt)
        return
    for motion in (constant, line):
        new = resampled(motion, dt)
        assert motion.duration - dt < new.duration <= motion.duration * (1.0 + 1e-12)
        expected = np.interp(new.time, motion.time, motion.acceleration)
        np.testing.assert_allclose(new.acceleration, expected, atol=1e-12)


def test_resampled_takes_out_what_the_new_step_cannot_carry():
    assert np.abs(resampled(sine(80.0), 0.02).acceleration[50:-50]).max() < 0.02


def test_resampling_to_an_odd_step_is_refused():
    with pytest.raises(
        InvalidInput, match="dt must stand to 0.005 s as two whole numbers up to 1000, not 0.00314159"
    ):
        resampled(sine(1.0), 0.00314159)
    with pytest.raises(InvalidInput, match="dt must be positive"):
        resampled(sine(1.0), 0.0)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_baseline_removes_a_polynomial_and_no_more(order):
    pure = padded(band_passed(sine(2.0), 0.5, 20.0), 2.0, 2.0)
    drift = 0.03 * (np.arange(pure.n) / pure.n) ** (order - 1)
    drifted = GroundMotion(pure.acceleration + drift, pure.dt)
    assert np.abs(velocity(drifted)[-1]) > 0.1
    corrected = baseline_corrected(drifted, order)
    expected = baseline_corrected(pure, order)
    np.testing.assert_allclose(corrected.acceleration, expected.acceleration, atol=2e-5)
    assert corrected.history == (f"baseline corrected, velocity of order {order}",)


def test_band_pass_keeps_the_band_without_delay():
    both = GroundMotion(sine(0.05).acceleration + sine(5.0).acceleration + sine(80.0).acceleration, 0.005)
    kept = band_passed(both, 0.5, 20.0)
    np.testing.assert_allclose(kept.acceleration[500:-500], sine(5.0).acceleration[500:-500], atol=0.02)
    assert kept.history == ("band-passed 0.5 to 20 Hz, Butterworth order 4 both ways",)


@pytest.mark.parametrize(("low", "high"), [(5.0, 1.0), (1.0, 100.0), (1.0, 1.0)])
def test_band_pass_refuses_bands(low, high):
    with pytest.raises(InvalidInput, match="low and high must be 0 < low < high < 100 Hz"):
        band_passed(sine(1.0), low, high)
    with pytest.raises(InvalidInput, match="order must be a whole number from 1 to 12, not 0"):
        band_passed(sine(1.0), 1.0, 10.0, order=0)


def test_rotation_turns_back_and_keeps_the_length():
    chance = np.random.default_rng(8)
    a, b = (GroundMotion(chance.normal(size=50), 0.01, name) for name in ("a", "b"))
    c, d = rotated(a, b, 30.0)
    np.testing.assert_allclose(c.acceleration**2 + d.acceleration**2, a.acceleration**2 + b.acceleration**2)
    back = rotated(c, d, -30.0)
    np.testing.assert_allclose(back[0].acceleration, a.acceleration, atol=1e-14)
    np.testing.assert_allclose(rotated(a, b, 90.0)[0].acceleration, b.acceleration, atol=1e-14)
    assert c.history == ("rotated by 30 degrees, from a to b",)
    with pytest.raises(InvalidInput, match="a pair must agree in samples and dt"):
        rotated(a, COUNT, 30.0)
