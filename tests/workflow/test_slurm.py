"""A real SLURM, one node on loopback, through dask-jobqueue; scripts/slurm_on_loopback.sh sets it up."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.store import chunks
from tests.unit.test_sweep import record
from tests.workflow.test_cluster import some_finished, when

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "slurm_on_loopback.sh"

AXES: dict[str, Any] = {
    "period": np.linspace(0.05, 1.0, 40),
    "pretension": np.linspace(0.0, 400e3, 20),
    "stiffness_ratio": [0.5, 4.0, 10.0],
}

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        sys.platform != "linux" or os.geteuid() != 0 or shutil.which("apt-get") is None,
        reason="the daemons are installed and started by root on Debian",
    ),
    # What tornado and distributed leave open when a job is cancelled is not ours to close.
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
    # dask-jobqueue 0.9 meets distributed 2026.8 with these.
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
    pytest.mark.filterwarnings("ignore::FutureWarning"),
]


@pytest.fixture
def slurm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    folder = tmp_path / "slurm"
    subprocess.run(["bash", SCRIPT, "start", folder], check=True, timeout=300)
    monkeypatch.setenv("SLURM_CONF", str(folder / "slurm.conf"))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    try:
        yield
    finally:
        subprocess.run(["bash", SCRIPT, "stop", folder], check=True, timeout=60)


def jobs() -> list[str]:
    """Return the numbers of the jobs that run."""
    command = ["squeue", "--noheader", "--states=RUNNING", "--format=%i"]
    told = subprocess.run(command, capture_output=True, text=True, check=True)
    return told.stdout.split()


@pytest.mark.usefixtures("slurm")
def test_a_job_that_is_cancelled_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dask_jobqueue import SLURMCluster
    from distributed import Client

    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    motions = [record("a"), record("b", 2, 250)]
    plain = fdspec.sweep(motions, **AXES)
    store = tmp_path / "cube.zarr"
    cancelled: list[str] = []

    def cancel() -> None:
        cancelled.append(jobs()[0])
        subprocess.run(["scancel", "--signal=KILL", cancelled[0]], check=True)

    with (
        SLURMCluster(
            cores=1,
            processes=1,
            memory="1GB",
            walltime="00:30:00",
            interface="lo",
            python=sys.executable,
            local_directory=str(tmp_path),
            log_directory=str(tmp_path / "logs"),
            job_directives_skip=["--mem"],
            scheduler_options={"dashboard_address": ":0"},
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        cluster.adapt(minimum=2, maximum=2)
        client.wait_for_workers(2, timeout=120)
        before = set(jobs())
        assert len(before) == 2
        with when(some_finished(store), cancel):
            swept = fdspec.sweep(motions, **AXES, client=client, store=store, columns_per_task=1)
        xr.testing.assert_identical(swept.load(), plain)
        assert chunks.unfinished(store) == 0
        until = time.monotonic() + 60
        while time.monotonic() < until and not (len(jobs()) == 2 and cancelled[0] not in jobs()):
            time.sleep(0.5)
        assert cancelled[0] in before
        assert cancelled[0] not in jobs()
        assert set(jobs()) - before, "no job has taken its place"
