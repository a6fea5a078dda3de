"""Scaling of motions: the scaled motion has what was asked for, found by other means."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fdspec.errors import InvalidInput, RecordError, StudyError
from fdspec.model.motion import GroundMotion
from fdspec.records import load_record
from fdspec.runs.record_scaling import Scaling
from fdspec.runs.study import Study
from fdspec.runs.study_records import RecordFile
from fdspec.signals.scaling import (
    Target,
    band,
    pair_spectrum,
    read_target,
    scaled_to_spectrum,
    spectrum,
    target_spectrum,
)


def record(seed: int, name: str = "a", samples: int = 80) -> GroundMotion:
    rng = np.random.default_rng(seed)
    return GroundMotion(np.convolve(rng.standard_normal(samples), np.ones(4) / 2.0, mode="same"), 0.02, name)


def dense_peak(samples: np.ndarray, dt: float, period: float, ratio: float) -> float:
    """Pseudo-acceleration by an integrator that knows nothing of closed forms, 40 points a sample."""
    omega = 2.0 * math.pi / period
    times = np.arange(samples.size) * dt

    def rate(t: float, state: np.ndarray) -> list[float]:
        ground = np.interp(t, times, samples)
        return [state[1], -ground - 2.0 * ratio * omega * state[1] - omega * omega * state[0]]

    at = np.linspace(0.0, times[-1], 40 * samples.size)
    found = solve_ivp(rate, (0.0, times[-1]), [0.0, 0.0], t_eval=at, rtol=1e-9, atol=1e-12, max_step=dt)
    return float(omega**2 * np.abs(found.y[0]).max())


def test_one_ordinate() -> None:
    motion = scaled_to_spectrum(record(1), 4.2, 0.4, damping_ratio=0.02)
    assert spectrum(motion, 0.4, damping_ratio=0.02)[0] == pytest.approx(4.2, rel=1e-12)
    assert dense_peak(motion.acceleration, motion.dt, 0.4, 0.02) == pytest.approx(4.2, rel=1e-4)
    assert motion.history[-1].startswith(f"scaled by {motion.scale_factor!r} to an Sa of 4.2 m/s2 at 0.4 s")


def test_the_geometric_mean_over_a_band() -> None:
    motion = scaled_to_spectrum(record(2), 3.0, (0.2, 1.5))
    ordinates = spectrum(motion, np.geomspace(0.2, 1.5, 50))
    assert math.exp(np.log(ordinates).mean()) == pytest.approx(3.0, rel=1e-12)
    assert "a mean Sa of 3.0 m/s2 at 0.2 to 1.5 s" in motion.history[-1]


def test_no_other_factor_is_closer_to_a_target() -> None:
    target = target_spectrum([0.1, 0.5, 1.0, 3.0], [6.0, 8.0, 5.0, 1.5])
    motion, periods = record(3), band(0.2, 2.0)
    wanted, given = np.log(target.at(periods)), np.log(spectrum(motion, periods))

    def misfit(factor: float) -> float:
        return float(((math.log(factor) + given - wanted) ** 2).sum())

    best = scaled_to_spectrum(motion, target, (0.2, 2.0)).scale_factor
    assert all(misfit(best) < misfit(best * (1.0 + step)) for step in (-1e-3, -1e-6, 1e-6, 1e-3))


def test_pairs_over_all_directions() -> None:
    one, two = record(4), record(5, "b")
    period = 0.5
    turned = [
        dense_peak(
            math.cos(angle) * one.acceleration + math.sin(angle) * two.acceleration, one.dt, period, 0.05
        )
        for angle in np.radians(np.arange(0, 180, 15))
    ]
    largest = float(pair_spectrum(one, two, period, "rotd100")[0])
    middle = float(pair_spectrum(one, two, period, "rotd50")[0])
    assert max(turned) <= largest * (1.0 + 1e-6)
    assert largest == pytest.approx(max(turned), rel=0.02)
    assert min(turned) < middle < max(turned)
    both = (
        dense_peak(one.acceleration, one.dt, period, 0.05),
        dense_peak(two.acceleration, one.dt, period, 0.05),
    )
    assert pair_spectrum(one, two, period, "geometric_mean")[0] == pytest.approx(
        math.sqrt(both[0] * both[1]), 1e-4
    )


def test_a_polarised_pair_in_closed_form() -> None:
    """Both components the same motion at right angles: a motion of sqrt(2) times it along 45 degrees."""
    one = record(6)
    other = GroundMotion(one.acceleration, one.dt, "b")
    alone = float(spectrum(one, 0.6)[0])
    assert pair_spectrum(one, other, 0.6, "rotd100")[0] == pytest.approx(math.sqrt(2.0) * alone, rel=1e-12)
    angles = np.radians(np.arange(180))
    expected = alone * np.median(np.abs(np.cos(angles) + np.sin(angles)))
    assert pair_spectrum(one, other, 0.6, "rotd50")[0] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("combination", ["geometric_mean", "rotd50", "rotd100"])
def test_both_of_a_pair_get_one_factor(combination: str) -> None:
    one, two = record(7), record(8, "b")
    scaled = [
        scaled_to_spectrum(a, 5.0, 0.7, pair=b, combination=combination)  # type: ignore[arg-type]
        for a, b in ((one, two), (two, one))
    ]
    assert scaled[0].scale_factor == pytest.approx(scaled[1].scale_factor, rel=1e-12)
    assert pair_spectrum(*scaled, 0.7, combination)[0] == pytest.approx(5.0, rel=1e-10)  # type: ignore[arg-type]
    assert f"{combination} with b" in scaled[0].history[-1]


def test_targets_in_files(tmp_path: Path) -> None:
    path = tmp_path / "target.csv"
    path.write_text("T (s), Sa (g)\n0,0.4\n0.1,1.0\n\n1.0,0.5\n")
    target = read_target(path)
    np.testing.assert_allclose(target.period, [0.1, 1.0])
    np.testing.assert_allclose(target.acceleration, [9.80665, 4.903325])
    assert target.at([0.1, 10.0**-0.5])[1] == pytest.approx(9.80665 * math.sqrt(0.5))
    path.write_text("0.1,1.0\n1.0,0.5\n")
    np.testing.assert_allclose(read_target(path, "m/s2").acceleration, [1.0, 0.5])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.1,1\n1,0.5\n", "does not say the unit"),
        ("Sa (g), Sv (cm/s2)\n0.1,1\n1,0.5\n", "does not say the unit"),
        ("T,g\n1,1\n0.5,2\n", "must rise, but 0.5 follows 1"),
        ("T,g\n1,1\n2,-1\n", "must be positive"),
        ("T,g\n", "holds no rows"),
        ("T,g\n1,1\nx,2\n", "line 3"),
        ("T,g\n1,1\n", "two or more points"),
    ],
)
def test_targets_that_cannot_be_used(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "target.csv"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=message):
        read_target(path)


def test_what_cannot_be_scaled() -> None:
    nothing = GroundMotion(np.zeros(10), 0.02, "nothing")
    with pytest.raises(InvalidInput, match="nothing has no response"):
        scaled_to_spectrum(nothing, 1.0, 0.5)
    with pytest.raises(InvalidInput, match="reaches from 0.5 to 1 s"):
        scaled_to_spectrum(record(1), Target(np.array([0.5, 1.0]), np.ones(2)), (0.2, 2.0))
    with pytest.raises(InvalidInput, match="target must be positive"):
        scaled_to_spectrum(record(1), -1.0, 0.5)


def test_study_files_scale_records(tmp_path: Path) -> None:
    (tmp_path / "target.csv").write_text("T (s),Sa (g)\n0.1,1.0\n2.0,0.3\n")
    for name, seed in (("ns", 1), ("ew", 2)):
        samples = "\n".join(f"{value:.9f}" for value in record(seed).acceleration)
        (tmp_path / f"{name}.txt").write_text(samples)
    text = """
