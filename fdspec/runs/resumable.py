"""A sweep that goes into a store, block by block, and goes on where it stopped when it is started again."""

from __future__ import annotations

import json
import logging
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import DiskError, StoreError
from fdspec.locks import locked
from fdspec.model.motion import GroundMotion
from fdspec.scheduling.task import Task, cores
from fdspec.store import chunks, description
from fdspec.store import open as open_cube
from fdspec.store.blocks import Blocks, cut
from fdspec.store.replacing import check_writable
from fdspec.variables import Variable

if TYPE_CHECKING:
    import xarray as xr

IntArray = NDArray[np.int64]
Compute = Callable[[IntArray, GroundMotion], Mapping[str, NDArray[np.generic]]]

LONGEST: Final = 2.0
"""s of core time in a block, which is what a crash loses of each core's work."""

SHORTEST: Final = 0.2
"""s of core time in a block, below which what a task costs by itself would show."""

SHARE: Final = 16
"""Blocks for each core at least, so that the cores end together."""

LARGEST: Final = 4_000_000
"""Cells of a block: 32 MB of each variable."""

log = logging.getLogger(__name__)


class Fan(Protocol):
    """`fdspec.scheduling.threads.fan_out` with all that does not concern the store."""

    def __call__(
        self, work: Callable[[IntArray, GroundMotion], int], *, tasks: Sequence[Task], finished: int
    ) -> list[int]:
        """Return the work's result for every task."""


def sweep_into(
    path: str | os.PathLike[str],
    frame: xr.Dataset,
    variables: Sequence[Variable],
    compute: Compute,
    fan: Fan,
    *,
    items: Sequence[str],
    seconds: float,
    items_per_task: int | None = None,
    restart: bool = False,
) -> xr.Dataset:
    """Compute what is not yet finished of the cube in a store; return the cube, its numbers still on disk.

    frame: coordinates and attributes of the cube; variables: those to be computed, the status among them;
    items: the dims along which work is shared out, beside the record, the last fastest, so that an item is a
    column of a study, or a cell of buildings; compute: the values of a block, given as its items, under a
    motion; seconds: core time of the whole cube, roughly.

    Raise BusyError when another process sweeps into the store.
    """
    path = Path(os.path.realpath(path))
    if not os.path.exists(path):  # noqa: PTH110  a name that is too long is none that exists
        check_writable(path, suffixes=chunks.SUFFIXES)
    with locked(path):
        return _sweep_into(
            path,
            frame,
            variables,
            compute,
            fan,
            items=tuple(items),
            seconds=seconds,
            items_per_task=items_per_task,
            restart=restart,
        )


def _sweep_into(
    path: Path,
    frame: xr.Dataset,
    variables: Sequence[Variable],
    compute: Compute,
    fan: Fan,
    *,
    items: tuple[str, ...],
    seconds: float,
    items_per_task: int | None,
    restart: bool,
) -> xr.Dataset:
    identity = identity_of(frame)
    if restart and path.exists():
        if not description.is_ours(path):
            description.described(path)  # what is not fdspec's own is refused
        chunks.remove(path)
    if path.exists():
        blocks = _agreed(path, identity)
        for name in chunks.mend(path, frame, variables, blocks, identity):
            log.warning("%s of %s was damaged and is mended", name, path)
        log.info("%s: going on where it stopped", path)
    else:
        sizes = {dim: frame.sizes[dim] for dim in _dims(variables)}
        blocks = plan_blocks(sizes, items, seconds, items_per_task)
        chunks.create(path, frame, variables, blocks, identity)
        log.info("%s: made, %d blocks of %s", path, len(blocks), dict(blocks.edges))
    todo = list(_unfinished(path, blocks, variables))
    status = _status(variables)
    total = sum(blocks.cells(number, status) for number in range(len(blocks)))
    finished = total - sum(blocks.cells(number, status) for number in todo)
    log.info("%d of %d histories are finished, %d blocks are left", finished, total, len(todo))
    if todo:
        names = tuple(map(str, frame["record"].values))
        work = partial(_fill, path, blocks, items, names, tuple(variables), compute)
        fan(work, tasks=[Task(*_items(blocks, items, number)) for number in todo], finished=finished)
    chunks.still_there(path)  # also under the last block
    chunks.tidy(path)
    if left := chunks.unfinished(path):
        raise DiskError(
            f"{path}: {left} blocks that were computed are not there any more; start the sweep again"
        )
    log.info("%s: complete", path)
    return open_cube(path)


def plan_blocks(
    sizes: Mapping[str, int], items: Sequence[str], seconds: float, items_per_task: int | None
) -> Blocks:
    """Cut the cube, whose work takes so many seconds of core time, into blocks of one record each."""
    total = math.prod(map(float, sizes.values()))
    if items_per_task is None:
        length = min(LONGEST, max(SHORTEST, seconds / (SHARE * cores())))
        cells = min(LARGEST, total * length / seconds)
    else:
        cells = items_per_task * math.prod(
            size for dim, size in sizes.items() if dim not in ("record", *items)
        )
    return cut(sizes, items, cells, singly=("record",))


