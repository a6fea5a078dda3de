"""Hysteresis loops: corners where the damper stops and starts, whatever the step of the outputs."""

import numpy as np
import pytest

import fdspec
from fdspec.errors import InvalidInput
from fdspec.measures import hysteresis
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@pytest.fixture(scope="module")
def motion() -> GroundMotion:
    whole = fdspec.load_record("FSR1")
    return GroundMotion(whole.acceleration[:1500], whole.dt, name="FSR1")


def area(loop) -> float:
    slip, force = loop["slip"].values, loop["force"].values
    return float((0.5 * (force[1:] + force[:-1]) * np.diff(slip)).sum())


@pytest.mark.parametrize("kinetic", [50e3, 40e3])
def test_the_loop_encloses_the_energy_that_friction_dissipates(motion: GroundMotion, kinetic: float) -> None:
    """Joined outputs lose some of it at every corner; the loop's own corners lose none."""
    frame = Building.single_storey(0.5, 4.0, 50e3, kinetic_slip_force=kinetic)
    history = fdspec.simulate(frame, motion)
    burned = history["dissipated_energy"].item()
    assert area(hysteresis(history)) == pytest.approx(burned, rel=1e-9 if kinetic == 50e3 else 1e-3)
    one = history.isel(storey=0)
    outputs = one["displacement"].values - one["brace_displacement"].values
    force = one["friction_force"].values
    cut = float((0.5 * (force[1:] + force[:-1]) * np.diff(outputs)).sum())
    assert abs(cut - burned) > 1e-3 * burned


def test_lines_are_level_at_the_slip_force_or_upright(motion: GroundMotion) -> None:
    loop = hysteresis(fdspec.simulate(Building.single_storey(0.5, 4.0, 50e3), motion, dt_out=1e-3))
    slip, force = loop["slip"].values, loop["force"].values
    moved = np.diff(slip) != 0.0
    level = np.abs(force[1:]) == 50e3
    assert (force[1:][moved] == force[:-1][moved]).all()
    assert level[moved].all()
    assert np.abs(force).max() <= 50e3
    assert loop["slip"].attrs["units"] == "m"


def test_each_storey_has_a_loop_of_its_own(motion: GroundMotion) -> None:
    building = Building.from_periods([20e3, 20e3], 0.6, 0.35, [60e3, 30e3], brace_mass=25.0)
    history = fdspec.simulate(building, motion, dt_out=1e-3)
    for storey, limit in ((1, 60e3), (2, 30e3)):
        loop = hysteresis(history, storey)
        burned = history["storey_friction_energy"].sel(storey=storey).values[-1]
        assert np.abs(loop["force"]).max() == limit
        assert area(loop) == pytest.approx(burned, rel=1e-3)
    with pytest.raises(InvalidInput, match="storey must be from 1 to 2, got 3"):
        hysteresis(history, 3)


def test_a_damper_that_never_slips_or_has_no_friction_gives_its_outputs(motion: GroundMotion) -> None:
    for force in (np.inf, 0.0):
        history = fdspec.simulate(Building.single_storey(0.5, 4.0, force), motion)
        loop = hysteresis(history)
        assert loop["force"].values.tolist() == history["friction_force"].values[:, 0].tolist()
