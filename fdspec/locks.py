"""One writer at a time: a lock of the operating system, which ends with the process that holds it.

The lock of ``cube.nc`` is held on a file ``.cube.nc.lock`` beside it, in which the holder writes who it is.
The file itself locks nothing: one that a killed process left is taken over without a question.  The system's
locks are ``flock`` on POSIX, which Linux passes on to an NFS server, and a locked byte on Windows.  On a file
system that has no locks a warning is logged, and work goes on without.

filelock, the library for this, empties the holder's file as it tries to lock it; here whoever is refused must
read in it whom to wait for.
"""

from __future__ import annotations

import errno
import hashlib
import json
import logging
import os
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from fdspec.errors import BusyError, DiskError

LONGEST_NAME: Final = 240
"""Bytes of a file's name, below what any common file system allows."""

PAUSE: Final = 0.05
"""s between two looks at a lock that is waited for."""

_NO_LOCKS: Final = (errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOTSUP)
_BYTE: Final = 1 << 30
"""Where Windows locks: far behind what the holder wrote, which others must be able to read."""

_started: Final = datetime.now(UTC).strftime("%Y-%m-%d %H:%M:%S UTC")
_held: Final[dict[Path, list[int]]] = {}
"""Path -> thread that holds it, how often, and the process: a child that was forked holds nothing."""
_guard: Final = threading.Lock()

log = logging.getLogger(__name__)


def lock_file(path: str | os.PathLike[str]) -> Path:
    """Return the file on which the lock of `path` is held."""
    target = Path(os.path.realpath(path))
    name = f".{target.name}.lock"
    if len(os.fsencode(name)) > LONGEST_NAME:
        name = f".fdspec-{hashlib.sha256(os.fsencode(target.name)).hexdigest()[:16]}.lock"
    return target.with_name(name)


@contextmanager
def locked(path: str | os.PathLike[str], *, wait: float = 0.0) -> Iterator[None]:
    """Hold the lock of a file or folder that is to be written; the thread that holds it may hold it again.

    Parameters
    ----------
    path : path
        What is written; need not exist, its folder must.
    wait : float, s
        How long another's lock is waited for.

    Raises
    ------
    BusyError
        When another process, or another thread, holds it: which, on which host, since when.
    DiskError
        When the folder takes no file.
    """
    target = Path(os.path.realpath(path))
    me, until = [threading.get_ident(), os.getpid()], time.monotonic() + wait
    while True:
        with _guard:
            mine = _held.get(target)
            if mine is None or mine[1] != os.getpid():
                _held[target] = [*me, 1]
                break
            if mine[:2] == me:
                mine[2] += 1
                break
        if time.monotonic() >= until:
            raise BusyError(f"{os.fspath(path)} is being written by another thread of this process")
        time.sleep(PAUSE)
    try:
        if _held[target][2] > 1:
            yield
            return
        descriptor = _taken(target, path, until)
        try:
            yield
        finally:
            _give_back(descriptor, lock_file(target))
    finally:
        with _guard:
            _held[target][2] -= 1
            if not _held[target][2]:
                del _held[target]


def _taken(target: Path, path: str | os.PathLike[str], until: float) -> int | None:
    """Return the descriptor that holds the lock, or None where the file system has none."""
    file = lock_file(target)
    while True:
        try:
            descriptor = _opened(
                file, os.O_RDONLY
            )  # one that may be written keeps a disk from being unmounted
        except OSError as error:
            raise DiskError(
                f"cannot write {os.fspath(path)}: {error.strerror or error} ({file.name})"
            ) from error
        try:
            got = _try_lock(descriptor, file)
            if got is None:
                log.warning(
                    "%s: this file system has no locks; do not run the same twice at a time", file.parent
                )
            elif got and not _is(descriptor, file):  # its holder has just removed it
                os.close(descriptor)
                continue
        except BaseException:
            os.close(descriptor)
            raise
        if got is None:
            os.close(descriptor)
            return None
        if got:
            _write_holder(file)
            return descriptor
        os.close(descriptor)
        if time.monotonic() >= until:
            raise BusyError(
                f"{os.fspath(path)} is being written by {_holder(file)}; wait until it ends, or name another"
            )
        time.sleep(PAUSE)


def _opened(file: Path, how: int) -> int:
    return os.open(file, how | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o666)


def _try_lock(descriptor: int, file: Path) -> bool | None:
    """Lock a file; False where another holds it, None where there are no locks."""
    try:
        if os.name == "nt":
            import msvcrt

            os.lseek(descriptor, _BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno == errno.EBADF:  # NFS locks only what may be written
            writable = _opened(file, os.O_RDWR)
            os.dup2(writable, descriptor, inheritable=False)
            os.close(writable)
            return _try_lock_once(descriptor)
        return None if error.errno in _NO_LOCKS else False
    return True


def _try_lock_once(descriptor: int) -> bool | None:
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        return None if error.errno in _NO_LOCKS else False
    return True


def _is(descriptor: int, file: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), file.stat())
    except FileNotFoundError:
        return False


def _write_holder(file: Path) -> None:
    told = {"pid": os.getpid(), "host": socket.gethostname(), "started": _started}
    with suppress(OSError):  # a full disk: the lock holds without a name
        file.write_text(json.dumps(told), encoding="utf-8")


def _holder(file: Path) -> str:
    try:
        told = json.loads(file.read_bytes()[:1000])
        return f"process {int(told['pid'])} on {str(told['host'])!r}, started {str(told['started'])[:40]}"
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return "another process"


def _give_back(descriptor: int | None, file: Path) -> None:
    if descriptor is None:
        return
    # Removed while it is held: whoever waits on it sees that it is no longer the file of that name.
    with suppress(OSError):
        file.unlink()
    with suppress(OSError):
        os.close(descriptor)
    if os.name == "nt":  # where a file that is open cannot be removed
        with suppress(OSError):
            file.unlink()
