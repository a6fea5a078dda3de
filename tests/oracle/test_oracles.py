"""The oracles themselves against the reference numbers and against formulas: fdspec takes no part here."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests import closed_forms
from tests.oracle import mdof_events, sdof_events
from tests.reference import numbers

SLIPPING = [c for c in numbers.single_storeys() if c.transitions > 0]
SAMPLE = [SLIPPING[i] for i in np.random.default_rng(7).permutation(len(SLIPPING))[:8]]


def one_storey(storey: sdof_events.Storey) -> mdof_events.Frame:
    return mdof_events.frame(
        [storey.floor_mass],
        [storey.floor_stiffness],
        [storey.brace_mass],
        [storey.brace_stiffness],
        [storey.static_force],
        frame_damping=np.array([[storey.floor_damping]]),
        brace_damping=[storey.brace_damping],
        kinetic_slip_force=[storey.sliding_force],
    )


@pytest.mark.parametrize("cell", SAMPLE, ids=str)
def test_single_storey_oracle_meets_the_reference(cell: numbers.SingleStorey) -> None:
    storey = sdof_events.Storey.from_period(cell.period, cell.stiffness_ratio, cell.slip_force)
    history = sdof_events.integrate(storey, *numbers.motion())
    assert len(history.transitions) == cell.transitions
    assert history.peak_acceleration == pytest.approx(cell.peak_acceleration, rel=1e-12)
    assert history.peak_displacement == pytest.approx(cell.peak_displacement, rel=1e-12)


def test_storeys_oracle_meets_the_reference() -> None:
    given = numbers.read("mdof_peaks.json")["buildings"][3]
    frame = mdof_events.frame(
        given["floor_mass_kg"],
        given["storey_stiffness_n_m"],
        given["brace_mass_kg"],
        given["brace_stiffness_n_m"],
        given["slip_force_n"],
        damping_ratio=given["modal_damping_ratio"],
    )
    history = mdof_events.integrate(frame, *numbers.motion("mdof_peaks.json"))
    assert len(history.transitions) == given["n_transitions"]
    np.testing.assert_allclose(history.peak_acceleration, given["peak_acceleration_m_s2"], rtol=1e-12)
    np.testing.assert_allclose(history.peak_displacement, given["peak_displacement_m"], rtol=1e-12)
    scale = np.max(history.peak_displacement)
    final = given["final_displacement_m"]
    np.testing.assert_allclose(history.final_displacement, final, rtol=0, atol=1e-11 * scale)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"kinetic_force": 35e3},
        {"brace_damping_ratio": 0.2},
        {"kinetic_force": 20e3, "brace_damping_ratio": 0.05},
    ],
    ids=["plain", "kinetic", "damped brace", "kinetic, damped brace"],
)
def test_the_two_oracles_agree_on_one_storey(change: dict[str, float]) -> None:
    acceleration, dt = numbers.motion()
    storey = sdof_events.Storey.from_period(0.3, 4.0, 50e3, brace_mass=300.0, **change)
    one = sdof_events.integrate(storey, acceleration[:601], dt, energies=True)
    other = mdof_events.integrate(one_storey(storey), acceleration[:601], dt)
    assert len(one.transitions) > 10
    assert [phase for _, phase in one.transitions] == [phase for _, _, phase in other.transitions]
    times = [[time for time, *_ in history.transitions] for history in (one, other)]
    np.testing.assert_allclose(times[0], times[1], rtol=0, atol=1e-11)
    assert other.peak_acceleration[0] == pytest.approx(one.peak_acceleration, rel=1e-12)
    assert other.peak_displacement[0] == pytest.approx(one.peak_displacement, rel=1e-12)
    np.testing.assert_allclose(other.final_displacement, one.final_displacement, rtol=0, atol=1e-14)
    assert one.energy_error < 1e-13


def test_energy_closes_in_the_single_storey_oracle() -> None:
    acceleration, dt = numbers.motion()
    for stop in ({}, {"free_vibration": 2.0}, {"displacement": (0.02, 0.003), "velocity": (0.3, -0.1)}):
        for mass in (50.0, 0.0):
            storey = sdof_events.Storey.from_period(0.5, 4.0, 80e3, brace_mass=mass)
            history = sdof_events.integrate(storey, acceleration[:401], dt, energies=True, **stop)
            assert history.transitions
            assert history.energy_error < 1e-13, (stop, mass)


def test_single_storey_oracle_against_a_general_integrator() -> None:
    """One slip, with scipy's own events: neither matrix nor series is shared."""
    storey = sdof_events.Storey.from_period(0.4, 2.0, 40e3, brace_mass=400.0, brace_damping_ratio=0.1)
    ground, dt = 9.0, 0.05
    history = sdof_events.integrate(storey, [ground, ground, ground], dt)
    s = storey

    def stick(t: float, y: np.ndarray) -> list[float]:
        force = s.floor_stiffness * y[0] + s.brace_stiffness * y[1]
        force += s.floor_damping * y[2] + s.brace_damping * y[3]
        a = -force / (s.floor_mass + s.brace_mass) - ground
        return [y[2], y[3], a, a]

    def slip(t: float, y: np.ndarray) -> list[float]:
        f = -(s.floor_stiffness * y[0] + s.floor_damping * y[2] + sign * s.static_force) / s.floor_mass
        d = -(s.brace_stiffness * y[1] + s.brace_damping * y[3] - sign * s.static_force) / s.brace_mass
        return [y[2], y[3], f - ground, d - ground]

    def margin(t: float, y: np.ndarray) -> float:
        held = s.brace_mass * (stick(t, y)[2] + ground) + s.brace_stiffness * y[1] + s.brace_damping * y[3]
        return s.static_force - abs(held)

    margin.terminal = True  # type: ignore[attr-defined]
    tight = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-16, "max_step": 1e-3}
    first = solve_ivp(stick, (0.0, 2 * dt), np.zeros(4), events=margin, **tight)
    assert first.t_events[0].size == 1
    sign = -1  # the ground runs ahead to the right, the floor slips back
    second = solve_ivp(slip, (first.t[-1], 2 * dt), first.y[:, -1], **tight)
    assert np.all(second.y[2, 1:] < second.y[3, 1:])
    assert history.transitions == [(pytest.approx(first.t[-1], abs=1e-13), sign)]
    assert history.final_displacement == pytest.approx(tuple(second.y[:2, -1]), rel=1e-10)
    assert history.final_velocity == pytest.approx(tuple(second.y[2:, -1]), rel=1e-9)


