"""What a store says of itself in ``zarr.json`` and its copy: its cut, its sweep, checksums of what stays."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from fdspec.errors import DamagedError, DiskError, StoreError
from fdspec.store.blocks import Blocks
from fdspec.store.checksums import of_bytes
from fdspec.store.refusals import no_resources

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

STATUS: Final = "status"


def is_store(path: str | os.PathLike[str]) -> bool:
    """Whether there is a Zarr store at `path`, fdspec's or another's."""
    return (Path(path) / ROOT).is_file() or (Path(path) / COPY).is_file()


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
    attributes = attributes_of(path)
    return blocks_of(attributes), attributes[IDENTITY]


def described_files(path: str | os.PathLike[str]) -> dict[str, str]:
    """Return the files that never change, and their checksums; none for a store older than these."""
    return dict(attributes_of(path).get(FILES, {}))


def damaged_files(path: str | os.PathLike[str]) -> list[str]:
    """Return the files of coordinates, and of what describes the arrays, that are not as they were made."""
    told = described_files(path)
    root = [name for name in (ROOT, COPY) if told and root_of(Path(path, name)) is None]
    return root + [name for name, checksum in told.items() if checksum_of(Path(path, name)) != checksum]


def attributes_of(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the attributes of one of fdspec's stores."""
    found = root_of(Path(path, ROOT)) or root_of(Path(path, COPY))
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


def blocks_of(attributes: Mapping[str, Any]) -> Blocks:
    """Return how the cube is cut, or raise DamagedError."""
    told = attributes[BLOCKS]
    sizes, edges = told.get("sizes"), told.get("edges")
    if not (isinstance(sizes, dict) and isinstance(edges, dict) and list(sizes) == list(edges)) or not all(
        isinstance(one, int) and one > 0 for one in (*sizes.values(), *edges.values())
    ):
        raise DamagedError(f"the store is damaged: {BLOCKS} does not say how it is cut")
    return Blocks(sizes, edges)


def root_of(file: Path) -> dict[str, Any] | None:
    """Return what ``zarr.json``, or its copy, says; None where it is damaged."""
    try:
        if not file.is_file():
            return None
        root = json.loads(file.read_bytes())
        attributes = root["attributes"]
        if attributes.get(FORMAT) != 1 and ITSELF not in attributes and FORMAT in attributes:
            return None
        if ITSELF in attributes and attributes[ITSELF] != root_checksum(root):
            return None
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError):
        return None
    except OSError as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {file}: {told}") from error
        return None
    return dict(root)


def root_checksum(root: Mapping[str, Any]) -> str:
    """Return the checksum of all that ``zarr.json`` says beside it."""
    attributes = {key: value for key, value in root["attributes"].items() if key != ITSELF}
    return f"{of_bytes(json.dumps({**root, 'attributes': attributes}, sort_keys=True).encode()):08x}"


def checksum_of(file: Path) -> str | None:
    """Return the checksum of a file, None where there is none that can be read."""
    try:
        if not file.is_file():  # a pipe would be waited on
            return None
        return f"{of_bytes(file.read_bytes()):08x}"
    except OSError as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {file}: {told}") from error
        return None
