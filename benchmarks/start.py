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
    one_cell = [python, "-c", ONE_CELL]
    found = [
        ("python -c pass", "5", seconds([python, "-c", "pass"], 5)),
        ("import fdspec", "5", seconds([python, "-c", "import fdspec"], 5)),
        ("fdspec --help", "5", seconds([*command, "--help"], 5)),
        ("fdspec records list", "5", seconds([*command, "records", "list"], 5)),
    ]
    with tempfile.TemporaryDirectory() as folder:
        first = seconds(one_cell, 1, folder)
        found.append(("one-cell sweep, first time ever (compiles)", "1", first))
        found.append(("one-cell sweep, from the cache", "5", seconds(one_cell, 5, folder)))
        for options in (["--no-certify"], []):
            study = [*command, "sweep", *options, "-o", str(Path(folder) / "cube.nc"), "--force"]
            what = " ".join(["fdspec sweep", *options])
            found.append((f"{what}, command to closed file", "3", seconds(study, 3, folder)))
    return found
