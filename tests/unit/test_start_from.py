"""A history that goes on where another ended: two motions give the bits of both as one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec import Building, Link, ModalDamping, TensionBrace
from fdspec.errors import InvalidInput
from tests.reference import numbers

GROUND, DT = numbers.motion("mdof_peaks.json")
SAMPLES = GROUND[200:601] * 1.5
WHOLE = fdspec.GroundMotion(SAMPLES, DT, name="whole")
CUT = 173
FIRST = fdspec.GroundMotion(SAMPLES[: CUT + 1], DT, name="mainshock")
SECOND = fdspec.GroundMotion(SAMPLES[CUT:], DT, name="aftershock")

STOREYS = ([40e3, 30e3, 30e3], [40e6, 30e6, 20e6], [60.0, 0.0, 300.0], [80e6, 50e6, 40e6], [60e3, 40e3, 30e3])
BUILDINGS = {
    "one storey": Building.single_storey(0.4, 4.0, 40e3),
    "one massless": Building.single_storey(0.4, 4.0, 40e3, brace_mass=0.0, kinetic_slip_force=30e3),
    "three storeys": Building(*STOREYS, damping=ModalDamping(0.03)),
    "three storeys with devices": Building(
        *STOREYS,
        damping=ModalDamping(0.03),
        yield_shear=[200e3, 150e3, 80e3],
        storey_height=3.0,
        gravity_load=300e3,
        slot_length=0.005,
        slot_stiffness=60e6,
        links=[Link(3, 0, 10e6, 20e3, mass=50.0), TensionBrace(1, 0, 1e7, 40e3, slack=0.001)],
    ),
}
TRAJECTORIES = (
    "displacement",
    "velocity",
    "acceleration",
    "brace_velocity",
    "friction_force",
    "phase",
    "storey_shear",
)


@pytest.mark.parametrize("name", BUILDINGS)
def test_two_motions_give_the_bits_of_one(name: str, tmp_path: Path) -> None:
    building = BUILDINGS[name]
    whole = fdspec.simulate(building, WHOLE)
    fdspec.save(fdspec.simulate(building, FIRST), tmp_path / "mainshock.nc")
    second = fdspec.simulate(building, SECOND, start_from=fdspec.open(tmp_path / "mainshock.nc"))
    for trajectory in TRAJECTORIES:
        # Output instants are multiples of dt, rounded from another start.
        scale = 1e-11 * float(abs(whole[trajectory]).max())
        np.testing.assert_allclose(
            second[trajectory][1:], whole[trajectory][CUT + 1 :], rtol=0.0, atol=scale, err_msg=trajectory
        )
    np.testing.assert_array_equal(second["residual_displacement"], whole["residual_displacement"])
    later = whole["transition_time"] > CUT * DT
    np.testing.assert_array_equal(second["transition_phase"], whole["transition_phase"][later])
    np.testing.assert_allclose(
        second["transition_time"] + CUT * DT, whole["transition_time"][later], atol=1e-12
    )
    assert float(second["energy_error"]) < 1e-9
    if building.has_devices:
        np.testing.assert_array_equal(second["plastic_drift"], whole["plastic_drift"])
        np.testing.assert_array_equal(second["residual_link_slip"], whole["residual_link_slip"])


def test_what_start_from_refuses() -> None:
    history = fdspec.simulate(BUILDINGS["one storey"], FIRST)
    other = Building.single_storey(0.5, 4.0, 40e3)
    with pytest.raises(InvalidInput, match="of the same building, but its stiffness_matrix differs"):
        fdspec.simulate(other, SECOND, start_from=history)
    with pytest.raises(InvalidInput, match="start_from gives the start"):
        fdspec.simulate(BUILDINGS["one storey"], SECOND, start_from=history, initial_velocity=[0.1])
    with pytest.raises(InvalidInput, match="start_from needs method 'exact'"):
        fdspec.simulate(BUILDINGS["one storey"], SECOND, start_from=history, method="newmark")
    with pytest.raises(InvalidInput, match="start_from must be a history"):
        fdspec.simulate(BUILDINGS["one storey"], SECOND, start_from=history.drop_vars("end_state"))
