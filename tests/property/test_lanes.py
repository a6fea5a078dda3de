"""A history keeps its bits whichever way it goes: alone, or beside neighbours that change phase with it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import config

import fdspec
from fdspec.engines.batch import integrate_columns
from fdspec.kernels.batch.layout import WIDTH
from fdspec.kernels.storey.history import RESULTS
from tests.cells import FLOOR_MASS, Cell, draw


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


def results_of(cell: Cell, frames: np.ndarray, *, certify: bool = False) -> np.ndarray:
    """Results of the frames at the cell's slip force, at half of it and at a tenth."""
    share = np.array([1.0, 0.5, 0.1])
    motion = fdspec.GroundMotion(cell.acceleration, cell.dt, name="cell")
    _, results = integrate_columns(
        frames, share * cell.slip_force, share * cell.kinetic_slip_force, motion, certify=certify
    )
    return results


def check(first: int, last: int) -> float:
    """Compare both ways in these cells, bit by bit; return the changes of phase compared."""
    compared = 0.0
    for number in range(first, last):
        cell = draw(number)
        frames = neighbours(cell)
        together = results_of(cell, frames)
        for k in (number % len(frames), (7 * number + 3) % len(frames)):
            alone = results_of(cell, frames[k : k + 1])[0]
            np.testing.assert_array_equal(alone, together[k], err_msg=f"cell {number}: {cell}")
        compared += together[..., RESULTS.index("transitions")].sum()
    return compared


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="hours without the JIT")
def test_sixty_cells_and_their_neighbours() -> None:
    assert check(0, 60) > 100_000


@pytest.mark.slow
def test_two_thousand_cells_and_their_neighbours() -> None:
    assert check(60, 2_000) > 5_000_000


SHORT = Cell(0, 0.5, 4.0, 30e3, 30e3, 0.05, 60.0, 0.0, dt=0.02, duration=1.6, pga=4.0)
"""A storey that slips and stops all the time, in a motion short enough without the JIT."""


def test_the_certificate_changes_no_bit() -> None:
    frames = neighbours(SHORT)
    plain = results_of(SHORT, frames)
    certified = results_of(SHORT, frames, certify=True)
    but_error = [k for k, name in enumerate(RESULTS) if name != "energy_error"]
    assert plain[..., RESULTS.index("transitions")].sum() > 500
    np.testing.assert_array_equal(plain[..., but_error], certified[..., but_error])
