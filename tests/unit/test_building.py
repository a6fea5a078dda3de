"""Building and its damping: what is made of arguments, and what each refusal says."""

from __future__ import annotations

import dataclasses
import math
import pickle

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.building import Building, DampingMatrix, Linkage, ModalDamping, RayleighDamping
from tests.reference import numbers

TWO = {
    "floor_mass": [30e3, 20e3],
    "storey_stiffness": [40e6, 30e6],
    "brace_mass": 50.0,
    "brace_stiffness": 80e6,
    "slip_force": [100e3, 50e3],
}


def two(**changes: object) -> Building:
    return Building(**{**TWO, **changes})  # type: ignore[arg-type]


def test_numbers_become_arrays_of_every_storey() -> None:
    building = two()
    assert building.n_storeys == 2
    np.testing.assert_array_equal(building.brace_mass, [50.0, 50.0])
    np.testing.assert_array_equal(building.kinetic_slip_force, building.slip_force)
    np.testing.assert_array_equal(building.brace_damping, [0.0, 0.0])
    np.testing.assert_array_equal(building.stiffness_matrix, [[70e6, -30e6], [-30e6, 30e6]])
    assert building.damping == ModalDamping(0.05)


def test_arrays_are_copied_and_read_only() -> None:
    mass = np.array([30e3, 20e3])
    building = two(floor_mass=mass)
    mass[0] = 1.0
    assert building.floor_mass[0] == 30e3
    for array in (
        building.floor_mass,
        building.brace_mass,
        building.stiffness_matrix,
        building.damping_matrix,
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_equality_hash_repr_and_the_way_to_another_process() -> None:
    building = two()
    assert building == two()
    assert hash(building) == hash(two())
    assert building != two(slip_force=1e3)
    assert building != two(damping=ModalDamping(0.02))
    assert building != "building"
    travelled = pickle.loads(pickle.dumps(building))
    assert travelled == building
    assert not travelled.floor_mass.flags.writeable
    assert repr(building) == (
        "<Building: 2 storeys, first period 0.2517 s bare and 0.1419 s braced, slip force 50000 to 100000 N>"
    )
    stiffer = dataclasses.replace(building, storey_stiffness=[50e6, 30e6])
    assert stiffer.stiffness_matrix[0, 0] == 80e6


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"floor_mass": [1.0, 0.0]}, "floor_mass must be positive and finite, in kg, not 0.0 in storey 2"),
        ({"floor_mass": [1.0, math.nan]}, "floor_mass must be positive .* not nan in storey 2"),
        (
            {"floor_mass": [1.0, 2.0, 3.0]},
            "slip_force has 2 values, but the building has 3 storeys: give 1 or 3",
        ),
        ({"floor_mass": "heavy"}, "floor_mass must be a number or one number a storey, not 'heavy'"),
        (
            {"floor_mass": [[1.0, 2.0]]},
            r"floor_mass must be a number or have shape \(N,\), not shape \(1, 2\)",
        ),
        ({"storey_stiffness": -1.0}, "storey_stiffness must be positive and finite, in N/m, not -1.0"),
        ({"brace_mass": -1.0}, "brace_mass must be 0 or more and finite, in kg, not -1.0 in storey 1"),
        ({"brace_stiffness": math.inf}, "brace_stiffness must be 0 or more and finite, in N/m, not inf"),
        ({"brace_damping": -2.0}, "brace_damping must be 0 or more and finite, in N s/m, not -2.0"),
        (
            {"slip_force": [1.0, -1.0]},
            r"slip_force must be 0 or more, in N \(inf never slips\), not -1.0 in storey 2",
        ),
        ({"slip_force": math.nan}, "slip_force must be 0 or more, .* not nan"),
        (
            {"kinetic_slip_force": 60e3},
            "kinetic_slip_force must be at most slip_force, but storey 2 has 60000 over 50000 N",
        ),
        (
            {"brace_stiffness": [80e6, 0.0]},
            r"brace_mass must be 0 where there is no brace .* not 50.0 in storey 2",
        ),
        ({"brace_stiffness": 0.0, "brace_mass": 0.0}, "slip_force must be 0 where there is no brace"),
        ({"damping": 0.05}, "damping must be ModalDamping, RayleighDamping or DampingMatrix, not 0.05"),
        (
            {"damping": ModalDamping([0.02, 0.03, 0.04])},
            "ModalDamping has 3 ratios, but the frame has 2 modes",
        ),
        (
            {"damping": DampingMatrix([[1.0]])},
            r"damping matrix has shape \(1, 1\), but the frame has 2 storeys",
        ),
        (
            {"storey_stiffness": [[1.0, 2.0], [2.0, 1.0]]},
            "stiffness must be positive definite, .* eigenvalue is -1 N/m",
        ),
        (
            {"storey_stiffness": [[2.0, 1.0], [0.0, 2.0]]},
            r"stiffness must be symmetric, .* \[0, 1\] and \[1, 0\] are 1 and 0",
        ),
        ({"storey_stiffness": [[2.0, 1.0]]}, "stiffness must be a square matrix"),
        (
            {"storey_stiffness": [[2.0, math.nan], [math.nan, 2.0]]},
            r"stiffness must be finite, but its entry \[0, 1\]",
        ),
    ],
)
def test_refusals(changes: dict[str, object], text: str) -> None:
    with pytest.raises(InvalidInput, match=text):
        two(**changes)


