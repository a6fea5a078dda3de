"""Frames side by side give what each gives by itself: to the bit among themselves, to rounding elsewhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import fdspec
from fdspec.engines import frames as batch
from fdspec.engines.many_storeys import peaks_of
from fdspec.kernels.frame.results import DEMANDS, RESULT, STOREY_RESULTS, TOTALS
from fdspec.model.building import Frame
from tests.buildings import Case
from tests.reference import numbers

ENERGIES = ("viscous_energy", "energy_error")
PEAKS = slice(0, 6)
COUNTS = STOREY_RESULTS.index("storey_transitions")


def part_of_motion(first: int, last: int) -> fdspec.GroundMotion:
    acceleration, dt = numbers.motion()
    return fdspec.GroundMotion(acceleration[first:last], dt, name="part")


def scaled(frame: Frame, scale: float) -> Frame:
    """The frame with its slip forces times a factor."""
    from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE, SLIP_FORCE

    properties = frame.properties.copy()
    properties[[SLIP_FORCE, KINETIC_SLIP_FORCE]] *= scale
    return frame._replace(properties=properties)


def of_all_kinds(storeys: int) -> list[Frame]:
    """Frames with and without braces, dashpots beside them, all kinds of damping, all slip forces."""
    cases = [Case(seed, storeys).building for seed in range(40, 46)]
    base = cases[0]
    stiffness = np.array(base.stiffness_matrix)
    stiffness[0, -1] = stiffness[-1, 0] = stiffness[0, -1] - 0.05 * stiffness[0, 0]
    given = np.diag(np.full(storeys, 2e4))
    for damping, k in (
        (fdspec.RayleighDamping(0.05, 0.5, 0.1), base.storey_stiffness),
        (fdspec.DampingMatrix(given), base.storey_stiffness),
        (fdspec.ModalDamping(0.03), stiffness),
        (fdspec.DampingMatrix(given), stiffness),
    ):
        cases.append(
            fdspec.Building(
                base.floor_mass,
                k,
                base.brace_mass,
                base.brace_stiffness,
                base.slip_force,
                damping=damping,
            )
        )
    frames = [scaled(case.frame, scale) for case in cases for scale in (1.0, 0.3, 2.5)]
    return [*frames, scaled(cases[0].frame, 0.0)]


def compare(frames: Sequence[Frame], motion: fdspec.GroundMotion) -> float:
    """Compare with the engine that takes one history at a time; return the changes of phase."""
    by_storey, totals = batch.peaks_of_frames(frames, motion, certify=True)
    for frame, of_storeys, of_all in zip(frames, by_storey, totals, strict=True):
        want, total = peaks_of(frame, motion, certify=True)
        named = dict(zip(TOTALS, of_all, strict=True))
        wanted = dict(zip(TOTALS, total, strict=True))
        assert named["status"] == wanted["status"] == 0.0
        assert named["transitions"] == wanted["transitions"]
        np.testing.assert_array_equal(of_storeys[COUNTS], want[COUNTS])
        np.testing.assert_allclose(of_storeys[PEAKS], want[PEAKS], rtol=1e-12)
        scale = want[1].max()
        np.testing.assert_allclose(of_storeys[6:8], want[6:8], rtol=0.0, atol=1e-11 * scale)
        slip = RESULT.residual_slip
        np.testing.assert_allclose(of_storeys[slip], want[slip], rtol=0.0, atol=1e-11 * scale)
        assert np.isnan(of_storeys[DEMANDS:]).all()
        for name in ("dissipated_energy", "viscous_energy", "input_energy"):
            assert named[name] == pytest.approx(wanted[name], rel=1e-11, abs=1e-11 * wanted["input_energy"])
        assert named["energy_error"] < 1e-11
    return float(totals[:, 0].sum())


@pytest.mark.parametrize("storeys", [2, 5])
def test_frames_of_all_kinds(storeys: int) -> None:
    assert compare(of_all_kinds(storeys), part_of_motion(250, 400)) > 1000


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(200, 212))
def test_many_random_frames(seed: int) -> None:
    rng = np.random.default_rng(seed)
    storeys = int(rng.integers(1, 13))
    frames = [
        scaled(Case(1000 * seed + number, storeys).building.frame, float(10.0 ** rng.uniform(-1.0, 1.0)))
        for number in range(24)
    ]
    first = int(rng.integers(0, 600))
    compare(frames, part_of_motion(first, first + 500))


@pytest.mark.parametrize("which", range(5))
def test_reference_buildings(which: int) -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][which]
    building = fdspec.Building(
        given["floor_mass_kg"],
        given["storey_stiffness_n_m"],
        given["brace_mass_kg"],
        given["brace_stiffness_n_m"],
        given["slip_force_n"],
        damping=fdspec.ModalDamping(given["modal_damping_ratio"]),
    )
    acceleration, dt = numbers.motion("mdof_peaks.json")
    motion = fdspec.GroundMotion(acceleration, dt, name="reference")
    by_storey, totals = batch.peaks_of_frames([building.frame], motion, certify=True)
    assert totals[0, 0] == given["n_transitions"]
    np.testing.assert_allclose(by_storey[0, 0], given["peak_acceleration_m_s2"], rtol=1e-12)
    np.testing.assert_allclose(by_storey[0, 1], given["peak_displacement_m"], rtol=1e-12)
    assert totals[0, TOTALS.index("energy_error")] < 1e-12


@pytest.mark.parametrize("storeys", [1, 3])
def test_no_neighbour_touches_a_bit(storeys: int) -> None:
    frames = of_all_kinds(storeys) if storeys > 1 else [Case(seed, 1).building.frame for seed in range(12)]
    motion = part_of_motion(300, 380)
    together = batch.peaks_of_frames(frames, motion, certify=True)
    backwards = batch.peaks_of_frames(frames[::-1], motion, certify=True)
    for one, other in zip(together, backwards, strict=True):
        np.testing.assert_array_equal(one, other[::-1])
    for item in (0, 7, len(frames) - 1):
        alone = batch.peaks_of_frames([frames[item]], motion, certify=True)
        for one, other in zip(together, alone, strict=True):
            np.testing.assert_array_equal(one[item], other[0])


def test_the_certificate_touches_no_bit() -> None:
    frames = of_all_kinds(3)
    motion = part_of_motion(300, 380)
    with_it, totals = batch.peaks_of_frames(frames, motion, certify=True)
    without, plain = batch.peaks_of_frames(frames, motion, certify=False)
    np.testing.assert_array_equal(with_it, without)
    others = [row for row, name in enumerate(TOTALS) if name not in ENERGIES]
    np.testing.assert_array_equal(totals[:, others], plain[:, others])


def test_massless_braces_run_one_by_one_among_the_others() -> None:
    light = fdspec.Building([40e3, 40e3], [2e7, 2e7], [0.0, 50.0], [3e7, 3e7], [60e3, 40e3])
    frames = [Case(3, 2).building.frame, light.frame, Case(4, 2).building.frame]
    motion = part_of_motion(300, 400)
    by_storey, totals = batch.peaks_of_frames(frames, motion, certify=True)
    want, total = peaks_of(light.frame, motion, certify=True)
    np.testing.assert_array_equal(by_storey[1][:DEMANDS], want[:DEMANDS])
    assert np.isnan(by_storey[:, DEMANDS:]).all()
    np.testing.assert_array_equal(totals[1], total)
    compare([frames[0], frames[2]], motion)


def test_a_state_that_is_no_number_ends_its_own_history_alone() -> None:
    frames = [Case(3, 2).building.frame, Case(4, 2).building.frame]
    broken = frames[0].properties.copy()
    broken[2] = -1e300
    motion = part_of_motion(300, 360)
    _, totals = batch.peaks_of_frames(
        [frames[0]._replace(properties=broken), frames[1]], motion, certify=True
    )
    assert totals[0, TOTALS.index("status")] != 0.0
    _, alone = batch.peaks_of_frames([frames[1]], motion, certify=True)
    np.testing.assert_array_equal(totals[1], alone[0])
