"""The study's validation problems: what is printed of them holds, and they run on either excitation."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.units import G
from fdspec.validation import four_storey, single_storey_k_braced
from fdspec.validation.kalamata import read_kalamata, stand_in
from fdspec.validation.pair import Pair
from tests.reference import numbers


def excitation() -> GroundMotion:
    return GroundMotion(*numbers.motion())


def test_the_k_braced_frame_has_the_printed_periods_and_masses() -> None:
    frame = single_storey_k_braced.building(20e3)
    assert frame.floor_mass.tolist() == [20e3]
    assert frame.brace_mass.tolist() == [27.0]
    assert frame.bare_periods[0] == pytest.approx(0.4, rel=1e-14)
    alone = 2.0 * math.pi * math.sqrt(frame.brace_mass[0] / frame.brace_stiffness[0])
    assert alone == pytest.approx(0.0684, rel=1e-14)
    assert frame.slip_force[0] == pytest.approx(0.15 * 20e3)
    damping = frame.damping_matrix[0, 0] / (2.0 * math.sqrt(frame.stiffness_matrix[0, 0] * 20e3))
    assert damping == pytest.approx(0.02)


def test_the_four_storey_frame_has_the_printed_periods_and_masses() -> None:
    frame = four_storey.building([1e5, 2e5, 3e5, 4e5])
    assert frame.floor_mass.tolist() == [41610.0, 41610.0, 41610.0, 40820.0]
    assert frame.brace_mass.tolist() == [23.0] * 4
    assert frame.bare_periods[0] == pytest.approx(1.006, rel=1e-13)
    assert frame.braced_periods[0] == pytest.approx(0.612, rel=1e-13)
    np.testing.assert_allclose(frame.slip_force, [15e3, 30e3, 45e3, 60e3])


def test_the_reference_frame_is_the_problem_at_its_slip_force() -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][0]
    pair = four_storey.solve(excitation(), given["slip_force_n"][0] / 0.15)
    np.testing.assert_allclose(pair.damped.peak_acceleration, given["peak_acceleration_m_s2"], rtol=1e-9)
    assert int(pair.damped.transitions) == given["n_transitions"]


@pytest.mark.parametrize("problem", [single_storey_k_braced, four_storey])
def test_bare_beside_damped(problem: object) -> None:
    pair = problem.solve(excitation())  # type: ignore[attr-defined]
    assert isinstance(pair, Pair)
    assert int(pair.bare.transitions) == 0
    assert int(pair.damped.transitions) > 50
    assert pair.damped.peak_displacement[-1] < pair.bare.peak_displacement[-1]
    assert pair.bare.sizes == {**pair.damped.sizes, "transition": 0}
    with pytest.raises(InvalidInput, match="slip_force must be 0 or more"):
        problem.solve(excitation(), -1.0)  # type: ignore[attr-defined]


def test_without_normal_force_the_additional_frame_does_next_to_nothing() -> None:
    pair = single_storey_k_braced.solve(excitation(), 0.0)
    np.testing.assert_allclose(pair.damped.peak_displacement, pair.bare.peak_displacement, rtol=1e-12)


def test_the_stand_in_has_the_printed_peak() -> None:
    motion = stand_in()
    assert motion.pga == pytest.approx(0.240 * G, rel=1e-14)
    assert any("0.24" in step or "PGA" in step for step in motion.history)


def test_the_users_own_file(tmp_path: Path) -> None:
    path = tmp_path / "kalamata.txt"
    path.write_text("".join(f"{0.00976 * k:.5f} {math.sin(k):.6f}\n" for k in range(100)))
    motion = read_kalamata(path, units="m/s2")
    assert (motion.name, motion.n) == ("Kalamata 1986", 100)
    assert motion.dt == pytest.approx(0.00976)
    assert motion.pga == pytest.approx(0.240 * G, rel=1e-14)


def test_the_nearest_file_there_is(shared: Path) -> None:
    motion = read_kalamata(shared / "records" / "real" / "kalamata_ms2.txt", units="m/s2", dt=0.01)
    pair = four_storey.solve(motion)
    assert pair.damped.peak_displacement[-1] < 0.8 * pair.bare.peak_displacement[-1]
    assert float(pair.damped.energy_error) < 1e-9
