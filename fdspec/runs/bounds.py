"""What a run may take: its memory, disk and time are estimated before it begins, and refused where absurd.

A slipped decimal in a step makes 10^15 histories, a period in the wrong unit a million steps a sample.
Estimates of time are rough, within a factor of five; the limit is far above what anybody waits for.
"""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]

VARIABLE: Final = "FDSPEC_CORE_HOURS"
"""The environment variable that sets the limit of core time, h."""

SWEEP_HOURS: Final = 1000.0
"""h of core time that a sweep may be expected to take, unless the user says otherwise."""

HISTORY_HOURS: Final = 0.5
"""h that a single history may be expected to take: nothing is seen of it before it ends."""

PER_SAMPLE: Final = 8e-9
"""s of core time for one history and sample."""

PER_STEP: Final = 9e-9
"""s more for each further step within a sample, as floor and brace swing together."""

PER_BRACE_STEP: Final = 1.5e-9
"""s for each radian that the brace swings on its own while it slips, beyond BRACE_FREE of them a sample."""

BRACE_FREE: Final = 10.0

PER_STOREY: Final = 0.8e-6
"""s for one history of an N-storey building, for each step and N^1.5."""

PER_DEVICE: Final = 8e-6
"""s for one history of a building with devices, for each step and N^1.5."""

TRIED: Final = 50
"""Points of an axis that estimates look at."""


def seconds_of_sweep(grid: Grid, motions: Sequence[GroundMotion], certify: bool = True) -> list[float]:
    """Core time of all histories under each motion, s, roughly."""
    ratio, period = _spread(grid.stiffness_ratio)[:, np.newaxis], _spread(grid.period)
    bare = 2.0 * np.pi / period
    held = bare * np.sqrt((1.0 + ratio) / (1.0 + grid.brace_mass / grid.floor_mass))
    brace = bare * np.sqrt(ratio * grid.floor_mass / grid.brace_mass) if grid.brace_mass > 0.0 else 0.0
    found = []
    for motion in motions:
        steps = np.maximum(1.0, np.ceil(held * motion.dt)) - 1.0
        if grid.devices:
            found.append(float(steps.mean() + 1.0) * motion.n * grid.size * PER_DEVICE)
            continue
        swings = np.maximum(0.0, brace * motion.dt - BRACE_FREE)
        rate = PER_SAMPLE + PER_STEP * steps + PER_BRACE_STEP * swings
        found.append(float(rate.mean()) * motion.n * grid.size * (1.35 if certify else 1.0))
    return found


def seconds_of_history(building: Building, dt: float, samples: float) -> float:
    """Core time of one history of this many samples, s, roughly."""
    mass = np.concatenate([building.floor_mass, building.brace_mass])
    brace = building.brace_stiffness
    floor = np.abs(building.stiffness_matrix).sum(axis=1) + 2.0 * brace
    floor[:-1] += 2.0 * brace[1:]
    moving = mass > 0.0
    fastest = float(np.sqrt(np.max(np.concatenate([floor, brace])[moving] / mass[moving])))
    steps = max(1.0, fastest * dt)
    if building.has_devices:
        return samples * steps * PER_DEVICE * math.pow(building.n_storeys, 1.5)
    if building.n_storeys == 1:
        return samples * (PER_SAMPLE + PER_BRACE_STEP * steps)
    return samples * steps * PER_STOREY * math.pow(building.n_storeys, 1.5)


def refuse_long(seconds: float, default_hours: float, what: str) -> None:
    """Raise InvalidInput when what is to run would take longer than the limit."""
    told = os.environ.get(VARIABLE, "")
    try:
        limit = float(told) if told else default_hours
    except ValueError:
        raise InvalidInput(f"{VARIABLE} must be a number of hours, got {told!r}") from None
    if not seconds <= 3600.0 * limit:
        raise InvalidInput(
            f"{what} would take about {seconds / 3600.0:.2g} hours of core time, over the limit of "
            f"{limit:g}: are period, brace mass, dt and the axes what they should be? {VARIABLE} raises "
            "the limit"
        )


def refuse_large(n_bytes: float, what: str, *, folder: Path | None = None) -> None:
    """Raise InvalidInput for results larger than the free memory or, with a folder, its free disk."""
    free = memory_free() if folder is None else _disk_free(folder)
    if free is not None and n_bytes > free:
        where = "of memory" if folder is None else f"on the disk of {folder}"
        remedy = "; a store, such as cube.zarr, needs no memory for it" if folder is None else ""
        raise InvalidInput(f"{what} would take {_size(n_bytes)}, but {_size(free)} {where} are free{remedy}")


def memory_free() -> float | None:
    """Bytes of memory that this process may still take, None where the system does not tell."""
    found = []
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as lines:
            found += [1024.0 * float(line.split()[1]) for line in lines if line.startswith("MemAvailable:")]
    except (OSError, ValueError):
        pass
    try:
        limit, used = (
            Path(f"/sys/fs/cgroup/memory.{name}").read_text("ascii") for name in ("max", "current")
        )
        if limit.strip() != "max":
            found.append(float(limit) - float(used))
    except (OSError, ValueError):
        pass
    if not found and hasattr(os, "sysconf") and {"SC_PHYS_PAGES", "SC_PAGE_SIZE"} <= os.sysconf_names.keys():
        found.append(float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE"))
    return min(found, default=None)


def _disk_free(folder: Path) -> float | None:
    try:
        return float(shutil.disk_usage(folder).free)
    except OSError:
        return None


def _spread(axis: FloatArray) -> FloatArray:
    """Points of an axis that stand for all: in the middle of as many equal shares."""
    count = min(axis.size, TRIED)
    return axis[((np.arange(count) + 0.5) * axis.size / count).astype(np.int64)]


def _size(n_bytes: float) -> str:
    for unit in ("bytes", "kB", "MB", "GB"):
        if n_bytes < 1000.0:
            return f"{n_bytes:.3g} {unit}"
        n_bytes /= 1000.0
    return f"{n_bytes:.3g} TB"
