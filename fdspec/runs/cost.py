"""What histories cost before any has run: the one place of every constant of core time.

Rough, within a factor of five on today's processors: for plans and refusals, never for results.  What a sweep
costs on this machine, `fdspec.runs.pilot` measures.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.engines.step_count import fastest_rate, parts_of_storeys, steps_of_building
from fdspec.model.building import Building
from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.columns import frames_of

FloatArray = NDArray[np.float64]

PER_SAMPLE: Final = 8e-9
"""s for one history of a sweep and sample; the four lanes of a core share it."""

PER_STEP: Final = 9e-9
"""s more for each further step within a sample, as floor and brace swing together."""

PER_BRACE_STEP: Final = 1.5e-9
"""s for each radian that the brace swings on its own while it slips, beyond BRACE_FREE of them a sample."""

BRACE_FREE: Final = 10.0

CERTIFIED: Final = 1.35
"""Times that a sweep takes with ``energy_error``."""

PER_LONE_SAMPLE: Final = 60e-9
"""s for one history of a single storey on its own, and sample."""

PER_STOREY: Final = 0.12e-6
"""s for one history of an N-storey building, for each step and N^1.5."""

PER_DEVICE: Final = 2e-6
"""s for one history of a building with devices, for each step and N^1.5."""

STRAIN: Final = 4.0
"""Times that a history takes with outputs of strain energy."""

PER_SEARCH: Final = 20e-6
"""s for the search of the best pretension of one frame, for each sample."""

PER_OSCILLATOR: Final = 40e-9
"""s for one history of a bilinear oscillator, for each sample."""

TRIED: Final = 50
"""Points of an axis that estimates look at."""


def seconds_of_sweep(grid: Grid, motions: Sequence[GroundMotion], certify: bool = True) -> list[float]:
    """Core time of all histories under each motion, s."""
    part = replace(
        grid,
        stiffness_ratio=grid.stiffness_ratio[middles(grid.stiffness_ratio.size, TRIED)],
        period=grid.period[middles(grid.period.size, TRIED)],
    )
    brace = fastest_rate(*_frames(part).T[3:])
    found = []
    for motion in motions:
        steps = steps_per_sample(part, motion.dt).ravel()
        if grid.devices:
            found.append(float(steps.mean()) * motion.n * grid.size * PER_DEVICE)
            continue
        swings = np.maximum(0.0, brace * motion.dt - BRACE_FREE)
        rate = PER_SAMPLE + PER_STEP * (steps - 1.0) + PER_BRACE_STEP * swings
        found.append(float(rate.mean()) * motion.n * grid.size * (CERTIFIED if certify else 1.0))
    return found


def seconds_of_history(building: Building, dt: float, samples: float) -> float:
    """Core time of one history of this many samples, s."""
    steps = steps_of_building(building, dt)
    if building.has_devices:
        return samples * steps * PER_DEVICE * math.pow(building.n_storeys, 1.5)
    if building.n_storeys == 1:
        return samples * (PER_LONE_SAMPLE + PER_BRACE_STEP * steps)
    return samples * steps * PER_STOREY * math.pow(building.n_storeys, 1.5)


def steps_per_sample(grid: Grid, dt: float) -> FloatArray:
    """Steps that a history takes in each sample, (stiffness ratio, period), segments of slip not counted."""
    steps = parts_of_storeys(_frames(grid), dt)
    return steps.reshape(grid.stiffness_ratio.size, grid.period.size)


def middles(size: int, count: int) -> NDArray[np.int64]:
    """Positions of at most `count` things of so many: in the middle of as many equal shares."""
    count = min(size, count)
    return ((np.arange(count) + 0.5) * size / count).astype(np.int64)


def _frames(grid: Grid) -> FloatArray:
    return frames_of(grid, np.arange(grid.stiffness_ratio.size * grid.period.size))
