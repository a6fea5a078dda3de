"""Histories whose answer is a formula.

Rigid friction against the ground is a brace so heavy and stiff that it moves with the ground; where the
ground moves the brace has a critical dashpot, for the first sample's jump would make it ring for ever.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from fdspec.building import Building, ModalDamping
from fdspec.course import FloatArray
from fdspec.methods import EXACT, Method
from fdspec.motion import GroundMotion
from fdspec.simulate import simulate
from fdspec.verification.problems import still
from fdspec.verification.row import Row, absolute, relative, same_count

DEN_HARTOG: Final = (
    (0.7, 0.3, 0.0, 25),
    (0.8, 0.5, 0.05, 25),
    (0.9, 0.6, 0.0, 40),
    (1.2, 0.5, 0.05, 25),
    (1.5, 0.4, 0.05, 25),
    (0.6, 0.2, 0.1, 25),
    (1.1, 0.5, 0.02, 40),
)
"""Frequency ratio, friction over force, damping ratio; cycles until the start is forgotten."""

STEADY: Final = 1e-6
"""What reading an amplitude off samples through a parabola leaves, with 2000 samples a cycle."""


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    yield from free_decay()
    yield from free_vibration()
    yield from den_hartog(DEN_HARTOG if full else DEN_HARTOG[:5])
    yield from shaken_block()
    yield from massless_brace()


def rubbing(
    mass: float,
    stiffness: float,
    damping_ratio: float,
    force: float,
    brace_omega: float,
    heavier: float,
    brace_damping_ratio: float,
) -> Building:
    """Make a floor that rubs on the ground: a brace ``heavier`` times its mass, at ``brace_omega`` rad/s."""
    brace = heavier * mass
    return Building(
        mass,
        stiffness,
        brace,
        brace * brace_omega**2,
        force,
        damping=ModalDamping(damping_ratio),
        brace_damping=2.0 * brace_damping_ratio * brace * brace_omega,
    )


def free_decay() -> Iterator[Row]:
    """Let go of a mass on a spring, with friction: the amplitude falls by 4 F / k a cycle until it sticks."""
    stiffness, force, start = 1e4, 1.0, 0.85e-3
    extrema = [start]
    while abs(extrema[-1]) > force / stiffness:
        extrema.append(-extrema[-1] + math.copysign(2.0 * force / stiffness, extrema[-1]))
    half = math.pi / math.sqrt(stiffness)
    history = simulate(
        rubbing(1.0, stiffness, 0.0, force, 1e3, 1e15, 0.0),
        GroundMotion(np.zeros(2), half),
        dt_out=half,
        free_vibration=half * (len(extrema) + 1),
        initial_displacement=[[start], [0.0]],
    )
    for k, extremum in enumerate(extrema[1:], start=1):
        computed = float(history["displacement"][k, 0])
        yield relative("free decay with friction", f"extremum {k}, m", extremum, computed, 1e-11)
    stop = half * (len(extrema) - 1)
    yield absolute(
        "free decay with friction",
        "instant of the last stop, s",
        stop,
        float(history["transition_time"][-1]),
        1e-12,
    )


def free_vibration() -> Iterator[Row]:
    """Let an undamped frame swing: its peaks lie between the samples, three to a period."""
    omega, u0, v0 = 2.0 * math.pi, 0.01, 0.09
    frame = Building(1000.0, 1000.0 * omega**2, 0.0, 0.0, 0.0, damping=ModalDamping(0.0))
    history = simulate(frame, still(3.0, 0.37), initial_displacement=[u0], initial_velocity=[v0])
    amplitude = math.hypot(u0, v0 / omega)
    for name, unit, power in (("displacement", "m", 0), ("velocity", "m/s", 1), ("acceleration", "m/s2", 2)):
        computed = float(history[f"peak_{name}"][0])
        quantity = f"peak {name}, {unit}"
        yield relative("free vibration", quantity, amplitude * omega**power, computed, 1e-13)


def den_hartog(cases: tuple[tuple[float, float, float, int], ...]) -> Iterator[Row]:
    """Steady state without stops (Den Hartog 1931), the ground shaken at a0 cos(w t)."""
    omega_n, acceleration, mass, per_cycle = 2.0 * math.pi, 1.0, 1000.0, 2000
    for r, beta, zeta, cycles in cases:
        frame = rubbing(mass, mass * omega_n**2, zeta, beta * mass * acceleration, 1.5e4, 1e6, 1.0)
        positive, negative, changes = steady_amplitude(frame, r * omega_n, acceleration, per_cycle, cycles)
        case = f"Den Hartog r {r:g}, F/P {beta:g}, zeta {zeta:g}"
        expected = den_hartog_amplitude(r, beta, zeta)
        computed = 0.5 * (positive + negative) * omega_n**2 / acceleration
        yield relative(case, "amplitude x0 k / P", expected, computed, STEADY)
        yield same_count(case, "changes of phase in two cycles", 4, changes)


def den_hartog_amplitude(frequency_ratio: float, friction_ratio: float, damping_ratio: float) -> float:
    """x0 k / P of the steady state without stops: force P cos(wt) on a damped mass with rigid friction F."""
    r, beta, zeta = frequency_ratio, friction_ratio, damping_ratio
    q = math.sqrt(1.0 - zeta**2)
    a, b = zeta * math.pi / r, q * math.pi / r
    d = math.cosh(a) + math.cos(b)
    g = (math.sinh(a) - (zeta / q) * math.sin(b)) / d
    h = math.sin(b) / (q * r * d)
    return -g * beta + math.sqrt(1.0 / ((1.0 - r**2) ** 2 + (2.0 * zeta * r) ** 2) - (h * beta) ** 2)


def shaken_block() -> Iterator[Row]:
    """A block on a base shaken at a0 cos(w t): a floor on no spring worth the name."""
    mass, omega, acceleration, per_cycle = 1000.0, 2.0 * math.pi, 3.0, 2000
    for beta in (0.2, 0.53):
        frame = rubbing(mass, mass * (omega * 1e-5) ** 2, 0.0, beta * mass * acceleration, 1.5e4, 1e6, 1.0)
        positive, negative, changes = steady_amplitude(frame, omega, acceleration, per_cycle, 20)
        expected = acceleration / omega**2 * math.sqrt(1.0 - (math.pi * beta / 2.0) ** 2)
        case = f"block on a shaken base, mu g / a0 {beta:g}"
        yield relative(case, "half the slip, m", expected, 0.5 * (positive + negative), STEADY)
        yield same_count(case, "changes of phase in two cycles", 4, changes)


def steady_amplitude(
    frame: Building,
    omega: float,
    acceleration: float,
    per_cycle: int,
    cycles: int,
    method: str | Method = EXACT,
) -> tuple[float, float, int]:
    """Largest and smallest displacement in the last two cycles (both positive, m), changes of phase there.

    A cosine through straight lines has the amplitude (sin(x)/x)^2, x = omega dt / 2, which is put back.
    """
    dt = 2.0 * math.pi / omega / per_cycle
    x = 0.5 * omega * dt
    cosine = np.cos(omega * dt * np.arange(cycles * per_cycle + 1))
    history = simulate(frame, GroundMotion(acceleration / (math.sin(x) / x) ** 2 * cosine, dt), method=method)
    steady = history["displacement"].values[-2 * per_cycle :, 0]
    late = int((history["transition_time"] > (cycles - 2) * per_cycle * dt).sum())
    return crest(steady), crest(-steady), late


def crest(samples: FloatArray) -> float:
    """Largest value of the parabola through the largest sample inside and its neighbours."""
    i = int(np.argmax(samples[1:-1])) + 1
    before, at, after = samples[i - 1 : i + 2]
    return float(at + (after - before) ** 2 / (8.0 * (2.0 * at - before - after)))


def massless_brace() -> Iterator[Row]:
    """Free vibration of a bilinear spring: extrema from energy, arcs of k_f + k_d and then of k_f."""
    mass, k_f, k_d, force, velocity = 1000.0, 4.0e4, 1.0e5, 900.0, 0.35
    frame = Building(mass, k_f, 0.0, k_d, force, damping=ModalDamping(0.0))
    history = simulate(frame, still(2e-4, 1e-4), free_vibration=2.0, initial_velocity=[velocity])
    expected = bilinear_extrema(mass, k_f, k_d, force, velocity, 4)
    yield relative(
        "massless brace", "peak displacement, m", expected[0], float(history["peak_displacement"][0]), 1e-12
    )
    u = history["displacement"].values[:, 0]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(u)))) + 1
    for k in range(1, 4):
        near = u[turns[k] - 1 : turns[k] + 2]
        sign = math.copysign(1.0, expected[k])
        yield relative("massless brace", f"extremum {k + 1}, m", expected[k], sign * crest(sign * near), 1e-8)


def bilinear_extrema(
    mass: float, k_f: float, k_d: float, force: float, velocity: float, count: int
) -> list[float]:
    """First extrema of an undamped mass on k_f and an elasto-plastic spring (k_d, force), from u = 0."""
    extrema: list[float] = []
    u, energy, spring, sign = 0.0, 0.5 * mass * velocity**2, 0.0, math.copysign(1.0, velocity)
    for _ in range(count):
        offset = u - spring / k_d
        elastic = energy + 0.5 * k_f * u**2 + 0.5 * spring**2 / k_d
        yields = offset + sign * force / k_d
        left = elastic - 0.5 * k_f * yields**2 - 0.5 * force**2 / k_d
        if left <= 0.0:  # it turns before it yields: k_f x^2 / 2 + k_d (x - offset)^2 / 2 = elastic
            a, b = k_f + k_d, k_d * offset
            u = (b + sign * math.sqrt(b * b - a * (k_d * offset**2 - 2.0 * elastic))) / a
            spring = k_d * (u - offset)
        else:  # from there m v^2 / 2 + k_f x^2 / 2 + s F x is constant
            total = left + 0.5 * k_f * yields**2 + sign * force * yields
            balance = sign * force / k_f
            u = -balance + sign * math.sqrt(balance**2 + 2.0 * total / k_f)
            spring = sign * force
        extrema.append(u)
        energy, sign = 0.0, -sign
    return extrema
