"""Random frames with massless braces: every mixture that the law of such a brace has to bear."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import fdspec
from fdspec.model.damping import ModalDamping
from fdspec.model.springs import shear_matrix

STOREYS = (1, 2, 2, 3, 3, 4, 5, 6, 8, 12)


class Drawn(NamedTuple):
    """A building, its motion, the start (2, 2, N) and how many steps of free vibration follow."""

    building: fdspec.Building
    motion: fdspec.GroundMotion
    start: NDArray[np.float64]
    free_steps: int


def draw(
    seed: int,
    *,
    storeys: tuple[int, ...] = STOREYS,
    shortest_period: float = 0.03,
    weakest_dashpot: float = 1e-5,
    all_massless: bool = False,
) -> Drawn:
    """Draw one; forces from nearly nothing to never, dashpots from weak to half of critical, and none."""
    rng = np.random.default_rng([77, seed])
    n = int(rng.choice(storeys))
    mass = rng.uniform(10e3, 150e3, n)
    if rng.random() < 0.3:
        mass[:] = mass[0]
    period = math.exp(rng.uniform(math.log(shortest_period), math.log(0.4))) * n
    stiffness = mass.mean() * (2.0 * math.pi / period) ** 2 * n * rng.uniform(0.5, 2.0, n)
    brace = stiffness * np.exp(rng.uniform(math.log(0.05), math.log(20.0), n))
    force, kinetic = _forces(rng, mass)
    dashpot = np.zeros(n)
    damped = rng.random(n) < rng.choice([0.0, 0.5, 1.0])
    share = np.exp(rng.uniform(math.log(weakest_dashpot), math.log(0.5), n))
    dashpot[damped] = (2.0 * np.sqrt(brace * mass) * share)[damped]
    brace_mass = np.zeros(n)
    if rng.random() < 0.3 and not all_massless:
        heavy = rng.random(n) < 0.5
        brace_mass[heavy] = np.exp(rng.uniform(math.log(20.0), math.log(2000.0), n))[heavy]
        dashpot[heavy] *= np.sqrt(brace_mass / mass)[heavy]
    bare = rng.random(n) < rng.choice([0.0, 0.0, 0.2])
    for array in (brace, dashpot, brace_mass, force, kinetic):
        array[bare] = 0.0
    given = stiffness
    if n > 1 and rng.random() < 0.2:  # no shear building
        spread = rng.normal(size=(n, n)) * 0.05 * math.sqrt(stiffness.mean())
        given = shear_matrix(stiffness) + spread @ spread.T
        given = 0.5 * (given + given.T)
    damping = ModalDamping(float(rng.choice([0.0, 0.02, 0.05, 0.1])))
    building = fdspec.Building(mass, given, brace_mass, brace, force, kinetic, damping, dashpot)
    motion = _motion(rng)
    start = np.zeros((2, 2, n))
    if not motion.acceleration.any() or rng.random() < 0.4:
        start[0] = rng.normal(size=n) * 0.01
        start[1] = rng.normal(size=n) * 0.05 * rng.choice([0.0, 1.0])
        if rng.random() < 0.3:
            start[0, 1] = rng.normal(size=n) * 0.01
    return Drawn(building, motion, start, int(rng.choice([0, 0, 50])))


def _forces(
    rng: np.random.Generator, mass: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Static and kinetic: none, tiny, equal, infinite; kinetic none, below, just below, the same."""
    n = mass.size
    scale = mass.mean() * math.exp(rng.uniform(math.log(0.05), math.log(10.0))) * math.sqrt(n)
    force = scale * np.exp(rng.uniform(math.log(0.05), math.log(3.0), n))
    if rng.random() < 0.3:
        force[:] = force[0]
    if rng.random() < 0.05:
        force *= 10.0 ** -rng.uniform(3.0, 12.0)
    which, nothing, never = rng.random(n), rng.choice([0.0, 0.2, 0.5]), rng.choice([0.0, 0.1, 0.4])
    force[which < nothing] = 0.0
    ratio = (1.0, 0.0, rng.uniform(0.1, 1.0), 0.9, 1.0 - 10.0 ** -rng.uniform(2.0, 12.0))[rng.integers(5)]
    kinetic = np.where(rng.random(n) < rng.choice([0.5, 1.0]), ratio, 1.0) * force
    force[which > 1.0 - never] = kinetic[which > 1.0 - never] = math.inf
    return force, kinetic


def _motion(rng: np.random.Generator) -> fdspec.GroundMotion:
    """None, constant, harmonic, noise, a ramp or a decaying sine; up to 50 m/s2."""
    n, dt = int(rng.integers(20, 250)), float(rng.choice([0.005, 0.01, 0.02]))
    t = np.arange(n) * dt
    peak = math.exp(rng.uniform(math.log(0.2), math.log(10.0)))
    shapes = (
        np.zeros(n),
        np.ones(n),
        np.sin(2.0 * np.pi * t / math.exp(rng.uniform(math.log(0.1), math.log(2.0)))),
        np.clip(rng.normal(size=n), -4.0, 4.0),
        np.linspace(0.0, 1.0, n),
        np.sin(6.0 * np.pi * t) * np.exp(-t),
    )
    return fdspec.GroundMotion(peak * shapes[rng.integers(len(shapes))], dt)
