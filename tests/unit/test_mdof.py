"""The engine for N storeys: its cases one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.single_storey import integrate_single_storey
from fdspec.engines.trajectory import Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.kernels.frame.taylor import LONGEST_PHASE, TERMS, TRUNCATION, order_for
from fdspec.model.building import Building, DampingMatrix, ModalDamping, RayleighDamping
from fdspec.model.motion import GroundMotion
from tests.reference import numbers

GROUND, DT = numbers.motion("mdof_peaks.json")
SHORT = GroundMotion(GROUND[200:601], DT)
WHOLE = GroundMotion(GROUND, DT)


def run(
    building: Building,
    motion: GroundMotion = SHORT,
    *,
    free_steps: int = 0,
    outputs: int = 2,
    dt_out: float | None = None,
    start: np.ndarray | None = None,
    **options: float,
) -> Trajectory:
    total = motion.duration + free_steps * motion.dt
    span = Span(free_steps, total / (outputs - 1) if dt_out is None else dt_out, outputs)
    state = np.zeros((2, 2, building.n_storeys)) if start is None else start
    trajectory = integrate_many_storeys(building, motion, span, state, **options)  # type: ignore[arg-type]
    assert trajectory.status == 0
    assert trajectory.energy_error < 1e-9
    return trajectory


def three_storeys(**changes: object) -> Building:
    given: dict[str, object] = {
        "floor_mass": [40e3, 35e3, 30e3],
        "storey_stiffness": [40e6, 30e6, 20e6],
        "brace_mass": [60.0, 400.0, 2000.0],
        "brace_stiffness": [80e6, 60e6, 30e6],
        "slip_force": [60e3, 40e3, 30e3],
        "damping": ModalDamping(0.03),
        **changes,
    }
    return Building(**given)  # type: ignore[arg-type]


def assert_same(one: Trajectory, other: Trajectory, rtol: float = 1e-10) -> None:
    np.testing.assert_array_equal(one.transition_storey, other.transition_storey)
    np.testing.assert_array_equal(one.transition_phase, other.transition_phase)
    np.testing.assert_allclose(one.transition_time, other.transition_time, rtol=0.0, atol=1e-10)
    for name in (
        "peak_acceleration",
        "peak_displacement",
        "peak_velocity",
        "peak_drift",
        "peak_storey_shear",
    ):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=rtol, err_msg=name)


@pytest.mark.parametrize("which", range(5))
def test_reference_buildings(which: int) -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][which]
    building = Building(
        given["floor_mass_kg"],
        given["storey_stiffness_n_m"],
        given["brace_mass_kg"],
        given["brace_stiffness_n_m"],
        given["slip_force_n"],
        damping=ModalDamping(given["modal_damping_ratio"]),
    )
    trajectory = run(building, WHOLE)
    np.testing.assert_allclose(trajectory.peak_acceleration, given["peak_acceleration_m_s2"], rtol=1e-11)
    np.testing.assert_allclose(trajectory.peak_displacement, given["peak_displacement_m"], rtol=1e-11)
    assert trajectory.transition_time.size == given["n_transitions"]
    final = np.concatenate([trajectory.displacement[-1], trajectory.brace_displacement[-1]])
    scale = max(given["peak_displacement_m"])
    np.testing.assert_allclose(final, given["final_displacement_m"], rtol=0.0, atol=1e-11 * scale)
    np.testing.assert_allclose(trajectory.residual_displacement, trajectory.displacement[-1], rtol=1e-12)
    assert trajectory.energy_error < 1e-12


DAMPED = {"brace_damping": [2e4, 0.0, 5e4]}
KINETIC = {"kinetic_slip_force": [40e3, 40e3, 10e3]}
RAYLEIGH = {"damping": RayleighDamping(0.03, 0.5, 0.1)}
FULL = {
    "damping": DampingMatrix(np.array([[9e4, -2e4, 1e4], [-2e4, 7e4, -3e4], [1e4, -3e4, 4e4]])),
    "storey_stiffness": np.array([[70e6, -30e6, 2e6], [-30e6, 50e6, -20e6], [2e6, -20e6, 20e6]]),
}
MASSLESS = {"brace_mass": [0.0, 400.0, 0.0]}
ONE_BARE = {
    "brace_mass": [60.0, 0.0, 2000.0],
    "brace_stiffness": [80e6, 0.0, 30e6],
    "slip_force": [60e3, 0.0, 30e3],
}
ONE_FREE = {"slip_force": [60e3, 0.0, 30e3]}
KINDS = {
    "plain": {},
    "damped braces": DAMPED,
    "kinetic": KINETIC,
    "rayleigh": RAYLEIGH,
    "full matrices": FULL,
    "massless": MASSLESS,
    "massless, kinetic": {**MASSLESS, **KINETIC},
    "massless, damped, kinetic": {**MASSLESS, **DAMPED, **KINETIC},
    "one without a brace": ONE_BARE,
    "one free": ONE_FREE,
    "one free and massless": {**ONE_FREE, "brace_mass": [60.0, 0.0, 2000.0]},
    "kinetic zero": {"kinetic_slip_force": 0.0},
    "undamped": {"damping": ModalDamping(0.0)},
}


@pytest.mark.parametrize("kind", KINDS)
def test_neither_the_step_nor_the_order_is_in_the_answer(kind: str) -> None:
    building = three_storeys(**KINDS[kind])
    trajectory = run(building)
    assert trajectory.transition_time.size > 20
    for options in ({"radians": 1.25}, {"radians": 0.4}, {"extra_terms": 6}):
        other = run(building, **options)  # type: ignore[arg-type]
        assert_same(trajectory, other)


@pytest.mark.parametrize(
    "kind", ["plain", "damped braces", "kinetic", "massless", "massless, damped, kinetic"]
)
def test_one_storey_is_the_single_storey_engines(kind: str) -> None:
    changes = {name: np.asarray(value)[:1] for name, value in KINDS[kind].items()}
    building = Building(
        **{  # type: ignore[arg-type]
            "floor_mass": 40e3,
            "storey_stiffness": 40e6,
            "brace_mass": 60.0,
            "brace_stiffness": 80e6,
            "slip_force": 60e3,
            **changes,
        }
    )
    many = run(building, outputs=201)
    single = integrate_single_storey(building, SHORT, Span(0, SHORT.duration / 200, 201), np.zeros((2, 2, 1)))
    assert_same(many, single)
    for name in (
        "displacement",
        "velocity",
        "acceleration",
        "brace_displacement",
        "friction_force",
        "storey_shear",
        "slip_travel",
        "storey_friction_energy",
        "input_energy",
        "viscous_energy",
    ):
        one, other = getattr(many, name), getattr(single, name)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9 * np.max(np.abs(other)), err_msg=name)


def test_two_storeys_that_slip_at_one_instant() -> None:
    """Slip forces set to the reactions of the stuck building where both are larger than ever before."""
    locked = run(three_storeys(slip_force=math.inf), outputs=40_001)
    reaction = np.abs(locked.friction_force)
    record = np.maximum.accumulate(reaction, axis=0) <= reaction
    both = np.nonzero(record[:, 0] & record[:, 1] & (reaction[:, 0] > 2e4))[0]
    at = both[0]
    forces = [reaction[at, 0], reaction[at, 1], math.inf]
    trajectory = run(three_storeys(slip_force=forces))
    assert sorted(trajectory.transition_storey[:2]) == [0, 1]
    assert trajectory.transition_time[1] - trajectory.transition_time[0] < 1e-9
    assert trajectory.transition_time[0] == pytest.approx(locked_time(at), abs=1e-9)
    for options in ({"radians": 1.0}, {"extra_terms": 5}):
        other = run(three_storeys(slip_force=forces), **options)  # type: ignore[arg-type]
        np.testing.assert_allclose(trajectory.peak_acceleration, other.peak_acceleration, rtol=1e-10)
        assert trajectory.transition_time.size == other.transition_time.size


def locked_time(index: int) -> float:
    return index * SHORT.duration / 40_000


def test_storeys_that_are_let_go_beyond_their_limits_slip_at_once_together() -> None:
    """Braces stretched alike above and below: equal storeys of one mode, all at t = 0."""
    building = three_storeys(slip_force=10e3)
    u = np.array([0.01, 0.02, 0.03])
    start = np.array([[u, u], [np.zeros(3), np.zeros(3)]])
    trajectory = run(building, GroundMotion([0.0, 0.0], 0.01), free_steps=50, start=start)
    assert trajectory.transition_storey[:3].tolist() == [0, 1, 2]
    assert trajectory.transition_time[:3].tolist() == [0.0, 0.0, 0.0]


def test_floors_that_move_when_the_motion_begins_slip_without_a_transition() -> None:
    building = three_storeys()
    start = np.zeros((2, 2, 3))
    start[1, 0] = [0.5, 0.5, -0.5]
    trajectory = run(building, GroundMotion([0.0, 0.0], 0.001), start=start, outputs=2)
    assert trajectory.phase[0].tolist() == [1, 1, -1]
    assert (trajectory.transition_time > 0.0).all()
    locked = three_storeys(slip_force=[1e3, math.inf, 1e3])
    with pytest.raises(
        InvalidInput, match="equal where the damper never slips, got 0.5 and 0 m/s in storey 2"
    ):
        run(locked, GroundMotion([0.0, 0.0], 0.001), start=start)


def test_ground_at_rest_for_seconds_and_a_record_of_two_samples() -> None:
    silent = run(three_storeys(), GroundMotion(np.zeros(301), 0.01))
    assert silent.transition_time.size == 0
    assert not silent.peak_acceleration.any()
    late = run(three_storeys(), GroundMotion(np.append(np.zeros(300), SHORT.acceleration), SHORT.dt))
    early = run(three_storeys(), GroundMotion(np.append(np.zeros(1), SHORT.acceleration), SHORT.dt))
    np.testing.assert_allclose(late.peak_acceleration, early.peak_acceleration, rtol=1e-10)
    np.testing.assert_allclose(late.transition_time, early.transition_time + 2.99, rtol=0.0, atol=1e-9)
    two = GroundMotion([8.0, -3.0], 0.2)
    trajectory = run(three_storeys(), two, free_steps=20)
    assert trajectory.transition_time.size > 0
    fine = GroundMotion(np.linspace(8.0, -3.0, 41), 0.005)
    assert_same(trajectory, run(three_storeys(), fine, free_steps=800), rtol=1e-9)


def test_free_vibration_is_a_longer_record_of_zeros() -> None:
    longer = GroundMotion(np.append(SHORT.acceleration, np.zeros(200)), SHORT.dt)
    # The last sample falls to zero within one step in the record, and at once before free vibration.
    ends_at_rest = GroundMotion(np.append(SHORT.acceleration, 0.0), SHORT.dt)
    one, other = run(three_storeys(), longer), run(three_storeys(), ends_at_rest, free_steps=199)
    assert_same(one, other)
    np.testing.assert_array_equal(one.residual_displacement, other.residual_displacement)


def test_a_storey_without_a_brace_has_no_phase_and_its_brace_stands_at_its_floor() -> None:
    trajectory = run(three_storeys(**ONE_BARE), outputs=101)
    assert not (trajectory.transition_storey == 1).any()
    assert not trajectory.phase[:, 1].any()
    assert not trajectory.friction_force[:, 1].any()
    assert not trajectory.slip_travel[:, 1].any()
    np.testing.assert_array_equal(trajectory.brace_displacement[:, 1], trajectory.displacement[:, 1])


def test_free_sliding_counts_distance_and_no_transitions() -> None:
    trajectory = run(three_storeys(slip_force=0.0), outputs=20_001)
    assert trajectory.transition_time.size == 0
    assert trajectory.dissipated_energy == 0.0
    sliding = np.abs(np.diff(trajectory.displacement - trajectory.brace_displacement, axis=0)).sum(axis=0)
    np.testing.assert_allclose(trajectory.slip_travel[-1], sliding, rtol=1e-4)
    assert not trajectory.friction_force.any()


def test_peaks_are_those_of_the_course_sampled_finely_and_no_less() -> None:
    trajectory = run(three_storeys(**KINETIC), outputs=400_001)
    below = np.pad(trajectory.displacement, ((0, 0), (1, 0)))[:, :-1]
    for peak, sampled in (
        (trajectory.peak_acceleration, trajectory.acceleration),
        (trajectory.peak_displacement, trajectory.displacement),
        (trajectory.peak_velocity, trajectory.velocity),
        (trajectory.peak_drift, trajectory.displacement - below),
        (trajectory.peak_storey_shear, trajectory.storey_shear),
    ):
        finest = np.abs(sampled).max(axis=0)
        assert (peak >= finest * (1.0 - 1e-12)).all()
        np.testing.assert_allclose(peak, finest, rtol=1e-3)


def test_outputs_satisfy_the_equations_of_motion() -> None:
    """Frame, brace and friction forces balance inertia in every storey at every output instant."""
    building = three_storeys(**DAMPED, **KINETIC)
    trajectory = run(building, outputs=997)
    u, v, d, e = (
        trajectory.displacement,
        trajectory.velocity,
        trajectory.brace_displacement,
        trajectory.brace_velocity,
    )
    below, below_v = (np.pad(x, ((0, 0), (1, 0)))[:, :-1] for x in (u, v))
    brace = building.brace_stiffness * (d - below) + building.brace_damping * (e - below_v)
    above = np.pad(brace, ((0, 0), (0, 1)))[:, 1:]
    force = -u @ building.stiffness_matrix - v @ building.damping_matrix + above - trajectory.friction_force
    np.testing.assert_allclose(
        building.floor_mass * trajectory.acceleration, force, rtol=0.0, atol=1e-9 * np.abs(force).max()
    )
    slipping = trajectory.phase != 0
    assert slipping.any()
    forces = np.broadcast_to(building.kinetic_slip_force, slipping.shape) * trajectory.phase
    np.testing.assert_array_equal(trajectory.friction_force[slipping], forces[slipping])
    stuck = np.abs(trajectory.friction_force) <= building.slip_force * (1.0 + 1e-12)
    assert stuck.all()
    np.testing.assert_allclose(v[~slipping], e[~slipping], rtol=0.0, atol=1e-15)


def test_energies_over_time_balance_and_friction_is_slip_force_times_travel() -> None:
    building = three_storeys()
    trajectory = run(building, outputs=101)
    below = np.pad(trajectory.displacement, ((0, 0), (1, 0)))[:, :-1]
    kinetic = (
        trajectory.velocity**2 @ building.floor_mass + trajectory.brace_velocity**2 @ building.brace_mass
    )
    strain = (
        np.einsum("ti,ij,tj->t", trajectory.displacement, building.stiffness_matrix, trajectory.displacement)
        + (trajectory.brace_displacement - below) ** 2 @ building.brace_stiffness
    )
    stored = 0.5 * (kinetic + strain)
    spent = trajectory.viscous_energy + trajectory.storey_friction_energy.sum(axis=1)
    np.testing.assert_allclose(
        trajectory.input_energy, stored + spent, rtol=0.0, atol=1e-12 * np.abs(trajectory.input_energy).max()
    )
    np.testing.assert_allclose(
        trajectory.storey_friction_energy, trajectory.slip_travel * building.slip_force, rtol=1e-15
    )


def test_orders_leave_out_less_than_rounding() -> None:
    for n in range(6, TERMS):
        assert LONGEST_PHASE[n] ** n / math.factorial(n) == pytest.approx(TRUNCATION, rel=1e-9)
    assert order_for(LONGEST_PHASE[12] * 0.999, 0) == 12
    assert order_for(LONGEST_PHASE[12] * 1.001, 3) == 16
    assert order_for(100.0, 0) == TERMS - 1


def test_upper_floors_begin_to_move_by_terms_of_high_order() -> None:
    """From rest the n-th floor's series begins at x^(2n): its peaks are found all the same, and soon."""
    tower = Building.from_periods([40e3] * 12, 1.2, 0.7, 100e3, 50.0, RayleighDamping(0.03, 1.2, 0.3))
    trajectory = run(tower, GroundMotion([0.0, 1.0, 0.0], 0.002))
    assert (np.diff(trajectory.peak_drift) < 0.0).all()
    assert trajectory.peak_drift[-1] > 0.0


