"""The edges of one storey: last samples, exact ties, braces without mass, dampers without friction."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numba import config

import fdspec
from fdspec.errors import IntegrationError
from fdspec.kernels.storey.history import RESULT, RESULTS, finish
from fdspec.kernels.types import ENERGY_NOT_CLOSED, N_STATE, OK, STATE, Storey

AT_REST = fdspec.GroundMotion(np.zeros(3), 0.01, name="rest")


def constant(acceleration: float, samples: int, dt: float) -> fdspec.GroundMotion:
    return fdspec.GroundMotion(acceleration * np.ones(samples), dt, name="constant")


def swept(motion: fdspec.GroundMotion, period: float, ratio: float, force: float, **more: Any) -> xr.Dataset:
    cube = fdspec.sweep(
        motion, period=[period], stiffness_ratio=[ratio], pretension=[force], friction_coefficient=1.0, **more
    )
    return cube.squeeze()


@pytest.mark.parametrize("certify", [True, False])
def test_a_peak_at_the_last_sample_counts(certify: bool) -> None:
    """The velocity is largest at the record's very end, behind which no step tells of it."""
    motion = fdspec.GroundMotion(3.0 * np.sin(math.pi * np.arange(41) / 20.0), 0.01, name="sine")
    cube = swept(motion, 0.3, 4.0, 2e3, brace_mass=500.0, brace_damping_ratio=0.1, certify=certify)
    assert float(cube.peak_velocity) == pytest.approx(0.27175308, rel=1e-7)


def test_a_reaction_that_returns_to_the_slip_force_at_a_sample_has_slipped() -> None:
    """The slip force read off the braced frame's samples: between two of them the reaction is larger."""
    motion = constant(1.0, 101, 0.02)
    braced = fdspec.Building.single_storey(period=0.6, stiffness_ratio=10, slip_force=math.inf)
    force = float(np.abs(fdspec.simulate(braced, motion).friction_force).max())
    cube = swept(motion, 0.6, 10.0, force)
    assert float(cube.peak_acceleration) == pytest.approx(1.91273999, rel=1e-7)
    assert float(cube.slip_travel) == pytest.approx(5.52991501e-5, rel=1e-6)


def test_a_massless_brace_without_friction_springs_free_at_once() -> None:
    """So the base feels the columns alone, and the energy of the brace is gone."""
    free = fdspec.Building([20e3], [8e6], [0.0], [16e6], [0.0])
    history = fdspec.simulate(free, AT_REST, free_vibration=1.0, initial_displacement=[0.01])
    assert float(history.peak_base_shear) == pytest.approx(80e3, rel=1e-12)
    assert float(history.dissipated_energy) == pytest.approx(0.5 * 16e6 * 0.01**2, rel=1e-12)
    assert float(history.energy_error) < 1e-12


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_damped_massless_brace_without_friction_creeps_back(side: float) -> None:
    """c_d u' + k_d u = 0: from u_0 with the velocity -k_d u_0 / c_d, whatever the floor does."""
    free = fdspec.Building([20e3], [8e6], [0.0], [16e6], [0.0], brace_damping=[1e6])
    history = fdspec.simulate(free, AT_REST, free_vibration=0.5, initial_displacement=[0.01 * side])
    brace = history.brace_displacement.squeeze()
    np.testing.assert_allclose(brace, 0.01 * side * np.exp(-16.0 * history.time), rtol=1e-11)
    assert float(history.energy_error) < 1e-12


@pytest.mark.parametrize("velocity", [0.5, -0.5])
def test_a_free_brace_keeps_the_velocity_it_is_given(velocity: float) -> None:
    free = fdspec.Building([20e3], [8e6], [50.0], [16e6], [0.0], damping=fdspec.ModalDamping(0.0))
    history = fdspec.simulate(free, AT_REST, free_vibration=1.0, initial_velocity=[[0.0], [velocity]])
    omega = math.sqrt(16e6 / 50.0)
    brace = history.brace_displacement.squeeze()
    np.testing.assert_allclose(brace, velocity / omega * np.sin(omega * history.time), atol=1e-13)
    assert float(np.abs(history.displacement).max()) == 0.0
    travel = 2.0 / math.pi * abs(velocity) * float(history.time[-1])  # but for the swing that is cut
    assert float(history.slip_travel[-1, 0]) == pytest.approx(travel, rel=1e-3)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="long without the JIT")
@pytest.mark.parametrize(("period", "ratio", "force"), [(0.0638, 183.0, 2.8e-7), (3.8, 0.035, 1.7e-10)])
def test_kinetic_friction_just_below_static_ends(period: float, ratio: float, force: float) -> None:
    """The two are further apart than rounding, but not than the rounding of large displacements."""
    record = fdspec.load_record("FSR1")
    found = [
        swept(record, period, ratio, force, kinetic_friction_coefficient=share, brace_mass=0.0)
        for share in (0.999999, 1.0)
    ]
    assert int(found[0].status) == OK
    assert float(found[0].transitions) < 5000
    assert float(found[0].energy_error) < 1e-9
    for name in ("peak_acceleration", "peak_displacement", "peak_base_shear"):
        assert float(found[0][name]) == pytest.approx(float(found[1][name]), rel=1e-9)