records = [
  "FSR1",
  { path = "FSR2", factor = 2.0 },
  { path = "FSR3", pga = 3.0 },
  { path = "FMR1", sa = 4.0, period = 0.5, damping_ratio = 0.02 },
  { path = "FMR2", target = "target.csv", period = [0.2, 1.5] },
  { path = "ns.txt", units="m/s2", dt=0.02, sa=6, period=1, pair = "ew.txt", combination = "rotd100" },
]
scaling = { sa = 5.0, period = [0.1, 1.0] }
"""
    study = Study.parse(text, folder=tmp_path)
    again = Study.parse(study.to_toml(), folder=tmp_path)
    assert (again.records, again.scaling) == (study.records, study.scaling)
    first, doubled, to_pga, to_sa, to_target, paired = study.motions()
    assert math.exp(np.log(spectrum(first, band(0.1, 1.0))).mean()) == pytest.approx(5.0)
    assert doubled.pga == pytest.approx(2.0 * load_record("FSR2").pga)
    assert to_pga.pga == pytest.approx(3.0)
    assert spectrum(to_sa, 0.5, damping_ratio=0.02)[0] == pytest.approx(4.0)
    wanted = read_target(tmp_path / "target.csv").at(band(0.2, 1.5))
    assert np.log(spectrum(to_target, band(0.2, 1.5)) / wanted).mean() == pytest.approx(0.0, abs=1e-12)
    other = Study(
        records=(RecordFile("ew.txt", units="m/s2", dt=0.02, scaling=Scaling(factor=paired.scale_factor)),),
        folder=tmp_path,
    ).motions()[0]
    assert pair_spectrum(paired, other, 1.0, "rotd100")[0] == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("scaling = 2.0", "scaling: must be a table"),
        ("scaling = { sa = 2.0 }", "scaling: sa needs period"),
        ("scaling = { sa = 2.0, pga = 1.0, period = 1 }", "scaling: give one of factor, pga, sa, target"),
        ("scaling = { }", "scaling: give one of factor, pga, sa, target, not none"),
        ("scaling = { pga = -1 }", "scaling: pga must be positive"),
        ("scaling = { pga = 1, pair = 'b.txt' }", "scaling: pair go with sa and target"),
        ("scaling = { sa = 1, period = [2, 1] }", "scaling: period must be one or two rising"),
        ("scaling = { target = 'a.csv', period = 1 }", "scaling: target needs the two ends"),
        ("scaling = { goal = 1 }", "scaling: unknown key 'goal'"),
        ("records = [{ path = 'FSR1', sa = 1 }]", "records: sa needs period"),
        ("records = [{ path = 'FSR1', factor = 0 }]", "records: factor must be a number other than 0"),
        (
            "records = [{ path = 'FSR1', sa = 1, period = 1, combination = 'max' }]",
            "records: combination must",
        ),
    ],
)
def test_mistakes_in_study_files(line: str, message: str) -> None:
    with pytest.raises(StudyError, match="line 1: " + message):
        Study.parse(line)


def test_a_target_that_is_not_there_is_told_with_the_record(tmp_path: Path) -> None:
    study = Study.parse(
        "records = [{ path = 'FSR1', target = 'none.csv', period = [0.2, 1] }]", folder=tmp_path
    )
    with pytest.raises(RecordError, match="FSR1: cannot read .*none.csv"):
        study.motions()
