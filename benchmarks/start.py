"""What a user waits for at the command line: starts, the first compilation, the study to its file."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median

from benchmarks import timing

ONE_CELL = """\
import fdspec
fdspec.sweep(fdspec.load_record("FSR1"), period=[0.5], pretension=[100e3], stiffness_ratio=[4.0])
"""

HISTORY = """\
import fdspec
frame = fdspec.Building(20e3, 3.16e6, 50.0, 12.6e6, 100e3)
fdspec.simulate(frame, fdspec.load_record("FSR1"))
"""

BUILDING = """\
import fdspec
building = fdspec.Building([20e3] * 4, [30e6] * 4, 50.0, 60e6, [40e3] * 4)
fdspec.{run}
"""

FIRST = {
    "one-cell sweep": ONE_CELL,
    "one history, one storey": HISTORY,
    "one history, four storeys": BUILDING.format(run='simulate(building, fdspec.load_record("FSR1"))'),
    "one-cell sweep of four storeys": BUILDING.format(
        run='sweep_buildings(fdspec.load_record("FSR1"), building, slip_scale=[1.0], stiffness_scale=[1.0])'
    ),
}


def seconds(command: Sequence[str], rounds: int, cache: str | None = None) -> float:
    """Median wall seconds of a command in a process of its own."""
    environment = {**os.environ, **({"FDSPEC_CACHE_DIR": cache} if cache else {})}

    def run() -> None:
        subprocess.run(
            command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    return median(timing.once(run) for _ in range(rounds))


def rows() -> list[tuple[str, str, float]]:
    """What, how often measured, seconds."""
    python = sys.executable
    command = [python, "-m", "fdspec"]
    found = [
        ("python -c pass", "5", seconds([python, "-c", "pass"], 5)),
        ("import fdspec", "5", seconds([python, "-c", "import fdspec"], 5)),
        ("fdspec --help", "5", seconds([*command, "--help"], 5)),
        ("fdspec records list", "5", seconds([*command, "records", "list"], 5)),
    ]
    for what, code in FIRST.items():
        with tempfile.TemporaryDirectory() as folder:
            found.append(
                (f"{what}, first time ever (compiles)", "1", seconds([python, "-c", code], 1, folder))
            )
            found.append((f"{what}, from the cache", "5", seconds([python, "-c", code], 5, folder)))
    with tempfile.TemporaryDirectory() as folder:
        seconds([python, "-c", ONE_CELL], 1, folder)
        for options in (["--no-certify"], []):
            study = [*command, "sweep", *options, "-o", str(Path(folder) / "cube.nc"), "--force"]
            what = " ".join(["fdspec sweep", *options])
            found.append((f"{what}, command to closed file", "3", seconds(study, 3, folder)))
    return found