@pytest.mark.parametrize("size", [1.0, 1e3, 1e6])
def test_a_massless_free_brace_under_any_motion(size: float) -> None:
    """Linear: everything grows with the motion."""
    ground = size * np.random.default_rng(1).standard_normal(400)
    with warnings.catch_warnings(action="ignore"):
        motion = fdspec.GroundMotion(ground, 0.01, name="white")
    cube = swept(motion, 0.5, 4.0, 0.0, damping_ratio=0.0, brace_mass=0.0)
    assert int(cube.status) == OK
    assert float(cube.energy_error) < 1e-11
    assert float(cube.peak_acceleration) == pytest.approx(float(cube.elastic_acceleration), rel=1e-12)


def test_no_pair_of_changes_at_one_instant_where_a_slip_begins_at_a_sample() -> None:
    record = fdspec.load_record("FSR2")
    for period in (0.3, 0.45, 0.7, 1.1):
        stuck = fdspec.Building.single_storey(period=period, stiffness_ratio=6, slip_force=math.inf)
        reaction = np.abs(fdspec.simulate(stuck, record).friction_force.squeeze().to_numpy())
        for sample in np.flatnonzero(reaction[1:] > np.maximum.accumulate(reaction)[:-1])[-6:] + 1:
            frame = fdspec.Building.single_storey(
                period=period, stiffness_ratio=6, slip_force=float(reaction[sample])
            )
            times = fdspec.simulate(frame, record).transition_time.to_numpy()
            assert (np.diff(times) > 0.0).all()


@pytest.mark.parametrize("phase", [1e-2, 1e-4, 1e-6])
def test_a_brace_that_is_slow_against_the_step(phase: float) -> None:
    """The sweep's closed form, were it used, would lose digits by the square of the phase."""
    record = fdspec.load_record("FSR1")
    ratio = 50.0 * (phase / record.dt) ** 2 / (20e3 * (2.0 * math.pi / 0.5) ** 2)
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=ratio, slip_force=100.0)
    history = fdspec.simulate(frame, record)
    cube = swept(record, 0.5, ratio, 100.0)
    assert float(cube.slip_travel) == pytest.approx(float(history.slip_travel[-1, 0]), rel=1e-12)


def test_the_last_output_has_the_last_sample_of_the_ground() -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
    for dt in (0.01, 0.005, 1.0 / 3.0, 0.07):
        motion = constant(1.0, 30, dt)
        for share in (1.0, 1.0 / 3.0, 0.1, 1.0 / 7.0):
            ground = fdspec.simulate(frame, motion, dt_out=share * dt).ground_acceleration
            assert (ground == 1.0).all()
    later = fdspec.simulate(frame, motion, free_vibration=3.0 * motion.dt).ground_acceleration
    assert later.to_numpy()[-4:].tolist() == [1.0, 0.0, 0.0, 0.0]


def test_the_energy_error_is_measured_by_the_energy_in_play() -> None:
    """Over one whole period the ground puts in nothing, net."""
    mass = 20e3 + 50.0
    period = 2.0 * math.pi * math.sqrt(mass / (5.0 * 20e3 * (2.0 * math.pi / 0.5) ** 2))
    cube = swept(constant(1.0, 101, period / 100.0), 0.5, 4.0, 1e9, damping_ratio=0.0)
    assert abs(float(cube.input_energy)) < 1e-11
    assert float(cube.energy_error) < 1e-12


def test_a_balance_that_does_not_close_is_a_status() -> None:
    storey = Storey(20e3, 0.0, 3e6, 50.0, 0.0, 12e6, 1e4, 1e4)
    s, result = np.zeros(N_STATE), np.empty(len(RESULTS))
    s[STATE.input], s[STATE.peak_velocity] = 1.0, 0.1
    finish(storey, s, True, result)
    assert result[RESULT.energy_error] == pytest.approx(1.0 / (0.5 * 20e3 * 0.1**2))
    assert result[RESULT.status] == ENERGY_NOT_CLOSED
    s[STATE.input] = 1e-5
    finish(storey, s, True, result)
    assert result[RESULT.status] == OK


def test_simulate_says_that_the_energy_does_not_close(monkeypatch: pytest.MonkeyPatch) -> None:
    from fdspec.engines import single_storey

    def leaking(*arguments: Any) -> None:
        arguments[-1][:] = 0.0
        arguments[-1][10] = ENERGY_NOT_CLOSED

    monkeypatch.setattr(single_storey, "integrate", leaking)
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=50e3)
    with pytest.raises(IntegrationError, match="energy_not_closed"):
        fdspec.simulate(frame, constant(1.0, 5, 0.01))
