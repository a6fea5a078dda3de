"""A cube in a Zarr store, written block by block by whoever computed the block, and opened lazily.

Every chunk ends in its own CRC-32C, which any reader of Zarr 3 checks.  The store itself says what is
finished: a block is, when all of its chunks are there and whole.  A chunk appears under its name only when
it is complete, and the status comes last, so that a store is readable at every instant: cells that are not
computed yet have the status "not computed".
"""

from __future__ import annotations

import json
import os
import secrets
import shutil
import socket
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import BusyError, DamagedError, DiskError, StoreError
from fdspec.store import layout
from fdspec.store.blocks import Blocks
from fdspec.store.checksums import is_whole
from fdspec.store.description import (
    BLOCKS,
    COPY,
    FILES,
    FORMAT,
    IDENTITY,
    ITSELF,
    ORDER,
    ROOT,
    STATUS,
    VERSION,
    attributes_of,
    blocks_of,
    checksum_of,
    damaged_files,
    described,
    described_files,
    is_store,
    root_checksum,
)
from fdspec.store.holding import is_held
from fdspec.store.refusals import no_resources
from fdspec.variables import NOT_COMPUTED, Variable

if TYPE_CHECKING:
    import xarray as xr


SUFFIXES: Final = (".zarr",)


class State(Enum):
    """What is found of a block."""

    MISSING = "missing"
    DAMAGED = "damaged"
    WHOLE = "whole"


def create(
    path: str | os.PathLike[str],
    frame: xr.Dataset,
    variables: Sequence[Variable],
    blocks: Blocks,
    identity: Mapping[str, Any],
) -> None:
    """Make the store of a cube whose cells are still to be computed; it appears as a whole.

    frame: coordinates and attributes of the cube; variables: those along its dims; identity: what JSON can
    hold.
    """
    target = Path(path)
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        try:
            _make(part, frame, variables, blocks, identity)
            part.rename(target)
        finally:
            shutil.rmtree(part, ignore_errors=True)


def mend(
    path: str | os.PathLike[str],
    frame: xr.Dataset,
    variables: Sequence[Variable],
    blocks: Blocks,
    identity: Mapping[str, Any],
) -> list[str]:
    """Write anew what is damaged of the files that `create` made; return their names in the store.

    Raise StoreError where that gives another file than the one that was there.
    """
    target = Path(path)
    damaged = damaged_files(target)
    if not damaged:
        return []
    told = described_files(target)
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        try:
            _make(part, frame, variables, blocks, identity)
            for name in damaged:
                if name in {ROOT, COPY}:
                    continue
                if checksum_of(part / name) != told[name]:
                    raise StoreError(
                        f"{target}: {name} is damaged for good; start over with --restart (restart=True)"
                    )
                clear(target / name)
                (target / name).parent.mkdir(parents=True, exist_ok=True)
                (part / name).replace(target / name)
            for name, other in ((ROOT, COPY), (COPY, ROOT)):
                if name in damaged:
                    clear(target / name)
                    (target / name).parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(target / other, part / ROOT)
                    (part / ROOT).replace(target / name)
        finally:
            shutil.rmtree(part, ignore_errors=True)
    return damaged


def clear(path: Path) -> None:
    """Remove whatever stands in the place of a file."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def remove(path: str | os.PathLike[str]) -> None:
    """Remove a store; under its name it is gone at once.  One that is being read is kept: BusyError."""
    target = Path(os.path.realpath(path))
    if is_held(target):
        raise BusyError(f"{os.fspath(path)} is being read, by another process or this one; it is kept")
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        target.rename(part)
        shutil.rmtree(part)


def write(
    path: str | os.PathLike[str],
    blocks: Blocks,
    number: int,
    values: Mapping[str, NDArray[np.generic]],
    variables: Sequence[Variable],
) -> None:
    """Write one block's values, variable by variable, the status last."""
    import zarr

    mine = [variable for variable in variables if blocks.owns(number, variable)]
    paths = {variable.name: chunk_path(path, blocks, number, variable) for variable in mine}
    with written(path), _of_a_store_that_stays(path, list(paths.values())):
        group = zarr.open_group(path, mode="r+", zarr_format=3)
        for variable in sorted(mine, key=lambda variable: variable.name == STATUS):
            if variable.name == STATUS:
                # The status says that the others are there: also after the machine has stopped.
                for name, chunk in paths.items():
                    if name != STATUS:
                        _sync(chunk)
            array: Any = group[variable.name]
            array[blocks.region(number, variable)] = values[variable.name]


