"""Tasks of many histories each, and how the histories of a run are shared out among them."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput

if TYPE_CHECKING:
    import distributed

    Client: TypeAlias = distributed.Client

IntArray = NDArray[np.int64]

TASK_SECONDS: Final = 0.2
"""Target length of a task: long compared with what dask spends on one, short compared with the whole run."""


class Task(NamedTuple):
    """Some items of one record."""

    record: int
    items: IntArray


def cores() -> int:
    """Cores of this machine, as many as dask starts workers."""
    return os.cpu_count() or 1


def require_per_task(per_task: int | None, argument: str) -> None:
    """Raise InvalidInput unless a task has at least one item."""
    if per_task is not None and per_task < 1:
        raise InvalidInput(f"{argument} must be at least 1, got {per_task}")


def plan(items: int, seconds: Sequence[float], per_task: int | None, argument: str) -> list[Task]:
    """Share out the items of every record.

    seconds: rough core time of all items under each record; per_task: items of a task where the user has set
    it in this argument.  Each task takes every n-th item, so that neighbours, which cost about the same, are
    spread over tasks.
    """
    require_per_task(per_task, argument)
    tasks = []
    for record, cost in enumerate(seconds):
        if per_task is None:
            count = max(1, min(items, round(cost / TASK_SECONDS)))
        else:
            count = math.ceil(items / per_task)
        tasks += [Task(record, np.arange(first, items, count)) for first in range(count)]
    return tasks
