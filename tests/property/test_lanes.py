"""A history keeps its bits whichever way it goes: alone, or beside neighbours that change phase with it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import config

import fdspec
from fdspec.engines.batch import integrate_columns
from fdspec.kernels.batch import entry as kernels
from fdspec.kernels.batch.layout import WIDTH
from fdspec.kernels.storey.history import RESULTS
from tests.cells import FLOOR_MASS, Cell, draw

ALONE, TOGETHER = WIDTH + 1, 1
"""Lanes that must change phase on one step to be walked side by side: more than there are, or any."""


def neighbours(cell: Cell) -> np.ndarray:
    """Frames (2 WIDTH, 6) around a cell's: near in period, so that many change phase on the same step."""
    period = cell.period * np.linspace(0.98, 1.02, 2 * WIDTH)
    stiffness = FLOOR_MASS * (2.0 * math.pi / period) ** 2
    brace = cell.stiffness_ratio * stiffness
    same = np.ones_like(period)
    return np.column_stack(
        [
            FLOOR_MASS * same,
            2.0 * cell.damping_ratio * np.sqrt(stiffness * FLOOR_MASS),
            stiffness,
            cell.brace_mass * same,
            2.0 * cell.brace_damping_ratio * np.sqrt(brace * cell.brace_mass),
            brace,
        ]
    )


def results_of(cell: Cell, crowd: int, *, certify: bool = False) -> np.ndarray:
    """Results of the neighbours at the cell's slip force, at half of it and at a tenth."""
    share = np.array([1.0, 0.5, 0.1])
    motion = fdspec.GroundMotion(cell.acceleration, cell.dt, name="cell")
    _, results = integrate_columns(
        neighbours(cell),
        share * cell.slip_force,
        share * cell.kinetic_slip_force,
        motion,
        certify=certify,
        crowd=crowd,
    )
    return results


def check(first: int, last: int) -> float:
    """Compare both ways in these cells, bit by bit; return the changes of phase compared."""
    compared = 0.0
    for number in range(first, last):
        cell = draw(number)
        alone, together = results_of(cell, ALONE), results_of(cell, TOGETHER)
        np.testing.assert_array_equal(alone, together, err_msg=f"cell {number}: {cell}")
        compared += alone[..., RESULTS.index("transitions")].sum()
    return compared


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="hours without the JIT")
def test_sixty_cells_and_their_neighbours() -> None:
    assert check(0, 60) > 100_000


@pytest.mark.slow
def test_two_thousand_cells_and_their_neighbours() -> None:
    assert check(60, 2_000) > 5_000_000


SHORT = Cell(0, 0.5, 4.0, 30e3, 30e3, 0.05, 60.0, 0.0, dt=0.02, duration=1.6, pga=4.0)
"""A storey that slips and stops all the time, in a motion short enough without the JIT."""


def test_the_certificate_takes_them_one_by_one_to_the_same_bits() -> None:
    plain = results_of(SHORT, TOGETHER)
    certified = results_of(SHORT, TOGETHER, certify=True)
    but_error = [k for k, name in enumerate(RESULTS) if name != "energy_error"]
    assert plain[..., RESULTS.index("transitions")].sum() > 500
    np.testing.assert_array_equal(plain[..., but_error], certified[..., but_error])


@pytest.mark.skipif(not config.DISABLE_JIT, reason="compiled kernels cannot be watched")
def test_lanes_are_walked_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    """That most of them are, and few handed back."""
    sent = returned = 0
    original = kernels.walk_lanes

    def watched(p: np.ndarray, a0: float, rate: float, to_walk: int, *rest: object) -> int:
        nonlocal sent, returned
        back = original(p, a0, rate, to_walk, *rest)
        sent += int(to_walk).bit_count()
        returned += int(back).bit_count()
        return int(back)

    monkeypatch.setattr(kernels, "walk_lanes", watched)
    together = results_of(SHORT, TOGETHER)
    assert sent > 200
    assert returned < 0.3 * sent
    np.testing.assert_array_equal(together, results_of(SHORT, ALONE))
