"""The folder that keeps compiled kernels: where it is, who may write there, who fills it, what goes again.

numba unpickles what it finds in its cache, so that whoever can write there runs code here: the folder must be
the user's own and nobody else's to write in or to exchange, or there is none.  What is damaged ends in a
traceback or a crash inside numba: each kernel has a list of its files' digests, compared before numba
opens any, and is compiled anew where they differ.

numba writes each file of its cache as a whole, but the index and the files that it names are several: of
processes that filled one cache at once, some left an index that later starts could not load.  So one process
compiles a kernel under a lock and the others wait for it; what is compiled is loaded without one.
"""

from __future__ import annotations

import hashlib
import multiprocessing
import os
import re
import shutil
import stat
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import IO, Final

UNUSED: Final = 30 * 86400.0
"""s; a folder that no process has used for so long belongs to sources that are gone."""

OTHERS_WRITE: Final = stat.S_IWGRP | stat.S_IWOTH


def cache_folder(key: str, named: str = "") -> Path | None:
    """Return the user's own folder for what is compiled from sources of this key; warn and give None if none.

    named: the folder that the user chose; else the user's cache folder, then one in the system's temporary
    folder (read-only homes are common on clusters).
    """
    refused = []
    for candidate in [Path(named)] if named else list(_usual()):
        folder = (candidate / key).absolute()
        try:
            _make(folder)
            if reason := not_safe(folder):
                refused.append(reason)
                continue
            with tempfile.TemporaryFile(dir=folder):
                pass
            os.utime(folder)  # the time of last use, which `prune` goes by
        except OSError as error:
            refused.append(f"{candidate}: {error.strerror}")
            continue
        return folder.resolve()
    tell("; ".join(refused) or "there is no home folder")
    return None


def tell(reason: str) -> None:
    """Warn that nothing compiled is kept; once for all processes of this program."""
    if multiprocessing.parent_process() is None:
        warnings.warn(
            f"compiled kernels cannot be kept ({reason}): every start will compile them, for about a "
            "quarter of a minute; FDSPEC_CACHE_DIR can name a folder that only you can write in",
            stacklevel=3,
        )


@cache
def say_once() -> None:
    """Tell whoever waits at a terminal or a notebook that kernels are compiled."""
    notebook = "ipykernel" in sys.modules
    if multiprocessing.parent_process() is None and (sys.stderr.isatty() or notebook):
        print(  # noqa: T201
            "fdspec: compiling kernels, once for this version and processor: about a quarter of a minute",
            file=sys.stderr,
            flush=True,
        )


def not_safe(folder: Path) -> str:
    """Say why other users could put files into this folder or exchange it; "" if they cannot.

    Looked at are the folder and all above it, along the path as given and where its links lead.  Folders
    above may be writable by all with the sticky bit set, as the system's temporary folder is: what the user
    owns there only the user can rename.
    """
    if not hasattr(os, "getuid"):
        return ""
    real = folder.resolve()
    for path in dict.fromkeys([real, folder, *real.parents, *folder.parents]):
        state = path.lstat()
        if state.st_uid not in {os.getuid(), 0}:
            return f"{path} belongs to another user"
        if stat.S_ISLNK(state.st_mode):
            continue
        sticky = state.st_mode & stat.S_ISVTX and path not in {real, folder}
        if state.st_mode & OTHERS_WRITE and not sticky and not _private_group(state):
            return f"{path} is writable by others"
    return ""


@contextmanager
def compiling(folder: Path | None, kernel: str) -> Iterator[Path | None]:
    """Give the folder of this kernel's files: whole, or empty and to be filled by this process alone.

    kernel: a name that says what is compiled, from which file, by what, for which machine.  The system takes
    the lock from a process that dies.
    """
    if folder is None:
        yield None
        return
    mine, listed = folder / kernel, folder / f"{kernel}.sha256"
    if _whole(mine, listed):
        yield mine
        return
    with (folder / f"{kernel}.lock").open("wb") as file:
        _lock(file)
        first = not _whole(mine, listed)
        if first:
            _clear(mine, listed)
            mine.mkdir(mode=0o700)
            say_once()
        yield mine
        if first:
            with suppress(OSError):
                _list(mine, listed)
            prune(folder)


def prune(folder: Path, *, unused: float = UNUSED) -> None:
    """Remove the folders beside this one that were made for other sources and not used for so long, s."""
    oldest = time.time() - unused
    for other in folder.parent.iterdir():
        with suppress(OSError):
            ours = re.fullmatch("[0-9a-f]{16}", other.name) and other.is_dir() and not other.is_symlink()
            if ours and other != folder and other.stat().st_mtime < oldest:
                shutil.rmtree(other, ignore_errors=True)


def _usual() -> Iterator[Path]:
    """Give the folders to try where the user has named none."""
    if os.environ.get("XDG_CACHE_HOME"):
        yield Path(os.environ["XDG_CACHE_HOME"]) / "fdspec"
    else:
        with suppress(RuntimeError):  # no HOME, and a user whom the system does not know
            yield Path.home() / ".cache" / "fdspec"
    yield Path(tempfile.gettempdir()) / (f"fdspec-{os.getuid()}" if hasattr(os, "getuid") else "fdspec")


def _make(folder: Path) -> None:
    """Make a folder and what is missing above it, all for this user alone."""
    for path in (*reversed(folder.parents), folder):
        if not path.is_dir():
            with suppress(FileExistsError):
                path.mkdir(mode=0o700)


def _private_group(state: os.stat_result) -> bool:
    """Say whether a group may write which is the user's own: of the user's name, without other members."""
    if state.st_mode & stat.S_IWOTH or state.st_gid != os.getgid():
        return False
    import grp
    import pwd

    try:
        user, group = pwd.getpwuid(os.getuid()), grp.getgrgid(state.st_gid)
    except KeyError:
        return False
    return group.gr_name == user.pw_name and set(group.gr_mem) <= {user.pw_name}


def _digests(folder: Path) -> str:
    """One line for each file below a folder: digest and name; ValueError where something else lies there."""
    lines = []
    for path in sorted(folder.rglob("*")):
        mode = path.lstat().st_mode
        if stat.S_ISDIR(mode):
            continue
        if not stat.S_ISREG(mode):
            raise ValueError(f"{path} is no file")
        lines.append(
            f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder).as_posix()}\n"
        )
    return "".join(lines)


def _whole(folder: Path, listed: Path) -> bool:
    """Say whether a kernel's files are those that were listed when they were written."""
    try:
        if not stat.S_ISREG(listed.lstat().st_mode) or not stat.S_ISDIR(folder.lstat().st_mode):
            return False
        return listed.read_bytes() == _digests(folder).encode()
    except (OSError, ValueError):
        return False


def _clear(folder: Path, listed: Path) -> None:
    """Take away what is left of a kernel."""
    for path in (listed, folder):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)


def _list(folder: Path, listed: Path) -> None:
    """Write down the digests of a kernel's files, all at once or not at all."""
    part = listed.with_name(f"{listed.name}.{os.getpid()}")
    try:
        part.write_bytes(_digests(folder).encode())
        part.replace(listed)
    finally:
        part.unlink(missing_ok=True)


def _lock(file: IO[bytes]) -> None:
    """Wait for the lock; go on without one where the system or the file system has none."""
    try:
        import fcntl
    except ImportError:
        return
    with suppress(OSError):
        fcntl.flock(file, fcntl.LOCK_EX)
