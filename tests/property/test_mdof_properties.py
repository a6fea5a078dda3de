"""What holds for every building of many storeys, whatever its numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fdspec
from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.trajectory import Span, Trajectory
from fdspec.records import catalogue
from tests.reference import numbers

GROUND, DT = numbers.motion("mdof_peaks.json")
MOTION = fdspec.GroundMotion(GROUND[300:451], DT)


def integrate(building: fdspec.Building, motion: fdspec.GroundMotion, **options: float) -> Trajectory:
    n = building.n_storeys
    trajectory = integrate_many_storeys(
        building,
        motion,
        Span(0, motion.duration, 2),
        np.zeros((2, 2, n)),
        **options,  # type: ignore[arg-type]
    )
    assert trajectory.status == 0
    return trajectory


def drawn(seed: int, storeys: int) -> fdspec.Building:
    """Any mixture: heavy and light braces, none, without mass, damped; forces from none to never."""
    rng = np.random.default_rng(seed)
    n = storeys
    mass = rng.uniform(10e3, 60e3, n)
    stiffness = (
        mass.mean() * (2.0 * math.pi / (rng.uniform(0.05, 0.2) * n)) ** 2 * n * rng.uniform(0.5, 2.0, n)
    )
    brace = stiffness * np.exp(rng.uniform(math.log(0.1), math.log(10.0), n))
    brace_mass = np.exp(rng.uniform(math.log(20.0), math.log(4000.0), n))
    force = mass * 9.81 * np.exp(rng.uniform(math.log(0.02), math.log(1.0), n))
    kinetic = force * np.where(rng.random(n) < 0.3, rng.uniform(0.3, 1.0, n), 1.0)
    damping = np.where(rng.random(n) < 0.3, rng.uniform(0.0, 0.3, n), 0.0) * 2.0 * np.sqrt(brace * brace_mass)
    kind = rng.random(n)
    brace_mass[kind < 0.15] = 0.0
    none = kind > 0.9
    force[(kind > 0.8) & ~none] = kinetic[(kind > 0.8) & ~none] = 0.0
    force[(kind > 0.7) & (kind < 0.8)] = math.inf
    for array in (brace, brace_mass, force, kinetic, damping):
        array[none] = 0.0
    choice = rng.integers(3)
    ratio = float(rng.uniform(0.0, 0.1))
    return fdspec.Building(
        mass,
        stiffness,
        brace_mass,
        brace,
        force,
        kinetic,
        fdspec.RayleighDamping(ratio, 0.5, 0.1) if choice == 0 else fdspec.ModalDamping(ratio),
        damping,
    )


buildings = st.builds(drawn, st.integers(0, 2**32 - 1), st.integers(1, 6))


@given(buildings)
@settings(max_examples=40)
def test_energy_closes_and_the_mirrored_motion_gives_the_mirrored_answer(building: fdspec.Building) -> None:
    one, other = integrate(building, MOTION), integrate(building, MOTION.scaled(-1.0))
    assert one.energy_error < 1e-9
    np.testing.assert_array_equal(one.peak_acceleration, other.peak_acceleration)
    np.testing.assert_array_equal(one.residual_displacement, -other.residual_displacement)
    np.testing.assert_array_equal(one.transition_phase, -other.transition_phase)
    np.testing.assert_array_equal(one.transition_time, other.transition_time)


@given(buildings, st.sampled_from([0.25, 8.0, 2.0**-20]))
@settings(max_examples=30)
def test_scaling_the_motion_and_the_slip_forces_scales_the_answer(
    building: fdspec.Building, factor: float
) -> None:
    """By powers of two, so that not even rounding differs."""
    scaled = fdspec.Building(
        building.floor_mass,
        building.storey_stiffness,
        building.brace_mass,
        building.brace_stiffness,
        building.slip_force * factor,
        building.kinetic_slip_force * factor,
        building.damping,
        building.brace_damping,
    )
    one, other = integrate(building, MOTION), integrate(scaled, MOTION.scaled(factor))
    np.testing.assert_array_equal(one.peak_acceleration * factor, other.peak_acceleration)
    np.testing.assert_array_equal(one.transition_time, other.transition_time)


@given(buildings)
@settings(max_examples=30)
def test_a_longer_record_keeps_its_beginning(building: fdspec.Building) -> None:
    longer = fdspec.GroundMotion(GROUND[300:500], DT)
    one, other = integrate(building, MOTION), integrate(building, longer)
    n = one.transition_time.size
    np.testing.assert_array_equal(one.transition_time, other.transition_time[:n])
    assert (other.peak_acceleration >= one.peak_acceleration).all()


@given(buildings)
@settings(max_examples=30)
def test_storeys_never_hold_more_than_their_slip_force(building: fdspec.Building) -> None:
    n = building.n_storeys
    trajectory = integrate_many_storeys(building, MOTION, Span(0, 0.0037, 401), np.zeros((2, 2, n)))
    stuck = trajectory.phase == 0
    limit = building.slip_force * (1.0 + 1e-9)
    assert (np.abs(trajectory.friction_force) <= limit)[stuck].all()
    travel = np.diff(trajectory.slip_travel, axis=0)
    assert (travel >= -1e-12).all()


@pytest.mark.slow
def test_a_hundred_random_ten_storey_buildings_under_every_record() -> None:
    motions = [fdspec.load_record(entry.name) for entry in catalogue()]
    worst = 0.0
    for seed in range(100):
        building = drawn(1000 + seed, 10)
        for motion in motions:
            trajectory = integrate(building, motion)
            worst = max(worst, trajectory.energy_error)
    assert worst < 1e-9