@contextmanager
def _of_a_store_that_stays(path: str | os.PathLike[str], chunks: Sequence[Path]) -> Iterator[None]:
    """Write chunks; raise DiskError where their store is removed before or meanwhile, whatever failed then.

    Zarr makes the folders of a store that is gone anew. What was written into them is removed: a folder
    that is no store would be in the way of the next one.
    """
    still_there(path)
    try:
        yield
    except (KeyError, FileNotFoundError) as error:
        _withdraw_unless_there(path, chunks)
        raise DiskError(
            f"cannot write {os.fspath(path)}: parts of it were removed meanwhile ({error}); "
            "start the sweep again"
        ) from error
    _withdraw_unless_there(path, chunks)


def _withdraw_unless_there(path: str | os.PathLike[str], chunks: Sequence[Path]) -> None:
    try:
        still_there(path)
    except DiskError:
        store = Path(path)
        for chunk in chunks:
            with suppress(OSError):
                chunk.unlink(missing_ok=True)
            for folder in (chunk.parent, *chunk.parent.parents):
                if not folder.is_relative_to(store):
                    break
                with suppress(OSError):
                    folder.rmdir()  # one that is not empty stays
        raise


def still_there(path: str | os.PathLike[str]) -> None:
    """Raise DiskError for a store that was there and is not."""
    if not is_store(path):
        raise DiskError(
            f"cannot write {os.fspath(path)}: on {socket.gethostname()} there is no such store; it was "
            "removed, or the workers do not share its file system"
        )


def states(
    path: str | os.PathLike[str], blocks: Blocks, variables: Sequence[Variable]
) -> Iterator[tuple[int, State, list[Path]]]:
    """Read every chunk; give each block's number, what is found of it, and the files that are damaged."""

    def look(number: int) -> tuple[int, State, list[Path]]:
        paths = [chunk_path(path, blocks, number, v) for v in variables if blocks.owns(number, v)]
        found = [_state(one) for one in paths]
        damaged = [one for one, state in zip(paths, found, strict=True) if state is State.DAMAGED]
        if damaged:
            return number, State.DAMAGED, damaged
        return number, State.MISSING if State.MISSING in found else State.WHOLE, []

    with ThreadPoolExecutor(4) as pool:
        # In portions: the pool takes all it is given at once.
        for first in range(0, len(blocks), 1000):
            yield from pool.map(look, range(first, min(first + 1000, len(blocks))))


def chunk_path(path: str | os.PathLike[str], blocks: Blocks, number: int, variable: Variable) -> Path:
    """File that holds a block's chunk of a variable, by Zarr's naming."""
    return Path(path, variable.name, "c", *map(str, blocks.chunk_of(number, variable)))


def unfinished(path: str | os.PathLike[str]) -> int:
    """Count the blocks whose status is not there, and so the blocks that are not finished."""
    return _unfinished(path, described(path)[0])


def _unfinished(path: str | os.PathLike[str], blocks: Blocks) -> int:
    found = sum(
        not name.endswith(".partial") for _, _, names in os.walk(Path(path) / STATUS / "c") for name in names
    )
    return len(blocks) - found


def tidy(path: str | os.PathLike[str]) -> None:
    """Remove what killed processes left of chunks that they were writing."""
    for left in Path(path).glob("*/c/**/*.partial"):
        with suppress(OSError):
            left.unlink()


def open_store(path: str | os.PathLike[str]) -> tuple[xr.Dataset, int, int]:
    """Return the cube of a store, its blocks that are not finished, and all.

    Numbers are read when they are used; nobody removes the store before ``close()``.
    """
    import xarray as xr

    from fdspec.store.checked_store import CheckedStore

    if damaged := damaged_files(path):
        told = ", ".join(damaged[:5]) + (f" and {len(damaged) - 5} more" if len(damaged) > 5 else "")
        raise DamagedError(
            f"cannot open {os.fspath(path)}: the store is damaged: {told}; start the sweep again to mend it"
        )
    attributes = attributes_of(path)
    blocks = blocks_of(attributes)
    store = CheckedStore(Path(os.path.realpath(path)))
    on_disk = xr.open_dataset(
        store,  # type: ignore[arg-type]
        engine="zarr",
        chunks=None,
        cache=False,
        mask_and_scale=False,
        decode_times=False,
        decode_timedelta=False,
        consolidated=False,
        zarr_format=3,
    )
    cube = layout.from_disk(on_disk[attributes[ORDER]])
    store.dims |= {str(name): tuple(map(str, array.dims)) for name, array in cube.data_vars.items()}
    for name in (FORMAT, BLOCKS, IDENTITY, ORDER, FILES, ITSELF):
        cube.attrs.pop(name, None)
    for variable in cube.variables.values():
        variable.attrs = {key: _typed(value, variable.dtype) for key, value in variable.attrs.items()}
    left = _unfinished(path, blocks)
    if left:
        flags = cube[STATUS].attrs
        flags["flag_values"] = np.append(flags["flag_values"], np.int8(NOT_COMPUTED))
        flags["flag_meanings"] = f"{flags['flag_meanings']} not_computed"
    cube = cube.drop_encoding()
    cube.set_close(store.release)
    return cube, left, len(blocks)


