"""Random single-storey cells over all of the range fdspec promises, to compare two ways to one answer.

Cell ``draw(i)`` depends on i alone, so a failing one is reproduced by its number: its ``str`` is that line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

G = 9.80665
FLOOR_MASS = 20e3
FASTEST_BRACE = 5e4
"""rad/s"""


CHAOTIC = (279, 5213)
"""Cells whose exact answer moves by more than 1e-11 with the last bit of their slip force.

Kinetic friction is 0.6 of static in both, with 10 000 and 14 000 changes of phase in three seconds: a
difference grows a hundred thousandfold and more. tests/oracle/test_single_storey.py shows it without fdspec.
"""


@dataclass(frozen=True)
class Cell:
    """SI units; ``slip_force`` may be 0 or infinite."""

    number: int
    period: float
    stiffness_ratio: float
    slip_force: float
    kinetic_slip_force: float
    damping_ratio: float
    brace_mass: float
    brace_damping_ratio: float
    dt: float
    duration: float
    pga: float

    def __str__(self) -> str:
        fields = ", ".join(f"{k}={v!r}" for k, v in vars(self).items() if k in self.__dataclass_fields__)
        return f"tests.cells.draw({self.number})  # {fields}"

    @cached_property
    def acceleration(self) -> NDArray[np.float64]:
        """Ground acceleration (m/s2): twelve sines under a rise and a decay, and a little noise."""
        rng = np.random.default_rng([self.number, 1])
        n = max(3, round(self.duration / self.dt) + 1)
        t = np.arange(n) * self.dt
        f = np.exp(rng.uniform(math.log(0.3), math.log(15.0), 12))
        phi = rng.uniform(0.0, 2.0 * math.pi, 12)
        x = np.sum(np.sin(2.0 * math.pi * f[:, None] * t + phi[:, None]) / np.sqrt(f)[:, None], axis=0)
        x += 0.05 * rng.standard_normal(n)
        x *= np.minimum(1.0, t / (0.15 * self.duration)) * np.exp(-t / self.duration)
        return np.asarray(x * self.pga / np.max(np.abs(x)))

    @property
    def halved(self) -> NDArray[np.float64]:
        """The same motion with a sample at the middle of every step."""
        x = self.acceleration
        fine = np.empty(2 * len(x) - 1)
        fine[::2] = x
        fine[1::2] = 0.5 * (x[:-1] + x[1:])
        return fine


def draw(number: int) -> Cell:
    """Period 0.02 to 10 s, SR 0.05 to 50, slip force 0 to 5 floor weights, damping 0 to 0.3.

    Brace 1 to 5000 kg and at most 5e4 rad/s, dt 0.001 to 0.05 s, 2 to 4 s of motion, PGA 0.05 to 1 g. More
    than half of the slip forces lie where they matter, about the force that the locked storey would feel.
    """
    rng = np.random.default_rng([number, 0])

    def between(low: float, high: float) -> float:
        return float(math.exp(rng.uniform(math.log(low), math.log(high))))

    period, ratio = between(0.02, 10.0), between(0.05, 50.0)
    pga = G * between(0.05, 1.0)
    weight = FLOOR_MASS * G
    brace_stiffness = ratio * FLOOR_MASS * (2.0 * math.pi / period) ** 2
    brace_mass = between(max(1.0, brace_stiffness / FASTEST_BRACE**2), 5000.0)
    kind = rng.integers(20)
    if kind == 0:
        force = 0.0
    elif kind == 1:
        force = 5.0 * weight
    elif kind < 8:
        force = float(rng.uniform(0.0, 5.0 * weight))
    else:
        force = between(0.005, 2.0) * ratio / (1.0 + ratio) * FLOOR_MASS * pga
    kinetic = force * (float(rng.uniform(0.3, 1.0)) if rng.integers(3) == 0 else 1.0)
    damping = 0.0 if rng.integers(8) == 0 else float(rng.uniform(0.0, 0.3))
    brace_damping = float(rng.uniform(0.0, 0.3)) if rng.integers(4) == 0 else 0.0
    return Cell(
        number,
        period,
        ratio,
        force,
        kinetic,
        damping,
        brace_mass,
        brace_damping,
        between(0.001, 0.05),
        float(rng.uniform(2.0, 4.0)),
        pga,
    )
