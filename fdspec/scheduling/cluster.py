"""Tasks on a cluster of dask.distributed; the only importer of distributed.

What many tasks share (the work with its grid, each record) is a task of its own: a worker gets it once and
keeps it, and when the worker that held it dies it is made again.
"""

from __future__ import annotations

import logging
import math
import multiprocessing.resource_tracker
import signal
import socket
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING, Any, Final, TypeVar

from fdspec.errors import ClusterError, FdspecError
from fdspec.model.motion import GroundMotion
from fdspec.scheduling.task import IntArray, Task
from fdspec.version import __version__

if TYPE_CHECKING:
    from distributed import Client, Future

Result = TypeVar("Result")

IN_FLIGHT: Final = 2000
"""Tasks that the scheduler knows at a time: many for any cluster that grows by need, few for its memory."""

RETRIES: Final = 2
"""More attempts at a task that failed: a network file system may come back."""

DEATHS: Final = 2
"""Times that a task may be given up by the scheduler, which each time saw it take several workers along."""

PATIENCE: Final = 120.0
"""s that a lost scheduler, or the first worker, is waited for."""

SILENCE: Final = 5.0
"""s without a result after which the workers are counted."""

LOOPBACK: Final = "127.0.0.1"

CONNECT: Final = 30.0
"""s that a scheduler may take to answer."""

ASKED: Final = "__import__('fdspec.scheduling.cluster', fromlist=['version']).version()"

log = logging.getLogger(__name__)


