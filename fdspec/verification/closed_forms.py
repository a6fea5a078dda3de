"""Free vibrations whose extrema are formulas."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import rubbing, still
from fdspec.verification.row import Row, absolute, relative


def rows(full: bool) -> Iterator[Row]:  # noqa: ARG001
    """Yield the rows of this family."""
    yield from free_decay()
    yield from free_vibration()
    yield from massless_brace()


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


def crest(samples: FloatArray) -> float:
    """Largest value of the parabola through the largest sample inside and its neighbours."""
    i = int(np.argmax(samples[1:-1])) + 1
    before, at, after = samples[i - 1 : i + 2]
    return float(at + (after - before) ** 2 / (8.0 * (2.0 * at - before - after)))
