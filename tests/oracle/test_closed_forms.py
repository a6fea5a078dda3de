"""fdspec against answers on paper.

Rigid friction against the ground, which fdspec has no element for, is a brace so heavy and so stiff that it
moves with the ground: it lags by a_g/omega_d^2, and friction bends it by F/(m_d omega_d^2), both below what
is asked. Where the ground moves the brace has a critical dashpot: the first sample's jump would make it ring
for ever.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import fdspec
from tests import closed_forms
from tests.reference import numbers

STILL = np.zeros(2)


def with_ground_friction(
    mass: float,
    stiffness: float,
    damping_ratio: float,
    force: float,
    brace_omega: float,
    heavier: float,
    brace_damping_ratio: float = 0.0,
) -> fdspec.Building:
    """A floor that rubs against the ground: a brace ``heavier`` times its mass, at ``brace_omega`` rad/s."""
    return fdspec.Building(
        floor_mass=[mass],
        storey_stiffness=[stiffness],
        brace_mass=[heavier * mass],
        brace_stiffness=[heavier * mass * brace_omega**2],
        slip_force=[force],
        damping=fdspec.ModalDamping(damping_ratio),
        brace_damping=[2.0 * brace_damping_ratio * heavier * mass * brace_omega],
    )


@pytest.mark.parametrize(
    ("stiffness", "force", "start"), [(1e4, 1.0, 0.85e-3), (4e4, 3.0, -1.9e-3), (2.5e3, 0.2, 2.02e-3)]
)
def test_free_decay(stiffness: float, force: float, start: float) -> None:
    """Each half cycle ends where the formula says, at the instant it says, and it stays in the last one."""
    frame = with_ground_friction(1.0, stiffness, 0.0, force, 1e3, 1e15)
    extrema = closed_forms.friction_decay_extrema(stiffness, force, start)
    half = math.pi / math.sqrt(stiffness)
    history = fdspec.simulate(
        frame,
        fdspec.GroundMotion(STILL, half),
        dt_out=half,
        free_vibration=half * (len(extrema) + 2),
        initial_displacement=[[start], [0.0]],
    )
    # It lets go at once, turns at each extremum but the last, and sticks in that.
    np.testing.assert_allclose(
        history.transition_time,
        half * np.arange(len(extrema) + 1),
        rtol=0.0,
        atol=1e-12 * half * len(extrema),
    )
    phases = [-math.copysign(1, x) for x in (start, *extrema[:-1])]
    assert history.transition_phase.values.tolist() == [*phases, 0]
    got = history.displacement[1 : len(extrema) + 1, 0]
    np.testing.assert_allclose(got, extrema, rtol=0.0, atol=1e-12 * abs(start))
    np.testing.assert_allclose(history.displacement[len(extrema) :, 0], extrema[-1], atol=1e-12 * abs(start))
    travel = np.sum(np.abs(np.diff([start, *extrema])))
    assert history.slip_travel[-1].item() == pytest.approx(travel, rel=1e-12)
    assert history.dissipated_energy.item() == pytest.approx(force * travel, rel=1e-12)


DEN_HARTOG = [
    (0.7, 0.3, 0.0, 25),
    (0.8, 0.5, 0.05, 25),
    (0.9, 0.6, 0.0, 40),
    (1.2, 0.5, 0.05, 25),
    (1.5, 0.4, 0.05, 25),
    (0.6, 0.2, 0.1, 25),
    (1.1, 0.5, 0.02, 40),
    (0.95, 0.5, 0.2, 25),
]
"""r, beta, zeta, and the cycles until the start is forgotten."""


@pytest.mark.parametrize(("r", "beta", "zeta", "cycles"), DEN_HARTOG)
def test_den_hartog(r: float, beta: float, zeta: float, cycles: int) -> None:
    """Harmonic base motion, friction against the ground, steady state without stops.

    A cosine through straight lines has the amplitude (sin(x)/x)^2, x = omega dt / 2: with 2000 samples a
    cycle 8e-7 less, which is put back. The amplitude is read from the last two cycles, through the parabola
    about the largest sample. Two changes of phase a cycle say that it does not stop.
    """
    omega_n, acceleration, mass, per_cycle = 2.0 * math.pi, 1.0, 1000.0, 2000
    omega = r * omega_n
    dt = 2.0 * math.pi / omega / per_cycle
    x = 0.5 * omega * dt
    amplitude = acceleration / (math.sin(x) / x) ** 2
    motion = fdspec.GroundMotion(amplitude * np.cos(omega * dt * np.arange(cycles * per_cycle + 1)), dt)
    force = beta * mass * acceleration
    frame = with_ground_friction(mass, mass * omega_n**2, zeta, force, 1.5e4, 1e6, 1.0)
    history = fdspec.simulate(frame, motion)
    steady = history.displacement.values[-2 * per_cycle :, 0]
    late = history.transition_time[history.transition_time > (cycles - 2) * per_cycle * dt]
    assert late.size == 4
    assert peak_of(steady) == pytest.approx(peak_of(-steady), rel=1e-6)
    expected = closed_forms.den_hartog_amplitude(r, beta, zeta) * acceleration / omega_n**2
    assert peak_of(steady) == pytest.approx(expected, rel=1e-6)


def peak_of(samples: np.ndarray) -> float:
    """Largest value of the parabola through the largest sample and its neighbours."""
    i = int(np.argmax(samples[1:-1])) + 1
    before, at, after = samples[i - 1 : i + 2]
    return float(at + (after - before) ** 2 / (8.0 * (2.0 * at - before - after)))


@pytest.mark.parametrize("beta", [0.2, 0.4, 0.53])
def test_block_on_a_shaken_base(beta: float) -> None:
    """A block on a base: a floor on no spring worth the name, rubbing against the ground."""
    mass, gravity, omega, acceleration, per_cycle, cycles = 1000.0, 9.80665, 2.0 * math.pi, 3.0, 4000, 30
    dt = 1.0 / per_cycle
    x = 0.5 * omega * dt
    cosine = np.cos(omega * dt * np.arange(cycles * per_cycle + 1))
    motion = fdspec.GroundMotion(acceleration / (math.sin(x) / x) ** 2 * cosine, dt)
    friction = beta * acceleration / gravity
    frame = with_ground_friction(
        mass, mass * (omega * 1e-5) ** 2, 0.0, friction * mass * gravity, 1.5e4, 1e6, 1.0
    )
    history = fdspec.simulate(frame, motion)
    late = history.transition_time[history.transition_time > (cycles - 2) * per_cycle * dt]
    assert late.size == 4
    steady = history.displacement.values[-2 * per_cycle :, 0]
    expected = closed_forms.shaken_block_amplitude(acceleration, omega, friction, gravity)
    assert 0.5 * (peak_of(steady) + peak_of(-steady)) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("velocity", [0.35, -0.12, 0.02])
def test_massless_brace_is_a_bilinear_spring(velocity: float) -> None:
    """Free vibration: the extrema of the bilinear loop, from energy alone."""
    mass, k_f, k_d, force = 1000.0, 4.0e4, 1.0e5, 900.0
    frame = fdspec.Building(
        floor_mass=[mass],
        storey_stiffness=[k_f],
        brace_mass=[0.0],
        brace_stiffness=[k_d],
        slip_force=[force],
        damping=fdspec.ModalDamping(0.0),
    )
    extrema = closed_forms.bilinear_free_extrema(mass, k_f, k_d, force, velocity, 8)
    dt = 1e-4
    history = fdspec.simulate(
        frame, fdspec.GroundMotion(STILL, dt), free_vibration=5.0, initial_velocity=[velocity]
    )
    assert history.peak_displacement.item() == pytest.approx(abs(extrema[0]), rel=1e-13)
    turns = history.displacement.values[:, 0]
    inside = np.nonzero(np.diff(np.sign(np.diff(turns))))[0] + 1
    got = [math.copysign(peak_of(abs(turns[i - 1 : i + 2])), turns[i]) for i in inside[:8]]
    np.testing.assert_allclose(got, extrema, rtol=1e-8)


@pytest.mark.parametrize("slip_force", [0.0, math.inf], ids=["free", "locked"])
@pytest.mark.parametrize("period", [0.05, 0.4, 3.0])
def test_the_two_linear_limits(slip_force: float, period: float) -> None:
    """No friction: the bare frame. No slip: the braced frame. Both by one matrix exponential."""
    acceleration, dt = numbers.motion()
    frame = fdspec.Building.single_storey(period=period, stiffness_ratio=3.0, slip_force=slip_force)
    storey = frame.storey
    braced = slip_force > 0.0
    mass = storey.floor_mass + braced * storey.brace_mass
    stiffness = storey.floor_stiffness + braced * storey.brace_stiffness
    u, v = closed_forms.linear_states(mass, storey.floor_damping, stiffness, acceleration, dt, subdivisions=4)
    history = fdspec.simulate(frame, fdspec.GroundMotion(acceleration, dt), dt_out=dt / 4)
    assert history.sizes["transition"] == 0
    np.testing.assert_allclose(history.displacement, u, rtol=0.0, atol=1e-10 * np.max(np.abs(u)))
    np.testing.assert_allclose(history.velocity, v, rtol=0.0, atol=1e-10 * np.max(np.abs(v)))
    # The floor's absolute acceleration is what its springs and dashpots give it.
    absolute = -(storey.floor_damping * v + stiffness * u) / mass
    np.testing.assert_allclose(
        history.acceleration, absolute, rtol=0.0, atol=1e-10 * np.max(np.abs(absolute))
    )
    assert history.peak_acceleration.item() >= np.max(np.abs(absolute)) * (1.0 - 1e-10)
