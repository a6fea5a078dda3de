"""The folder that keeps compiled kernels: where it is, who fills it, what is cleared away.

numba writes each file of its cache as a whole, but the index and the files that it names are several: of
processes that filled one cache at once, some left an index that later starts could not load.  So one process
compiles a kernel under a lock and the others wait for it; what is compiled is loaded without one.
"""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Final

UNUSED: Final = 30 * 86400.0
"""s; a folder that no process has used for so long belongs to sources that are gone."""


def cache_folder(key: str, named: str = "") -> Path | None:
    """Return a writable folder for what is compiled from sources of this key, or None where there is none.

    named: the folder that the user chose; else the user's cache folder, then the system's temporary folder
    (read-only homes are common on clusters).
    """
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    user = f"fdspec-{os.getuid()}" if hasattr(os, "getuid") else "fdspec"
    candidates = [Path(named)] if named else [home / "fdspec", Path(tempfile.gettempdir()) / user]
    for candidate in candidates:
        folder = candidate / key
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                pass
            os.utime(folder)  # the time of last use, which `prune` goes by
        except OSError:
            continue
        return folder
    return None


@contextmanager
def compiling(folder: Path | None, kernel: str) -> Iterator[None]:
    """Let one process at a time through this block, until one has come to its end; then all at once.

    kernel: a name that says what is compiled, from which file, for which machine.  The system takes the lock
    from a process that dies.
    """
    if folder is None or (done := folder / f"{kernel}.compiled").exists():
        yield
        return
    with (folder / f"{kernel}.lock").open("wb") as file:
        _lock(file)
        first = not done.exists()
        yield
        if first:
            with suppress(OSError):
                done.touch()
            prune(folder)


def prune(folder: Path, *, unused: float = UNUSED) -> None:
    """Remove the folders beside this one that were made for other sources and not used for so long, s."""
    oldest = time.time() - unused
    for other in folder.parent.iterdir():
        with suppress(OSError):
            ours = re.fullmatch("[0-9a-f]{16}", other.name) and other.is_dir() and not other.is_symlink()
            if ours and other != folder and other.stat().st_mtime < oldest:
                shutil.rmtree(other, ignore_errors=True)


def _lock(file: IO[bytes]) -> None:
    """Wait for the lock; go on without one where the system or the file system has none."""
    try:
        import fcntl
    except ImportError:
        return
    with suppress(OSError):
        fcntl.flock(file, fcntl.LOCK_EX)
