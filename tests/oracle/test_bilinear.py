"""The bilinear kernel against matrix exponentials, closed forms, the textbook and the stick-slip engine."""

import math
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.engines.bilinear import Oscillator, bilinear_peaks, ductility_strengths, elastic_strength
from fdspec.kernels.bilinear.history import RESULTS
from tests.oracle.bilinear_events import bilinear

SHARED = Path(__file__).parents[3] / "shared" / "records" / "real"
INCH = 0.0254


def _random_cell(rng):
    n = int(rng.integers(20, 90))
    dt = float(rng.choice([0.005, 0.01, 0.02, 0.05]))
    ground = np.cumsum(rng.normal(size=n)) * rng.uniform(0.1, 2.0)
    ground[0] = 0.0
    ground *= min(1.0, 40.0 / np.abs(ground).max())
    period = float(np.exp(rng.uniform(np.log(4 * dt), np.log(3.0))))
    zeta = float(rng.choice([0.0, 0.02, 0.05, 0.3]))
    alpha = float(rng.choice([0.0, 0.02, 0.1, 0.5, -0.03]))
    ratio = float(rng.uniform(0.08, 1.05))
    return ground, dt, period, zeta, alpha, ratio


def _one(oscillator, period, strength, motion, halvings=0):
    row = bilinear_peaks(oscillator, period, np.array([strength]), motion, halvings=halvings)[0]
    return dict(zip(RESULTS, row, strict=True))


def _compare(seed):
    ground, dt, period, zeta, alpha, ratio = _random_cell(np.random.default_rng(seed))
    motion = fdspec.GroundMotion(np.append(ground, 0.0), dt, name="random")
    oscillator = Oscillator(zeta, alpha, math.inf)
    elastic = elastic_strength(Oscillator(zeta, 0.0, math.inf), period, motion)
    strength = ratio * elastic
    ours = _one(oscillator, period, strength, motion)
    if ours["status"] != 0.0:  # negative hardening ran away: the oracle has no end for that
        return
    # Long enough for the strength to use up the velocity that all of the ground could give.
    free = 12.0 * period + float(np.abs(motion.acceleration).sum()) * dt / strength
    peak_u, peak_a, p, travel, events = bilinear(
        motion.acceleration,
        dt,
        period=period,
        damping_ratio=zeta,
        hardening_ratio=alpha,
        strength=strength,
        free=free,
    )
    assert ours["peak_displacement"] == pytest.approx(peak_u, rel=1e-10)
    assert ours["peak_acceleration"] == pytest.approx(peak_a, rel=1e-10)
    assert ours["energy_error"] <= 1e-12
    if zeta > 0.0:
        assert ours["residual_displacement"] == pytest.approx((1.0 - alpha) * p, rel=1e-9, abs=1e-10 * peak_u)
        assert ours["plastic_travel"] == pytest.approx(travel, rel=1e-9, abs=1e-10 * peak_u)
        assert ours["transitions"] == events


@pytest.mark.parametrize("seed", range(12))
def test_random_cells(seed):
    _compare(seed)


@pytest.mark.slow
@pytest.mark.parametrize("tens", range(100))
def test_a_thousand_random_cells(tens):
    for seed in range(1000 + 10 * tens, 1010 + 10 * tens):
        _compare(seed)


@pytest.mark.parametrize("ratio", [0.6, 0.8, 0.9, 0.95])
def test_a_load_applied_at_once(ratio):
    motion = fdspec.GroundMotion(np.full(801, -1.0), 0.01, name="load")
    strength = 1.0 / ratio
    row = _one(Oscillator(0.0, 0.0, math.inf), 1.0, strength, motion)
    ductility = row["peak_displacement"] * 4.0 * math.pi**2 / strength
    assert ductility == pytest.approx(0.5 / (1.0 - ratio), rel=1e-12)


def test_a_rigid_block_under_a_pulse():
    """Slip V^2/(2N) (1 - N/A) under a rectangular pulse; the ramp of one sample is a triangle beside it."""
    strength, length, dt = 0.4, 1.0, 1e-6
    motion = fdspec.GroundMotion([1.0, 1.0, 1.0 - 1e-15], length / 2, name="pulse")
    row = _one(Oscillator(0.05, 0.0, math.inf), 0.0, strength, motion)
    assert row["peak_displacement"] == pytest.approx(length**2 / (2 * strength) * (1 - strength), rel=1e-12)
    assert row["energy_error"] <= 1e-12
    assert dt < length


def test_halving_changes_nothing():
    motion = fdspec.load_record("FSR1")
    for alpha in (0.0, 0.1, -0.02):
        for period in (0.07, 0.4, 2.0):
            oscillator = Oscillator(0.05, alpha, math.inf)
            strength = 0.3 * elastic_strength(oscillator, period, motion)
            once, twice = (_one(oscillator, period, strength, motion, halvings=h) for h in (0, 1))
            if once["status"] == 0.0:
                for name in RESULTS[:6]:
                    assert twice[name] == pytest.approx(once[name], rel=1e-10), (alpha, period, name)
                assert twice["transitions"] == once["transitions"]


