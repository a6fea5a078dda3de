"""Whether what a file opens to fits into memory, before it is read."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from fdspec.errors import StoreError

if TYPE_CHECKING:
    import xarray as xr

SMALL: Final = 256e6
"""Bytes that are read without a question."""

SWOLLEN: Final = 300.0
"""Bytes in memory over bytes on disk, beyond what numbers of a sweep compress to."""


def check_size(dataset: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Raise StoreError for a dataset that is larger than the memory that is free, or swollen by design."""
    held = dataset.nbytes
    if held <= SMALL:
        return
    remedy = "open it with lazily=True, or take a part of it"
    free = available()
    if free is not None and held > free:
        raise StoreError(
            f"cannot open {os.fspath(path)}: it needs {held / 1e9:.1f} GB of memory, {free / 1e9:.1f} GB are "
            f"free; {remedy}"
        )
    size = Path(path).stat().st_size if Path(path).is_file() else held
    if held > SWOLLEN * size:
        raise StoreError(
            f"cannot open {os.fspath(path)}: {size / 1e6:.1f} MB on disk would become {held / 1e9:.1f} GB in "
            f"memory, which no result does; {remedy}"
        )


def available() -> int | None:
    """Bytes of memory that are free for a program; None where that is not told."""
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as file:
            for line in file:
                if line.startswith("MemAvailable:"):
                    return 1024 * int(line.split()[1])
    except (OSError, ValueError):
        return None
    return None
