"""Symmetry and scaling: a mirrored ground mirrors the answer, ground and friction scale it together."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import frame, noise, two_storeys
from fdspec.verification.row import Row, relative, same_count

WITHIN = 1e-9
FACTOR = 1.7


def rows(full: bool) -> Iterator[Row]:  # noqa: ARG001
    """Yield the rows of this family."""
    motion = noise(6.0, 0.01, seed=21)
    cases = {"one storey": frame(0.5, 4.0, 40e3), "two storeys": two_storeys()}
    for name, building in cases.items():
        plain = simulate(building, motion)
        expected = float(plain["peak_acceleration"][-1])
        count = int(plain["transitions"])
        mirrored = simulate(building, GroundMotion(-motion.acceleration, motion.dt, "mirrored"))
        case = f"mirrored ground, {name}"
        computed = float(mirrored["peak_acceleration"][-1])
        yield relative(case, "peak acceleration, m/s2", expected, computed, WITHIN)
        final, other = plain["displacement"].values[-1, -1], mirrored["displacement"].values[-1, -1]
        yield relative(case, "final displacement, m", float(-final), float(other), WITHIN)
        yield same_count(case, "changes of phase", count, int(mirrored["transitions"]))
        louder = GroundMotion(FACTOR * motion.acceleration, motion.dt, "louder")
        scaled = simulate(with_forces(building, FACTOR), louder)
        case = f"ground and friction times {FACTOR:g}, {name}"
        computed = float(scaled["peak_acceleration"][-1])
        yield relative(case, "peak acceleration, m/s2", FACTOR * expected, computed, WITHIN)
        yield same_count(case, "changes of phase", count, int(scaled["transitions"]))
        longer = GroundMotion(np.append(motion.acceleration, np.zeros(50)), motion.dt, "longer")
        after = simulate(building, longer)
        case = f"half a second of rest behind the record, {name}"
        there = float(after["displacement"].values[motion.n - 1, -1])
        yield relative(case, "displacement at its end, m", float(final), there, WITHIN)


def with_forces(building: Building, factor: float) -> Building:
    """Return the building with its slip forces times a factor."""
    return Building(
        building.floor_mass,
        building.storey_stiffness,
        building.brace_mass,
        building.brace_stiffness,
        factor * building.slip_force,
        factor * building.kinetic_slip_force,
        building.damping,
        building.brace_damping,
    )