def identity_of(frame: xr.Dataset) -> dict[str, Any]:
    """Return what a store's sweep and this one must share: versions, parameters, the numbers of records."""
    from fdspec.compiler.options import source_key

    parameters = json.loads(frame.attrs["parameters"])
    records = {record["name"]: record["checksum"] for record in parameters.pop("records")}
    versions = {"fdspec_version": frame.attrs["fdspec_version"], "kernels_source": source_key()}
    return {**versions, **parameters, "records": records}


def differences(held: Mapping[str, Any], wanted: Mapping[str, Any]) -> list[str]:
    """Say of each thing that a store and a study do not share what it is there and what here."""
    told = []
    for name in dict.fromkeys([*held, *wanted]):
        there, here = held.get(name), wanted.get(name)
        if name == "records":
            told += _other_records(there or {}, here or {})
        elif name == "buildings" and isinstance(there, dict) and isinstance(here, dict):
            told += _other_buildings(there, here)
        elif there != here:
            told.append(f"{name} is {_short(there)} in the store, {_short(here)} in the study")
    return told


def _other_records(there: Mapping[str, str], here: Mapping[str, str]) -> list[str]:
    if there == here and list(there) != list(here):
        return ["the records stand in another order"]
    return [
        *(f"record {name} is not in the study" for name in there if name not in here),
        *(f"record {name} is not in the store" for name in here if name not in there),
        *(f"record {name} has other numbers" for name in there if here.get(name, there[name]) != there[name]),
    ]


def _other_buildings(there: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    if there == here and list(there) != list(here):
        return ["the buildings stand in another order"]
    told = [f"building {name} is not in the study" for name in there if name not in here]
    told += [f"building {name} is not in the store" for name in here if name not in there]
    for name in there:
        mine, other = here.get(name, there[name]), there[name]
        parts = [part for part in {**other, **mine} if mine.get(part) != other.get(part)]
        told += [f"building {name} has another {', '.join(parts)}"] if parts else []
    return told


def _status(variables: Sequence[Variable]) -> Variable:
    return next(variable for variable in variables if variable.name == description.STATUS)


def _dims(variables: Sequence[Variable]) -> tuple[str, ...]:
    """Return the cube's dims: those of every history, and then what it has of its own, such as storeys."""
    every = (_status(variables), *variables)
    return tuple(dict.fromkeys(dim for variable in every for dim in variable.dims))


def _agreed(path: Path, identity: Mapping[str, Any]) -> Blocks:
    """Return how the store is cut, when its sweep is this one."""
    blocks, held = description.described(path)
    told = differences(held, identity)
    if told:
        raise StoreError(
            f"{path} holds another sweep: {'; '.join(told)}; name another store, or start over "
            "with --restart (restart=True)"
        )
    return blocks


def _unfinished(path: Path, blocks: Blocks, variables: Sequence[Variable]) -> Iterator[int]:
    """Give the blocks to be computed; what is damaged is removed and computed again."""
    for number, state, damaged in chunks.states(path, blocks, variables):
        for chunk in damaged:
            log.warning("%s is damaged and will be computed again", chunk)
        if state is not chunks.State.WHOLE:
            # The status first: it says that the others are there.
            status = chunks.chunk_path(path, blocks, number, _status(variables))
            for chunk in (status, *damaged):
                chunks.clear(chunk)
        if state is not chunks.State.WHOLE:
            yield number


def _items(blocks: Blocks, items: Sequence[str], number: int) -> tuple[int, IntArray]:
    """Return a block's record and its items, numbered over the whole cube."""
    slices = blocks.slices(number)
    numbers = np.arange(math.prod(blocks.sizes[dim] for dim in items))
    every = numbers.reshape([blocks.sizes[dim] for dim in items])
    return slices["record"].start, every[tuple(slices[dim] for dim in items)].ravel()


def _fill(
    path: Path,
    blocks: Blocks,
    items: tuple[str, ...],
    records: tuple[str, ...],
    variables: Sequence[Variable],
    compute: Compute,
    numbers: IntArray,
    motion: GroundMotion,
) -> int:
    """Compute a block and write it; return how many of its histories have a status other than ok."""
    first = np.unravel_index(int(numbers[0]), [blocks.sizes[dim] for dim in items])
    at = dict.fromkeys(blocks.sizes, 0) | dict(zip(items, map(int, first), strict=True))
    at["record"] = records.index(motion.name)
    values = compute(numbers, motion)
    chunks.write(path, blocks, blocks.number(at), values, variables)
    return int(np.count_nonzero(values["status"]))


def _short(value: object) -> str:
    if isinstance(value, list) and len(value) > 4:
        return f"{len(value)} values from {value[0]} to {value[-1]}"
    return json.dumps(value)
