"""Every reference number, through the public interface: `simulate` cell by cell and `sweep` as one grid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import fdspec
from tests.reference import numbers

CELLS = numbers.single_storeys()
BUILDINGS = numbers.read("mdof_peaks.json")["buildings"]
FRICTION = 0.5


@pytest.fixture(scope="module")
def motion() -> fdspec.GroundMotion:
    return fdspec.GroundMotion(*numbers.motion(), name="reference")


def test_the_files_are_whole() -> None:
    assert len(CELLS) == 144
    assert sum(cell.transitions > 0 for cell in CELLS) == 71
    assert [len(b["floor_mass_kg"]) for b in BUILDINGS] == [4, 4, 2, 2, 8]


@pytest.mark.parametrize("name", numbers.FILES)
def test_the_copy_is_the_shared_file(name: str, shared: Path) -> None:
    assert (numbers.HERE / name).read_bytes() == (shared / "reference" / name).read_bytes()


@pytest.mark.parametrize("cell", CELLS, ids=str)
def test_simulate_one_storey(cell: numbers.SingleStorey, motion: fdspec.GroundMotion) -> None:
    frame = fdspec.Building.single_storey(
        period=cell.period,
        stiffness_ratio=cell.stiffness_ratio,
        slip_force=cell.slip_force,
        floor_mass=20e3,
        brace_mass=50.0,
        damping_ratio=0.05,
    )
    history = fdspec.simulate(frame, motion)
    assert history.sizes["transition"] == cell.transitions
    assert history.peak_acceleration.item() == pytest.approx(cell.peak_acceleration, rel=1e-10)
    assert history.peak_displacement.item() == pytest.approx(cell.peak_displacement, rel=1e-10)
    assert history.energy_error.item() < 1e-9


def test_sweep(motion: fdspec.GroundMotion) -> None:
    periods = sorted({c.period for c in CELLS})
    ratios = sorted({c.stiffness_ratio for c in CELLS})
    forces = sorted({c.slip_force for c in CELLS})
    assert len(periods) * len(ratios) * len(forces) == len(CELLS)
    cube = fdspec.sweep(
        motion,
        period=periods,
        stiffness_ratio=ratios,
        pretension=[force / FRICTION for force in forces],
        friction_coefficient=FRICTION,
    )
    assert (cube.status == 0).all()
    assert (cube.energy_error < 1e-9).all()
    for cell in CELLS:
        place = {
            "record": "reference",
            "period": cell.period,
            "stiffness_ratio": cell.stiffness_ratio,
            "pretension": cell.slip_force / FRICTION,
        }
        got = cube.sel(place)
        assert got.transitions.item() == cell.transitions, str(cell)
        assert got.peak_acceleration.item() == pytest.approx(cell.peak_acceleration, rel=1e-10), str(cell)
        assert got.peak_displacement.item() == pytest.approx(cell.peak_displacement, rel=1e-10), str(cell)


@pytest.mark.parametrize("given", BUILDINGS, ids=lambda b: f"{len(b['floor_mass_kg'])} storeys")
def test_simulate_a_building(given: dict[str, list[float]], motion: fdspec.GroundMotion) -> None:
    building = fdspec.Building(
        floor_mass=given["floor_mass_kg"],
        storey_stiffness=given["storey_stiffness_n_m"],
        brace_mass=given["brace_mass_kg"],
        brace_stiffness=given["brace_stiffness_n_m"],
        slip_force=given["slip_force_n"],
        damping=fdspec.ModalDamping(given["modal_damping_ratio"]),
    )
    history = fdspec.simulate(building, motion)
    assert history.sizes["transition"] == given["n_transitions"]
    np.testing.assert_allclose(history.peak_acceleration, given["peak_acceleration_m_s2"], rtol=1e-9)
    np.testing.assert_allclose(history.peak_displacement, given["peak_displacement_m"], rtol=1e-9)
    final = np.concatenate([history.displacement[-1], history.brace_displacement[-1]])
    scale = float(history.peak_displacement.max())
    np.testing.assert_allclose(final, given["final_displacement_m"], rtol=0.0, atol=1e-9 * scale)
    assert history.energy_error.item() < 1e-9
