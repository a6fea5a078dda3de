"""Disks that give out under a sweep: one clear line, exit code 1, and what is finished is kept."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

import fdspec
from fdspec.store import chunks

ROOT = Path(__file__).resolve().parents[2]

STUDY = """\
records = ["FSR1", "FMR1", "FHR1"]
stiffness_ratio = [1, 4]
pretension = { start = 0, stop = 300e3, num = 60 }
period = { start = 0.1, stop = 1.5, num = 60 }
"""

SWEEP = f"{sys.executable} -m fdspec sweep study.toml"

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="makes file systems of its own")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    (tmp_path / "disk").mkdir()
    return tmp_path


def run(folder: Path, script: str) -> subprocess.CompletedProcess[str]:
    """Run a script of the shell where it may mount what the rest of the machine does not see."""
    own = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--mount", "--map-root-user"]
    return subprocess.run(
        [*own, "bash", "-c", f"set -u\n{script}"],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "SOURCE_DATE_EPOCH": "1700000000"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.mark.slow
def test_a_full_disk(folder: Path) -> None:
    """It holds some of the blocks; with more room the same command goes on."""
    done = run(
        folder,
        f"""
        mount -t tmpfs -o size=1100k tmpfs disk
        {SWEEP} -o disk/cube.zarr; echo "exit code $?"
        {sys.executable} -m fdspec check disk/cube.zarr; echo "exit code $?"
        find disk -path '*/status/c/*' -type f | sort | xargs sha256sum >before
        mount -o remount,size=50m disk
        sha256sum --quiet --check before && echo intact
        {SWEEP} -o disk/cube.zarr; echo "exit code $?"
        sha256sum --quiet --check before && echo intact
        cp -r disk/cube.zarr grown.zarr
        """,
    )
    codes = [line for line in done.stdout.splitlines() if line.startswith(("exit code", "intact"))]
    assert codes == ["exit code 1", "exit code 1", "intact", "exit code 0", "intact"], done.stderr
    errors = done.stderr.splitlines()
    assert "fdspec: disk/cube.zarr keeps what is finished; the same command goes on from there" in errors[0]
    assert errors[1].startswith("fdspec: error: cannot write ")
    assert errors[1].endswith("No space left on device; what is finished is kept")
    assert "blocks are missing" in done.stdout
    assert (folder / "before").read_text().count("\n") > 0, "nothing was finished before the disk was full"
    assert run(folder, f"{SWEEP} -o plain.nc").returncode == 0
    xr.testing.assert_identical(
        fdspec.open(folder / "grown.zarr", lazily=False), fdspec.open(folder / "plain.nc")
    )


@pytest.mark.slow
def test_a_full_disk_under_the_file(folder: Path) -> None:
    done = run(
        folder, f"mount -t tmpfs -o size=200k tmpfs disk; {SWEEP} -o disk/cube.nc; echo $?; ls -A disk"
    )
    assert done.stdout == "1\n"
    (error,) = done.stderr.splitlines()
    assert error.startswith("fdspec: error: cannot write disk/cube.nc: ")


@pytest.mark.parametrize("name", ["cube.nc", pytest.param("cube.zarr", marks=pytest.mark.slow)])
def test_a_read_only_folder(folder: Path, name: str) -> None:
    done = run(
        folder,
        f"mount -t tmpfs -o size=10m tmpfs disk; mount -o remount,ro disk; {SWEEP} -o disk/{name}; echo $?",
    )
    assert done.stdout == "1\n"
    (error,) = done.stderr.splitlines()
    assert f"cannot write disk/{name}: the folder disk takes no files (Read-only file system)" in error


@pytest.mark.slow
def test_a_disk_that_turns_read_only_at_work(folder: Path) -> None:
    done = run(
        folder,
        f"""
        mount -t tmpfs -o size=50m tmpfs disk
        {SWEEP} -o disk/cube.zarr & sweep=$!
        until find disk -path '*/status/c/*' -type f 2>/dev/null | grep -q .; do sleep 0.005; done
        kill -STOP $sweep; mount -o remount,ro disk; kill -CONT $sweep
        wait $sweep; echo "exit code $?"
        mount -o remount,rw disk
        {SWEEP} -o disk/cube.zarr; echo "exit code $?"
        """,
    )
    codes = [line for line in done.stdout.splitlines() if line.startswith("exit code")]
    assert codes == ["exit code 1", "exit code 0"], done.stderr
    assert "Read-only file system; what is finished is kept" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_a_store_that_is_deleted_at_work(folder: Path) -> None:
    done = run(
        folder,
        f"""
        {SWEEP} -o cube.zarr & sweep=$!
        until find cube.zarr -path '*/status/c/*' -type f 2>/dev/null | grep -q .; do sleep 0.005; done
        kill -STOP $sweep; mv cube.zarr elsewhere; kill -CONT $sweep
        wait $sweep; echo "exit code $?"
        """,
    )
    assert done.stdout == "exit code 1\n"
    assert "there is no such store; it was removed" in done.stderr
    assert "Traceback" not in done.stderr
    with pytest.warns(UserWarning, match="blocks are not computed yet"):
        kept = fdspec.open(folder / "elsewhere", lazily=False)
    assert int((kept["status"] == 0).sum()) > 0
    # What is finished serves on, under whatever name.
    shutil.move(folder / "elsewhere", folder / "renamed.zarr")
    assert run(folder, f"{SWEEP} -o renamed.zarr").returncode == 0
    assert chunks.unfinished(folder / "renamed.zarr") == 0
