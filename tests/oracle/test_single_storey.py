"""fdspec's single-storey engine against the slow integrator: every quantity, every change of phase."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import fdspec
from tests import cells
from tests.answers import PEAKS, building_of, simulated, swept
from tests.oracle import sdof_events
from tests.reference import numbers

FEW, ALL = range(5000, 5016), range(5016, 5400)


def compare(numbers: range) -> list[str]:
    """Differences, each as one line that reproduces it."""
    found = []
    for number in numbers:
        if number in cells.CHAOTIC:
            continue
        cell = cells.draw(number)
        want = sdof_events.integrate(sdof_events.of_cell(cell), cell.acceleration, cell.dt)
        for way in (swept, simulated):
            got = way(cell, cell.acceleration, cell.dt)
            label = f"{way.__name__}, closest call {want.closest_call:.1e}: {cell}"
            if got.transitions != len(want.transitions):
                found.append(f"transitions {got.transitions} for {len(want.transitions)}, {label}")
            for name, value in zip(PEAKS, got.peaks, strict=True):
                error = value / getattr(want, name) - 1.0
                if not abs(error) < 1e-10:
                    found.append(f"{name} off by {error:.1e}, {label}")
            if cell.slip_force > 0.0 and not math.isclose(
                got.slip_travel, want.slip_travel, rel_tol=1e-9, abs_tol=1e-12 * want.peak_displacement
            ):
                found.append(f"slip travel {got.slip_travel!r} for {want.slip_travel!r}, {label}")
            drift = got.residual_displacement - want.final_displacement[0]
            if not abs(drift) < 1e-10 * want.peak_displacement:
                found.append(f"residual displacement off by {drift:.1e} m, {label}")
    return found


def test_random_cells() -> None:
    found = compare(FEW)
    assert not found, "\n".join(found)


@pytest.mark.slow
def test_many_random_cells() -> None:
    found = compare(ALL)
    assert not found, "\n".join(found)


@pytest.mark.slow
@pytest.mark.parametrize("number", cells.CHAOTIC)
def test_chaotic_cells_are_chaotic(number: int) -> None:
    """In extended precision, without fdspec: one unit in the last place of one input."""
    cell = cells.draw(number)
    one, other = (
        sdof_events.integrate(sdof_events.of_cell(cell, force), cell.acceleration, cell.dt)
        for force in (cell.slip_force, np.nextafter(cell.slip_force, np.inf))
    )
    drift = (other.final_displacement[0] - one.final_displacement[0]) / one.peak_displacement
    assert max(abs(drift), abs(other.peak_velocity / one.peak_velocity - 1.0)) > 1e-11


def test_the_cells_slip() -> None:
    drawn = [cells.draw(number) for number in FEW]
    slipping = sum(simulated(cell, cell.acceleration, cell.dt).transitions > 0 for cell in drawn)
    assert len(FEW) / 4 < slipping < len(FEW)


CASES: dict[str, dict[str, Any]] = {
    "plain": {},
    "kinetic": {"kinetic_slip_force": 30e3},
    "no kinetic friction": {"kinetic_slip_force": 0.0},
    "damped brace": {"brace_damping_ratio": 0.1},
    "overdamped brace": {"brace_damping_ratio": 1.5, "overdamped": True},
    "kinetic, damped brace": {"kinetic_slip_force": 20e3, "brace_damping_ratio": 0.1},
    "heavy brace": {"brace_mass": 5000.0},
    "massless brace": {"brace_mass": 0.0},
    "massless brace, kinetic": {"brace_mass": 0.0, "kinetic_slip_force": 30e3},
    "undamped frame": {"damping_ratio": 0.0},
    "overdamped frame": {"damping_ratio": 1.3, "overdamped": True},
    "critical": {"damping_ratio": 1.0, "brace_damping_ratio": 1.0, "overdamped": True},
    "never slips": {"slip_force": math.inf},
    "slides freely": {"slip_force": 0.0},
}


def storey_of(frame: fdspec.Building) -> sdof_events.Storey:
    kernel = frame.storey
    return sdof_events.Storey(
        kernel.floor_mass,
        kernel.floor_stiffness,
        kernel.floor_damping,
        kernel.brace_mass,
        kernel.brace_stiffness,
        kernel.brace_damping,
        kernel.slip_force,
        kernel.kinetic_slip_force,
    )


def check(frame: fdspec.Building, acceleration: np.ndarray, dt: float, start: Any, free: float = 0.0) -> None:
    motion = fdspec.GroundMotion(acceleration, dt)
    history = fdspec.simulate(
        frame,
        motion,
        free_vibration=free,
        initial_displacement=start[0],
        initial_velocity=start[1],
    )
    want = sdof_events.integrate(
        storey_of(frame),
        acceleration,
        dt,
        displacement=tuple(np.ravel(start[0])),
        velocity=tuple(np.ravel(start[1])),
        free_vibration=free,
        energies=True,
    )
    times = [time for time, _ in want.transitions]
    assert history.transition_phase.values.tolist() == [phase for _, phase in want.transitions]
    np.testing.assert_allclose(history.transition_time, times, rtol=0.0, atol=1e-11)
    for name in PEAKS:
        assert history[name].item() == pytest.approx(getattr(want, name), rel=1e-11), name
    scale = want.peak_displacement
    end = [history.displacement[-1].item(), history.brace_displacement[-1].item()]
    np.testing.assert_allclose(end, want.final_displacement, rtol=0.0, atol=1e-11 * scale)
    if frame.storey.brace_mass > 0.0 or history.phase[-1] == 0:
        end = [history.velocity[-1].item(), history.brace_velocity[-1].item()]
        np.testing.assert_allclose(end, want.final_velocity, rtol=0.0, atol=1e-11 * want.peak_velocity)
    energy = max(abs(want.input_energy), want.initial_energy)
    for name in ("input_energy", "viscous_energy", "friction_energy"):
        np.testing.assert_allclose(
            history[name][-1].item(), getattr(want, name), rtol=0.0, atol=1e-10 * energy, err_msg=name
        )
    stored = history.kinetic_energy[-1].item() + history.strain_energy[-1].item()
    assert stored == pytest.approx(want.final_energy, abs=1e-10 * energy)
    assert history.energy_error.item() < 1e-9


@pytest.mark.parametrize("change", CASES.values(), ids=CASES.keys())
def test_every_kind_of_storey(change: dict[str, Any]) -> None:
    given = {"period": 0.4, "stiffness_ratio": 4.0, "slip_force": 45e3, "brace_mass": 200.0, **change}
    acceleration, dt = numbers.motion()
    check(fdspec.Building.single_storey(**given), acceleration[100:501], dt, ([[0.0], [0.0]], [[0.0], [0.0]]))


@pytest.mark.parametrize("change", CASES.values(), ids=CASES.keys())
def test_free_vibration_from_a_start(change: dict[str, Any]) -> None:
    """A floor pulled away from its brace and let go while the ground moves, then the ground at rest."""
    given = {"period": 0.4, "stiffness_ratio": 4.0, "slip_force": 45e3, "brace_mass": 200.0, **change}
    acceleration, dt = numbers.motion()
    together = given["brace_mass"] == 0.0 or given["slip_force"] == math.inf
    start = ([[0.03], [0.002]], [[0.2], [0.2 if together else -0.1]])
    check(fdspec.Building.single_storey(**given), acceleration[400:451], dt, start, free=1.5)


@pytest.mark.parametrize("displacement", [[[0.0], [0.0]], [[0.02], [0.02]], [[0.0], [0.02]]])
def test_a_start_that_pulls_at_the_damper(displacement: list[list[float]]) -> None:
    """Nothing slides at first; the third one's brace is bent beyond what friction holds."""
    frame = fdspec.Building.single_storey(period=0.4, stiffness_ratio=4.0, slip_force=45e3, brace_mass=200.0)
    check(frame, np.zeros(101), 0.01, (displacement, [[0.0], [0.0]]))


def test_the_record_s_end_is_a_sample_like_any_other() -> None:
    """A longer record keeps the prefix."""
    cell = cells.draw(5003)
    motion = cell.acceleration
    half = len(motion) // 2
    whole = fdspec.simulate(building_of(cell), fdspec.GroundMotion(motion, cell.dt))
    part = fdspec.simulate(building_of(cell), fdspec.GroundMotion(motion[:half], cell.dt))
    np.testing.assert_array_equal(part.displacement, whole.displacement[:half])
    np.testing.assert_array_equal(part.transition_time, whole.transition_time[: part.sizes["transition"]])
