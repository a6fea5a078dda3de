"""Two processes that write one thing: whole in the end, with the right bits, and nobody's work taken away."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray as xr

import fdspec
from fdspec.errors import BusyError, StoreError
from fdspec.locks import lock_file, locked
from fdspec.records.links import VARIABLE
from fdspec.store import chunks
from fdspec.store.replacing import replacing
from tests.unit.test_sweep import AXES, record

STUDY = (
    'records = ["FSR1", "FSR2"]\nstiffness_ratio = [1, 2, 4]\n'
    "pretension = [10e3, 30e3, 50e3, 100e3]\nperiod = [{}]\n"
).format(", ".join(f"{0.02 * k:.2f}" for k in range(2, 60)))


def started(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "fdspec", *arguments],
        cwd=folder,
        env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def until(true: Callable[[], bool], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    folder = tmp_path_factory.mktemp("plain")
    (folder / "s.toml").write_text(STUDY)
    run = started(folder, "sweep", "s.toml")
    run.communicate()
    assert run.returncode == 0
    return fdspec.open(folder / "s.nc")


def two_runs(folder: Path, plain: xr.Dataset, options: list[list[str]], delay: float) -> None:
    folder.mkdir()
    (folder / "s.toml").write_text(STUDY)
    first = started(folder, "sweep", "s.toml", *options[0])
    time.sleep(delay)
    runs = [first, started(folder, "sweep", "s.toml", *options[1])]
    told = [run.communicate(timeout=120) for run in runs]
    codes = [run.returncode for run in runs]
    assert 0 in codes
    for code, (_, err) in zip(codes, told, strict=True):
        assert "Traceback" not in err
        if code:
            assert code in {1, 2}
            # Refused by the other's process, or by its file.
            assert any(f"process {run.pid} " in err for run in runs) or "exists already" in err, err
    xr.testing.assert_identical(fdspec.open(folder / "s.nc"), plain)
    assert sorted(path.name for path in folder.iterdir()) == ["s.nc", "s.toml"]


@pytest.mark.parametrize("seed", [0])
def test_one_of_two_sweeps_is_refused_by_process(tmp_path: Path, plain: xr.Dataset, seed: int) -> None:
    delay = random.Random(seed).uniform(0.0, 1.5)
    two_runs(tmp_path / "run", plain, [["--resumable"], ["--resumable"]], delay)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 10))
def test_interleavings_of_two_sweeps(tmp_path: Path, plain: xr.Dataset, seed: int) -> None:
    chance = random.Random(seed)
    kinds = [["--resumable"], ["--resumable", "--force"], ["--not-resumable", "--force"], ["--restart"]]
    two_runs(tmp_path / "run", plain, [chance.choice(kinds), chance.choice(kinds)], chance.uniform(0.0, 3.0))


def test_a_killed_run_holds_nothing(tmp_path: Path, plain: xr.Dataset) -> None:
    (tmp_path / "s.toml").write_text(STUDY)
    run = started(tmp_path, "sweep", "s.toml", "--resumable")
    until((tmp_path / "s.unfinished.zarr" / "zarr.json").exists)
    busy = pytest.raises(BusyError, match=rf"s\.nc is being written by process {run.pid} on '.+', started 2")
    with busy, locked(tmp_path / "s.nc"):
        pass
    run.kill()
    run.communicate()
    assert lock_file(tmp_path / "s.nc").exists()  # and locks nothing
    again = started(tmp_path, "sweep", "s.toml", "--resumable")
    again.communicate()
    assert again.returncode == 0
    xr.testing.assert_identical(fdspec.open(tmp_path / "s.nc"), plain)
    assert not lock_file(tmp_path / "s.nc").exists()


def test_a_store_that_is_read_is_not_removed(tmp_path: Path) -> None:
    store = tmp_path / "cube.zarr"
    motion = record("a", samples=60)
    whole = fdspec.sweep(motion, **AXES, store=store, columns_per_task=3)
    part = whole.peak_acceleration[:, 1]
    expected = part.values
    del whole
    with pytest.raises(BusyError, match="is being read"):
        chunks.remove(store)
    with pytest.raises(BusyError, match="is being read"):
        fdspec.sweep(motion, **AXES, store=store, restart=True)
    assert (part.values == expected).all()
    del part
    chunks.remove(store)
    assert not store.exists()


def test_a_store_that_was_removed_is_no_fill_value(tmp_path: Path) -> None:
    swept = fdspec.sweep(record("a", samples=60), **AXES, store=tmp_path / "cube.zarr")
    (tmp_path / "cube.zarr").rename(tmp_path / "away")
    with pytest.raises(StoreError, match="the store was removed"):
        swept.peak_acceleration.load()


def test_of_two_files_that_may_not_replace_one_is_kept(tmp_path: Path) -> None:
    cube = xr.Dataset({"a": ("x", [1.0])})

    refused = pytest.raises(StoreError, match="exists already")
    with refused, replacing(tmp_path / "a.nc", overwrite=False) as part:
        part.write_text("second")
        fdspec.save(cube, tmp_path / "a.nc", overwrite=False)
    xr.testing.assert_identical(fdspec.open(tmp_path / "a.nc"), cube)
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc"]


def test_of_links_made_at_one_time_none_is_lost(tmp_path: Path) -> None:
    program = (
        "import sys, fdspec.records.links as l, pathlib\n"
        "l.save_links({sys.argv[1]: l.Link(pathlib.Path('x'), 'c', '0' * 64)})\n"
    )
    environment = {**os.environ, VARIABLE: str(tmp_path / "records.toml")}
    names = [f"R{k}" for k in range(9)]
    runs = [subprocess.Popen([sys.executable, "-c", program, name], env=environment) for name in names]
    assert [run.wait() for run in runs] == [0] * 9
    kept = (tmp_path / "records.toml").read_text()
    assert all(f"[{name}]" in kept for name in names)


def test_a_thread_holds_its_own_lock_twice_and_another_does_not(tmp_path: Path) -> None:
    refused: list[BusyError] = []

    def other() -> None:
        try:
            with locked(tmp_path / "a.nc"):
                pass
        except BusyError as error:
            refused.append(error)

    with locked(tmp_path / "a.nc"), locked(tmp_path / "a.nc"):
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
    assert "another thread of this process" in str(refused[0])
    other()
    assert len(refused) == 1
    assert list(tmp_path.iterdir()) == []
