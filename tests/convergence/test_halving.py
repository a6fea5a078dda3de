"""No subdivision stands in the answer: more samples on the same lines change no peak and no count."""

from __future__ import annotations

import numpy as np
import pytest

import fdspec
from fdspec.engines.single_storey import integrate_single_storey
from fdspec.engines.trajectory import Span
from fdspec.kernels.storey.constants import RADIANS
from tests import cells
from tests.answers import PEAKS, Answer, building_of, swept

FEW, ALL = range(100), range(100, 2100)


def differences(cell: cells.Cell, one: Answer, other: Answer) -> list[str]:
    """What differs, each as one line that reproduces it."""
    found = []
    if one.transitions != other.transitions:
        found.append(f"transitions {one.transitions} and {other.transitions}: {cell}")
    for name, a, b in zip(PEAKS, one.peaks, other.peaks, strict=True):
        if abs(a - b) > 1e-10 * abs(a):
            found.append(f"{name} {a!r} and {b!r} ({(b - a) / a:.1e}): {cell}")
    errors = [answer.energy_error for answer in (one, other)]
    found += [f"energy error {error:.1e}: {cell}" for error in errors if not error <= 1e-9]
    return found


def finer(cell: cells.Cell, radians: float) -> Answer:
    """One history with segments of at most this phase (rad) searched for roots, without a trajectory."""
    building = building_of(cell)
    motion = fdspec.GroundMotion(cell.acceleration, cell.dt)
    span = Span(0, motion.duration, 2)
    trajectory = integrate_single_storey(building, motion, span, np.zeros((2, 2, 1)), radians=radians)
    assert trajectory.status == 0
    peaks = (
        trajectory.peak_acceleration[0],
        trajectory.peak_displacement[0],
        trajectory.peak_velocity[0],
        trajectory.peak_base_shear,
    )
    return Answer(
        tuple(float(peak) for peak in peaks),
        trajectory.transition_time.size,
        float(trajectory.slip_travel[-1, 0]),
        float(trajectory.residual_displacement[0]),
        trajectory.energy_error,
    )


def halve_segments(numbers: range) -> list[str]:
    found = []
    for number in numbers:
        if number in cells.CHAOTIC:
            continue
        cell = cells.draw(number)
        found += differences(cell, finer(cell, RADIANS), finer(cell, 0.5 * RADIANS))
    return found


def halve(numbers: range) -> list[str]:
    found = []
    for number in numbers:
        if number in cells.CHAOTIC:
            continue
        cell = cells.draw(number)
        one = swept(cell, cell.acceleration, cell.dt)
        found += differences(cell, one, swept(cell, cell.halved, cell.dt / 2.0))
    return found


def test_the_cells_cover_the_range() -> None:
    drawn = [cells.draw(number) for number in ALL]
    weight = cells.FLOOR_MASS * cells.G
    for name, low, high in (
        ("period", 0.025, 8.0),
        ("stiffness_ratio", 0.06, 40.0),
        ("damping_ratio", 0.0, 0.29),
        ("brace_mass", 2.0, 4500.0),
        ("dt", 0.0011, 0.045),
        ("slip_force", 0.0, 4.9 * weight),
    ):
        values = np.array([getattr(cell, name) for cell in drawn])
        assert values.min() <= low, name
        assert values.max() >= high, name
    fastest = max(
        np.sqrt(c.stiffness_ratio * cells.FLOOR_MASS / c.brace_mass) * 2.0 * np.pi / c.period for c in drawn
    )
    assert 4e4 < fastest < 5.0001e4


def test_halving_the_steps_of_the_motion() -> None:
    found = halve(FEW)
    assert not found, "\n".join(found)


@pytest.mark.slow
def test_halving_the_steps_of_the_motion_on_two_thousand_cells() -> None:
    found = halve(ALL)
    assert not found, "\n".join(found)


def test_halving_the_pieces_that_are_searched() -> None:
    found = halve_segments(FEW)
    assert not found, "\n".join(found)


@pytest.mark.slow
def test_halving_the_pieces_that_are_searched_on_two_thousand_cells() -> None:
    found = halve_segments(ALL)
    assert not found, "\n".join(found)
