"""A cube in a Zarr store, written block by block by whoever computed the block, and opened lazily.

Every chunk ends in its own CRC-32C, which any reader of Zarr 3 checks.  The store itself says what is
finished: a block is, when all of its chunks are there and whole.  A chunk appears under its name only when
it is complete, and the status comes last, so that a store is readable at every instant: cells that are not
computed yet have the status "not computed".
"""

from __future__ import annotations

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

from fdspec.errors import DiskError, StoreError
from fdspec.store import layout
from fdspec.store.blocks import Blocks
from fdspec.variables import Variable

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

VERSION: Final = 1

NOT_COMPUTED: Final = -1
"""Status of a cell whose block is not finished."""

SUFFIXES: Final = (".zarr",)

STATUS: Final = "status"

_CHECKSUM_BYTES: Final = 4


class State(Enum):
    """What is found of a block."""

    MISSING = "missing"
    DAMAGED = "damaged"
    WHOLE = "whole"


def is_store(path: str | os.PathLike[str]) -> bool:
    """Whether there is a Zarr store at `path`, fdspec's or another's."""
    return (Path(path) / "zarr.json").is_file()


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
    import zarr

    target = Path(path)
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        try:
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
            part.rename(target)
        finally:
            shutil.rmtree(part, ignore_errors=True)


def remove(path: str | os.PathLike[str]) -> None:
    """Remove a store; under its name it is gone at once."""
    target = Path(path)
    part = target.with_name(f".fdspec-{os.getpid()}-{secrets.token_hex(4)}.part")
    with written(path):
        target.rename(part)
        shutil.rmtree(part)


def described(path: str | os.PathLike[str]) -> tuple[Blocks, dict[str, Any]]:
    """Return how the cube of a store is cut, and its identity."""
    attributes = _attributes(path)
    blocks = Blocks(**attributes[BLOCKS])
    return blocks, attributes[IDENTITY]


def write(
    path: str | os.PathLike[str],
    blocks: Blocks,
    number: int,
    values: Mapping[str, NDArray[np.generic]],
    variables: Sequence[Variable],
) -> None:
    """Write one block's values, variable by variable, the status last."""
    import zarr

    with written(path):
        still_there(path)  # Zarr would make the folders of a store that is gone anew
        group = zarr.open_group(path, mode="r+", zarr_format=3)
        for variable in sorted(variables, key=lambda variable: variable.name == STATUS):
            if blocks.owns(number, variable):
                array: Any = group[variable.name]
                array[blocks.region(number, variable)] = values[variable.name]


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
    blocks, _ = described(path)
    found = sum(
        not name.endswith(".partial") for _, _, names in os.walk(Path(path) / STATUS / "c") for name in names
    )
    return len(blocks) - found


def tidy(path: str | os.PathLike[str]) -> None:
    """Remove what killed processes left of chunks that they were writing."""
    for left in Path(path).glob("*/c/**/*.partial"):
        with suppress(OSError):
            left.unlink()


def open_store(path: str | os.PathLike[str]) -> xr.Dataset:
    """Return the cube of a store; numbers are read when they are used."""
    import xarray as xr

    _attributes(path)
    on_disk = xr.open_dataset(
        path,
        engine="zarr",
        chunks=None,
        cache=False,
        mask_and_scale=False,
        decode_times=False,
        decode_timedelta=False,
        consolidated=False,
        zarr_format=3,
    )
    cube = layout.from_disk(on_disk[on_disk.attrs[ORDER]])
    for name in (FORMAT, BLOCKS, IDENTITY, ORDER):
        del cube.attrs[name]
    for variable in cube.variables.values():
        variable.attrs = {key: _typed(value, variable.dtype) for key, value in variable.attrs.items()}
    if unfinished(path):
        flags = cube[STATUS].attrs
        flags["flag_values"] = np.append(flags["flag_values"], np.int8(NOT_COMPUTED))
        flags["flag_meanings"] = f"{flags['flag_meanings']} not_computed"
    return cube.drop_encoding()


def by_blocks(path: str | os.PathLike[str]) -> Iterator[dict[str, slice]]:
    """Give the place of every block of the store, in order."""
    blocks, _ = described(path)
    for number in range(len(blocks)):
        yield blocks.slices(number)


@contextmanager
def written(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn what a disk refuses into one sentence."""
    try:
        yield
    except StoreError:
        raise
    except OSError as error:
        raise DiskError(
            f"cannot write {os.fspath(path)}: {error.strerror or error}; what is finished is kept"
        ) from error


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


def _state(path: Path) -> State:
    from google_crc32c import value

    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return State.MISSING
    except OSError:
        return State.DAMAGED
    stored = int.from_bytes(content[-_CHECKSUM_BYTES:], "little")
    whole = len(content) > _CHECKSUM_BYTES and value(content[:-_CHECKSUM_BYTES]) == stored
    return State.WHOLE if whole else State.DAMAGED


def _attributes(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the attributes of one of fdspec's stores."""
    import zarr

    try:
        attributes: dict[str, Any] = zarr.open_group(path, mode="r", zarr_format=3).attrs.asdict()
    except (OSError, ValueError, KeyError) as error:
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is no Zarr store, or a damaged one ({error})"
        ) from error
    if not {FORMAT, BLOCKS, IDENTITY, ORDER} <= attributes.keys():
        raise StoreError(
            f"cannot open {os.fspath(path)}: it is another program's Zarr store; name one that fdspec made, "
            "or read it with xarray.open_zarr"
        )
    if attributes[FORMAT] > VERSION:
        raise StoreError(
            f"cannot open {os.fspath(path)}: its layout is version {attributes[FORMAT]}, this fdspec knows "
            f"{VERSION}; upgrade fdspec"
        )
    return attributes


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
