"""What CONTRIBUTING says under "Adding things" is enough for a toy output and a toy record format."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import fdspec

PACKAGE = Path(fdspec.__file__).parent
PAGE = PACKAGE.parent / "CONTRIBUTING.md"

Edits = dict[str, list[tuple[str, str]]]

VARIABLE = '        Variable("slip_travel", each, "m",'
TRAVEL = "        by_storey[RESULT.slip_travel, i] = travel\n"
STATUS = "    result[RESULT.status] = s[STATE.status]\n"

OUTPUT: Edits = {
    "fdspec/variables.py": [
        (
            VARIABLE,
            f'        Variable("end_velocity", each, "m/s", "velocity of the floor at the end"),\n{VARIABLE}',
        )
    ],
    "fdspec/kernels/storey/history.py": [
        ('    "status",\n', '    "status",\n    "end_velocity",\n'),
        (STATUS, f"{STATUS}    result[RESULT.end_velocity] = motion.v\n"),
    ],
    "fdspec/kernels/frame/results.py": [
        ('    "storey_friction_energy",\n', '    "storey_friction_energy",\n    "end_velocity",\n'),
    ],
    "fdspec/kernels/frame/finish.py": [
        (TRAVEL, f"{TRAVEL}        by_storey[RESULT.end_velocity, i] = state[1, i]\n"),
    ],
}

FORMAT: Edits = {
    "fdspec/records/formats.py": [
        ("    smc,\n", "    smc,\n    toy,\n"),
        ("for module in (at2,", "for module in (toy, at2,"),
    ],
}

TOY = '''
"""A toy format: its name, the time step in s, then values in m/s2."""

from fdspec.records.channel import Channel
from fdspec.records.numbers import parse_block, parse_number
from fdspec.records.units import to_si

NAME = "toy"


def recognises(text):
    return text.lines[0].strip() == "TOY"


def read(text):
    dt = parse_number(text.line(2, "the time step"))
    values = to_si(parse_block(text, 3, len(text.lines)), "m/s2")
    return (Channel(name="toy", acceleration=values, dt=dt, units="m/s2"),)
'''

COMPUTE = """
import numpy as np, fdspec

motion = fdspec.GroundMotion(np.sin(np.arange(12.0)), 0.02, "toy")
frame = dict(period=0.5, stiffness_ratio=4.0)
cube = fdspec.sweep(motion, period=[0.5], stiffness_ratio=[4.0], pretension=[4e3], scheduler="synchronous")
building = fdspec.Building.single_storey(**frame, slip_force=2e3)
last = fdspec.simulate(building, motion).velocity[-1]
assert cube.end_velocity.attrs["units"] == "m/s"
np.testing.assert_allclose(cube.end_velocity.item(), last.item(), rtol=1e-9)
two = fdspec.Building([20e3, 20e3], 3e6, brace_mass=50.0, brace_stiffness=12e6, slip_force=2e3)
grid = dict(slip_scale=[1.0], stiffness_scale=[1.0], scheduler="synchronous")
many = fdspec.sweep_buildings(motion, {"two": two}, **grid)
last = fdspec.simulate(two, motion).velocity[-1]
np.testing.assert_allclose(many.end_velocity.squeeze(), last, rtol=1e-9)
"""

READ = """
import numpy as np, fdspec

with open("toy.txt", "w") as file:
    file.write("TOY\\n0.02\\n" + "\\n".join(map(str, range(30))) + "\\n")
motion = fdspec.read_record("toy.txt")
np.testing.assert_array_equal(motion.acceleration, np.arange(30.0))
assert motion.dt == 0.02
"""


def run_changed(folder: Path, edits: Edits, code: str, added: dict[str, str] | None = None) -> None:
    """Copy the package, edit the copy, add files, and run the code with it, kernels uncompiled."""
    shutil.copytree(PACKAGE, folder / "fdspec", ignore=shutil.ignore_patterns("__pycache__"))
    for name, changes in edits.items():
        text = (folder / name).read_text(encoding="utf-8")
        for old, new in changes:
            assert text.count(old) == 1, f"{name}: {old!r} stands there {text.count(old)} times"
            text = text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")
    for name, text in (added or {}).items():
        (folder / name).write_text(text, encoding="utf-8")
    settings = {
        "PYTHONPATH": str(folder),
        "NUMBA_DISABLE_JIT": "1",
        "FDSPEC_CACHE_DIR": str(folder / "cache"),
    }
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code],
        cwd=folder,
        env={**os.environ, **settings},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_an_output(tmp_path: Path) -> None:
    run_changed(tmp_path, OUTPUT, COMPUTE)


def test_a_record_format(tmp_path: Path) -> None:
    run_changed(tmp_path, FORMAT, READ, {"fdspec/records/toy.py": TOY})


@pytest.mark.parametrize("name", [*OUTPUT, *FORMAT])
def test_the_page_names_the_file(name: str) -> None:
    assert f"`{name}`" in PAGE.read_text(encoding="utf-8").split("## Adding things")[1]