@pytest.mark.parametrize("kinetic", [50e3, 30e3])
@pytest.mark.parametrize("velocity", [0.2, 0.0, -0.2])
def test_a_massless_brace_released_too_far_springs_back(kinetic: float, velocity: float) -> None:
    """Then it slips on with the floor, or the floor, moving back already, takes it along at once."""
    building = Building(20e3, 9e6, 0.0, 25e6, 50e3, kinetic, damping=ModalDamping(0.03))
    start = np.zeros((2, 2, 1))
    start[0] = 0.01
    start[1] = velocity
    still = GroundMotion(np.zeros(101), DT)
    many = run(building, still, start=start, outputs=201)
    single = integrate_single_storey(building, still, Span(0, still.duration / 200, 201), start)
    assert single.energy_error < 1e-12
    assert_same(many, single)
    begun = many.transition_phase[many.transition_time == 0.0]
    assert begun.tolist() == ([1] if velocity > 0.0 else [1, 0])
    assert many.brace_displacement[0, 0] == pytest.approx(kinetic / 25e6, rel=1e-12)


@pytest.mark.parametrize("velocity", [(0.2, -0.1), (-0.2, 0.1), (0.0, 0.0)])
def test_two_massless_braces_released_beyond_their_slip_forces(velocity: tuple[float, float]) -> None:
    building = Building(
        [20e3, 18e3], [9e6, 7e6], [0.0, 0.0], [25e6, 20e6], [50e3, 30e3], damping=ModalDamping(0.03)
    )
    start = np.zeros((2, 2, 2))
    start[0] = 0.01, 0.018
    start[1] = velocity
    trajectory = run(building, GroundMotion(np.zeros(201), DT), start=start)
    assert trajectory.energy_error < 1e-12
    assert 4 <= trajectory.transition_time.size <= 40
