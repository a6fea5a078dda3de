"""Limits on demands against brute force: every kilonewton, every level, every bound, one by one."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.choice.targets import meet, target_of
from fdspec.cli.main import main
from fdspec.engines.batch import integrate_columns
from fdspec.errors import InvalidInput
from fdspec.kernels.storey.history import RESULTS
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.store import open as open_cube

RESPONSES = {"acceleration": "peak_acceleration", "drift": "peak_displacement", "slip": "peak_slip"}


def record(seed: int, samples: int = 120) -> GroundMotion:
    rng = np.random.default_rng(seed)
    shake = np.convolve(rng.standard_normal(samples), np.ones(5) / 5.0, mode="same")
    return GroundMotion(4.0 * shake / np.abs(shake).max(), 0.02, name=f"r{seed}")


def with_slip_force(building: Building, force: np.ndarray) -> Building:
    """The building with these slip forces, kinetic friction as large."""
    return building.with_changes(slip_force=force, kinetic_slip_force=force)


def shares(
    building: Building, motions: list[GroundMotion], limits: dict[str, float], force: np.ndarray
) -> np.ndarray:
    """Largest demand over its limit at each slip force, by the sweep's own engine and nothing else."""
    worst = np.zeros(force.size)
    frame = np.array([building.storey[:6]])
    for level in (1.0, 1.5):
        for bound in (0.8, 1.0, 1.2):
            found = [
                integrate_columns(frame, bound * force, bound * force, motion.scaled(level), certify=False)[
                    1
                ][0]
                for motion in motions
            ]
            for name, limit in limits.items():
                mean = np.mean([part[:, RESULTS.index(RESPONSES[name])] for part in found], axis=0)
                worst = np.maximum(worst, mean / limit)
    return worst


def check_against_brute_force(seed: int) -> bool:
    rng = np.random.default_rng(seed)
    building = Building.single_storey(rng.uniform(0.2, 1.0), rng.uniform(2.0, 8.0), 1.0)
    motions = [record(3 * seed + k) for k in range(3)]
    force = 1e3 * np.arange(0.0, 160.0)
    limits = {"acceleration": rng.uniform(3.0, 9.0), "drift": rng.uniform(0.005, 0.08)}
    limits["slip"] = rng.uniform(0.005, 0.15)  # last, so that the others stay what they were
    target = meet(building, motions, limits, levels=[1.0, 1.5])
    known = shares(building, motions, limits, force)
    inside = np.zeros(force.size, dtype=bool)
    for start, end in target.bands:
        inside |= (force >= start) & (force <= end)
        edges = np.array([start] if np.isinf(end) else [start, end])
        assert shares(building, motions, limits, edges).max() <= 1.0 + 1e-12
    good = known <= 1.0
    # Where they differ, a stretch is narrower than a step of the scan, or an end within a few newtons.
    assert np.abs(known[good != inside] - 1.0).max(initial=0.0) < 0.02
    if target.met:
        first = force[good][0] if good.any() else np.inf
        assert target.slip_force[0] <= first + 1.0 or abs(known[force == first][0] - 1.0) < 0.02
        assert target.worst.value <= target.worst.limit * (1.0 + 1e-12)
    else:
        assert target.worst.value > target.worst.limit
        assert target.worst.value / target.worst.limit <= known.min() * 1.02
    return target.met


def test_three_random_frames() -> None:
    assert {check_against_brute_force(seed) for seed in range(3, 6)} == {True, False}


@pytest.mark.slow
def test_a_hundred_random_frames() -> None:
    assert {check_against_brute_force(seed) for seed in range(6, 106)} == {True, False}


def test_from_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["choose", "--record", "FSR1", "--period", "0.5", "--storey-height", "3"]
    assert main([*given, "--limit", "drift_ratio=0.02", "--limit", "acceleration=3g", "--level", "DE"]) == 0
    assert "All limits are met at slip forces of" in capsys.readouterr().out
    assert main([*given, "--limit", "drift=0.001mm"]) == 1
    out = capsys.readouterr().out
    assert "No slip force meets all limits: peak drift at level 1 is over its limit by" in out


