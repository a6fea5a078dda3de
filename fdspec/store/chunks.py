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
from fdspec.store.checksums import is_whole, of_bytes
from fdspec.store.holding import is_held
from fdspec.store.refusals import no_resources
from fdspec.variables import NOT_COMPUTED, Variable

if TYPE_CHECKING:
    import xarray as xr

FORMAT: Final = "fdspec_format"
"""Attribute of the store alone: the version of its layout."""

BLOCKS: Final = "fdspec_blocks"
"""Attribute of the store alone: its dims, their lengths and those of a block."""

IDENTITY: Final = "fdspec_identity"
"""Attribute of the store alone: what a sweep must share to go on in it."""

ORDER: Final = "fdspec_order"
"""Attribute of the store alone: its variables in their order, which a folder does not keep."""

FILES: Final = "fdspec_files"
"""Attribute of the store alone: each file that never changes -> its checksum."""

ITSELF: Final = "fdspec_checksum"
"""Attribute of the store alone: the checksum of all that ``zarr.json`` says beside it."""

VERSION: Final = 2
"""Since 2 there are checksums of coordinates and of what describes the arrays."""

ROOT: Final = "zarr.json"

COPY: Final = "status/root.json"
"""A second ``zarr.json``, in the folder of an array, where no reader of Zarr looks."""

SUFFIXES: Final = (".zarr",)

STATUS: Final = "status"


class State(Enum):
    """What is found of a block."""

    MISSING = "missing"
    DAMAGED = "damaged"
    WHOLE = "whole"


def is_store(path: str | os.PathLike[str]) -> bool:
    """Whether there is a Zarr store at `path`, fdspec's or another's."""
    return (Path(path) / ROOT).is_file() or (Path(path) / COPY).is_file()


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
                if _checksum(part / name) != told[name]:
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


def damaged_files(path: str | os.PathLike[str]) -> list[str]:
    """Return the files of coordinates, and of what describes the arrays, that are not as they were made."""
    told = described_files(path)
    root = [name for name in (ROOT, COPY) if told and _root(Path(path, name)) is None]
    return root + [name for name, checksum in told.items() if _checksum(Path(path, name)) != checksum]


def described_files(path: str | os.PathLike[str]) -> dict[str, str]:
    """Return the files that never change, and their checksums; none for a store older than these."""
    return dict(_attributes(path).get(FILES, {}))


def remove(path: str | os.PathLike[str]) -> None:
    """Remove a store; under its name it is gone at once.  One that is being read is kept: BusyError."""
    target = Path(os.path.realpath(path))
    if is_held(target):
        raise BusyError(f"{os.fspath(path)} is being read, by another process or this one; it is kept")
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        target.rename(part)
        shutil.rmtree(part)


def is_ours(path: str | os.PathLike[str]) -> bool:
    """Whether a folder is a store that fdspec made, however damaged."""
    for name in (ROOT, COPY, f"{STATUS}/{ROOT}"):
        file = Path(path, name)
        with suppress(OSError):
            if file.is_file() and (FORMAT if name != f"{STATUS}/{ROOT}" else "flag_meanings").encode() in (
                file.read_bytes()
            ):
                return True
    return False


def described(path: str | os.PathLike[str]) -> tuple[Blocks, dict[str, Any]]:
    """Return how the cube of a store is cut, and its identity."""
    attributes = _attributes(path)
    return _blocks(attributes), attributes[IDENTITY]


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
    attributes = _attributes(path)
    blocks = _blocks(attributes)
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
    root["attributes"][FILES] = {file.relative_to(part).as_posix(): _checksum(file) for file in files}
    root["attributes"][ITSELF] = _of_root(root)
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


def _checksum(file: Path) -> str | None:
    """Return the checksum of a file, None where there is none that can be read."""
    try:
        if not file.is_file():  # a pipe would be waited on
            return None
        return f"{of_bytes(file.read_bytes()):08x}"
    except OSError as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {file}: {told}") from error
        return None


def _of_root(root: Mapping[str, Any]) -> str:
    attributes = {key: value for key, value in root["attributes"].items() if key != ITSELF}
    return f"{of_bytes(json.dumps({**root, 'attributes': attributes}, sort_keys=True).encode()):08x}"


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


def _root(file: Path) -> dict[str, Any] | None:
    """Return what ``zarr.json``, or its copy, says; None where it is damaged."""
    try:
        if not file.is_file():
            return None
        root = json.loads(file.read_bytes())
        attributes = root["attributes"]
        if attributes.get(FORMAT) != 1 and ITSELF not in attributes and FORMAT in attributes:
            return None
        if ITSELF in attributes and attributes[ITSELF] != _of_root(root):
            return None
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError):
        return None
    except OSError as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {file}: {told}") from error
        return None
    return dict(root)


def _attributes(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the attributes of one of fdspec's stores."""
    found = _root(Path(path, ROOT)) or _root(Path(path, COPY))
    if found is None:
        if is_ours(path):
            raise DamagedError(
                f"cannot open {os.fspath(path)}: the store is damaged: zarr.json; start over with --restart "
                "(restart=True)"
            )
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is no Zarr store, or one that cannot be read as one"
        )
    attributes: dict[str, Any] = found["attributes"]
    if not {FORMAT, BLOCKS, IDENTITY, ORDER} <= attributes.keys():
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is another program's Zarr store; name one that fdspec made, "
            "or read it with xarray.open_zarr"
        )
    version = attributes[FORMAT]
    if isinstance(version, int) and version > VERSION:
        raise StoreError(
            f"cannot open {os.fspath(path)}: its layout is version {version}, this fdspec knows "
            f"{VERSION}; upgrade fdspec"
        )
    kinds = {FORMAT: int, BLOCKS: dict, IDENTITY: dict, ORDER: list, FILES: dict}
    for name, kind in kinds.items():
        if not isinstance(attributes.get(name, kind()), kind):
            raise DamagedError(
                f"cannot open {os.fspath(path)}: the store is damaged: {name} is no {kind.__name__}"
            )
    return attributes


def _blocks(attributes: Mapping[str, Any]) -> Blocks:
    told = attributes[BLOCKS]
    sizes, edges = told.get("sizes"), told.get("edges")
    if not (isinstance(sizes, dict) and isinstance(edges, dict) and list(sizes) == list(edges)) or not all(
        isinstance(one, int) and one > 0 for one in (*sizes.values(), *edges.values())
    ):
        raise DamagedError(f"the store is damaged: {BLOCKS} does not say how it is cut")
    return Blocks(sizes, edges)


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
