"""Steady states of a shaken floor that rubs on the ground, without stops, whose amplitude is a formula."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from fdspec.methods import EXACT, Method
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import rubbing
from fdspec.verification.row import Row, relative, same_count

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

BRACE_OMEGA: Final = 1.5e4
"""rad/s"""

STEADY: Final = 1e-6
"""What the lag of the brace behind the ground leaves, (omega / brace's omega)^2 over the amplitude."""


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    yield from den_hartog(DEN_HARTOG if full else DEN_HARTOG[:5])
    yield from shaken_block()


def den_hartog(cases: tuple[tuple[float, float, float, int], ...]) -> Iterator[Row]:
    """Steady state without stops (Den Hartog 1931), the ground shaken at a0 cos(w t)."""
    omega_n, acceleration, mass, per_cycle = 2.0 * math.pi, 1.0, 1000.0, 500
    for r, beta, zeta, cycles in cases:
        frame = rubbing(mass, mass * omega_n**2, zeta, beta * mass * acceleration, BRACE_OMEGA, 1e6, 1.0)
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
    mass, omega, acceleration, per_cycle = 1000.0, 2.0 * math.pi, 3.0, 500
    for beta in (0.2, 0.53):
        frame = rubbing(
            mass, mass * (omega * 1e-5) ** 2, 0.0, beta * mass * acceleration, BRACE_OMEGA, 1e6, 1.0
        )
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

    The floor turns where its sliding turns, so its extrema are at the changes of phase: read by a cubic from
    the sample before each, for acceleration jumps at it.  A cosine through straight lines has the amplitude
    (sin(x)/x)^2, x = omega dt / 2, which is put back.
    """
    dt = 2.0 * math.pi / omega / per_cycle
    x = 0.5 * omega * dt
    cosine = np.cos(omega * dt * np.arange(cycles * per_cycle + 1))
    motion = GroundMotion(acceleration / (math.sin(x) / x) ** 2 * cosine, dt)
    history = simulate(frame, motion, method=method)
    times = history["transition_time"].values
    late = times[times > (cycles - 2) * per_cycle * dt]
    at = np.minimum((late / dt).astype(np.int64), motion.n - 1)
    tau = late - at * dt
    u, v = history["displacement"].values[:, 0], history["velocity"].values[:, 0]
    a = history["acceleration"].values[:, 0] - motion.acceleration
    jerk = (a[at] - a[at - 1]) / dt
    turns = u[at] + v[at] * tau + a[at] * tau**2 / 2.0 + jerk * tau**3 / 6.0
    if not turns.size:
        return math.nan, math.nan, 0
    return float(turns.max()), float(-turns.min()), turns.size