def test_a_limit_on_the_slip_of_storeys_holds_in_their_histories() -> None:
    building = Building.from_periods([20e3, 15e3], 0.6, 0.35, 1.0, brace_mass=25.0)
    motion = record(7)
    target = meet(building, motion, {"slip": 0.02}, distribution="shear", lower=0.9, upper=1.1)

    def slip(factor: float) -> float:
        history = simulate(with_slip_force(building, factor * target.slip_force), motion)
        return float(history["peak_slip"].max())

    assert target.met
    assert max(map(slip, (0.9, 1.0, 1.1))) == pytest.approx(target.worst.value, rel=1e-9)
    assert target.worst.value <= 0.02
    assert max(map(slip, (0.89, 0.99, 1.09))) > 0.02  # a little less would not do


def test_drift_ratios_are_those_of_each_storey_s_own_height() -> None:
    building = Building.from_periods([20e3, 15e3], 0.6, 0.35, 1.0, brace_mass=25.0)
    building = building.with_changes(storey_height=[5.0, 2.5])
    motion = record(7)
    target = meet(building, motion, {"drift_ratio": 0.0045}, distribution="shear")
    ratios = [
        simulate(with_slip_force(building, bound * target.slip_force), motion)["peak_drift"] / [5.0, 2.5]
        for bound in (0.8, 1.0, 1.2)
    ]
    assert target.slip_force.min() > 0.0
    assert max(float(ratio.max()) for ratio in ratios) == pytest.approx(target.worst.value, rel=1e-9)
    assert target.worst.value <= 0.0045


@pytest.mark.parametrize("limit", ["0.1mm", "60mm"])
def test_limits_in_file_page_and_json(limit: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What cannot be met ends with 1, and everything is written all the same."""
    given = ["choose", "--record", "FSR1", "--limit", f"slip={limit}", "--limit", "acceleration=1.2g"]
    given += ["--level", "MCE", "--html", str(tmp_path / "c.html"), "-o", str(tmp_path / "c.nc")]
    met = limit == "60mm"
    assert main(given) == (0 if met else 1)
    told = capsys.readouterr().out
    page = (tmp_path / "c.html").read_text(encoding="utf-8")
    choice = open_cube(tmp_path / "c.nc")
    assert bool(choice["limits_met"]) is met
    target = target_of(choice)
    assert [one.name for one in target.demands] == ["slip", "acceleration"]
    force = target.slip_force[0]
    motion = fdspec.load_record("FSR1").times(1.5)
    building = Building.single_storey(0.5, 4.0, 1.0)
    slip = max(
        simulate(with_slip_force(building, bound * target.slip_force), motion)["peak_slip"].item()
        for bound in (0.8, 1.0, 1.2)
    )
    assert choice["used"].sel(limited="slip").item() == pytest.approx(
        slip / target.demands[0].limit, rel=1e-9
    )
    assert choice["storey_slip"].max().item() == pytest.approx(slip, rel=1e-9)
    if met:
        assert told.startswith("Least slip force")
        assert "It is the least that meets all limits" in page
        assert choice["band_slip_force"].values[0, 0] == force == choice["slip_force"].item()
    else:
        over = f"{100.0 * (target.worst.value / target.worst.limit - 1.0):.1f} %"
        assert f"is over its limit by {over} at best" in told
        assert "No slip force meets all limits" in page
        assert np.isnan(choice["band_slip_force"]).all()
    assert main([*given[:-4], "--json"]) == (0 if met else 1)
    results = json.loads(capsys.readouterr().out)["variables"]
    assert results["limits_met"]["values"] == int(met)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"limits": {}}, "at least one of"),
        ({"limits": {"slide": 0.1}}, "limit 'slide' is none of"),
        ({"limits": {"drift": -1.0}}, "limit drift must be positive"),
        ({"levels": [0.0]}, "levels must be positive"),
        ({"lower": 1.1}, "lower and upper"),
        ({"distribution": "free"}, "distribution must be uniform or shear"),
        ({"limits": {"drift_ratio": 0.01}}, "needs storey_height"),
    ],
)
def test_what_cannot_be_asked(change: dict[str, object], message: str) -> None:
    arguments: dict[str, object] = {"limits": {"drift": 0.01}, **change}
    with pytest.raises(InvalidInput, match=message):
        meet(Building.single_storey(0.5, 4.0, 1.0), record(1), **arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "options",
    [["--limit", "drift"], ["--limit", "drift=x"], ["--level", "1"], ["--limit", "drift=1", "--level", "no"]],
)
def test_wrong_usage(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["choose", *options]) == 2
    assert "--l" in capsys.readouterr().err