def test_a_massless_brace_is_a_bilinear_spring():
    """T_bare = T/sqrt(alpha), zeta_bare = zeta/sqrt(alpha), SR = (1 - alpha)/alpha, F = (1 - alpha) f_y."""
    motion = fdspec.load_record("FMR1")
    mass, period, zeta, alpha = 1000.0, 0.5, 0.03, 0.2
    oscillator = Oscillator(zeta, alpha, math.inf)
    strength = 0.25 * elastic_strength(oscillator, period, motion)
    frame = fdspec.Building.single_storey(
        period=period / math.sqrt(alpha),
        stiffness_ratio=(1.0 - alpha) / alpha,
        slip_force=(1.0 - alpha) * strength * mass,
        floor_mass=mass,
        brace_mass=0.0,
        damping_ratio=zeta / math.sqrt(alpha),
    )
    history = fdspec.simulate(frame, motion)
    row = _one(oscillator, period, strength, motion)
    assert row["peak_displacement"] == pytest.approx(history.peak_displacement.item(), rel=1e-12)
    assert row["peak_acceleration"] == pytest.approx(history.peak_acceleration.item(), rel=1e-12)


def _el_centro():
    return fdspec.read_record(SHARED / "ElCentro_1940_NS_Chopra_ms2.txt", units="m/s2")


@pytest.mark.skipif(not SHARED.is_dir(), reason="the folder of real records is not there")
def test_the_textbook():
    """Chopra's El Centro, T 0.5 s, 5 %, elastoplastic: every digit the book prints and the exact ones."""
    motion = _el_centro()
    oscillator = Oscillator(0.05, 0.0, math.inf)
    elastic = elastic_strength(oscillator, 0.5, motion)
    assert elastic / 9.80665 == pytest.approx(0.9190, abs=5e-5)
    roots, counts = ductility_strengths(oscillator, 0.5, np.array([2.0, 4.0, 8.0]), motion)
    assert 100 * roots[:, 0] / elastic == pytest.approx([36.96, 19.54, 12.03], abs=5e-3)
    assert counts.min() >= 1
    omega = 4.0 * math.pi
    for ratio, inches, ductility in (
        (1, 2.247, 1),
        (0.5, 1.625, 1.446),
        (0.25, 1.746, 3.108),
        (0.125, 2.065, 7.351),
    ):
        row = _one(oscillator, 0.5, ratio * elastic, motion)
        assert row["peak_displacement"] / INCH == pytest.approx(inches, abs=5e-4)
        assert row["peak_displacement"] * omega**2 / (ratio * elastic) == pytest.approx(ductility, abs=5e-4)


@pytest.mark.skipif(not SHARED.is_dir(), reason="the folder of real records is not there")
@pytest.mark.parametrize(
    ("period", "yield_displacement", "ductility"), [(0.2, 0.004875, 5.051), (5.0, 0.023, 4.993)]
)
def test_san_salvador(period, yield_displacement, ductility):
    """Uang and Bertero's record."""
    motion = fdspec.read_record(SHARED / "SanSalvador_1986_GIC090_ms2.txt", units="m/s2")
    strength = yield_displacement * (2.0 * math.pi / period) ** 2
    row = _one(Oscillator(0.05, 0.0, math.inf), period, strength, motion)
    assert row["peak_displacement"] / yield_displacement == pytest.approx(ductility, abs=5e-4)


def _roots_of_a_dense_scan(oscillator, period, target, motion):
    """Brackets of every root on 1 000 strengths, down to well below where the last may lie."""
    elastic = elastic_strength(oscillator, period, motion)
    strengths = elastic * np.geomspace(1.0, 0.3 / target, 1000)
    peaks = bilinear_peaks(oscillator, period, strengths, motion)[:, 0]
    above = peaks * (2.0 * math.pi / period) ** 2 / strengths > target
    at = np.flatnonzero(np.diff(above))
    return strengths[at + 1], strengths[at]


@pytest.mark.slow
def test_every_root_of_two_hundred():
    rng = np.random.default_rng(5)
    names = ["FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3"]
    motions = {name: fdspec.load_record(name) for name in names}
    several = 0
    for _ in range(200):
        motion = motions[str(rng.choice(names))]
        period = float(np.exp(rng.uniform(np.log(0.08), np.log(4.0))))
        target = float(rng.choice([1.5, 2.0, 3.0, 4.0, 6.0, 8.0]))
        oscillator = Oscillator(0.05, float(rng.choice([0.0, 0.05])), math.inf)
        roots, counts = ductility_strengths(oscillator, period, np.array([target]), motion)
        low, high = _roots_of_a_dense_scan(oscillator, period, target, motion)
        found = roots[0, : counts[0]]
        for a, b in zip(low, high, strict=True):
            assert ((found >= a * (1 - 1e-12)) & (found <= b * (1 + 1e-12))).any(), (
                motion.name,
                period,
                target,
            )
        several += counts[0] > 1
        peaks = bilinear_peaks(oscillator, period, found, motion)[:, 0]
        assert peaks * (2.0 * math.pi / period) ** 2 / found == pytest.approx(target, rel=1e-11)
    assert several > 5  # ductility is not monotonic in strength
