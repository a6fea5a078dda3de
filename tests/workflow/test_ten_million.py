"""Ten million histories: the driving process stays under 1 GiB, and their store opens in under a second."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.store import description
from fdspec.variables import CUBE

ROOT = Path(__file__).resolve().parents[2]

GIB = 1 << 30

STUDY = """\
records = [{records}]
stiffness_ratio = {{ start = 0.5, stop = 10, num = 20 }}
pretension = {{ start = 0, stop = 990e3, step = 10e3 }}
period = {{ start = 0.02, stop = 2, step = 0.02 }}
"""

DRIVER = """
import resource, sys
from fdspec.cli import main

code = main(["sweep", "study.toml", "-o", sys.argv[1], *sys.argv[2:]])
print("peak memory", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
sys.exit(code)
"""


def peak_memory(folder: Path, *arguments: str) -> int:
    """Run the program; return the most memory that its own process held, bytes."""
    run = subprocess.run(
        [sys.executable, "-c", DRIVER, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert "status: 10 000 000 ok" in run.stdout
    peak = int(run.stdout.split()[-1])
    print(f"{arguments[0]}: at most {peak / 1e6:.0f} MB of memory")
    return peak


def opened(path: Path) -> tuple[float, float]:
    """Open a cube and read one cell; return the seconds of the best of three attempts, and the cell."""
    attempts = []
    for _ in range(3):  # the first imports what reads it
        started = time.perf_counter()
        with fdspec.open(path, lazily=True) as cube:
            cell = float(cube.peak_acceleration[49, 19, 99, 99])
        attempts.append(time.perf_counter() - started)
    print(f"{path.name} opens in {min(attempts):.2f} s")
    return min(attempts), cell


@pytest.mark.slow
def test_ten_million_histories(tmp_path: Path) -> None:
    records = []
    for number in range(50):
        noise = np.random.default_rng(number).standard_normal(25)
        np.savetxt(tmp_path / f"r{number}.txt", 3.0 * noise / np.abs(noise).max(), fmt="%.6f")
        records.append(f'{{ path = "r{number}.txt", units = "m/s2", dt = 0.02 }}')
    (tmp_path / "study.toml").write_text(STUDY.format(records=", ".join(records)), encoding="utf-8")
    assert peak_memory(tmp_path, "cube.zarr", "--log", "log") < GIB
    blocks, _ = description.described(tmp_path / "cube.zarr")
    assert sum(blocks.cells(number, CUBE["status"]) for number in range(len(blocks))) == 10_000_000
    opening, cell = opened(tmp_path / "cube.zarr")
    assert opening < 1.0
    assert cell > 0.0
    # The same command makes the file of it, block by block.
    (tmp_path / "cube.zarr").rename(tmp_path / "cube.unfinished.zarr")
    assert peak_memory(tmp_path, "cube.nc") < GIB
    opening, same = opened(tmp_path / "cube.nc")
    assert opening < 1.0
    assert same == cell
