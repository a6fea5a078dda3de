"""Random buildings of a few storeys, for the tests that compare two ways to one answer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import fdspec


@dataclass(frozen=True)
class Case:
    """A random building: N storeys, some without a brace, some with kinetic friction or a damped brace."""

    seed: int
    storeys: int

    def __str__(self) -> str:
        return f"{self.storeys} storeys, seed {self.seed}"

    @property
    def building(self) -> fdspec.Building:
        rng = np.random.default_rng(self.seed)
        n = self.storeys
        floor = rng.uniform(20e3, 60e3, n)
        stiffness = rng.uniform(0.5, 2.0, n) * np.mean(floor) * (2.0 * math.pi / (0.12 * n)) ** 2 * n
        brace = rng.uniform(0.3, 6.0, n) * stiffness
        mass = np.exp(rng.uniform(math.log(40.0), math.log(2000.0), n))
        force = np.exp(rng.uniform(math.log(5e3), math.log(80e3), n))
        kinetic = force * np.where(rng.random(n) < 0.3, rng.uniform(0.5, 1.0, n), 1.0)
        ratio = np.where(rng.random(n) < 0.3, rng.uniform(0.0, 0.2, n), 0.0)
        bare = rng.random(n) < 0.15
        brace[bare] = mass[bare] = force[bare] = kinetic[bare] = ratio[bare] = 0.0
        return fdspec.Building(
            floor_mass=floor,
            storey_stiffness=stiffness,
            brace_mass=mass,
            brace_stiffness=brace,
            slip_force=force,
            kinetic_slip_force=kinetic,
            damping=fdspec.ModalDamping(float(rng.uniform(0.0, 0.1))),
            brace_damping=2.0 * ratio * np.sqrt(brace * mass),
        )


CASES = [Case(seed, storeys) for storeys in (2, 3) for seed in range(6)] + [Case(20, 5)]
