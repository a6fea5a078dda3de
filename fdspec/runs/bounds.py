"""What a run may take of memory, disk and time: more than that is refused before it begins.

A slipped decimal in a step makes 10^15 histories, a period in the wrong unit a million steps a sample.  The
time is that of `fdspec.runs.cost`; its limit is far above what anybody waits for.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final

from fdspec.errors import InvalidInput

VARIABLE: Final = "FDSPEC_CORE_HOURS"
"""The environment variable that sets the limit of core time, h."""

SWEEP_HOURS: Final = 1000.0
"""h of core time that a sweep may be expected to take, unless the user says otherwise."""

HISTORY_HOURS: Final = 0.5
"""h that a single history may be expected to take: nothing is seen of it before it ends."""


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


PACKED: Final = 0.1
"""Share of their size that results take on disk at the least; a study's cube takes a quarter."""


def refuse_large(n_bytes: float, what: str, *, folder: Path | None = None) -> None:
    """Raise InvalidInput for results larger than the free memory or, with a folder, its free disk.

    On disk they are packed; what surely does not fit even so is refused.
    """
    free = memory_free() if folder is None else _disk_free(folder)
    if folder is not None:
        n_bytes *= PACKED
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


def _size(n_bytes: float) -> str:
    for unit in ("bytes", "kB", "MB", "GB"):
        if n_bytes < 1000.0:
            return f"{n_bytes:.3g} {unit}"
        n_bytes /= 1000.0
    return f"{n_bytes:.3g} TB"
