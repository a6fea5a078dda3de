"""Write a file as a whole or not at all."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from fdspec.errors import DiskError, StoreError
from fdspec.store.refusals import no_resources

ABANDONED: Final = 86400.0
"""s after which a file that is not written to is nobody's."""

NETCDF_SUFFIXES: Final = (".nc", ".nc4", ".netcdf", ".cdf")


def check_writable(
    path: str | os.PathLike[str], *, suffixes: tuple[str, ...] = NETCDF_SUFFIXES, overwrite: bool = True
) -> Path:
    """Make sure that a file can be written at `path`, before the work that fills it.

    Nothing is left behind and nothing that exists is touched.

    Parameters
    ----------
    path : path
        The file to be written. Its folder must exist.
    suffixes : tuple of str
        What the name may end with; a name without any suffix passes too.
    overwrite : bool
        Whether a file that exists may be replaced.

    Returns
    -------
    Path
        The file itself, with symbolic links followed.

    Raises
    ------
    StoreError
        When it cannot be written; the text says why and what would be right. A DiskError where the disk
        refuses: it is full or read-only, or the folder belongs to somebody else.
    """
    given = Path(path)
    try:
        target = _checked(given, suffixes, overwrite)
    except (OSError, RuntimeError, ValueError) as error:  # a loop of links, a name too long, a NUL in it
        if isinstance(error, StoreError):
            raise
        told = no_resources(error) or "no file can have that name"
        raise StoreError(f"cannot write {given}: {told}") from error
    try:
        # Asking for permission bits is not enough: root, network and read-only file systems answer otherwise.
        with tempfile.TemporaryFile(dir=target.parent):
            pass
    except OSError as error:
        raise DiskError(
            f"cannot write {given}: the folder {given.parent} takes no files ({_reason(error)}); "
            "give a file in another folder"
        ) from error
    return target


def _checked(given: Path, suffixes: tuple[str, ...], overwrite: bool) -> Path:
    if given.name == "-":
        raise StoreError("cannot write -: results go to files, not to standard output; name one")
    if not given.is_absolute() and not _working_folder():
        raise StoreError(f"cannot write {given}: the working folder was deleted; change to another")
    target = given.resolve()
    folder = target.parent
    if target.is_symlink():
        raise OSError(errno.ELOOP, "")
    if target.is_dir():
        raise StoreError(f"cannot write {given}: it is a folder; name a file, such as {given / 'cube.nc'}")
    if given.suffix and given.suffix.lower() not in suffixes:
        raise StoreError(f"cannot write {given}: the name should end in {' or '.join(suffixes)}")
    if not folder.is_dir():
        raise StoreError(f"cannot write {given}: there is no folder {given.parent}; make it first")
    if target.exists():
        if not overwrite:
            raise StoreError(f"cannot write {given}: it exists already; remove it or allow overwriting")
        if not target.is_file():
            raise StoreError(f"cannot write {given}: it is no regular file; give the name of one")
        if not os.access(target, os.W_OK):
            raise StoreError(f"cannot write {given}: the file is write-protected; give another name")
    return target


def _working_folder() -> bool:
    try:
        Path.cwd()
    except OSError:
        return False
    return True


@contextmanager
def replacing(
    path: str | os.PathLike[str], *, suffixes: tuple[str, ...] = NETCDF_SUFFIXES, overwrite: bool = True
) -> Iterator[Path]:
    """Give a name to write to; what was written there becomes `path` when the block ends without error.

    The name is a new one in the same folder, so that the last step is one rename: whoever reads `path` finds
    the old file or the whole new one, also when this process is killed or the machine stops. After any error,
    KeyboardInterrupt included, the new file is removed; one that a killed process left goes when it is a day
    old.
    """
    target = check_writable(path, suffixes=suffixes, overwrite=overwrite)
    _tidy(target.parent)
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    try:
        yield part
        with part.open("rb+") as written:
            os.fsync(written.fileno())
        if overwrite:
            part.replace(target)
        else:
            _put_first(part, target, path)
        _sync_folder(target.parent)
    except OSError as error:
        if isinstance(error, StoreError):
            raise
        raise DiskError(f"cannot write {path}: {_reason(error)}") from error
    finally:
        part.unlink(missing_ok=True)


def _put_first(part: Path, target: Path, path: str | os.PathLike[str]) -> None:
    """Give a file its name unless somebody took that meanwhile."""
    try:
        os.link(part, target)
    except FileExistsError:
        raise StoreError(f"cannot write {path}: it exists already; remove it or allow overwriting") from None
    except OSError:  # a file system without links
        part.rename(check_writable(target, suffixes=(target.suffix.lower(),), overwrite=False))


def _tidy(folder: Path) -> None:
    """Remove what processes that were killed left here; what is younger may be at work, here or elsewhere."""
    for left in folder.glob(".fdspec-*.part"):
        with suppress(OSError):
            if time.time() - left.stat().st_mtime > ABANDONED:
                shutil.rmtree(left) if left.is_dir() else left.unlink()


def _sync_folder(folder: Path) -> None:
    """Make the rename itself durable where folders can be opened (not on Windows)."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _reason(error: OSError) -> str:
    return no_resources(error) or error.strerror or "the disk refuses it"
