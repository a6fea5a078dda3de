"""The cost model: its steps are the kernels', its fit finds known constants, sweeps take what it says."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec.model.grid import Grid
from fdspec.runs.columns import frames_of, timed
from fdspec.runs.cost import steps_per_sample
from fdspec.runs.pilot import Cost, Measured, fitted, measured, parts_of, work_of
from tests.unit.test_sweep import record


def test_steps_are_those_of_the_kernels() -> None:
    from fdspec.kernels.batch.entry import prepare
    from fdspec.kernels.batch.layout import N_PLAN, N_STRIDE
    from fdspec.kernels.storey.constants import RADIANS
    from fdspec.kernels.storey.energy import N_FORMS

    grid = Grid.study()
    columns = np.arange(7 * 60)
    storeys = np.hstack([frames_of(grid, columns), np.ones((420, 2))])
    for dt in (0.002, 0.01, 0.05):
        steps = np.empty(420, np.int64)
        plans, forms, stride = (np.empty((420, n)) for n in (N_PLAN, N_FORMS, N_STRIDE))
        prepare(storeys, dt, RADIANS, True, steps, plans, forms, stride)
        np.testing.assert_array_equal(steps_per_sample(grid, dt), steps.reshape(7, 60))


def test_constants_are_found_again() -> None:
    rng = np.random.default_rng(4)
    work = rng.uniform(1.0, 1e6, (30, 3)) * [1.0, 3.0, 0.02]
    cost = fitted([Measured(float(row[1:] @ [5e-9, 3e-7]), *row.tolist()) for row in work])
    np.testing.assert_allclose((cost.step, cost.transition), (5e-9, 3e-7), rtol=1e-9)
    assert cost.transitions_per_sample == pytest.approx(work[:, 2].sum() / work[:, 0].sum())
    still = fitted([Measured(float(n), n, n, 0.0) for n in range(1, 5)])
    assert (still.step, still.transition) == (pytest.approx(1.0), 0.0)


def test_a_sweep_costs_its_steps_and_transitions() -> None:
    grid = Grid(stiffness_ratio=[3.0], pretension=[1.0, 2.0], period=[0.1, 1.0], brace_mass=0.0)
    motion = record("a", samples=50)
    # omega = 4 pi / period: at dt 0.01 s that is 1.26 and 0.13 rad, 2 steps and 1.
    assert work_of(grid, [motion]) == (200.0, 300.0)
    assert Cost(1e-3, 1e-2, 0.1).of_sweep(grid, [motion]) == pytest.approx(0.3 + 0.2)
    assert Cost(1e-3, 1e-2, 0.1).of_sweep(grid, [motion, motion], 7.0) == pytest.approx(0.6 + 0.07)


@pytest.mark.parametrize("sizes", [(1, 1, 1), (7, 11, 60), (2, 1000, 3)])
def test_parts_are_small_and_of_the_study(sizes: tuple[int, int, int]) -> None:
    axes = [np.linspace(1.0, 2.0, size) for size in sizes]
    grid = Grid(stiffness_ratio=axes[0], pretension=axes[1], period=axes[2])
    motions = [
        record(name, samples=samples) for name, samples in (("a", 30), ("b", 90), ("c", 60), ("d", 70))
    ]
    parts = list(parts_of(grid, motions))
    assert {motion.name for _, motion in parts} == {"a", "d", "b"}
    for part, _ in parts:
        assert part.size <= 900
        for name in ("stiffness_ratio", "pretension", "period"):
            assert set(getattr(part, name)) <= set(getattr(grid, name))


SWEEPS: dict[str, dict[str, Any]] = {
    "the study": {},
    "short periods, stiff braces": {
        "period": np.linspace(0.02, 0.3, 40),
        "stiffness_ratio": [6.0, 10.0, 20.0],
    },
    "long periods": {"period": np.linspace(1.0, 4.0, 40)},
    "weak dampers": {"pretension": np.linspace(5e3, 40e3, 8)},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SWEEPS)
def test_sweeps_cost_what_the_model_says(name: str) -> None:
    """Within 20 % of the core time, with the constants of a pilot of each study."""
    grid = replace(Grid.study(), **SWEEPS[name])
    motions = [fdspec.load_record(record) for record in ("FSR1", "FMR2", "FHR3")]
    cost = measured(grid, motions)
    taken = [timed(grid, motion) for motion in motions]
    seconds, transitions = (sum(column) for column in zip(*taken, strict=True))
    expected = cost.of_sweep(grid, motions)
    samples, steps = work_of(grid, motions)
    print(
        f"{name}: {seconds:.2f} s, expected {expected:.2f}; "
        f"{1e9 * cost.step:.1f} ns a step, {1e9 * cost.transition:.0f} ns a transition; "
        f"{steps / samples:.2f} steps a sample, {transitions / samples:.4f} transitions a sample"
    )
    assert abs(expected / seconds - 1.0) < 0.2
    assert abs(cost.of_sweep(grid, motions, transitions) / seconds - 1.0) < 0.2


def test_a_sweep_of_single_storeys_loads_no_kernels_of_several() -> None:
    code = "import sys, fdspec.runs.sweep; print([name for name in sys.modules if 'frame.history' in name])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
