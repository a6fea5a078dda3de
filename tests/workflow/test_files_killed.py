"""A run that is killed, interrupted or out of space leaves the old file or a whole new one."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fdspec import store
from tests.cubes import synthetic_cube

ROOT = Path(__file__).resolve().parents[2]

KILLED = """
import os, random, signal, sys, time
from pathlib import Path
from fdspec import store
from tests.cubes import synthetic_cube

folder = Path(sys.argv[1])
path = folder / "cube.nc"
cubes = [synthetic_cube(shape=(4, 5, 20), seed=seed) for seed in (1, 2)]
store.save(cubes[0], path)
random.seed(20)
for attempt in range(30):
    child = os.fork()
    if child == 0:
        while True:
            for cube in cubes:
                store.save(cube, path)
    time.sleep(random.uniform(0.001, 0.15))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    opened = store.open(path)
    assert any(opened.identical(cube) for cube in cubes), f"attempt {attempt} left another file"
store.save(cubes[1], path)
assert store.open(path).identical(cubes[1])
print(len(list(folder.glob(".fdspec-*.part"))))
"""

FULL = """
import resource, sys
from pathlib import Path
from fdspec import store
from fdspec.errors import StoreError
from tests.cubes import synthetic_cube

folder = Path(sys.argv[1])
path = folder / "cube.nc"
small = synthetic_cube()
store.save(small, path)
# The system refuses to let a file grow past this, as on a full disk.
resource.setrlimit(resource.RLIMIT_FSIZE, (120_000, 120_000))
try:
    store.save(synthetic_cube(shape=(7, 11, 60)), path)
except StoreError as error:
    print(error)
assert store.open(path).identical(small)
assert [file.name for file in folder.iterdir()] == ["cube.nc"]
"""

INTERRUPTED = """
import sys
from pathlib import Path
from fdspec import store
from tests.cubes import synthetic_cube

path = Path(sys.argv[1]) / "cube.nc"
store.save(synthetic_cube(), path)
store.save(synthetic_cube(shape=(10, 40, 500)), path)
"""


def start(script: str, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", script, str(folder)],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills forked processes")
def test_killed_while_saving(tmp_path):
    with start(KILLED, tmp_path) as process:
        output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    # A kill that hits the middle of a save cannot clean up: that shows that some did.
    assert int(output) > 0


@pytest.mark.skipif(sys.platform == "win32", reason="limits are POSIX")
def test_disk_full(tmp_path):
    with start(FULL, tmp_path) as process:
        output, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    assert output.startswith(f"cannot write {tmp_path / 'cube.nc'}: ")


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
def test_interrupted_while_saving(tmp_path):
    with start(INTERRUPTED, tmp_path) as process:
        # The second save, of 50 MB, takes over a second; meet it on its way.
        while process.poll() is None and not large_part(tmp_path):
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert errors.rstrip().endswith("KeyboardInterrupt")
    assert [file.name for file in tmp_path.iterdir()] == ["cube.nc"]
    assert store.open(tmp_path / "cube.nc").identical(synthetic_cube())


def large_part(folder: Path) -> bool:
    for part in folder.glob(".fdspec-*.part"):
        with contextlib.suppress(FileNotFoundError):
            if part.stat().st_size > 1_000_000:
                return True
    return False
