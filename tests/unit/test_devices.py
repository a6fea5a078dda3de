"""Buildings with devices: what they refuse, what a history says, and each device's corner cases."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec import Building, Link, ModalDamping, TensionBrace
from fdspec.engines.devices import integrate_devices, run
from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.trajectory import Span
from fdspec.errors import IntegrationError, InvalidInput
from fdspec.kernels.devices import layout as row
from fdspec.kernels.types import COLLAPSED
from tests.reference import numbers

GROUND, DT = numbers.motion("mdof_peaks.json")
SHORT = fdspec.GroundMotion(GROUND[200:601] * 1.5, DT, name="short")


def two_storeys(**changes: Any) -> Building:
    given: dict[str, Any] = {
        "floor_mass": [40e3, 30e3],
        "storey_stiffness": [40e6, 25e6],
        "brace_mass": [60.0, 0.0],
        "brace_stiffness": [80e6, 50e6],
        "slip_force": [60e3, 40e3],
        "damping": ModalDamping(0.03),
        **changes,
    }
    return Building(**given)


def one_storey(**changes: Any) -> Building:
    given: dict[str, Any] = {"period": 0.4, "stiffness_ratio": 4.0, "slip_force": 40e3, **changes}
    return Building.single_storey(**given)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"storey_height": -3.0}, "storey_height must be positive and finite, in m, not -3.0"),
        ({"yield_shear": [1e5, 0.0]}, "yield_shear must be positive.* not 0.0 in storey 2"),
        ({"yield_shear": 1e5, "hardening_ratio": 1.0}, "hardening_ratio must be less than 1"),
        ({"hardening_ratio": math.nan}, "hardening_ratio must be less than 1"),
        ({"gravity_load": 1e5}, "storey_height must be given, in m, where gravity_load is"),
        ({"gravity_load": -1.0, "storey_height": 3.0}, "gravity_load must be 0 or more"),
        (
            {"gravity_load": [1e5, 80e6], "storey_height": 3.0},
            r"beyond elastic stability.*2\.66667e\+07 N/m against 2\.5e\+07 N/m \(storey 2\)",
        ),
        ({"slot_length": 0.02}, "slot_stiffness must be positive, in N/m, where slot_length is given"),
        ({"slot_length": 0.0, "slot_stiffness": 1e8}, "slot_length must be positive"),
        ({"slot_length": 0.02, "slot_stiffness": -1e8}, "slot_stiffness must be 0 or more"),
        ({"recentring_stiffness": math.inf}, "recentring_stiffness must be 0 or more and finite"),
        ({"collapse_drift": 0.0}, "collapse_drift must be positive"),
        ({"yield_shear": [1e5, 1e5, 1e5]}, "yield_shear has 3 values, but the building has 2|has 2 values"),
        ({"links": [Link(3, 0, 1e6, 1e3)]}, "link 1 joins floor 3, but the building has 2 storeys"),
        ({"links": ["damper"]}, "links must be Link or TensionBrace, but number 1 is 'damper'"),
        ({"links": 3}, "links must be a sequence of Link or TensionBrace"),
        (
            {"links": [Link(2, 0, 1e6, 1e3, name="a"), Link(1, 0, 1e6, 1e3, name="a")]},
            "different names, but a comes twice",
        ),
    ],
)
def test_what_a_building_refuses(changes: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidInput, match=text) as caught:
        two_storeys(**changes)
    assert "\n" not in str(caught.value)


def test_a_slot_needs_a_brace() -> None:
    with pytest.raises(InvalidInput, match="slot_length needs a brace"):
        Building(1e4, 1e6, 0.0, 0.0, 0.0, slot_length=0.01, slot_stiffness=1e6)


def test_a_matrix_does_not_yield() -> None:
    with pytest.raises(InvalidInput, match="yield_shear needs storey_stiffness"):
        Building.from_matrices(
            [1e4, 1e4],
            [[2e6, -1e6], [-1e6, 1e6]],
            ModalDamping(),
            brace_stiffness=0.0,
            slip_force=0.0,
            yield_shear=1e4,
        )


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: Link(1, 1, 1e6, 1e3), "upper and lower must be two floors, not both 1"),
        (lambda: Link(0, 1, 1e6, 1e3), "upper must be a floor"),
        (lambda: Link(-1, 0, 1e6, 1e3), "upper must be a floor counted from 1, or 0"),
        (lambda: Link(1.5, 0, 1e6, 1e3), "upper must be a floor counted from 1, or 0"),  # type: ignore[arg-type]
        (lambda: Link(1, 0, 0.0, 1e3), "stiffness must be positive"),
        (lambda: Link(1, 0, 1e6, -1.0), "slip_force must be 0 or more"),
        (lambda: Link(1, 0, 1e6, 1e3, kinetic_slip_force=2e3), "kinetic_slip_force must be at most"),
        (lambda: Link(1, 0, 1e6, 1e3, slot_length=0.01), "slot_stiffness must be positive"),
        (lambda: Link(1, 0, 1e6, 1e3, mass=-1.0), "mass must be 0 or more"),
        (lambda: Link(1, 0, 1e6, 1e3, mass=5.0, recentring_preload=1.0), "links without mass"),
        (lambda: Link(1, 0, 1e6, 1e3, friction_stiffness=1.0), "at most recentring_stiffness"),
        (lambda: Link(1, 0, 1e6, 1e3, name=""), "name must be a text"),
        (lambda: TensionBrace(1, 0, 1e6, 0.0), "yield_force must be positive"),
        (lambda: TensionBrace(1, 0, 1e6, direction=0), "direction must be 1 or -1"),
        (lambda: TensionBrace(1, 0, 1e6, slack=-1.0), "slack must be 0 or more"),
    ],
)
def test_what_a_link_refuses(call: Any, text: str) -> None:
    with pytest.raises(InvalidInput, match=text):
        call()


def test_devices_at_infinity_leave_every_bit() -> None:
    plain = two_storeys()
    without = two_storeys(
        yield_shear=math.inf,
        hardening_ratio=0.05,
        gravity_load=0.0,
        storey_height=3.0,
        slot_length=math.inf,
        slot_stiffness=1e9,
        recentring_stiffness=0.0,
    )
    assert not without.has_devices
    one, other = fdspec.simulate(plain, SHORT), fdspec.simulate(without, SHORT)
    for name, variable in one.variables.items():
        if variable.dtype.kind == "f":
            np.testing.assert_array_equal(variable.values, other[name].values, err_msg=str(name))


@pytest.mark.parametrize("which", range(5))
def test_without_devices_it_is_the_engine_of_frames(which: int) -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][which]
    building = Building(
        given["floor_mass_kg"],
        given["storey_stiffness_n_m"],
        given["brace_mass_kg"],
        given["brace_stiffness_n_m"],
        given["slip_force_n"],
        damping=ModalDamping(given["modal_damping_ratio"]),
    )
    start = np.zeros((2, 2, building.n_storeys))
    span = Span(50, 4 * DT, 101)
    one = integrate_devices(building, SHORT, span, start)
    other = integrate_many_storeys(building, SHORT, span, start)
    np.testing.assert_array_equal(one.transition_storey, other.transition_storey)
    np.testing.assert_array_equal(one.transition_phase, other.transition_phase)
    np.testing.assert_allclose(one.transition_time, other.transition_time, rtol=0.0, atol=1e-10)
    for name in ("peak_acceleration", "peak_velocity", "peak_drift", "peak_storey_shear"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-10, err_msg=name)
    for name in ("displacement", "brace_velocity", "friction_force", "slip_travel", "storey_friction_energy"):
        scale = np.abs(getattr(other, name)).max()
        np.testing.assert_allclose(
            getattr(one, name), getattr(other, name), rtol=0.0, atol=1e-9 * scale, err_msg=name
        )
    np.testing.assert_allclose(one.input_energy, other.input_energy, rtol=1e-9, atol=1e-6)


def everything() -> Building:
    return two_storeys(
        storey_height=[3.5, 3.0],
        yield_shear=[200e3, 90e3],
        hardening_ratio=0.03,
        gravity_load=[700e3, 300e3],
        slot_length=0.006,
        slot_stiffness=60e6,
        recentring_stiffness=[2e6, 1e6],
        links=[
            Link(2, 0, 20e6, 40e3, mass=80.0, kinetic_slip_force=30e3, name="long"),
            Link(1, 0, 30e6, 20e3, recentring_stiffness=3e6, recentring_preload=25e3, name="flag"),
            TensionBrace(1, 0, 15e6, 60e3, slack=0.001),
        ],
    )


@pytest.fixture(scope="module")
def history() -> xr.Dataset:
    return fdspec.simulate(everything(), SHORT, dt_out=0.003, free_vibration=1.0)


def test_energy_closes_at_every_output(history: xr.Dataset) -> None:
    gained = history["input_energy"] + history["gravity_energy"]
    spent = sum(
        history[name]
        for name in (
            "kinetic_energy",
            "strain_energy",
            "bearing_energy",
            "viscous_energy",
            "friction_energy",
            "yielding_energy",
            "links_energy",
        )
    )
    assert float(abs(gained - spent).max()) < 1e-9 * float(history["input_energy"].max())
    assert float(history["energy_error"]) < 1e-12
    for name in ("bearing_energy", "gravity_energy", "yielding_energy", "links_energy"):
        assert float(history[name].max()) > 0.0, name


def test_what_a_history_says_of_devices(history: xr.Dataset) -> None:
    assert history["link"].values.tolist() == ["long", "flag", "link 3"]
    assert (history["column_events"] > 0).all()
    assert (history["slot_events"] > 0).any()
    assert (history["link_events"] > 0).all()
    yield_drift = np.array([200e3 / 40e6, 90e3 / 25e6])
    np.testing.assert_allclose(history["ductility"], history["peak_drift"] / yield_drift)
    np.testing.assert_allclose(history["peak_drift_ratio"], history["peak_drift"] / [3.5, 3.0])
    np.testing.assert_allclose(history["plastic_drift"], history["plastic_deformation"][-1])
    np.testing.assert_allclose(history["column_energy"].sum(), history["yielding_energy"][-1])
    np.testing.assert_allclose(
        history["dissipated_energy"], history["friction_energy"][-1] + history["links_energy"][-1]
    )
    for over_time, peak in (
        ("column_shear", "peak_column_shear"),
        ("link_slip", "peak_link_slip"),
        ("link_force", "peak_link_force"),
    ):
        sampled = np.abs(history[over_time]).max("time").values
        if over_time == "link_slip":
            sampled[2] -= 0.001  # a tension brace starts with its slack
        assert (sampled <= history[peak].values * (1.0 + 1e-12)).all(), over_time
        assert (sampled >= 0.9 * history[peak].values).all(), over_time
    slip = (history["displacement"] - history["brace_displacement"]).values
    assert (np.abs(slip).max(axis=0) <= history["peak_slip"].values * (1.0 + 1e-9)).all()


def test_a_history_with_devices_survives_a_file(history: xr.Dataset, tmp_path: Any) -> None:
    fdspec.save(history, tmp_path / "history.nc")
    xr.testing.assert_identical(fdspec.open(tmp_path / "history.nc"), history)


def test_the_columns_law_holds_at_every_output(history: xr.Dataset) -> None:
    k, alpha = np.array([40e6, 25e6]), 0.03
    drift, plastic = history["drift"].values, history["plastic_deformation"].values
    expected = alpha * k * drift + (1.0 - alpha) * k * (drift - plastic)
    np.testing.assert_allclose(history["column_shear"].values, expected, rtol=1e-9, atol=1e-6)
    limit = (1.0 - alpha) * np.array([200e3, 90e3])
    assert (np.abs((1.0 - alpha) * k * (drift - plastic)) <= limit * (1.0 + 1e-12)).all()


def test_the_order_of_links_plays_no_part() -> None:
    """Several stuck plates at one floor decide together, whichever comes first."""
    links = [
        Link(1, 0, 30e6, 20e3, mass=50.0),
        Link(1, 0, 10e6, 20e3, mass=400.0),
        Link(1, 2, 40e6, 30e3, mass=100.0, kinetic_slip_force=20e3),
    ]
    peaks, counts = [], []
    for order in itertools.permutations(range(3)):
        building = two_storeys(links=[links[i] for i in order])
        trajectory = integrate_devices(building, SHORT, Span(0, 1.0, 1), np.zeros((2, 2, 2)))
        peaks.append(trajectory.peak_acceleration)
        counts.append([int(trajectory.devices.link_events[order.index(i)]) for i in range(3)])
        assert trajectory.energy_error < 1e-12
    np.testing.assert_allclose(peaks, [peaks[0]] * 6, rtol=1e-9)
    assert counts == [counts[0]] * 6
    assert min(counts[0]) > 10


def test_two_equal_plates_are_one_twice_as_heavy() -> None:
    """Equal links at one floor slip and stick at the same instants, as one link of both together."""
    halves = [Link(1, 0, 20e6, 25e3, mass=40.0, kinetic_slip_force=20e3) for _ in range(2)]
    whole = Link(1, 0, 40e6, 50e3, mass=80.0, kinetic_slip_force=40e3)
    frame: dict[str, Any] = {"floor_mass": 30e3, "storey_stiffness": 10e6, "brace_mass": 0.0}
    frame |= {"brace_stiffness": 0.0, "slip_force": 0.0}
    two = fdspec.simulate(Building(**frame, links=halves), SHORT)
    one = fdspec.simulate(Building(**frame, links=[whole]), SHORT)
    assert two["link_events"].values.tolist() == [int(one["link_events"][0])] * 2
    np.testing.assert_allclose(two["peak_acceleration"], one["peak_acceleration"], rtol=1e-10)


def test_a_link_is_the_storeys_damper() -> None:
    """The same damper given as the storey's and as a link."""
    frame: dict[str, Any] = {
        "floor_mass": [30e3, 20e3],
        "storey_stiffness": 20e6,
        "damping": ModalDamping(0.02),
    }
    slot: dict[str, Any] = {"slot_length": 0.005, "slot_stiffness": 50e6}
    own = Building(
        **frame,
        brace_mass=[40.0, 0.0],
        brace_stiffness=[60e6, 0.0],
        slip_force=[50e3, 0.0],
        slot_length=[0.005, math.inf],
        slot_stiffness=50e6,
    )
    linked = Building(
        **frame,
        brace_mass=0.0,
        brace_stiffness=0.0,
        slip_force=0.0,
        links=[Link(1, 0, 60e6, 50e3, mass=40.0, **slot)],
    )
    one, other = fdspec.simulate(own, SHORT), fdspec.simulate(linked, SHORT)
    assert int(one["transitions"]) == int(other["link_events"][0]) > 10
    assert int(one["slot_events"][0]) == int(other["link_contacts"][0]) > 0
    np.testing.assert_allclose(one["displacement"], other["displacement"], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(one["peak_slip"][0], other["peak_link_slip"][0], rtol=1e-12)


def test_two_frames_joined_by_dampers() -> None:
    """Joined without friction they are two buildings; joined for good they are one."""
    k1, k2 = 20e6, 5e6
    matrix = np.diag([k1, k2])
    frame: dict[str, Any] = {"brace_stiffness": 0.0, "slip_force": 0.0}
    damping = np.diag([8e4, 3e4])
    apart = Building.from_matrices([30e3, 20e3], matrix, damping, **frame, links=[Link(1, 2, 1e3, 0.0)])
    joined = Building.from_matrices(
        [30e3, 20e3], matrix, damping, **frame, links=[Link(1, 2, 30e6, math.inf)]
    )
    damped = Building.from_matrices([30e3, 20e3], matrix, damping, **frame, links=[Link(1, 2, 30e6, 20e3)])
    for i, (mass, k, c) in enumerate(((30e3, k1, 8e4), (20e3, k2, 3e4))):
        alone = Building.from_matrices([mass], [[k]], [[c]], **frame)
        np.testing.assert_allclose(
            fdspec.simulate(apart, SHORT)["peak_displacement"][i],
            fdspec.simulate(alone, SHORT)["peak_displacement"][0],
            rtol=1e-10,
        )
    stiff = np.array([[30e6 + k1, -30e6], [-30e6, 30e6 + k2]])
    whole = Building.from_matrices([30e3, 20e3], stiff, damping, **frame)
    np.testing.assert_allclose(
        fdspec.simulate(joined, SHORT)["peak_acceleration"],
        fdspec.simulate(whole, SHORT)["peak_acceleration"],
        rtol=1e-10,
    )
    assert int(fdspec.simulate(damped, SHORT)["link_events"][0]) > 10


def test_mirrored_ground_mirrors_the_answer() -> None:
    building = two_storeys(
        storey_height=3.0,
        yield_shear=[200e3, 90e3],
        gravity_load=300e3,
        slot_length=0.004,
        slot_stiffness=60e6,
    )
    one, other = fdspec.simulate(building, SHORT), fdspec.simulate(building, SHORT.scaled(-1.0))
    np.testing.assert_array_equal(one["plastic_drift"], -other["plastic_drift"])
    np.testing.assert_array_equal(one["peak_acceleration"], other["peak_acceleration"])


def test_friction_pendulum_is_a_bilinear_layer() -> None:
    """A massless slider with a re-centring spring: as columns that yield beside a spring."""
    weight, radius, mu, mass, first = 4e5, 2.0, 0.06, 4e5 / 9.80665, 4e7
    across = weight / radius
    pendulum = Building(
        mass,
        1e-3,
        0.0,
        0.0,
        0.0,
        damping=ModalDamping(0.0),
        links=[Link(1, 0, first, mu * weight, recentring_stiffness=across)],
    )
    # In series with the spring `first`, the line of slope `across` has slope a; it starts at mu W.
    slope = first * across / (first + across)
    share = slope / first
    layer = Building(
        mass,
        first + 1e-3,
        0.0,
        0.0,
        0.0,
        damping=ModalDamping(0.0),
        yield_shear=mu * weight,
        hardening_ratio=share,
    )
    one, other = fdspec.simulate(pendulum, SHORT), fdspec.simulate(layer, SHORT)
    np.testing.assert_allclose(one["displacement"], other["displacement"], rtol=0.0, atol=1e-9)
    assert int(one["link_events"][0]) == int(other["column_events"][0]) > 10


def test_collapse_has_a_status_and_says_where() -> None:
    building = two_storeys(
        brace_stiffness=0.0,
        brace_mass=0.0,
        slip_force=0.0,
        storey_height=3.0,
        yield_shear=[60e3, 50e3],
        hardening_ratio=-0.05,
        gravity_load=[6e6, 2e6],
    )
    strong = SHORT.scaled(2.0)
    with pytest.raises(
        IntegrationError, match=r"status collapsed: the drift of storey 1 reached its limit of 0.3 m"
    ):
        fdspec.simulate(building, strong)
    start = np.zeros((2, 2, 2))
    outcome = run(building.device_frame, strong, Span(0, DT, 1), start)
    assert outcome.totals["status"] == COLLAPSED
    assert outcome.peaks[3, 0] == pytest.approx(0.3, rel=1e-12)
    assert np.abs(outcome.floors[0, 1]) == pytest.approx(0.3, rel=1e-12)
    assert outcome.totals["energy_error"] < 1e-9


def test_the_limit_of_collapse_is_the_users() -> None:
    falling: dict[str, Any] = {
        "brace_stiffness": 0.0,
        "brace_mass": 0.0,
        "slip_force": 0.0,
        "storey_height": 3.0,
        "yield_shear": [60e3, 50e3],
        "gravity_load": [6e6, 2e6],
    }
    times = []
    for limit in (0.05, 0.2):
        frame = two_storeys(**falling, collapse_drift=limit).device_frame
        outcome = run(frame, SHORT.scaled(2.0), Span(400, DT, 1), np.zeros((2, 2, 2)))
        assert outcome.totals["status"] == COLLAPSED
        times.append(outcome.totals["collapse_time"])
    assert times[0] < times[1]
    never = two_storeys(**falling, collapse_drift=math.inf).device_frame
    outcome = run(never, SHORT.scaled(2.0), Span(400, DT, 1), np.zeros((2, 2, 2)))
    assert outcome.totals["status"] == 0


def test_softening_columns_of_unknown_height_end_too() -> None:
    frame = Building(30e3, 20e6, 0.0, 0.0, 0.0, yield_shear=50e3, hardening_ratio=-0.3)
    limit = 10.0 * 50e3 / 20e6 * (1.0 + 1.0 / 0.3)
    assert frame.device_frame.drift_limit[0] == pytest.approx(limit)
    with pytest.raises(IntegrationError, match="collapsed"):
        fdspec.simulate(frame, SHORT, free_vibration=20.0)


def test_other_methods_refuse_devices() -> None:
    with pytest.raises(InvalidInput, match="method 'newmark' knows frames, braces and friction alone"):
        fdspec.simulate(one_storey(yield_shear=5e4), SHORT, method="newmark")


def test_the_factory_takes_devices() -> None:
    frame = one_storey(yield_shear=30e3, hardening_ratio=0.02, storey_height=3.0, gravity_load=2e5)
    assert frame.has_devices
    assert frame.yield_shear.tolist() == [30e3]
    assert "yield_shear" in frame.parameters
    assert "yield_shear" not in one_storey().parameters
    assert frame != one_storey()
    assert frame == one_storey(yield_shear=30e3, hardening_ratio=0.02, storey_height=3.0, gravity_load=2e5)


def test_initial_velocity_yields_at_once_where_it_must() -> None:
    """A state beyond the strength at the start gives way before anything moves, and the balance knows it."""
    frame = one_storey(yield_shear=30e3, slot_length=0.01, slot_stiffness=1e7)
    history = fdspec.simulate(
        frame, fdspec.GroundMotion([0.0, 0.0], 0.01), free_vibration=3.0, initial_displacement=[0.05]
    )
    assert float(history["energy_error"]) < 1e-12
    assert abs(float(history["plastic_drift"][0])) > 0.0
    assert float(history["column_energy"][0]) > 0.0


def test_a_tension_brace_yields_and_grows_slack() -> None:
    frame = Building(
        20e3,
        2e6,
        0.0,
        0.0,
        0.0,
        damping=ModalDamping(0.02),
        links=[TensionBrace(1, 0, 8e6, 30e3, direction=d) for d in (1, -1)],
    )
    history = fdspec.simulate(frame, SHORT)
    slack = history["link_slip"].values
    assert (np.diff(slack, axis=0) >= -1e-15).all()
    assert (slack[-1] > 1e-3).all()
    assert (history["link_force"].values[:, 0] >= 0.0).all()
    assert (history["link_force"].values[:, 1] <= 0.0).all()
    np.testing.assert_allclose(history["link_energy"], 30e3 * slack[-1], rtol=1e-10)
    assert float(history["energy_error"]) < 1e-12


def test_kinds_of_links_in_the_frame() -> None:
    frame = everything().device_frame
    kinds = frame.places[row.KIND].tolist()
    assert kinds[:2] == [row.WITH_MASS, row.WITHOUT_MASS]
    assert frame.columns.tolist() == [2, 3]
    assert frame.others.tolist() == [4, 5, 6]
    assert kinds[4:] == [row.WITH_MASS, row.WITHOUT_MASS, row.ONE_SIDED]
