"""A sweep that is killed at any instant leaves a readable store, and goes on to the same bits."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import pytest
import xarray as xr

import fdspec
from fdspec.store import chunks

ROOT = Path(__file__).resolve().parents[2]

STUDY = """\
records = ["FSR1", "FMR1", "FHR1"]
stiffness_ratio = [0.5, 1, 2, 4, 10]
pretension = { start = 0, stop = 300e3, num = 40 }
period = { start = 0.05, stop = 1.5, num = 120 }
"""

EPOCH = "1700000000"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    """Give the cube of a sweep that nobody disturbs."""
    folder = tmp_path_factory.mktemp("reference")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    process = start(folder, "-o", "cube.nc")
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    return fdspec.open(folder / "cube.nc")


def start(folder: Path, *options: str) -> subprocess.Popen[bytes]:
    """Start the program as a user does, in a group of its own with all its threads and workers."""
    return subprocess.Popen(
        [sys.executable, "-m", "fdspec", "sweep", "study.toml", *options],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "SOURCE_DATE_EPOCH": EPOCH},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill -9 of the program and of every process that it started."""
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()


def finished(store: Path) -> set[int]:
    """Return the blocks whose status is there."""
    blocks, _ = chunks.described(store)
    status = fdspec.variables.CUBE["status"]
    return {n for n in range(len(blocks)) if chunks.chunk_path(store, blocks, n, status).exists()}


def killed_again_and_again(folder: Path, times: int, *options: str) -> Path:
    """Kill the sweep at random instants of its work; then let it end. Return its store."""
    store = folder / "cube.zarr"
    draw = random.Random(8)
    before: set[int] = set()
    stamps: dict[int, int] = {}
    for attempt in range(times):
        process = start(folder, "-o", "cube.zarr", *options)
        # Mostly in mid-sweep, that is when a new block has come; now and then before.
        until = time.monotonic() + 60
        while attempt % 5 and process.poll() is None and time.monotonic() < until:
            if store.exists() and finished(store) - before:
                break
            time.sleep(0.005)
        time.sleep(draw.uniform(0.0, 0.15) if attempt % 5 else draw.uniform(0.0, 2.0))
        kill(process)
        if not store.exists():
            continue
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            half = fdspec.open(store, lazily=False)
        there = finished(store)
        assert before <= there, "a finished block is gone"
        assert bool(said) == (len(there) < len(chunks.described(store)[0]))
        blocks, _ = chunks.described(store)
        assert int((half["status"] == 0).sum()) == sum(map(blocks.histories, there))
        # What was finished is not written again: its files are those of before.
        for number in there:
            stamp = chunks.chunk_path(store, blocks, number, fdspec.variables.CUBE["status"]).stat().st_ino
            assert stamps.setdefault(number, stamp) == stamp
        before = there
    assert len(before) > times / 2, "the kills missed the work"
    last = start(folder, "-o", "cube.zarr", *options)
    _, errors = last.communicate()
    assert last.returncode == 0, errors
    return store


@pytest.mark.slow
@pytest.mark.parametrize("options", [(), ("--workers", "2")], ids=["threads", "processes"])
def test_killed_at_twenty_instants(folder: Path, reference: xr.Dataset, options: tuple[str, ...]) -> None:
    times = 5 if options else 20
    store = killed_again_and_again(folder, times, *options)
    xr.testing.assert_identical(fdspec.open(store, lazily=False), reference)


@pytest.mark.slow
def test_killed_on_the_way_to_a_file(folder: Path, reference: xr.Dataset) -> None:
    """With a store on the way the file is not there, or whole."""
    draw = random.Random(9)
    path, store = folder / "cube.nc", folder / "cube.unfinished.zarr"
    for _ in range(4):
        process = start(folder, "-o", path.name, "--resumable")
        while process.poll() is None and not store.exists():
            time.sleep(0.005)
        time.sleep(draw.uniform(0.0, 3.0))
        kill(process)
        if path.exists():
            xr.testing.assert_identical(fdspec.open(path), reference)
            path.unlink()
    last = start(folder, "-o", path.name)  # goes on because the store is there
    _, errors = last.communicate()
    assert last.returncode == 0, errors
    xr.testing.assert_identical(fdspec.open(path), reference)
    assert not store.exists()