@contextmanager
def connected(address: str) -> Iterator[Client]:
    """Give a client of the scheduler at this address, such as tcp://host:8786."""
    with _installed():
        from distributed import Client
    try:
        client = Client(address, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(f"there is no scheduler at {address}: {error}") from error
    with client:
        log.info("scheduler %s with %d workers", address, len(client.scheduler_info(-1)["workers"]))
        yield client


@contextmanager
def processes(count: int) -> Iterator[Client]:
    """Give a client of so many worker processes on this machine, each of one thread."""
    with _installed():
        from distributed import Client, LocalCluster, Security
    with _deaf_to_ctrl_c():
        cluster = LocalCluster(
            n_workers=count,
            threads_per_worker=1,
            processes=True,
            host=LOOPBACK,
            dashboard_address=f"{LOOPBACK}:0",  # it is served even where none is asked for, then to everybody
            worker_dashboard_address=f"{LOOPBACK}:0",
            silence_logs=logging.CRITICAL,
            security=Security.temporary(),  # who can reach the scheduler can run code here
        )
    with cluster, Client(cluster, set_as_default=False) as client:
        # One that is killed is started again by its nanny; should that give up too, this makes another.
        cluster.adapt(minimum=count, maximum=count)
        log.info("%d worker processes", count)
        yield client


@contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """Have processes that are started in this block, and by threads started in it, never hear of a Ctrl-C.

    A terminal sends it to all of them; this process alone answers it, and ends the others.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Else spawning starts it and unblocks the signal.  What a killed worker left it clears without a word.
    sys.warnoptions.append("ignore:resource_tracker:UserWarning")
    multiprocessing.resource_tracker.ensure_running()
    sys.warnoptions.remove("ignore:resource_tracker:UserWarning")
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def gather(
    client: Client,
    work: Callable[[IntArray, GroundMotion], Result],
    motions: Sequence[GroundMotion],
    tasks: Sequence[Task],
    done: Callable[[Task], None],
) -> list[Result]:
    """Return the work's result for every task, in their order.

    done: told of each task as it ends.  A worker that is lost costs what it was at; a scheduler that is lost
    and comes back within PATIENCE costs what it knew, not what has come home.
    """
    results: dict[int, Result] = {}
    deaths: dict[int, int] = {}
    left = list(range(len(tasks)))
    _check_workers(client)
    while left:
        for index, outcome in _round(client, work, motions, tasks, left):
            if isinstance(outcome, Exception):
                deaths[index] = deaths.get(index, 0) + 1
                log.warning("a task took its workers along: %s", outcome)
                continue
            results[index] = outcome
            done(tasks[index])
        left = [index for index in left if index not in results]
        if doomed := [index for index in left if deaths.get(index, 0) >= DEATHS]:
            names = sorted({motions[tasks[index].record].name for index in doomed})
            raise ClusterError(
                f"{len(doomed)} of {len(tasks)} tasks killed every worker that took them (records "
                f"{', '.join(names)}): the workers may need more memory; the others are done"
            )
        if left:
            log.warning("%d of %d tasks have to be sent again", len(left), len(tasks))
            _wait_for_scheduler(client)
    return [results[index] for index in range(len(tasks))]


def _round(
    client: Client,
    work: Callable[[IntArray, GroundMotion], Result],
    motions: Sequence[GroundMotion],
    tasks: Sequence[Task],
    left: Sequence[int],
) -> Iterator[tuple[int, Any]]:
    """Send tasks and give (index, result), or KilledWorker in the result's place; end when all are heard of.

    Ends early, without a word of the others, when the scheduler is lost.
    """
    from distributed import as_completed

    here = version()
    shared = client.submit(_itself, work, pure=False)
    records: dict[int, Future[Any]] = {}
    index_of: dict[Future[Any], int] = {}
    waiting = iter(left)

    def send(index: int) -> Future[Any]:
        task = tasks[index]
        if task.record not in records:
            # Tasks come record by record; those in flight keep what they need.
            for other in [record for record in records if record < task.record]:
                del records[other]
            records[task.record] = client.submit(_itself, motions[task.record], pure=False)
        future = client.submit(
            _run,
            here,
            shared,
            task.items,
            records[task.record],
            pure=False,
            retries=RETRIES,
            priority=-index,
        )
        index_of[future] = index
        return future

    first = [send(index) for index in islice(waiting, IN_FLIGHT)]
    completed = as_completed(first, loop=client.loop)
    company = _Company(client)
    try:
        for future in _as_they_come(company, completed):
            index = index_of.pop(future)
            try:
                yield index, _outcome(company, future)
            except _SchedulerLostError:
                return
            for following in islice(waiting, 1):
                completed.add(send(following))
    finally:
        with suppress(OSError, CancelledError):
            client.cancel(list(index_of))


def _as_they_come(company: _Company, completed: Any) -> Iterator[Future[Any]]:
    """Give futures as they end; an error when for long there has been neither a result nor a worker."""
    while not completed.is_empty():
        if batch := completed.next_batch(block=False):
            yield from batch
            company.heard_of()
            continue
        time.sleep(0.005)
        company.look_after_silence()


class _SchedulerLostError(Exception):
    """The scheduler has gone, and all that it knew."""


def _outcome(company: _Company, future: Future[Any]) -> Any:
    """Return the result of a task that has ended, or the KilledWorker that ended it.

    A worker that is lost while its result comes home leaves the task to be done once more.
    """
    from distributed import KilledWorker

    while future.status != "cancelled":
        if future.status == "error":
            error = future.exception()
            if isinstance(error, KilledWorker):
                return error
            raise error if isinstance(error, FdspecError) else ClusterError(_told(error)) from error
        try:
            return future.result(timeout=SILENCE)
        except TimeoutError:
            company.look_after_silence()
        except Exception as error:
            if future.status == "error":
                continue
            if isinstance(error, (OSError, CancelledError)):
                break
            raise
    raise _SchedulerLostError


class _Company:
    """Whether there are workers to wait for."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.heard_of()

    def heard_of(self) -> None:
        """Start anew: something came back."""
        self._heard, self._alone_since = time.monotonic(), math.inf

    def look_after_silence(self) -> None:
        """Count the workers after every SILENCE; an error when for PATIENCE there has been none."""
        now = time.monotonic()
        if now - self._heard < SILENCE:
            return
        self._heard = now
        if self._client.status != "running" or _workers(self._client):
            self._alone_since = math.inf
            return
        self._alone_since = min(self._alone_since, now)
        if now - self._alone_since > PATIENCE:
            raise ClusterError(f"the cluster has had no workers for {PATIENCE:.0f} s; start some")


def _workers(client: Client) -> list[str]:
    """Addresses of the workers; of one that is unknown where the scheduler does not answer."""
    try:
        return list(client.scheduler_info(-1)["workers"])
    except (OSError, KeyError, TimeoutError):
        return [""]


def _check_workers(client: Client) -> None:
    """Wait for a worker, no longer than PATIENCE, and make sure that those there are run this fdspec.

    Asked of each in words that every Python understands: a worker without fdspec cannot read its functions.
    """
    # A cluster that grows by need starts its first worker for the first task.
    first = client.submit(eval, "1", pure=False)
    for patience in (min(2.0 * SILENCE, PATIENCE), PATIENCE):
        try:
            first.result(timeout=patience)
            break
        except TimeoutError:
            if patience == PATIENCE:
                raise ClusterError(
                    f"no worker took a task within {PATIENCE:.0f} s; start workers for this scheduler"
                ) from None
            log.warning("waiting for the first worker, for %.0f s at most", PATIENCE)
    asked = {
        address: client.submit(eval, ASKED, workers=[address], pure=False)
        for address in _workers(client)
        if address
    }
    until = time.monotonic() + PATIENCE
    for address, future in asked.items():
        try:
            theirs = future.result(timeout=max(until - time.monotonic(), 0.1))
        except (TimeoutError, CancelledError):  # busy, or gone: the next answers with its first task
            continue
        except Exception as error:
            raise ClusterError(
                f"worker {address} cannot load fdspec ({error}); install fdspec {__version__} there"
            ) from error
        if theirs != version():
            raise ClusterError(_other_version(address, theirs))


@contextmanager
def _installed() -> Iterator[None]:
    try:
        yield
    except ImportError as error:
        raise ClusterError(
            f"workers in processes need more than fdspec alone ({error}): pip install 'fdspec[cluster]'"
        ) from error


@cache
def version() -> str:
    """Say which fdspec runs here, to the last character of its kernels."""
    from fdspec.compiler.options import source_key

    return f"{__version__}, kernels {source_key()}"


def _itself(value: Result) -> Result:
    return value


def _run(
    expected: str, work: Callable[[IntArray, GroundMotion], Result], items: IntArray, motion: GroundMotion
) -> Result:
    if version() != expected:
        raise ClusterError(_other_version(socket.gethostname(), version(), expected))
    return work(items, motion)


def _other_version(worker: str, theirs: str, ours: str | None = None) -> str:
    return (
        f"worker {worker} runs fdspec {theirs}, this is fdspec {ours or version()}; "
        "install one version everywhere"
    )


def _wait_for_scheduler(client: Client) -> None:
    until = time.monotonic() + PATIENCE
    while client.status != "running":
        if client.status == "closed" or time.monotonic() > until:
            raise ClusterError("the scheduler is lost; start the sweep again when it is back")
        time.sleep(0.2)


def _told(error: BaseException | None) -> str:
    return f"a task failed on the cluster: {type(error).__name__}: {error}"