def test_no_friction_and_no_slip_are_fair() -> None:
    assert two(slip_force=0.0).slip_force.tolist() == [0.0, 0.0]
    assert two(slip_force=math.inf).kinetic_slip_force.tolist() == [math.inf, math.inf]


def test_a_storey_without_a_brace() -> None:
    building = two(brace_mass=[50.0, 0.0], brace_stiffness=[80e6, 0.0], slip_force=[1e5, 0.0])
    assert building.braced_periods[0] < building.bare_periods[0]


def test_single_storey_is_the_studys_frame() -> None:
    frame = Building.single_storey(
        period=0.5, stiffness_ratio=4, slip_force=100e3, kinetic_slip_force=80e3, brace_damping_ratio=0.1
    )
    stiffness = 20e3 * (2.0 * math.pi / 0.5) ** 2
    storey = frame.storey
    assert storey.floor_mass == 20e3
    assert storey.floor_stiffness == pytest.approx(stiffness, rel=1e-15)
    assert storey.floor_damping == pytest.approx(2.0 * 0.05 * math.sqrt(stiffness * 20e3), rel=1e-15)
    assert storey.brace_stiffness == pytest.approx(4.0 * stiffness, rel=1e-15)
    assert storey.brace_damping == pytest.approx(0.2 * math.sqrt(4.0 * stiffness * 50.0), rel=1e-15)
    assert (storey.brace_mass, storey.slip_force, storey.kinetic_slip_force) == (50.0, 100e3, 80e3)
    assert frame.bare_periods[0] == pytest.approx(0.5, rel=1e-14)
    with pytest.raises(InvalidInput, match="storey is for buildings of one storey, and this one has 2"):
        _ = two().storey


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"period": 0.0}, "period must be positive, in s, not 0.0"),
        ({"period": "short"}, "period must be a number, not 'short'"),
        ({"period": math.inf}, "period must be finite, not inf"),
        ({"stiffness_ratio": -1.0}, "stiffness_ratio must be 0 or more, not -1.0"),
        ({"damping_ratio": -0.1}, "ratio must be 0 or more"),
        ({"damping_ratio": True}, "ratio must be a number"),
        (
            {"damping_ratio": 5},
            r"damping_ratio must be below 1 \(0.05 is five per cent of critical\), not 5.0; ",
        ),
        ({"brace_damping_ratio": 1.0}, "brace_damping_ratio must be below 1"),
    ],
)
def test_single_storey_refusals(changes: dict[str, float], text: str) -> None:
    given: dict[str, float] = {"period": 0.5, "stiffness_ratio": 4.0, "slip_force": 1e5, **changes}
    with pytest.raises(InvalidInput, match=text):
        Building.single_storey(**given)


def test_from_periods_makes_the_four_storey_frame_of_the_reference() -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][0]
    frame = Building.from_periods([41610.0] * 3 + [40820.0], 1.006, 0.612, 50e3, brace_mass=23.0)
    np.testing.assert_allclose(frame.storey_stiffness, given["storey_stiffness_n_m"], rtol=1e-12)
    np.testing.assert_allclose(frame.brace_stiffness, given["brace_stiffness_n_m"], rtol=1e-12)
    assert frame.bare_periods[0] == pytest.approx(1.006, rel=1e-13)
    assert frame.braced_periods[0] == pytest.approx(0.612, rel=1e-13)


def test_from_periods_refuses_a_brace_that_softens() -> None:
    with pytest.raises(
        InvalidInput, match="braced_period must be short enough .* 1.2 s beside a bare period of 1.0 s"
    ):
        Building.from_periods([1e4, 1e4], 1.0, 1.2, 1e3)


def test_from_matrices() -> None:
    stiffness = np.array([[4.0, -1.0, 0.5], [-1.0, 3.0, -1.0], [0.5, -1.0, 2.0]]) * 1e7
    damping = 1e-3 * stiffness
    building = Building.from_matrices(
        [3e4, 2e4, 1e4], stiffness, damping, brace_stiffness=5e7, slip_force=1e5, brace_mass=40.0
    )
    np.testing.assert_array_equal(building.stiffness_matrix, stiffness)
    np.testing.assert_array_equal(building.damping_matrix, damping)
    np.testing.assert_array_equal(building.frame.dense_stiffness, stiffness)
    assert Building.from_matrices(
        1e4, stiffness, ModalDamping(0.03), brace_stiffness=5e7, slip_force=0.0
    ).damping == ModalDamping(0.03)
    with pytest.raises(InvalidInput, match=r"stiffness must be a matrix of shape \(N, N\)"):
        Building.from_matrices([1.0], [1.0], [[0.0]], brace_stiffness=0.0, slip_force=0.0)


