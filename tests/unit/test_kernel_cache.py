"""The folder of compiled kernels: one compiles and the others wait, and what nobody uses goes."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from fdspec.compiler.cache import cache_folder, compiling, prune

KEY = "0123456789abcdef"

TEN = """
import sys, time
from pathlib import Path
from fdspec.compiler.cache import compiling

folder, log = Path(sys.argv[1]), Path(sys.argv[2])
with compiling(folder, "kernel"):
    if not (folder / "compiled").exists():
        assert not (folder / "at work").exists(), "two at once"
        (folder / "at work").touch()
        time.sleep(0.3)
        (folder / "at work").unlink()
        (folder / "compiled").touch()
        log.open("a").write("compiled\\n")
assert (folder / "compiled").exists()
"""


def test_of_ten_processes_one_compiles(tmp_path: Path) -> None:
    arguments = [sys.executable, "-c", TEN, str(tmp_path), str(tmp_path / "log")]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    processes = [subprocess.Popen(arguments, env=environment) for _ in range(10)]
    assert [process.wait(60) for process in processes] == [0] * 10
    assert (tmp_path / "log").read_text() == "compiled\n"


def test_what_is_compiled_needs_no_lock(tmp_path: Path) -> None:
    with compiling(tmp_path, "kernel"):
        assert not (tmp_path / "kernel.compiled").exists()
    inside = []
    with compiling(tmp_path, "kernel"):
        other = threading.Thread(target=lambda: inside.append(_enter(tmp_path)))
        other.start()
        other.join(10)
    assert inside == [True]


def _enter(folder: Path) -> bool:
    with compiling(folder, "kernel"):
        return True


def fail_to_compile(folder: Path) -> None:
    with compiling(folder, "kernel"):
        raise MemoryError


def test_one_that_failed_leaves_it_to_the_next(tmp_path: Path) -> None:
    with pytest.raises(MemoryError):
        fail_to_compile(tmp_path)
    assert not (tmp_path / "kernel.compiled").exists()
    assert _enter(tmp_path)
    assert (tmp_path / "kernel.compiled").exists()


def test_the_lock_of_a_killed_process_is_free(tmp_path: Path) -> None:
    script = f"""
import os, signal
from pathlib import Path
from fdspec.compiler.cache import compiling
with compiling(Path({str(tmp_path)!r}), "kernel"):
    os.kill(os.getpid(), signal.SIGKILL)
"""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    assert subprocess.run([sys.executable, "-c", script], env=environment, check=False).returncode == -9
    assert _enter(tmp_path)


def test_folders_of_other_sources_go_when_nobody_used_them(tmp_path: Path) -> None:
    mine, recent, old, alien = (tmp_path / name for name in (KEY, "f" * 16, "e" * 16, "notes"))
    for folder in (mine, recent, old, alien):
        folder.mkdir()
        (folder / "kernel.nbi").touch()
        os.utime(folder, (time.time() - 1e7,) * 2)
    os.utime(recent)
    prune(mine)
    assert {path.name for path in tmp_path.iterdir()} == {mine.name, recent.name, alien.name}


def test_finding_the_folder_counts_as_use(tmp_path: Path) -> None:
    folder = cache_folder(KEY, str(tmp_path))
    assert folder == tmp_path / KEY
    os.utime(folder, (0, 0))
    assert cache_folder(KEY, str(tmp_path)) == folder
    assert time.time() - folder.stat().st_mtime < 60


def test_a_folder_that_takes_no_files_is_none(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert cache_folder(KEY, str(tmp_path / "file")) is None


def test_without_a_folder_nobody_waits() -> None:
    with compiling(None, "kernel"), compiling(None, "kernel"):
        entered = True
    assert entered
