"""The N-storey engine against the slow integrator, linear limits and the one-storey engine."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import eigh

import fdspec
from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.single_storey import integrate_single_storey
from fdspec.engines.trajectory import Span, Trajectory
from tests import cells, closed_forms
from tests.answers import building_of
from tests.buildings import CASES, Case
from tests.oracle import mdof_events
from tests.reference import numbers


def frame_of(building: fdspec.Building) -> mdof_events.Frame:
    """The same for the slow integrator; a storey without a brace gets one of 1 mg that it never feels."""
    alone = building.brace_stiffness == 0.0
    return mdof_events.frame(
        building.floor_mass,
        building.storey_stiffness,
        np.where(alone, 1e-6, building.brace_mass),
        np.where(alone, 1e-6, building.brace_stiffness),
        building.slip_force,
        frame_damping=building.damping_matrix,
        brace_damping=building.brace_damping,
        kinetic_slip_force=building.kinetic_slip_force,
    )


LONG = {Case(2, 2), Case(3, 2), Case(4, 2)}
"""Buildings over which the slow integrator spends more than others."""


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[pytest.mark.slow] * (case in LONG), id=str(case)) for case in CASES]
)
def test_random_buildings(case: Case) -> None:
    acceleration, dt = numbers.motion()
    part = acceleration[250:451]
    building = case.building
    history = fdspec.simulate(building, fdspec.GroundMotion(part, dt))
    want = mdof_events.integrate(frame_of(building), part, dt)
    got = list(
        zip(history.transition_storey.values - 1, history.transition_phase.values.tolist(), strict=True)
    )
    assert got == [(storey, phase) for _, storey, phase in want.transitions]
    times = [time for time, *_ in want.transitions]
    np.testing.assert_allclose(history.transition_time, times, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(history.peak_acceleration, want.peak_acceleration, rtol=1e-9)
    np.testing.assert_allclose(history.peak_displacement, want.peak_displacement, rtol=1e-9)
    scale = np.max(want.peak_displacement)
    final = want.final_displacement[: case.storeys]
    np.testing.assert_allclose(history.displacement[-1], final, rtol=0.0, atol=1e-9 * scale)
    assert history.energy_error.item() < 1e-9


def test_the_cases_slip_and_some_have_no_brace() -> None:
    acceleration, dt = numbers.motion()
    motion = fdspec.GroundMotion(acceleration[250:451], dt)
    changes = [fdspec.simulate(case.building, motion).transitions.item() for case in CASES]
    assert sum(n > 10 for n in changes) >= len(CASES) // 2
    assert any((case.building.brace_stiffness == 0.0).any() for case in CASES)
    assert any((case.building.kinetic_slip_force < case.building.slip_force).any() for case in CASES)


FEW, ALL = range(100), range(100, 2100)


def compare_engines(numbers: range) -> list[str]:
    """N = 1 by the two engines; differences, each as one line that reproduces it."""
    found = []
    for number in numbers:
        if number in cells.CHAOTIC:
            continue
        cell = cells.draw(number)
        building, motion = building_of(cell), fdspec.GroundMotion(cell.acceleration, cell.dt)
        span, start = Span(0, motion.duration, 2), np.zeros((2, 2, 1))
        one, other = (
            engine(building, motion, span, start)
            for engine in (integrate_single_storey, integrate_many_storeys)
        )
        found += [f"{what}: {cell}" for what in engine_differences(one, other)]
    return found


def engine_differences(one: Trajectory, other: Trajectory) -> list[str]:
    found = []
    if one.status != 0 or other.status != 0:
        found.append(f"status {one.status} and {other.status}")
    if one.transition_phase.tolist() != other.transition_phase.tolist():
        sizes = one.transition_time.size, other.transition_time.size
        size = min(sizes)
        apart = np.nonzero(one.transition_phase[:size] != other.transition_phase[:size])[0]
        at = f" from t = {one.transition_time[apart[0]]!r}" if apart.size else ""
        found.append(f"transitions {sizes[0]} and {sizes[1]}{at}")
    for name in ("peak_acceleration", "peak_displacement", "peak_velocity"):
        a, b = getattr(one, name)[0], getattr(other, name)[0]
        if not abs(a - b) <= 1e-9 * a:
            found.append(f"{name} {a!r} and {b!r}")
    if not abs(one.peak_base_shear - other.peak_base_shear) <= 1e-9 * one.peak_base_shear:
        found.append(f"peak_base_shear {one.peak_base_shear!r} and {other.peak_base_shear!r}")
    if not max(one.energy_error, other.energy_error) < 1e-9:
        found.append(f"energy error {one.energy_error:.1e} and {other.energy_error:.1e}")
    return found


def test_one_storey_by_both_engines() -> None:
    found = compare_engines(FEW)
    assert not found, "\n".join(found)


@pytest.mark.slow
def test_one_storey_by_both_engines_on_two_thousand_cells() -> None:
    found = compare_engines(ALL)
    assert not found, "\n".join(found)


@pytest.mark.parametrize("storeys", [2, 6])
@pytest.mark.parametrize("slip_force", [0.0, math.inf], ids=["free", "locked"])
def test_the_two_linear_limits(slip_force: float, storeys: int) -> None:
    """No friction: the 2N-DOF system. No slip: the braced frame. Both by one matrix exponential."""
    acceleration, dt = numbers.motion()
    part = acceleration[200:601]
    building = fdspec.Building.from_periods(
        np.linspace(50e3, 30e3, storeys),
        0.12 * storeys,
        0.07 * storeys,
        slip_force=slip_force,
        brace_mass=100.0,
        damping=fdspec.ModalDamping(0.03),
    )
    frame = frame_of(building)
    n = storeys
    mass, damping, stiffness = frame.mass, frame.damping, frame.stiffness
    if slip_force > 0.0:
        together = np.vstack([np.eye(n), np.eye(n)])
        mass = mass[:n] + mass[n:]
        damping, stiffness = together.T @ damping @ together, together.T @ stiffness @ together
    u, v = closed_forms.linear_states(mass, damping, stiffness, part, dt)
    history = fdspec.simulate(building, fdspec.GroundMotion(part, dt))
    assert history.sizes["transition"] == 0
    np.testing.assert_allclose(history.displacement, u[:, :n], rtol=0.0, atol=1e-10 * np.max(np.abs(u)))
    np.testing.assert_allclose(history.velocity, v[:, :n], rtol=0.0, atol=1e-10 * np.max(np.abs(v[:, :n])))
    absolute = -(u @ stiffness + v @ damping)[:, :n] / mass[:n]
    scale = np.max(np.abs(absolute))
    np.testing.assert_allclose(history.acceleration, absolute, rtol=0.0, atol=1e-10 * scale)


def test_all_storeys_give_way_at_one_instant() -> None:
    """Free vibration in one mode of the locked building, slip forces in proportion to its reactions."""
    n, dt = 3, 0.01
    floors, braces = np.array([50e3, 40e3, 30e3]), np.full(n, 200.0)
    locked = fdspec.Building.from_periods(
        floors, 0.4, 0.25, slip_force=math.inf, brace_mass=braces, damping=fdspec.ModalDamping(0.0)
    )
    frame = frame_of(locked)
    together = np.vstack([np.eye(n), np.eye(n)])
    stiffness = together.T @ frame.stiffness @ together
    squares, modes = eigh(stiffness, np.diag(floors + braces))
    shape = 0.05 * modes[:, 0] / modes[-1, 0]
    reaction = (floors * squares[0] * shape) - (frame.stiffness @ together @ shape)[:n]
    building = fdspec.Building(
        floor_mass=floors,
        storey_stiffness=locked.storey_stiffness,
        brace_mass=braces,
        brace_stiffness=locked.brace_stiffness,
        slip_force=0.6 * np.abs(reaction),
        damping=fdspec.ModalDamping(0.0),
    )
    velocity = math.sqrt(squares[0]) * shape
    history = fdspec.simulate(
        building, fdspec.GroundMotion(np.zeros(101), dt), initial_velocity=[velocity, velocity]
    )
    instant = math.asin(0.6) / math.sqrt(squares[0])
    np.testing.assert_allclose(history.transition_time[:n], instant, rtol=0.0, atol=1e-13)
    assert sorted(history.transition_storey.values[:n].tolist()) == [1, 2, 3]
    both = np.concatenate([velocity, velocity])
    want = mdof_events.integrate(frame_of(building), np.zeros(101), dt, velocity=both)
    assert history.sizes["transition"] == len(want.transitions)
    np.testing.assert_allclose(history.peak_acceleration, want.peak_acceleration, rtol=1e-9)
    np.testing.assert_allclose(history.peak_displacement, want.peak_displacement, rtol=1e-9)
    assert history.energy_error.item() < 1e-9


def test_a_motion_that_is_zero_for_seconds() -> None:
    """Nothing moves before the ground does, and everything is the same afterwards, later."""
    acceleration, dt = numbers.motion()
    part = acceleration[250:401] - acceleration[250]
    building, wait = CASES[0].building, 500
    late = np.concatenate([np.zeros(wait), part, np.zeros(wait)])
    history = fdspec.simulate(building, fdspec.GroundMotion(late, dt))
    at_once = fdspec.simulate(building, fdspec.GroundMotion(np.concatenate([part, np.zeros(wait)]), dt))
    assert not history.displacement[:wait].any()
    assert history.transition_phase.values.tolist() == at_once.transition_phase.values.tolist()
    np.testing.assert_allclose(history.peak_acceleration, at_once.peak_acceleration, rtol=1e-10)
    np.testing.assert_allclose(history.peak_displacement, at_once.peak_displacement, rtol=1e-10)


@pytest.mark.parametrize("storeys", [1, 2, 3])
def test_a_record_of_two_samples(storeys: int) -> None:
    building = Case(1, storeys).building
    history = fdspec.simulate(building, fdspec.GroundMotion([9.0, -6.0], 0.04))
    want = mdof_events.integrate(frame_of(building), [9.0, -6.0], 0.04)
    assert history.sizes["transition"] == len(want.transitions)
    np.testing.assert_allclose(history.peak_displacement, want.peak_displacement, rtol=1e-9)
    np.testing.assert_allclose(history.peak_acceleration, want.peak_acceleration, rtol=1e-9)
