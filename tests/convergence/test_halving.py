"""No subdivision stands in the answer: more samples on the same lines change no peak and no count."""

from __future__ import annotations

import numpy as np
import pytest

from tests import cells
from tests.answers import PEAKS, Answer, swept
from tests.oracle import sdof_events

FEW, ALL = range(100), range(100, 2100)

CHAOTIC = (279,)
"""Cells whose exact answer moves by more than 1e-11 with the last bit of the slip force, as the oracle shows.

279: kinetic friction 0.6 of static, 9559 changes of phase in 3 s; a difference grows 1e10-fold on the way.
"""


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


def halve(numbers: range) -> list[str]:
    found = []
    for number in numbers:
        if number in CHAOTIC:
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


@pytest.mark.slow
@pytest.mark.parametrize("number", CHAOTIC)
def test_chaotic_cells_are_chaotic(number: int) -> None:
    """In extended precision, without fdspec: one unit in the last place of one input."""
    cell = cells.draw(number)
    one, other = (
        sdof_events.integrate(sdof_events.of_cell(cell, force), cell.acceleration, cell.dt)
        for force in (cell.slip_force, np.nextafter(cell.slip_force, np.inf))
    )
    assert abs(other.peak_velocity / one.peak_velocity - 1.0) > 1e-11
