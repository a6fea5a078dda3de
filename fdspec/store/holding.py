"""Hold a store that is being read, so that nobody removes it meanwhile."""

from __future__ import annotations

import gc
import os
from contextlib import suppress
from pathlib import Path


def hold(root: Path) -> int | None:
    """Share the lock of a store's folder; None where there are no locks, or too many files are open."""
    if os.name == "nt":
        return None
    import fcntl

    try:
        descriptor = os.open(root, os.O_RDONLY)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def is_held(root: Path) -> bool:
    """Whether somebody, in this process or another, has the store open."""
    if os.name == "nt":
        return False  # there nobody can remove what is open
    import fcntl

    gc.collect()  # what nobody uses any more holds nothing
    with suppress(OSError):
        descriptor = os.open(root, os.O_RDONLY)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        finally:
            os.close(descriptor)
    return False
