"""Workers in processes of their own: the bits of threads; a lost worker or scheduler loses nothing else."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
import xarray as xr

import fdspec
from fdspec.cli import main
from fdspec.errors import ClusterError, DiskError
from fdspec.scheduling import cluster
from fdspec.scheduling.task import Task
from fdspec.store import chunks, description
from tests.unit.test_sweep import record

ROOT = Path(__file__).resolve().parents[2]

AXES: dict[str, Any] = {
    "period": np.linspace(0.05, 1.0, 20),
    "pretension": [0.0, 20e3, 110e3, 400e3, np.inf],
    "stiffness_ratio": [0.5, 4.0, 10.0],
}

pytestmark = [
    # What tornado and distributed leave open when a worker is killed is not ours to close.
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


@pytest.fixture(scope="module")
def motions() -> list[fdspec.GroundMotion]:
    return [record("a"), record("b", 2, 250)]


@pytest.fixture(autouse=True, scope="module")
def same_time() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        yield


@pytest.fixture(scope="module")
def plain(motions: list[fdspec.GroundMotion]) -> xr.Dataset:
    return fdspec.sweep(motions, **AXES)


@pytest.fixture(scope="module")
def two() -> Iterator[Any]:
    """Give the client of two worker processes."""
    with cluster.processes(2) as client:
        yield client


class Network:
    """A scheduler and two workers, each a process of its own, over TCP."""

    def __init__(self, folder: Path, workers: int) -> None:
        self.folder = folder
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler = self.start_scheduler()
        self.workers = [self.start_worker() for _ in range(workers)]

    def start_scheduler(self) -> subprocess.Popen[bytes]:
        return self._dask("scheduler", "--host", "127.0.0.1", "--port", str(self.port))

    def start_worker(self) -> subprocess.Popen[bytes]:
        return self._dask("worker", self.address, "--nthreads", "1", "--local-directory", str(self.folder))

    def _dask(self, what: str, *arguments: str) -> subprocess.Popen[bytes]:
        return self.start("-m", f"distributed.cli.dask_{what}", "--no-dashboard", *arguments)

    def start(self, *arguments: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, *arguments],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def end(self) -> None:
        for process in (*self.workers, self.scheduler):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@contextmanager
def network(folder: Path, workers: int = 2) -> Iterator[Network]:
    made = Network(folder, workers)
    try:
        yield made
    finally:
        made.end()


@contextmanager
def when(condition: Callable[[], bool], act: Callable[[], None]) -> Iterator[None]:
    """Act once, beside the block, as soon as the condition holds; it must come to hold."""
    acted = threading.Event()
    over = threading.Event()

    def watch() -> None:
        while not over.is_set():
            if condition():
                act()
                acted.set()
                return
            time.sleep(0.005)

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()
    assert acted.is_set(), "the sweep was over before"


def some_finished(store: Path) -> Callable[[], bool]:
    return lambda: description.is_store(store) and len(list((store / "status/c").rglob("0"))) > 5


def test_two_processes_give_the_bits_of_threads(
    two: Any, motions: list[fdspec.GroundMotion], plain: xr.Dataset, tmp_path: Path
) -> None:
    xr.testing.assert_identical(fdspec.sweep(motions, **AXES, client=two, columns_per_task=7), plain)
    swept = fdspec.sweep(motions, **AXES, client=two, store=tmp_path / "cube.zarr", columns_per_task=7)
    xr.testing.assert_identical(swept.load(), plain)


@pytest.mark.slow
def test_buildings_in_two_processes(two: Any, motions: list[fdspec.GroundMotion]) -> None:
    building = fdspec.Building([20e3, 18e3], [12e6, 9e6], 50.0, 30e6, [20e3, 10e3])
    factors: dict[str, Any] = {"slip_scale": [0.5, 1.0], "stiffness_scale": [1.0]}
    here = fdspec.sweep_buildings(motions, {"two": building}, **factors)
    there = fdspec.sweep_buildings(motions, {"two": building}, **factors, client=two, cells_per_task=1)
    xr.testing.assert_identical(there, here)


@pytest.mark.slow
def test_a_killed_worker_costs_nothing_but_time(
    two: Any, motions: list[fdspec.GroundMotion], plain: xr.Dataset, tmp_path: Path
) -> None:
    store = tmp_path / "cube.zarr"
    victim = next(iter(two.run(os.getpid).values()))
    with when(some_finished(store), lambda: os.kill(victim, signal.SIGKILL)):
        swept = fdspec.sweep(motions, **AXES, client=two, store=store, columns_per_task=1)
    xr.testing.assert_identical(swept.load(), plain)
    two.wait_for_workers(2, timeout=60)
    assert victim not in two.run(os.getpid).values()


@pytest.mark.slow
def test_records_travel_once(two: Any, motions: list[fdspec.GroundMotion]) -> None:
    """Twelve tasks under one record: it comes to each of two workers at most once."""
    long = fdspec.GroundMotion(np.tile(motions[0].acceleration, 200), 0.01, name="long")
    assert long.acceleration.nbytes > 600_000
    two.run(count_arrivals)
    fdspec.sweep(
        long,
        period=[0.5],
        pretension=[0.0, 1e3],
        stiffness_ratio=np.arange(1.0, 13.0),
        client=two,
        columns_per_task=1,
    )
    assert max(two.run(arrivals_of, "long").values()) == 1


ARRIVALS: list[str] = []
"""Names of the records that a worker has unpickled: each time that one came to it."""


def count_arrivals() -> None:
    """Have the worker that runs this note each record that comes to it."""
    ARRIVALS.clear()
    unpickle = fdspec.GroundMotion.__setstate__

    def noted(motion: fdspec.GroundMotion, state: dict[str, Any]) -> None:
        unpickle(motion, state)
        ARRIVALS.append(motion.name)

    fdspec.GroundMotion.__setstate__ = noted  # type: ignore[method-assign]


def arrivals_of(name: str) -> int:
    return ARRIVALS.count(name)


def test_an_error_of_the_disk_comes_home(
    two: Any, motions: list[fdspec.GroundMotion], tmp_path: Path
) -> None:
    store = tmp_path / "cube.zarr"
    with (
        when(some_finished(store), lambda: chunks.remove(store)),
        pytest.raises(DiskError, match="there is no such store; it was removed"),
    ):
        fdspec.sweep(motions, **AXES, client=two, store=store, columns_per_task=1)


def test_other_kernels_on_a_worker_are_refused(
    two: Any, motions: list[fdspec.GroundMotion], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "version", lambda: "0.0.1, kernels none")
    with pytest.raises(ClusterError, match=r"runs fdspec 0\.1\.0.*this is fdspec 0\.0\.1"):
        fdspec.sweep(motions, **AXES, client=two)


@pytest.mark.slow
def test_a_task_that_kills_its_workers_is_named(motions: list[fdspec.GroundMotion]) -> None:
    tasks = [Task(0, np.arange(1)), Task(1, np.arange(1))]
    done: list[Any] = []
    said = r"1 of 2 tasks killed every worker that took them \(records b\)"
    with cluster.processes(2) as client, pytest.raises(ClusterError, match=said):
        cluster.gather(client, deadly, motions, tasks, done.append)
    assert done == [tasks[0]]


def deadly(items: np.ndarray, motion: fdspec.GroundMotion) -> int:
    if motion.name == "b":
        os.kill(os.getpid(), signal.SIGKILL)
    return 1


def test_nobody_at_the_address(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "CONNECT", 0.5)
    nobody = cluster.connected("tcp://127.0.0.1:1")
    with pytest.raises(ClusterError, match=r"there is no scheduler at tcp://127\.0\.0\.1:1:"), nobody:
        pass


def listening(process: psutil.Process) -> set[str]:
    """Addresses at which a process takes connections."""
    return {at.laddr.ip for at in process.net_connections("inet") if at.status == psutil.CONN_LISTEN}


def test_processes_listen_to_this_machine_alone(two: Any) -> None:
    here = psutil.Process()
    addresses = [listening(process) for process in (here, *here.children(recursive=True))]
    assert set().union(*addresses) == {"127.0.0.1"}
    assert len([found for found in addresses if found]) >= 3  # the scheduler and two workers


def test_only_who_holds_the_key_can_use_the_scheduler(two: Any) -> None:
    from distributed import Client

    assert two.scheduler.address.startswith("tls://")
    with pytest.raises((OSError, TypeError)):
        Client(two.scheduler.address.replace("tls://", "tcp://"), timeout=2, set_as_default=False)


def test_a_cluster_without_workers_is_told(
    tmp_path: Path, motions: list[fdspec.GroundMotion], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    with (
        network(tmp_path, workers=0) as made,
        cluster.connected(made.address) as client,
        pytest.raises(ClusterError, match="no worker took a task within 1 s; start workers"),
    ):
        fdspec.sweep(motions, **AXES, client=client)


def test_a_worker_without_fdspec_is_named(tmp_path: Path, motions: list[fdspec.GroundMotion]) -> None:
    with network(tmp_path, workers=0) as made, cluster.connected(made.address) as client:
        lacking = (
            "import sys; sys.modules['fdspec'] = None; from distributed.cli.dask_worker import main; main()"
        )
        made.workers = [
            made.start("-c", lacking, made.address, "--no-nanny", "--local-directory", str(tmp_path))
        ]
        with pytest.raises(
            ClusterError, match=r"worker tcp://.* cannot load fdspec \(No module named 'fdspec"
        ):
            fdspec.sweep(motions, **AXES, client=client)


@pytest.mark.slow
def test_a_cluster_whose_workers_are_gone_for_good_is_told(
    tmp_path: Path, motions: list[fdspec.GroundMotion], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 5.0)
    monkeypatch.setattr(cluster, "SILENCE", 1.0)
    store = tmp_path / "cube.zarr"
    with network(tmp_path) as made, cluster.connected(made.address) as client:

        def kill() -> None:
            for worker in made.workers:
                os.killpg(worker.pid, signal.SIGKILL)

        with (
            when(some_finished(store), kill),
            pytest.raises(ClusterError, match="the cluster has had no workers for 5 s"),
        ):
            fdspec.sweep(motions, **AXES, client=client, store=store, columns_per_task=1)


def test_workers_lost_between_the_word_of_a_result_and_the_result_are_told(
    tmp_path: Path, motions: list[fdspec.GroundMotion], monkeypatch: pytest.MonkeyPatch
) -> None:
    from distributed import Future

    monkeypatch.setattr(cluster, "PATIENCE", 2.0)
    monkeypatch.setattr(cluster, "SILENCE", 0.5)
    fetched = Future.result
    with network(tmp_path) as made, cluster.connected(made.address) as client:

        def too_late(future: Future, timeout: float | None = None) -> object:
            if future.key.startswith("_run"):
                for worker in made.workers:
                    with suppress(ProcessLookupError):
                        os.killpg(worker.pid, signal.SIGKILL)
            return fetched(future, timeout)

        monkeypatch.setattr(Future, "result", too_late)
        with pytest.raises(ClusterError, match="the cluster has had no workers for 2 s"):
            fdspec.sweep(motions, **AXES, client=client)


@pytest.mark.slow
@pytest.mark.parametrize("where", [("--workers", "2"), ("--threads", "2")])
@pytest.mark.parametrize(
    ("number", "code", "said"),
    [(signal.SIGINT, 130, "fdspec: interrupted"), (signal.SIGTERM, 143, "fdspec: stopped by SIGTERM")],
)
def test_a_signal_to_all_its_processes_is_one_line(
    tmp_path: Path, where: tuple[str, ...], number: int, code: int, said: str
) -> None:
    """As a terminal sends Ctrl-C, and Slurm SIGTERM."""
    (tmp_path / "long.toml").write_text(
        "period = { start = 0.05, stop = 3, num = 400 }\n"
        "pretension = { start = 1e4, stop = 1e6, num = 100 }\n",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "fdspec", "sweep", "long.toml", "-o", "long.zarr", *where]
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )
    try:
        while not some_finished(tmp_path / "long.zarr")():
            assert process.poll() is None
            time.sleep(0.05)
        os.killpg(process.pid, number)
        _, err = process.communicate(timeout=60)
    finally:
        process.kill()
    kept = "fdspec: long.zarr keeps what is finished; the same command goes on from there"
    assert [line for line in err.splitlines() if line] == [kept, said]
    assert process.returncode == code
    assert {path.name for path in tmp_path.iterdir()} == {"long.toml", "long.zarr"}


@pytest.mark.slow
def test_over_tcp_from_the_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(
        'records = ["FSR1"]\nstiffness_ratio = [1, 4]\npretension = [0, 50e3]\n'
        "period = { start = 0.1, stop = 1, num = 10 }\n",
        encoding="utf-8",
    )
    assert main(["sweep", "study.toml", "-o", "threads.nc"]) == 0
    with network(tmp_path) as made:
        assert main(["sweep", "study.toml", "-o", "tcp.nc", "--scheduler", made.address, "--log", "log"]) == 0
        assert main(["sweep", "study.toml", "-o", "tcp.zarr", "--scheduler", made.address]) == 0
    threads = fdspec.open("threads.nc")
    xr.testing.assert_identical(fdspec.open("tcp.nc"), threads)
    xr.testing.assert_identical(fdspec.open("tcp.zarr", lazily=False), threads)
    log = Path("log").read_text(encoding="utf-8")
    assert f"scheduler {made.address} with" in log
    assert "40 of 40 histories" in log
    assert "status: 40 ok" in log


@pytest.mark.slow
def test_a_scheduler_that_is_restarted_goes_on(
    motions: list[fdspec.GroundMotion], plain: xr.Dataset, tmp_path: Path
) -> None:
    store = tmp_path / "cube.zarr"
    with network(tmp_path) as made:

        def restart() -> None:
            os.killpg(made.scheduler.pid, signal.SIGKILL)
            made.scheduler.wait()
            made.scheduler = made.start_scheduler()
            for worker in made.workers:  # they close when their scheduler is gone
                worker.wait(60)
            made.workers = [made.start_worker(), made.start_worker()]

        with cluster.connected(made.address) as client, when(some_finished(store), restart):
            swept = fdspec.sweep(motions, **AXES, client=client, store=store, columns_per_task=1)
        xr.testing.assert_identical(swept.load(), plain)


@pytest.mark.slow
def test_a_scheduler_that_stays_away_is_told_and_the_next_run_goes_on(
    motions: list[fdspec.GroundMotion], plain: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = tmp_path / "cube.zarr"
    monkeypatch.setattr(cluster, "PATIENCE", 2.0)
    with (
        network(tmp_path) as made,
        cluster.connected(made.address) as client,
        when(some_finished(store), lambda: os.killpg(made.scheduler.pid, signal.SIGKILL)),
        pytest.raises(ClusterError, match="the scheduler is lost"),
    ):
        fdspec.sweep(motions, **AXES, client=client, store=store, columns_per_task=1)
    assert 0 < chunks.unfinished(store) < 120
    xr.testing.assert_identical(fdspec.sweep(motions, **AXES, store=store).load(), plain)
