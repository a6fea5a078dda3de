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
from fdspec.store import chunks, description

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


def kill(process: subprocess.Popen[bytes]) -> bool:
    """Kill -9 of the program and of every process that it started; return whether it was in time."""
    in_time = process.poll() is None
    if in_time:
        os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    return in_time


def finished(store: Path) -> set[int]:
    """Return the blocks whose status is there."""
    blocks, _ = description.described(store)
    status = fdspec.variables.CUBE["status"]
    return {n for n in range(len(blocks)) if chunks.chunk_path(store, blocks, n, status).exists()}


class Interrupted:
    """A sweep into one store, killed again and again, and what every death must leave."""

    def __init__(self, folder: Path, name: str, options: tuple[str, ...]) -> None:
        self.store = folder / name
        self.command = (folder, "-o", name, *options)
        self.before: set[int] = set()
        self.stamps: dict[int, int] = {}

    def die(self, *, in_mid_sweep: bool, after: float) -> bool:
        """Kill it, seconds after a new block has come or after its start; return whether it had not ended."""
        process = start(*self.command)
        until = time.monotonic() + 60
        while in_mid_sweep and process.poll() is None and time.monotonic() < until:
            if self.store.exists() and finished(self.store) - self.before:
                break
            time.sleep(0.005)
        time.sleep(after)
        in_time = kill(process)
        if self.store.exists():
            self.inspect()
        return in_time

    def inspect(self) -> None:
        """What was finished is there, is readable, and was not written again."""
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            half = fdspec.open(self.store, lazily=False)
        there = finished(self.store)
        assert self.before <= there, "a finished block is gone"
        blocks, _ = description.described(self.store)
        status = fdspec.variables.CUBE["status"]
        assert bool(said) == (len(there) < len(blocks))
        assert int((half["status"] == 0).sum()) == sum(blocks.cells(number, status) for number in there)
        for number in there:
            stamp = chunks.chunk_path(self.store, blocks, number, status).stat().st_ino
            assert self.stamps.setdefault(number, stamp) == stamp
        self.before = there

    def half_done(self) -> bool:
        """Return whether some blocks are there and some are not."""
        return bool(self.before) and len(self.before) < len(description.described(self.store)[0])

    def end(self) -> xr.Dataset:
        """Let it go on to its end, and return what the store holds then."""
        last = start(*self.command)
        _, errors = last.communicate()
        assert last.returncode == 0, errors
        return fdspec.open(self.store, lazily=False)


@pytest.mark.slow
@pytest.mark.parametrize("options", [(), ("--workers", "2")], ids=["threads", "processes"])
def test_killed_at_twenty_instants(folder: Path, reference: xr.Dataset, options: tuple[str, ...]) -> None:
    draw = random.Random(8)
    times = 5 if options else 20
    in_the_midst = attempts = stores = 0
    # A fast machine may end the sweep before all the kills have come: the rest falls upon another one.
    while in_the_midst < times:
        sweep = Interrupted(folder, f"cube{stores}.zarr", options)
        stores += 1
        killed = True
        while killed and in_the_midst < times:
            early = attempts % 5 == 0  # now and then perhaps before the first block, mostly after a new one
            killed = sweep.die(in_mid_sweep=not early, after=draw.uniform(0.0, 2.0 if early else 0.15))
            attempts += 1
            in_the_midst += killed and sweep.half_done()
        xr.testing.assert_identical(sweep.end(), reference)


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
