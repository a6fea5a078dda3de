"""The folder of compiled kernels: one compiles and the others wait, and what nobody uses goes."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from numba import config, float64

from fdspec.compiler import options
from fdspec.compiler.cache import cache_folder, compiling, not_safe, prune

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
        assert not (tmp_path / "kernel.sha256").exists()
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
    assert not (tmp_path / "kernel.sha256").exists()
    assert _enter(tmp_path)
    assert (tmp_path / "kernel.sha256").exists()


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
    with pytest.warns(
        UserWarning, match=r"cannot be kept \(.*file: Not a directory\): every start will compile"
    ):
        assert cache_folder(KEY, str(tmp_path / "file")) is None


def test_without_a_folder_nobody_waits() -> None:
    with compiling(None, "kernel") as one, compiling(None, "kernel") as other:
        assert one is other is None


needs_users = pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users and modes here")


@needs_users
def test_the_folder_is_the_users_alone(tmp_path: Path) -> None:
    before = os.umask(0)
    try:
        folder = cache_folder(KEY, str(tmp_path / "a" / "b"))
    finally:
        os.umask(before)
    assert folder == tmp_path / "a" / "b" / KEY
    assert [path.stat().st_mode & 0o777 for path in (folder, folder.parent, folder.parent.parent)] == [
        0o700
    ] * 3


@needs_users
@pytest.mark.parametrize("level", [0, 1, 2])
@pytest.mark.parametrize("mode", [0o777, 0o702, 0o1777])
def test_where_others_can_write_nothing_is_kept(tmp_path: Path, level: int, mode: int) -> None:
    """A folder above may be as the temporary folder is, with the sticky bit; the folder itself may not."""
    folder = tmp_path / "a" / "b" / KEY
    folder.mkdir(parents=True)
    [folder, *folder.parents][level].chmod(mode)
    if mode == 0o1777 and level > 0:
        assert cache_folder(KEY, str(folder.parent)) == folder
        return
    with pytest.warns(UserWarning, match="is writable by others"):
        assert cache_folder(KEY, str(folder.parent)) is None


@needs_users
@pytest.mark.parametrize("theirs", [KEY, "b", "a"])
def test_what_belongs_to_another_user_is_not_used(
    tmp_path: Path, theirs: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a" / "b" / KEY
    folder.mkdir(parents=True)
    own = Path.lstat

    def lstat(path: Path) -> os.stat_result:
        state = list(own(path))
        return os.stat_result([*state[:4], 54321 if path.name == theirs else state[4], *state[5:]])

    monkeypatch.setattr(Path, "lstat", lstat)
    assert (
        not_safe(folder)
        == f"{next(p for p in [folder, *folder.parents] if p.name == theirs)} belongs to another user"
    )


@needs_users
@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can give files away")
def test_a_link_that_another_user_made_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir(mode=0o700)
    (tmp_path / "link").symlink_to(tmp_path / "mine")
    assert cache_folder(KEY, str(tmp_path / "link")) == tmp_path / "mine" / KEY
    os.lchown(tmp_path / "link", 54321, 54321)
    with pytest.warns(UserWarning, match="link belongs to another user"):
        assert cache_folder(KEY, str(tmp_path / "link")) is None


@needs_users
@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can give files away")
def test_a_folder_laid_ready_by_another_user_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder's name in the temporary folder can be guessed: whoever comes first would be served."""
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/nowhere")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    laid = tmp_path / f"fdspec-{os.getuid()}"
    laid.mkdir()
    os.chown(laid, 54321, 54321)
    with pytest.warns(UserWarning, match="belongs to another user"):
        assert cache_folder(KEY) is None


def test_without_a_home_the_temporary_folder_serves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", unknown)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    folder = cache_folder(KEY)
    assert folder is not None
    assert folder.parent.parent == tmp_path


DAMAGES = {
    "emptied": lambda data: b"",
    "cut": lambda data: data[: len(data) // 2],
    "first bit": lambda data: bytes([data[0] ^ 1]) + data[1:],
    "middle bit": lambda data: (
        data[: len(data) // 2] + bytes([data[len(data) // 2] ^ 16]) + data[len(data) // 2 + 1 :]
    ),
    "zeros": lambda data: bytes(len(data)),
    "garbled": lambda data: b"\x80\x04garbage" * 20,
}


def doubled(x: float) -> float:
    return 2.0 * x


def compiled_anew(cache: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[float, int]:
    """Compile through this cache or load from it; give what the kernel computes, and how often found."""
    monkeypatch.setattr(options, "CACHE", cache)
    kernel = options.entry(float64(float64))(doubled)
    return kernel(21.0), sum(kernel.stats.cache_hits.values())


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_every_damaged_file_is_compiled_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert compiled_anew(tmp_path, monkeypatch) == (42.0, 0)
    names = [path for path in tmp_path.rglob("*") if path.is_file() and path.suffix != ".lock"]
    assert {path.suffix for path in names} == {".nbi", ".nbc", ".sha256"}
    for path in names:
        for how, damage in DAMAGES.items():
            path.write_bytes(damage(path.read_bytes()))
            assert compiled_anew(tmp_path, monkeypatch) == (42.0, 0), (path.name, how)
            assert compiled_anew(tmp_path, monkeypatch) == (42.0, 1), (path.name, how)
        path.unlink()
        path.mkdir()
        assert compiled_anew(tmp_path, monkeypatch) == (42.0, 0)
        assert compiled_anew(tmp_path, monkeypatch) == (42.0, 1)


class Bomb:
    """What a stranger would put into a cache: unpickled, it makes a file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (self.path,)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_files_are_compared_before_they_are_unpickled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache, went_off = tmp_path / "cache", tmp_path / "went off"
    cache.mkdir()
    compiled_anew(cache, monkeypatch)
    for path in [*cache.rglob("*.nbi"), *cache.rglob("*.nbc")]:
        path.write_bytes(pickle.dumps(Bomb(went_off)))
        assert compiled_anew(cache, monkeypatch) == (42.0, 0)
    assert not went_off.exists()


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_a_cache_that_takes_no_more_is_told_and_the_kernel_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    with pytest.warns(UserWarning, match="cannot be kept .*Not a directory"):
        assert compiled_anew(tmp_path / "file", monkeypatch) == (42.0, 0)
