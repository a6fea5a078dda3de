"""Random cells over all of the promised range: no crash, no NaN, no status but ok, and energy closes.

The default is a sample.  ``FDSPEC_RANDOM_CELLS=0:100000`` takes as many, in five minutes of one core.
"""

from __future__ import annotations

import math
import os

import numpy as np
import pytest

import fdspec
from fdspec.engines.batch import integrate_columns
from fdspec.kernels.storey.history import RESULTS
from tests.cells import FLOOR_MASS, Cell, draw

FIRST, LAST = map(int, os.environ.get("FDSPEC_RANDOM_CELLS", "0:2000").split(":"))

ENERGY = 1e-9


def results_of(cell: Cell) -> dict[str, float]:
    """What one history of the cube leaves."""
    stiffness = FLOOR_MASS * (2.0 * math.pi / cell.period) ** 2
    brace = cell.stiffness_ratio * stiffness
    frame = [
        FLOOR_MASS,
        2.0 * cell.damping_ratio * math.sqrt(stiffness * FLOOR_MASS),
        stiffness,
        cell.brace_mass,
        2.0 * cell.brace_damping_ratio * math.sqrt(brace * cell.brace_mass),
        brace,
    ]
    motion = fdspec.GroundMotion(cell.acceleration, cell.dt, name="cell")
    forces = np.array([cell.slip_force]), np.array([cell.kinetic_slip_force])
    _, results = integrate_columns(np.array([frame]), *forces, motion, certify=True)
    return dict(zip(RESULTS, results[0, 0].tolist(), strict=True))


def wrong_with(cell: Cell) -> tuple[str, dict[str, float]]:
    results = results_of(cell)
    if results["status"] != 0:
        return f"status {results['status']}", results
    if not all(map(math.isfinite, results.values())):
        return "a number that is none", results
    if not results["energy_error"] < ENERGY:
        return f"energy error {results['energy_error']:.2g}", results
    return "", results


@pytest.mark.slow
def test_random_cells_end_well() -> None:
    found, worst, transitions = [], 0.0, 0.0
    for number in range(FIRST, LAST):
        cell = draw(number)
        wrong, results = wrong_with(cell)
        worst = max(worst, results["energy_error"])
        transitions += results["transitions"]
        if wrong:
            found.append(f"{wrong}: {cell}")
    print(f"{LAST - FIRST} cells, {transitions:.0f} changes of phase, energy error at most {worst:.2g}")
    assert not found, f"{len(found)} of {LAST - FIRST}:\n" + "\n".join(found[:20])
    assert transitions > 20 * (LAST - FIRST), "the cells hardly slip"
