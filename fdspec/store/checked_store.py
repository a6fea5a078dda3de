"""A Zarr store on disk that is read with care: no damage passes for numbers, and nobody removes it meanwhile.

Zarr takes a chunk that is missing for one of fill values, waits for ever on a pipe in a chunk's place, and
says of a checksum that fails only that it does.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from stat import S_ISREG
from typing import TYPE_CHECKING, Any, Final

from zarr.storage import LocalStore

from fdspec.errors import DamagedError, DiskError, StoreError
from fdspec.store.checksums import is_whole
from fdspec.store.holding import hold
from fdspec.store.refusals import no_resources

if TYPE_CHECKING:
    from zarr.core.buffer import Buffer

STATUS: Final = "status"


class CheckedStore(LocalStore):
    """Read a store of fdspec's, as Zarr asks for its files.

    dims: those of each variable that is written by blocks.
    """

    def __init__(self, root: Path | str, *, read_only: bool = True) -> None:
        super().__init__(Path(root), read_only=read_only)
        self.dims: dict[str, tuple[str, ...]] = {}
        self._hold = hold(self.root)

    def with_read_only(self, read_only: bool = False) -> CheckedStore:
        """Return a store of the same folder that may, or may not, be written."""
        other = type(self)(self.root, read_only=read_only)
        other.dims = self.dims
        return other

    def release(self) -> None:
        """Let others remove the store."""
        if self._hold is not None:
            with suppress(OSError):
                os.close(self._hold)
            self._hold = None

    def __del__(self) -> None:
        self.release()

    def get_sync(self, key: str, **asked: Any) -> Buffer | None:
        """Return a file's content, or None."""
        self._look(key)
        found = super().get_sync(key, **asked)
        if found is None and self._finished(key):
            found = super().get_sync(key, **asked)  # written since, before its status
        return self._seen(key, found)

    async def get(self, key: str, *positional: Any, **asked: Any) -> Buffer | None:
        """Return a file's content, or None."""
        self._look(key)
        try:
            found = await super().get(key, *positional, **asked)
            if found is None and self._finished(key):
                found = await super().get(key, *positional, **asked)
        except OSError as error:
            told = no_resources(error) or "the disk refuses it"
            raise DiskError(f"cannot read {self.root / key}: {told}") from error
        return self._seen(key, found)

    def _look(self, key: str) -> None:
        with suppress(FileNotFoundError, NotADirectoryError):
            if not S_ISREG((self.root / key).stat().st_mode):
                if (self.root / key).is_dir() and "/c/" not in f"/{key}/":
                    return
                raise DamagedError(f"{self.root}: {key} is damaged, it is no regular file; {_REMEDY}")

    def _seen(self, key: str, found: Buffer | None) -> Buffer | None:
        name, is_chunk, _ = key.partition("/c/")
        if not is_chunk or name not in self.dims:
            return found
        if found is None:
            if not (self.root / "zarr.json").is_file():
                raise StoreError(f"{self.root}: the store was removed")
            if self._finished(key):
                raise DamagedError(f"{self.root}: {key} is missing; {_REMEDY}")
        elif not is_whole(found.to_bytes()):
            raise DamagedError(f"{self.root}: {key} is damaged; {_REMEDY}")
        return found

    def _finished(self, key: str) -> bool:
        """Whether the block that this chunk belongs to has its status."""
        name, _, place = key.partition("/c/")
        if name not in self.dims or name == STATUS:
            return False
        at = dict(zip(self.dims[name], place.split("/"), strict=True))
        return Path(self.root, STATUS, "c", *(at.get(dim, "0") for dim in self.dims[STATUS])).exists()


_REMEDY: Final = "start the sweep again to compute it anew"
