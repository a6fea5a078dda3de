"""Columns that yield, slots that end and P-delta against numbers made outside, frame by frame."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fdspec
from tests.reference import numbers

FRAMES = 59
DEVICES = ("storey_height", "yield_shear", "gravity_load", "slot_length", "slot_stiffness")


@pytest.fixture(scope="module")
def given(shared: Path) -> dict[str, Any]:
    return dict(json.loads((shared / "reference" / "yielding_peaks.json").read_text(encoding="utf-8")))


@pytest.fixture(scope="module")
def motion(given: dict[str, Any]) -> fdspec.GroundMotion:
    plain, dt = numbers.motion()
    scale = given["motion"]["pga_g"] * given["motion"]["g"] / np.abs(plain).max()
    return fdspec.GroundMotion(plain * scale, dt, name="reference")


def building_of(frame: dict[str, Any]) -> fdspec.Building:
    return fdspec.Building(
        frame["floor_mass"],
        frame["storey_stiffness"],
        frame["brace_mass"],
        frame["brace_stiffness"],
        frame["slip_force"],
        frame["kinetic_slip_force"],
        damping=fdspec.ModalDamping(frame["damping_ratio"]),
        hardening_ratio=frame["hardening_ratio"],
        **{name: frame[name] for name in DEVICES},
    )


def test_the_file_is_whole(given: dict[str, Any]) -> None:
    cases = given["cases"]
    assert len(cases) == FRAMES
    motion_of = numbers.read("sdof_peaks.json")["motion"]
    assert {key: given["motion"][key] for key in ("f", "a", "phi", "n", "dt")} == {
        key: motion_of[key] for key in ("f", "a", "phi", "n", "dt")
    }


@pytest.mark.parametrize("which", range(FRAMES))
def test_a_frame(which: int, given: dict[str, Any], motion: fdspec.GroundMotion) -> None:
    case = given["cases"][which]
    building, answer = building_of(case["frame"]), case["answer"]
    history = fdspec.simulate(building, motion, dt_out=motion.duration)
    events = answer["events"]
    assert int(history["transitions"]) == events["damper"]
    assert float(history["energy_error"]) < 1e-9
    devices = building.has_devices
    assert devices or events["column"] == events["slot"] == 0
    pairs = [
        ("peak_acceleration", "peak_acceleration"),
        ("peak_displacement", "peak_displacement"),
        ("residual_displacement", "final_displacement"),
        ("peak_slip", "peak_slip"),
    ]
    if devices:
        assert int(history["column_events"].sum()) == events["column"]
        assert int(history["slot_events"].sum()) == events["slot"]
        if answer["plastic_drift"]:
            pairs += [(name, name) for name in ("peak_column_deformation", "plastic_drift")]
    for ours, theirs in pairs:
        expected = np.asarray(answer[theirs])
        np.testing.assert_allclose(
            history[ours].values, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max(), err_msg=ours
        )
