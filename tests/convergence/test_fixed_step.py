"""The study's scheme beside the exact engine: agreement at its own step, and the order of its error."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import fdspec
from fdspec.methods import Bilinear, Method, Newmark, StateSpace
from fdspec.validation import four_storey, kalamata, single_storey_k_braced
from fdspec.verification.problems import FRAMES, frame, shaking


def test_k_braced_storey_at_the_studys_step() -> None:
    agree_within(single_storey_k_braced.building(), 1 / 4)


@pytest.mark.slow
@pytest.mark.parametrize("beta", [1 / 4, 1 / 6], ids=["average", "linear"])
@pytest.mark.parametrize("problem", [single_storey_k_braced, four_storey])
def test_validation_problems_at_the_studys_step(problem: ModuleType, beta: float) -> None:
    agree_within(problem.building(), beta)


def agree_within(building: fdspec.Building, beta: float) -> None:
    motion = kalamata.stand_in()
    exact = fdspec.simulate(building, motion)
    stepped = fdspec.simulate(building, motion, method=Newmark(beta=beta))
    assert exact.transitions > 50
    np.testing.assert_allclose(stepped.peak_acceleration, exact.peak_acceleration, rtol=1e-5)
    assert stepped.transitions == exact.transitions


def typical_error(methods: list[Method], frames: list[fdspec.Building]) -> list[float]:
    """Geometric mean of the error in peak acceleration, for each method."""
    motion = shaking(5.0)
    exact = [float(fdspec.simulate(building, motion).peak_acceleration[0]) for building in frames]
    found = []
    for method in methods:
        errors = [
            abs(float(fdspec.simulate(building, motion, method=method).peak_acceleration[0]) / peak - 1.0)
            for building, peak in zip(frames, exact, strict=True)
        ]
        found.append(float(np.exp(np.mean(np.log(np.maximum(errors, 1e-15))))))
    return found


def measured_order(method: type[Newmark | StateSpace], steps: list[float]) -> float:
    frames = [frame(*numbers) for numbers in FRAMES[::2]]
    errors = typical_error([method(dt=step) for step in steps], frames)
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def test_the_studys_scheme_is_of_first_order() -> None:
    assert measured_order(Newmark, [1e-4, 3e-5, 1e-5]) == pytest.approx(1.0, abs=0.3)


def test_balanced_steps_are_of_a_higher_order_than_the_studys() -> None:
    """Friction chosen for the step's end lets a damper stop inside the step, on the average of it."""
    assert measured_order(StateSpace, [3e-4, 1e-4]) > 1.3


def test_the_elasto_plastic_spring_converges_to_the_massless_brace() -> None:
    frames = [
        fdspec.Building.single_storey(period, ratio, force, brace_mass=0.0)
        for period, ratio, force in FRAMES[4:16:3]
    ]
    coarse, fine = typical_error([Bilinear(dt=1e-3), Bilinear(dt=1e-4)], frames)
    assert fine < coarse / 5.0
