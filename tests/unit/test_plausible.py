"""Numbers that look like another unit's are told once, and computed."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec.runs.plausible import warn_of_units

USUAL: dict[str, Any] = {"period": [0.5, 2.0], "slip_force": [0.0, 5e4, np.inf], "floor_mass": 20e3}


def motion(peak: float = 3.0, **about: Any) -> fdspec.GroundMotion:
    return fdspec.GroundMotion([0.0, peak, -0.5 * peak], 0.01, "mine", **about)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"period": [0.5, 500.0]}, "a period of 500 s is very long: periods are in s, not in ms"),
        ({"slip_force": [10.0, 50.0, np.inf]}, "slip forces of at most 50 N under floors of 2e[+]04 kg"),
    ],
)
def test_periods_and_forces_of_another_unit(changed: dict[str, Any], said: str) -> None:
    with pytest.warns(UserWarning, match=said):
        warn_of_units([motion()], **{**USUAL, **changed})


def test_motions_in_g() -> None:
    with pytest.warns(
        UserWarning, match=r"mine has a peak of 0\.3 m/s2 only: acceleration is in m/s2, not in g"
    ):
        warn_of_units([motion(0.3)], **USUAL)


@pytest.mark.parametrize(
    "motions",
    [
        [motion()],
        [motion(), motion(0.3)],  # a weak one in a suite
        [motion(0.3, source="a.AT2")],  # of known unit
        [motion().scaled_to_pga(0.3)],  # weak on purpose
        [motion(1e-3)],
        [fdspec.GroundMotion([0.0, 0.0], 0.01)],
    ],
)
def test_usual_numbers_pass_in_silence(motions: list[fdspec.GroundMotion]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_units(motions, **USUAL)
        warn_of_units(motions, period=[0.2], slip_force=[5.0], floor_mass=3.0)  # on a shaking table
        warn_of_units(motions, period=[0.2], slip_force=[0.0, np.inf], floor_mass=20e3)


def test_every_door_tells() -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50.0)
    with pytest.warns(UserWarning, match="not in kN"):
        fdspec.simulate(frame, motion())
    with pytest.warns(UserWarning, match="not in kN"):
        fdspec.sweep(motion(), period=0.5, pretension=100.0, stiffness_ratio=4)
    with pytest.warns(UserWarning, match="not in kN"):
        fdspec.sweep_buildings(motion(), frame, slip_scale=[1.0], stiffness_scale=[1.0])
