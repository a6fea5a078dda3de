"""Braces without mass in buildings of many storeys: release, rest, no friction, what a neighbour feels."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pytest

from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.step_count import steps_of_building
from fdspec.engines.trajectory import Span, Trajectory
from fdspec.kernels.types import ENERGY_NOT_CLOSED, ENERGY_TOLERANCE, STATUS_MEANINGS
from fdspec.model.building import Building
from fdspec.model.damping import DampingMatrix, ModalDamping
from fdspec.model.motion import GroundMotion
from tests.massless_frames import draw

PEAKS = ("peak_acceleration", "peak_displacement", "peak_velocity", "peak_drift", "peak_storey_shear")
STILL = GroundMotion(np.zeros(201), 0.01)


def run(
    building: Building,
    motion: GroundMotion,
    start: np.ndarray | None = None,
    free_steps: int = 0,
    **scheme: float,
) -> Trajectory:
    n = building.n_storeys
    span = Span(free_steps, (motion.n - 1 + free_steps) * motion.dt, 2)
    state = np.zeros((2, 2, n)) if start is None else start
    return integrate_many_storeys(building, motion, span, state, **scheme)  # type: ignore[arg-type]


def apart(one: Trajectory, other: Trajectory) -> float:
    """Largest difference of a peak, relative to the largest of its kind."""
    worst = 0.0
    for name in PEAKS:
        a, b = getattr(one, name), getattr(other, name)
        worst = max(worst, np.abs(a - b).max() / max(np.abs(a).max(), 1e-300))
    return float(worst)


def sensitivity(
    building: Building, motion: GroundMotion, start: np.ndarray, free: int, one: Trajectory
) -> float:
    """How far a change of the ground in its last digits moves a peak: thousands of slips may amplify it.

    Kinetic friction below static can make the motion chaotic; what rounding decides, no step can.
    """
    moved = 0.0
    for digit in (1e-15, -1e-15, 3e-15):
        shaken = GroundMotion(motion.acceleration * (1.0 + digit), motion.dt)
        moved = max(moved, apart(one, run(building, shaken, start, free)))
    return moved


def held_up(*floors: float) -> np.ndarray:
    """Floors that start displaced, at rest, each brace with its floor."""
    start = np.zeros((2, 2, len(floors)))
    start[0] = floors
    return start


HARD = [
    "hang_33_94",
    "m8case_1_31",
    "mcase_11_24",
    "mcase_11_255",
    "mcase_1_126",
    "mfail_11_52",
]


@pytest.mark.parametrize("name", HARD)
def test_hard_frames(name: str, shared: Path) -> None:
    path = shared / "reference" / "hard_frames" / f"{name}.npz"
    if not path.is_file():
        pytest.skip(f"{path} is not on this machine")
    with np.load(path) as given:
        building = Building(
            given["mf"],
            given["given"],
            given["md"],
            given["kd"],
            given["F"],
            given["Fk"],
            DampingMatrix(given["C"]),
            given["cd"],
        )
        motion = GroundMotion(given["ag"], float(given["dt"]))
        start = given["init"] if given["init"].size else None
        free = int(given["free"])
    begin = time.thread_time()
    one = run(building, motion, start, free)
    assert time.thread_time() - begin < 1.0
    assert one.status == 0
    assert one.energy_error < 1e-9
    for scheme in ({"radians": 1.25}, {"extra_terms": 4}):
        other = run(building, motion, start, free, **scheme)
        assert other.status == 0
        assert apart(one, other) < 1e-10
        assert other.transition_time.size == one.transition_time.size


def test_a_reaction_beyond_the_slip_force_lets_a_dashpot_slide_at_once() -> None:
    """Worked by hand: at rest, floor 2 carries F_2 and its column, floor 1 the difference of both storeys."""
    damped = Building(2e4, 8e6, 0.0, 16e6, [40e3, 30e3], damping=ModalDamping(0.02), brace_damping=[2e5, 1e5])
    trajectory = run(damped, STILL, held_up(0.03, 0.05))
    assert trajectory.energy_error < 1e-12
    # Floor 2: (8e6 x 0.02 + 30e3) / 2e4. Floor 1: (8e6 x 0.01 + 10e3) / 2e4 = 4.5 at first, more later.
    assert trajectory.peak_acceleration[1] == pytest.approx(9.5, rel=1e-12)
    assert trajectory.peak_acceleration[0] == pytest.approx(5.79825338, rel=1e-8)
    assert apart(trajectory, run(damped, STILL, held_up(0.03, 0.05), radians=1.25)) < 1e-12


def test_a_dashpot_slides_with_what_is_beyond_friction_over_its_damping() -> None:
    """One heavy floor that moves at a steady speed v: the stretch relaxes as a first-order system."""
    mass, speed, spring, dashpot, force = 1e12, 0.5, 1e6, 4e4, 1e3
    building = Building(
        [mass, 1e3], [1.0, 1.0], 0.0, [spring, 0.0], [force, 0.0], None, DampingMatrix(np.zeros((2, 2))),
        [dashpot, 0.0],
    )  # fmt: skip
    start = np.zeros((2, 2, 2))
    start[1, :, :] = speed
    motion = GroundMotion(np.zeros(11), 0.01)
    outputs = 101
    trajectory = integrate_many_storeys(building, motion, Span(0, 0.001, outputs), start)
    t = np.linspace(0.0, 0.1, outputs)
    # c v = 20 kN is beyond F at once: e' = (F - k e) / c from e = 0. Friction hardly slows the floor.
    stretch = force / spring * (1.0 - np.exp(-spring / dashpot * t))
    slipped = speed * t - 0.5 * force / mass * t**2 - stretch
    np.testing.assert_allclose(trajectory.slip_travel[:, 0], slipped, rtol=0.0, atol=1e-13)
    rate = speed - force / mass * t - force / dashpot * np.exp(-spring / dashpot * t)
    np.testing.assert_allclose(
        trajectory.velocity[:, 0] - trajectory.brace_velocity[:, 0], rate, rtol=0.0, atol=1e-12
    )
    assert trajectory.transition_phase[0] == 1
    assert trajectory.transition_time[0] == 0.0


@pytest.mark.parametrize("dashpot", [0.0, 2e3, [0.0, 2e3], 1e-3], ids=str)
def test_without_friction_a_massless_brace_carries_nothing_that_lasts(dashpot: object) -> None:
    """And the mirrored start gives the mirrored answer, distances slipped included."""
    building = Building([2e4] * 2, 8e6, 0.0, 5e6, 0.0, damping=ModalDamping(0.02), brace_damping=dashpot)
    bare = run(Building([2e4] * 2, 8e6, 0.0, 0.0, 0.0, damping=ModalDamping(0.02)), STILL, held_up(0.01, 0.0))
    one, other = (run(building, STILL, held_up(sign * 0.01, 0.0)) for sign in (1.0, -1.0))
    assert one.energy_error < 1e-12
    assert one.transition_time.size == other.transition_time.size == 0
    np.testing.assert_array_equal(one.slip_travel, other.slip_travel)
    np.testing.assert_array_equal(one.peak_acceleration, other.peak_acceleration)
    np.testing.assert_array_equal(one.residual_displacement, -other.residual_displacement)
    np.testing.assert_allclose(one.peak_displacement, bare.peak_displacement, rtol=1e-3)
    if dashpot == 0.0:
        np.testing.assert_allclose(one.peak_acceleration, bare.peak_acceleration, rtol=1e-13)
        # The braces spring back 10 mm each, and follow the drifts from there.
        assert one.dissipated_energy == pytest.approx(2 * 0.5 * 5e6 * 0.01**2, rel=1e-12)


@pytest.mark.parametrize("seed", range(60))
def test_a_release_above_is_felt_by_a_brace_with_mass_below(seed: int) -> None:
    """The upper brace has no mass and lets go to kinetic friction; the lower one stands near its limit."""
    rng = np.random.default_rng([3, seed])
    lower, upper = 40e3 * rng.uniform(0.3, 1.5), 30e3 * rng.uniform(0.5, 2.0)
    building = Building(
        2e4,
        8e6,
        [3000.0 * rng.uniform(0.5, 3.0), 0.0],
        16e6,
        [lower, upper],
        [lower, upper * rng.uniform(0.0, 0.5)],
        ModalDamping(0.02),
        [0.0, rng.choice([0.0, 1e4])],
    )
    t = np.arange(301) * 0.01
    motion = GroundMotion(4.0 * np.sin(9.0 * t) + 2.0 * np.sin(31.0 * t), 0.01)
    one, other = run(building, motion), run(building, motion, radians=1.25)
    assert one.transition_time.size > 20
    assert one.energy_error < 1e-11
    assert one.transition_time.size == other.transition_time.size
    assert apart(one, other) < 1e-10


def test_eighty_random_frames() -> None:
    assert faults(range(80)) == []


@pytest.mark.slow
@pytest.mark.parametrize("part", range(5))
def test_ten_thousand_random_frames(part: int) -> None:
    assert faults(range(2000 * part, 2000 * (part + 1))) == []


def faults(seeds: range) -> list[str]:
    """What is wrong with the histories of these frames, whole and at half the step."""
    found = []
    for seed in seeds:
        building, motion, start, free = draw(seed)
        begin = time.thread_time()
        one = run(building, motion, start, free)
        spent = time.thread_time() - begin
        other = run(building, motion, start, free, radians=1.25)
        told = []
        if (one.status, other.status) != (0, 0):
            told.append(f"status {STATUS_MEANINGS[one.status]}, {STATUS_MEANINGS[other.status]}")
        if not max(one.energy_error, other.energy_error) < 1e-9:
            told.append(f"energy error {one.energy_error:.1e}, {other.energy_error:.1e}")
        moved = apart(one, other)
        if not moved < 1e-9 and not moved < 10.0 * sensitivity(building, motion, start, free, one):
            told.append(f"halving moves a peak by {moved:.1e}")
        steps = (motion.n - 1 + free) * steps_of_building(building, motion.dt)
        work = steps + 50 * one.transition_time.size
        # Both runs of an engine's, and a step of many storeys under a busy machine.
        if not spent < 5.0 + 20.0 * work * building.n_storeys * 10e-6:
            told.append(f"{spent:.2f} s for about {work:.0f} steps")
        found += [f"seed {seed}, {building.n_storeys} storeys: {what}" for what in told]
    return found


def test_a_balance_that_does_not_close_is_a_status() -> None:
    """A step far beyond what its series can bear stands for a rule that went wrong."""
    building = Building([2e4] * 3, 8e6, 0.0, 16e6, np.inf, damping=ModalDamping(0.02))
    wrong = run(building, GroundMotion([0.0, 3.0, -2.0, 0.0], 1.0), radians=20.0)
    assert np.isfinite(wrong.peak_displacement).all()
    assert wrong.energy_error > ENERGY_TOLERANCE
    assert wrong.status == ENERGY_NOT_CLOSED
    assert STATUS_MEANINGS[ENERGY_NOT_CLOSED] == "energy_not_closed"


def test_the_error_is_relative_to_the_most_that_was_put_in() -> None:
    """Over one whole period of an undamped frame under constant ground acceleration the net input is zero."""
    mass, period = 2e4, 0.5
    stiffness = mass * (2.0 * math.pi / period) ** 2
    building = Building([mass, 1.0], [stiffness, 1e9], 0.0, 0.0, 0.0, damping=ModalDamping(0.0))
    whole = building.bare_periods[0]
    trajectory = run(building, GroundMotion(np.ones(101), whole / 100))
    assert trajectory.energy_error < 1e-9


def test_work_is_estimated_before_a_history_starts() -> None:
    def two(**changes: object) -> Building:
        given = {"brace_mass": 50.0, "brace_stiffness": 16e6, "brace_damping": None, **changes}
        return Building([2e4] * 2, 8e6, slip_force=40e3, damping=ModalDamping(0.02), **given)  # type: ignore[arg-type]

    def work(building: Building, dt: float = 0.01) -> float:
        return 2000 * steps_of_building(building, dt)

    assert 2000 <= work(two()) < 20_000
    assert work(two(brace_mass=1e-8)) > 1e8
    # A massless brace asks for short steps only while its dashpot relaxes.
    assert work(two(brace_mass=0.0, brace_damping=1.0)) == 2000
    assert work(two(), 1e6) > 1e10