@contextmanager
def written(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn what a disk refuses into one sentence."""
    try:
        yield
    except StoreError:
        raise
    except OSError as error:
        told = no_resources(error) or error.strerror or "the disk refuses it"
        raise DiskError(f"cannot write {os.fspath(path)}: {told}; what is finished is kept") from error


def _create_array(group: Any, variable: Variable, blocks: Blocks) -> None:
    from zarr.codecs import BloscCodec, Crc32cCodec

    dtype = np.dtype(variable.dtype)
    attributes = {key: _json(value) for key, value in variable.cf_attributes.items()}
    group.create_array(
        variable.name,
        shape=blocks.shape(variable),
        chunks=blocks.chunks(variable),
        dtype=dtype,
        fill_value=np.nan if dtype.kind == "f" else NOT_COMPUTED,
        compressors=(
            BloscCodec(cname="zstd", clevel=1, shuffle="shuffle", typesize=dtype.itemsize),
            Crc32cCodec(),
        ),
        dimension_names=variable.dims,
        attributes=attributes,
        # A chunk of fill values alone is still a chunk that is finished.
        config={"write_empty_chunks": True},
    )


def _make(
    part: Path,
    frame: xr.Dataset,
    variables: Sequence[Variable],
    blocks: Blocks,
    identity: Mapping[str, Any],
) -> None:
    """Write all of a store but its blocks."""
    import zarr

    on_disk = _plain_text(layout.to_disk(frame.drop_encoding()))
    on_disk.attrs |= {
        FORMAT: VERSION,
        BLOCKS: {"sizes": dict(blocks.sizes), "edges": dict(blocks.edges)},
        IDENTITY: dict(identity),
        ORDER: [*map(str, on_disk.variables), *(variable.name for variable in variables)],
    }
    bare = {name: {"_FillValue": None} for name in on_disk.variables}
    on_disk.to_zarr(part, mode="w-", zarr_format=3, consolidated=False, encoding=bare)
    group = zarr.open_group(part, mode="r+", zarr_format=3)
    for variable in variables:
        _create_array(group, variable, blocks)
    files = sorted(file for file in part.rglob("*") if file.is_file() and file != part / ROOT)
    root = json.loads((part / ROOT).read_bytes())
    root["attributes"][FILES] = {file.relative_to(part).as_posix(): checksum_of(file) for file in files}
    root["attributes"][ITSELF] = root_checksum(root)
    for name in (ROOT, COPY):
        (part / name).write_text(json.dumps(root, indent=1), encoding="utf-8")
    for file in (*files, part / ROOT, part / COPY):
        _sync(file)


def _sync(file: Path) -> None:
    """Wait until a file is on the disk."""
    descriptor = os.open(file, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _state(path: Path) -> State:
    try:
        if not path.exists():
            return State.MISSING
        content = path.read_bytes() if path.is_file() else b""
    except FileNotFoundError:
        return State.MISSING
    except OSError as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {path}: {told}") from error
        return State.DAMAGED
    return State.WHOLE if is_whole(content) else State.DAMAGED


def _plain_text(on_disk: xr.Dataset) -> xr.Dataset:
    """Text as Zarr has it: of variable width."""
    changed = {
        name: (variable.dims, variable.values.astype(np.dtypes.StringDType()), variable.attrs)
        for name, variable in on_disk.variables.items()
        if layout.is_text(variable)
    }
    return on_disk.assign(changed).set_coords([name for name in changed if name in on_disk.coords])


def _json(value: object) -> Any:
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _typed(value: Any, dtype: Any) -> Any:
    """Numbers in a list as the file has them: flags in the type of their variable."""
    return np.array(value, dtype=dtype) if isinstance(value, list) else value
