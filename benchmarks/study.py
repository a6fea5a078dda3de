"""The whole study: nine records of the catalogue, 41 580 histories; the fixed-step side is extrapolated."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

import fdspec
from benchmarks import fixed_step, timing
from tests.oracle import sdof_events

NAMES = ("FSR1", "FSR2", "FSR3", "FMR1", "FMR2", "FMR3", "FHR1", "FHR2", "FHR3")
AXES: dict[str, Any] = {
    "stiffness_ratio": [0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0],
    "pretension": 10e3 + 100e3 * np.arange(11),
    "period": 0.05 * np.arange(1, 61),
}


def records() -> list[fdspec.GroundMotion]:
    """The catalogue's nine, as the study scales them."""
    return [fdspec.load_record(name) for name in NAMES]


def sweep(motions: list[fdspec.GroundMotion], *, workers: int, certify: bool, **axes: Any) -> xr.Dataset:
    """The cube of the study over these records."""
    return fdspec.sweep(motions, workers=workers, certify=certify, **{**AXES, **axes})


def fixed_step_core_seconds(motions: list[fdspec.GroundMotion], seed: int = 3) -> tuple[float, int]:
    """Core seconds of the study's scheme at 1e-6 s, from one cell a record, and how many were timed.

    The cost of a step hardly depends on the cell: each record's histories cost what its sample did.
    """
    rng = np.random.default_rng(seed)
    histories = np.prod([len(axis) for axis in AXES.values()])
    total = 0.0
    for motion in motions:
        storey = sdof_events.Storey.from_period(
            float(rng.choice(AXES["period"])),
            float(rng.choice(AXES["stiffness_ratio"])),
            0.5 * float(rng.choice(AXES["pretension"][:3])),
        )
        divisions = round(motion.dt / 1e-6)

        def run(motion: fdspec.GroundMotion = motion, s: Any = storey, divisions: int = divisions) -> None:
            fixed_step.integrate(
                s.floor_mass,
                s.floor_damping,
                s.floor_stiffness,
                s.brace_mass,
                s.brace_damping,
                s.brace_stiffness,
                s.static_force,
                np.array(motion.acceleration),
                motion.dt,
                divisions,
            )

        total += timing.once(run) * float(histories)
    return total, len(motions)
