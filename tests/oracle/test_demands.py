"""Slip, brace force and column shear: peaks of the continuous motion against a history that is told densely.

The dense history is read every hundredth of the record's step, or more often where the brace swings faster
than that shows.  A peak is at least what is read, and exceeds it by less than neighbouring readings differ.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba import config

import fdspec
from fdspec.engines.batch import integrate_columns
from fdspec.engines.many_storeys import peaks_of
from fdspec.kernels.frame.results import STOREY_RESULTS
from fdspec.kernels.storey.history import RESULTS
from tests.buildings import Case
from tests.cells import FLOOR_MASS, Cell, draw

ROUNDING = 1e-11
PER_RADIAN = 1.0
"""Readings in a radian of the brace, at the least."""

DEMANDS = (("peak_slip", "slip"), ("peak_brace_force", "brace_force"), ("peak_column_shear", "column_shear"))

without_jit = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="hours without the JIT")


def check(name: str, peak: float, dense: np.ndarray, what: str) -> None:
    top = float(np.abs(dense).max())
    between = float(np.abs(np.diff(dense)).max())
    assert peak >= top * (1.0 - ROUNDING), f"{name} of {what}: {peak!r} below {top!r}"
    assert peak <= top * (1.0 + ROUNDING) + between, f"{name} of {what}: {peak!r} above {top!r}"


def readings(dt: float, brace_rate: float) -> int:
    """Readings in a step of the record."""
    return max(100, math.ceil(PER_RADIAN * brace_rate * dt))


def check_cell(number: int) -> None:
    """Compare the lanes, the history and its readings in one cell."""
    cell: Cell = draw(number)
    k = FLOOR_MASS * (2.0 * math.pi / cell.period) ** 2
    kd = cell.stiffness_ratio * k
    c = 2.0 * cell.damping_ratio * math.sqrt(k * FLOOR_MASS)
    cd = 2.0 * cell.brace_damping_ratio * math.sqrt(kd * cell.brace_mass)
    motion = fdspec.GroundMotion(cell.acceleration, cell.dt, name="cell")
    frame = np.array([[FLOOR_MASS, c, k, cell.brace_mass, cd, kd]])
    forces = np.array([cell.slip_force]), np.array([cell.kinetic_slip_force])
    _, found = integrate_columns(frame, *forces, motion, certify=True)
    lanes = dict(zip(RESULTS, found[0, 0].tolist(), strict=True))
    building = fdspec.Building(
        FLOOR_MASS,
        k,
        cell.brace_mass,
        kd,
        cell.slip_force,
        cell.kinetic_slip_force,
        damping=fdspec.DampingMatrix([[c]]),
        brace_damping=cd,
    )
    dt_out = cell.dt / readings(cell.dt, math.sqrt(kd / cell.brace_mass))
    history = fdspec.simulate(building, motion, dt_out=dt_out)
    for name, over_time in DEMANDS:
        dense = history[over_time].values[:, 0]
        check(name, float(history[name][0]), dense, str(cell))
        check(name, lanes[name], dense, f"{cell}, in lanes")
    # The sum of all slips, one way and the other: rounding grows with the whole distance.
    scale = max(lanes["slip_travel"], np.finfo(float).tiny)
    assert abs(lanes["residual_slip"] - float(history.residual_slip[0])) <= 1e-9 * scale, str(cell)


def check_building(case: Case) -> None:
    """Compare the peaks of a building with its readings."""
    building = case.building
    rng = np.random.default_rng(case.seed + 1)
    shaking = np.convolve(4.0 * rng.standard_normal(60), [0.25, 0.5, 0.25], "same")
    motion = fdspec.GroundMotion(shaking, 0.02, name="noise")
    braced = building.brace_mass > 0.0
    rate = float(np.sqrt(building.brace_stiffness[braced] / building.brace_mass[braced]).max(initial=1.0))
    history = fdspec.simulate(building, motion, dt_out=motion.dt / readings(motion.dt, rate))
    rows, _ = peaks_of(building.frame, motion, certify=False)
    table = dict(zip(STOREY_RESULTS, rows, strict=True))
    for name, over_time in DEMANDS:
        for storey in range(building.n_storeys):
            dense = history[over_time].values[:, storey]
            check(name, float(history[name][storey]), dense, f"storey {storey + 1} of {case}")
            check(name, float(table[name][storey]), dense, f"storey {storey + 1} of {case}, in a sweep")
    np.testing.assert_array_equal(history.residual_slip.values, table["residual_slip"])


@without_jit
@pytest.mark.parametrize("number", range(9_000, 9_010))
def test_a_cell(number: int) -> None:
    check_cell(number)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(9_010, 9_510, 100))
def test_five_hundred_cells(first: int) -> None:
    for number in range(first, first + 100):
        check_cell(number)


@without_jit
@pytest.mark.parametrize("seed", range(5))
def test_a_building(seed: int) -> None:
    check_building(Case(seed, 2 + seed % 4))


@pytest.mark.slow
@pytest.mark.parametrize("first", range(100, 600, 100))
def test_five_hundred_buildings(first: int) -> None:
    for seed in range(first, first + 100):
        check_building(Case(seed, 2 + seed % 4))


def test_slip_and_brace_force_of_a_sudden_load() -> None:
    """A stuck storey under a constant ground acceleration swings to twice its static deflection."""
    building = fdspec.Building.single_storey(
        period=0.5, stiffness_ratio=4.0, slip_force=1e9, damping_ratio=0.0, brace_mass=50.0
    )
    a = 1.5
    motion = fdspec.GroundMotion(np.full(101, a), 0.01, name="constant")
    history = fdspec.simulate(building, motion)
    storey = building.storey
    mass = storey.floor_mass + storey.brace_mass
    top = 2.0 * mass * a / (storey.floor_stiffness + storey.brace_stiffness)
    assert float(history.peak_slip[0]) == 0.0
    assert float(history.peak_brace_force[0]) == pytest.approx(storey.brace_stiffness * top, rel=1e-12)
    assert float(history.peak_column_shear[0]) == pytest.approx(storey.floor_stiffness * top, rel=1e-12)


def test_brace_that_rings_in_slip() -> None:
    """Released at the slip force with kinetic friction below it, the brace rings about the kinetic force.

    The ground rests and the floor is far heavier, so the brace swings as far beyond the kinetic force as it
    began before it.
    """
    m_f, m_d, k_d, static, kinetic = 1e12, 50.0, 5e6, 10e3, 6e3
    building = fdspec.Building(m_f, 1.0, m_d, k_d, static, kinetic, damping=fdspec.DampingMatrix([[0.0]]))
    motion = fdspec.GroundMotion(np.zeros(2001), 1e-5, name="rest")  # two half swings
    d = 1.5 * static / k_d
    history = fdspec.simulate(
        building, motion, initial_displacement=[[0.0], [d]], initial_velocity=[[0.0], [0.0]]
    )
    low = kinetic / k_d - (d - kinetic / k_d)
    assert float(history.peak_brace_force[0]) == pytest.approx(k_d * d, rel=1e-12)
    assert abs(float(history.brace_force.min()) - k_d * low) < 1e-3 * static
