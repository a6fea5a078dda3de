"""Tasks of many histories each, spread over threads or processes; the only importer of dask.

Results do not depend on how items are shared out: each item is computed from itself and its motion alone.
"""

from __future__ import annotations

import multiprocessing
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from types import FrameType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import dask
from dask.callbacks import Callback

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.progress import progress as progress_bar
from fdspec.scheduling.task import IntArray, Task, cores
from fdspec.stopping import STOPPING

if TYPE_CHECKING:
    from fdspec.scheduling.task import Client

Result = TypeVar("Result")


class Done(NamedTuple, Generic[Result]):
    """What a task returns, and how many histories that took."""

    histories: int
    result: Result


def fan_out(
    work: Callable[[IntArray, GroundMotion], Result],
    motions: Sequence[GroundMotion],
    tasks: Sequence[Task],
    *,
    each: int,
    warm: Callable[[], None],
    workers: int | None,
    scheduler: str,
    progress: Shown,
    client: Client | None = None,
    finished: int = 0,
    what: str = "histories",
) -> list[Result]:
    """Return the work's result for every task, in their order.

    work: a function of a module, or a partial of one, which other processes can import; each: histories
    of an item; warm: loads the kernels, compiling them where no cache holds them, before many threads want
    them; client: a cluster that takes the tasks instead; finished: histories done before, for the bar;
    what: what the bar calls them.
    """
    if workers is not None and workers < 1:
        raise InvalidInput(f"workers must be at least 1, got {workers}")
    total = finished + each * sum(task.items.size for task in tasks)
    if client is not None:
        from fdspec.scheduling.cluster import gather

        with progress_bar(total, what, shown=progress, finished=finished) as done:

            def tell(task: Task) -> None:
                done(each * task.items.size)

            return gather(client, work, motions, tasks, tell)
    records = [dask.delayed(motion, pure=False, traverse=False) for motion in motions]
    counted = dask.delayed(partial(_counted, work, each), pure=False, traverse=False)
    graph = [counted(task.items, records[task.record]) for task in tasks]
    with progress_bar(total, what, shown=progress, finished=finished) as done, _reported(done):
        with interrupted_at_last():
            warm()
        done(0)
        with _pool(scheduler, workers or cores()) as pool:
            parts = dask.compute(*graph, scheduler=scheduler, num_workers=workers or cores(), **pool)
    return [part.result for part in parts]


@contextmanager
def _pool(scheduler: str, count: int) -> Iterator[dict[str, Executor]]:
    """Give dask threads of this sweep's own.

    dask keeps those that it makes for later, and a forked child would wait for its parent's for ever.
    """
    if scheduler == "processes" and multiprocessing.current_process().daemon:
        raise InvalidInput(
            "a process of a multiprocessing.Pool can start no processes: "
            "give scheduler='threads' or 'synchronous'"
        )
    if scheduler != "threads":
        yield {}
        return
    pool = ThreadPoolExecutor(count, thread_name_prefix="fdspec")
    try:
        yield {"pool": pool}
    finally:
        pool.shutdown(cancel_futures=True)


def _counted(
    work: Callable[[IntArray, GroundMotion], Result], each: int, items: IntArray, motion: GroundMotion
) -> Done[Result]:
    return Done(each * items.size, work(items, motion))


@contextmanager
def interrupted_at_last() -> Iterator[None]:
    """Heed at the end of this block a Ctrl-C, or another signal that raises, that was not heard inside it.

    Loading kernels runs callbacks from C, and what is raised in one of those Python prints and forgets.
    """
    heeded = {number: handler for number in STOPPING if callable(handler := signal.getsignal(number))}
    if threading.current_thread() is not threading.main_thread() or not heeded:
        yield
        return
    came = []

    def remember(number: int, frame: FrameType | None) -> None:
        came.append(number)
        heeded[number](number, frame)

    for number in heeded:
        signal.signal(number, remember)
    try:
        yield
    finally:
        for number, handler in heeded.items():
            signal.signal(number, handler)
    if came:
        heeded[came[0]](came[0], None)


@contextmanager
def _reported(done: Callable[[int], None]) -> Iterator[None]:
    """Tell ``done`` of the histories that each finished task held."""

    def posttask(key: Any, result: Any, dsk: Any, state: Any, worker_id: Any) -> None:  # noqa: ARG001
        if isinstance(result, Done):
            done(result.histories)

    with Callback(posttask=posttask):
        yield