def test_massless_brace_is_a_bilinear_spring() -> None:
    mass, k_f, k_d, force, velocity = 1000.0, 4.0e4, 1.0e5, 900.0, 0.35
    storey = sdof_events.Storey(mass, k_f, 0.0, 0.0, k_d, 0.0, force)
    extrema = closed_forms.bilinear_free_extrema(mass, k_f, k_d, force, velocity, 5)
    history = sdof_events.integrate(
        storey, np.zeros(1001), 0.01, velocity=(velocity, velocity), energies=True
    )
    assert history.peak_displacement == pytest.approx(extrema[0], rel=1e-14)
    assert history.energy_error < 1e-14
    # It ends swinging elastically: the last yield sets the offset.
    assert len(history.transitions) % 2 == 0


def test_light_brace_tends_to_the_massless_one() -> None:
    acceleration, dt = numbers.motion()
    acceleration = acceleration[:501]
    massless = sdof_events.Storey.from_period(0.5, 2.0, 70e3, brace_mass=0.0)
    limit = sdof_events.integrate(massless, acceleration, dt)
    errors = []
    for brace_mass in (20.0, 2.0, 0.2):
        damped = sdof_events.Storey.from_period(
            0.5, 2.0, 70e3, brace_mass=brace_mass, brace_damping_ratio=0.3
        )
        history = sdof_events.integrate(damped, acceleration, dt)
        errors.append(abs(history.peak_displacement / limit.peak_displacement - 1.0))
    # The brace's ringing dies out within sqrt(m_d / k_d).
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]


def test_den_hartog_table() -> None:
    """The values that stand beside the formula in the reference."""
    table = {
        (0.7, 0.3, 0.0): 1.885699850,
        (0.8, 0.5, 0.05): 1.929321530,
        (0.9, 0.6, 0.0): 3.661416382,
        (1.2, 0.5, 0.05): 1.272600496,
        (1.5, 0.4, 0.05): 0.601871852,
    }
    for arguments, amplitude in table.items():
        assert closed_forms.den_hartog_amplitude(*arguments) == pytest.approx(amplitude, abs=6e-10)


def test_friction_decay_formula() -> None:
    extrema = closed_forms.friction_decay_extrema(1e4, 1.0, 0.85e-3)
    np.testing.assert_allclose(extrema, [-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3], atol=1e-18)


def test_block_formula_ends_where_it_would_stop() -> None:
    edge = 1.0 / math.sqrt(1.0 + math.pi**2 / 4.0)
    assert edge == pytest.approx(0.537029, abs=5e-7)
    assert closed_forms.shaken_block_amplitude(2.0, 3.0, 1e-9, 1.0) == pytest.approx(2.0 / 9.0, rel=1e-12)
    with pytest.raises(ValueError, match="stops"):
        closed_forms.shaken_block_amplitude(1.0, 1.0, edge * 1.001, 1.0)