def test_modal_damping_gives_each_mode_its_ratio() -> None:
    ratios = (0.02, 0.07)
    building = two(damping=ModalDamping(ratios))
    mass = building.floor_mass
    squares, shapes = np.linalg.eigh(building.stiffness_matrix / np.sqrt(np.outer(mass, mass)))
    modal = shapes.T @ (building.damping_matrix / np.sqrt(np.outer(mass, mass))) @ shapes
    np.testing.assert_allclose(np.diag(modal), 2.0 * np.array(ratios) * np.sqrt(squares), rtol=1e-12)
    assert abs(modal[0, 1]) < 1e-12 * modal[0, 0]


def test_rayleigh_damping_gives_its_ratio_at_both_periods() -> None:
    damping = RayleighDamping(0.03, 1.0, 0.2)
    alpha, beta = damping.coefficients
    for period in (1.0, 0.2):
        omega = 2.0 * math.pi / period
        assert 0.5 * (alpha / omega + beta * omega) == pytest.approx(0.03, rel=1e-14)
    building = two(damping=damping)
    np.testing.assert_allclose(
        building.damping_matrix,
        alpha * np.diag(building.floor_mass) + beta * building.stiffness_matrix,
        rtol=1e-15,
    )


@pytest.mark.parametrize(
    ("periods", "text"),
    [
        ((1.0, 1.0), r"period_1 and period_2 must differ \(both are 1 s\)"),
        ((0.0, 1.0), "period_1 must be positive and finite, in s, not 0.0"),
        ((1.0, "x"), "period_2 must be a number of seconds, not 'x'"),
    ],
)
def test_rayleigh_refusals(periods: tuple[float, float], text: str) -> None:
    with pytest.raises(InvalidInput, match=text):
        RayleighDamping(0.05, *periods)


def test_damping_matrix() -> None:
    given = [[2.0, -1.0], [-1.0, 3.0]]
    assert DampingMatrix(given) == DampingMatrix(np.array(given))
    assert hash(DampingMatrix(given)) == hash(DampingMatrix(given))
    assert DampingMatrix(given) != DampingMatrix(np.eye(2))
    with pytest.raises(
        InvalidInput, match="must not feed energy into the frame, but its lowest eigenvalue is -1 N s/m"
    ):
        DampingMatrix([[1.0, 2.0], [2.0, 1.0]])
    with pytest.raises(InvalidInput, match="damping matrix must be a square matrix"):
        DampingMatrix([[1.0], [1.0, 2.0]])  # type: ignore[list-item]


@pytest.mark.parametrize("size", [1, 2, 5])
def test_a_banded_matrix_is_springs_and_the_springs_are_it(size: int) -> None:
    rng = np.random.default_rng(size)
    matrix = np.diag(rng.uniform(5.0, 9.0, size))
    side = np.diag(rng.uniform(-2.0, 0.0, size - 1), 1) if size > 1 else 0.0
    matrix = matrix + side + np.transpose(side)
    storey, ground, dense = Linkage.of(matrix)
    assert dense.size == 0
    above = np.append(storey[1:], 0.0)
    again = np.diag(storey + above + ground) - np.diag(storey[1:], 1) - np.diag(storey[1:], -1)
    np.testing.assert_allclose(again, matrix, rtol=1e-15, atol=1e-15)


def test_a_full_matrix_stays_whole() -> None:
    matrix = np.full((3, 3), 1.0) + np.eye(3)
    storey, ground, dense = Linkage.of(matrix)
    assert not storey.any()
    assert not ground.any()
    np.testing.assert_array_equal(dense, matrix)


def test_a_ratio_of_per_cent_is_refused_unless_asked_for() -> None:
    for make in (
        lambda: ModalDamping(5),
        lambda: ModalDamping([0.05, 2.0]),
        lambda: RayleighDamping(5, 1.0, 0.2),
    ):
        with pytest.raises(InvalidInput, match=r"must be below 1 .*where it is meant, say overdamped=True"):
            make()
    assert ModalDamping(1.5, overdamped=True).ratio == 1.5
    assert ModalDamping([0.05, 2.0], overdamped=True).ratio == (0.05, 2.0)
    assert RayleighDamping(1.5, 1.0, 0.2, overdamped=True).ratio == 1.5
    frame = Building.single_storey(0.5, 4.0, 1e5, damping_ratio=1.5, brace_damping_ratio=2.0, overdamped=True)
    assert frame.damping == ModalDamping(1.5, overdamped=True)
