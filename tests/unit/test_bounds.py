"""Runs without end are refused before they begin: nothing is allocated, nothing is compiled."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec.cli import main
from fdspec.errors import InvalidInput
from fdspec.model.grid import Grid
from fdspec.runs import bounds
from fdspec.runs.bounds import memory_free
from fdspec.runs.cost import seconds_of_history, seconds_of_sweep

AXES: dict[str, Any] = {"period": [0.5], "pretension": [50e3], "stiffness_ratio": [4.0]}


@pytest.fixture(autouse=True)
def at_once() -> Iterator[None]:
    """Fail a test that began the work."""
    began = time.monotonic()
    yield
    assert time.monotonic() - began < 20.0


def motion(n: int = 4000, dt: float = 0.01) -> fdspec.GroundMotion:
    return fdspec.GroundMotion(np.sin(np.arange(n)), dt, "mine")


@pytest.mark.parametrize("points", [10_000, 100_000, 1_000_000])
@pytest.mark.parametrize("dry", [[], ["--dry-run"]])
def test_a_study_of_too_many_cells_is_one_line(
    points: int, dry: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    """10^12 to 10^18 histories, from ranges in a file."""
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(
        'records = ["FSR1"]\n'
        f"period = {{ start = 0.1, stop = 2.0, num = {points} }}\n"
        f"pretension = {{ start = 1e4, stop = 1e6, num = {points} }}\n"
        f"stiffness_ratio = {{ start = 0.5, stop = 10.0, num = {points} }}\n",
        encoding="utf-8",
    )
    assert main(["sweep", "s.toml", *dry]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert f"a sweep of {points**3:.4g} histories would take" in err
    assert "TB, but" in err or "hours of core time" in err
    assert {path.name for path in tmp_path.iterdir()} == {"s.toml"}


@pytest.mark.parametrize("store", [None, "cube.zarr"])
def test_a_sweep_larger_than_memory_or_disk(
    store: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bounds, "memory_free", lambda: 1e3)
    monkeypatch.setattr(bounds, "_disk_free", lambda folder: 1e3)
    many = {**AXES, "pretension": np.linspace(1e3, 1e6, 1000)}
    where = "1 kB of memory are free; a store" if store is None else "1 kB on the disk of "
    with pytest.raises(InvalidInput, match=f"a sweep of 1000 histories would take .* kB, but {where}"):
        fdspec.sweep(motion(), **many, store=store and tmp_path / store)


@pytest.mark.parametrize(
    ("changed", "dt"),
    [
        ({"period": [1e-6], "pretension": np.linspace(1e3, 1e6, 10_000_000)}, 0.01),
        ({"period": [1e-9]}, 100.0),
        ({"brace_mass": 1e-30}, 0.01),
        ({}, 1e12),
    ],
)
def test_a_sweep_that_would_take_years(changed: dict[str, Any], dt: float) -> None:
    with pytest.raises(
        InvalidInput, match=r"hours of core time, over the limit of 1000: are period, brace mass"
    ):
        fdspec.sweep(motion(dt=dt), **{**AXES, **changed}, outputs=["peak_acceleration"])


@pytest.mark.parametrize(
    ("changed", "options", "dt"),
    [
        ({"period": 1e-9}, {}, 0.01),
        ({"brace_mass": 1e-18}, {}, 0.01),
        ({}, {}, 1e10),
        ({}, {"free_vibration": 1e12, "dt_out": 1e6}, 0.01),
    ],
)
def test_a_history_that_would_take_hours(changed: dict[str, Any], options: dict[str, Any], dt: float) -> None:
    frame = fdspec.Building.single_storey(
        **{"period": 0.5, "stiffness_ratio": 4, "slip_force": 5e4, **changed}
    )
    with pytest.raises(
        InvalidInput, match=r"hours of core time, over the limit of 0\.5|but .* of memory are free"
    ):
        fdspec.simulate(frame, motion(dt=dt), **options)


def test_a_building_too(monkeypatch: pytest.MonkeyPatch) -> None:
    building = fdspec.Building([20e3, 20e3], 1e7, 1e-12, 2e7, 5e4)
    with pytest.raises(InvalidInput, match="hours of core time, over the limit of"):
        fdspec.simulate(building, motion())
    with pytest.raises(InvalidInput, match="hours of core time, over the limit of 1000"):
        fdspec.sweep_buildings(motion(), building, slip_scale=[1.0], stiffness_scale=[1e6])


def test_the_limit_can_be_set(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(bounds.VARIABLE, "1e-9")
    with pytest.raises(InvalidInput, match="over the limit of 1e-09"):
        fdspec.sweep(motion(), **AXES)
    monkeypatch.setenv(bounds.VARIABLE, "many")
    with pytest.raises(InvalidInput, match="FDSPEC_CORE_HOURS must be a number of hours, got 'many'"):
        fdspec.sweep(motion(), **AXES)
    monkeypatch.setenv(bounds.VARIABLE, "inf")
    bounds.refuse_long(1e99, 1.0, "anything")


def test_ordinary_work_is_far_below() -> None:
    study = Grid.study()
    assert sum(seconds_of_sweep(study, [motion()] * 9)) < 60.0
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=5e4)
    assert seconds_of_history(frame, 0.01, 4000) < 0.01


def test_estimates_grow_with_the_steps() -> None:
    def seconds(**changed: Any) -> float:
        return sum(seconds_of_sweep(Grid(**{**AXES, **changed}), [motion()]))

    assert seconds(brace_mass=5e-4) > 50 * seconds()  # 120 times as measured
    assert seconds(period=[1e-4]) > 100 * seconds()
    assert seconds(brace_mass=0.0) <= seconds()


def test_the_system_tells_its_free_memory() -> None:
    free = memory_free()
    assert free is None or 1e7 < free < 1e15


def test_a_search_too() -> None:
    with pytest.raises(
        InvalidInput, match=r"a search for 1e\+07 frames would take .* over the limit of 1000"
    ):
        fdspec.best_pretension(motion(40_000), period=np.linspace(0.1, 3.0, 10_000_000), stiffness_ratio=4)
