"""`fdspec verify` as a user runs it, and what it says of kernels that were broken on purpose."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import fdspec
from fdspec.cli import main
from fdspec.errors import IntegrationError, InvalidInput
from fdspec.verification import FAMILIES, Family, Row, families, verify

ROOT = Path(fdspec.__file__).parents[1]
HEAD = ["case", "quantity", "reference", "computed", "error", "limit", "verdict"]


def test_a_family_passes_and_is_told_as_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--only", "symmetry"]) == 0
    out, err = capsys.readouterr()
    head, *lines = out.splitlines()
    assert head.split() == HEAD
    rows, told = lines[:-2], lines[-1]
    assert all(line.endswith("pass") for line in rows)
    assert re.fullmatch(rf"{len(rows)} rows, all passed, in .* s", told)
    assert err == ""


def test_json_has_every_row_and_its_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--only", "engines", "--only", "energy", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["version"] == fdspec.__version__
    assert told["passed"] is True
    assert len(told["rows"]) > 15
    for row in told["rows"]:
        assert list(row) == HEAD
        assert row["error"] <= row["limit"]
        assert row["verdict"] == "pass"


def test_markdown_is_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--only", "symmetry", "--markdown"]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
    assert lines[1].replace("|", "").replace(":", "").replace("-", "").strip() == ""
    assert {line.count("|") for line in lines} == {len(HEAD) + 1}


def _wrong(full: bool) -> Iterator[Row]:
    yield Row("right", "x, m", 1.0, 1.0, 0.0, 1e-9)
    yield Row("wrong | case", "x, m", 1.0, 1.1 if full else 1.2, 0.2, 1e-9)
    yield Row("no number", "x, m", 1.0, math.nan, math.nan, 1e-9)


def _raising(full: bool) -> Iterator[Row]:
    yield Row("right", "x, m", 1.0, 1.0, 0.0, 1e-9)
    raise IntegrationError("ended with status non_finite_state")


def test_one_row_that_fails_fails_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(families, "FAMILIES", (Family("wrong", _wrong), Family("raising", _raising)))
    assert main(["verify"]) == 1
    out, err = capsys.readouterr()
    assert out.count("FAIL") == 3
    assert "5 rows, 3 failed" in out
    assert err == "fdspec: error: 3 rows of 5 failed; first: wrong | case\n"
    assert main(["verify", "--json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert told["passed"] is False
    assert [row["verdict"] for row in told["rows"]] == ["pass", "fail", "fail", "pass", "fail"]
    assert told["rows"][2]["computed"] is None
    assert "non_finite_state" in told["rows"][4]["quantity"]
    assert main(["verify", "--markdown"]) == 1
    assert "wrong \\| case" in capsys.readouterr().out


def test_a_family_that_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--only", "everything"]) == 2
    assert "must be one of closed-forms, devices, steady-states" in capsys.readouterr().err
    with pytest.raises(InvalidInput, match="got 'everything'"):
        verify(["everything"])


def test_help_names_every_family(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--help"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    for family in FAMILIES:
        assert family.name in text


@pytest.mark.slow
def test_the_whole_table_holds_within_a_minute() -> None:
    """Kernels loaded, as in every run but the first; what the machine's other work takes is not counted."""
    verify(["engines", "symmetry"])
    began = time.process_time()
    rows = verify()
    assert [row for row in rows if not row.passed] == []
    assert time.process_time() - began < 60.0
    claims = [row for row in rows if row.case.startswith("README")]
    assert len(claims) == 3


@pytest.mark.slow
def test_the_full_table_holds() -> None:
    assert [row for row in verify(full=True) if not row.passed] == []


def without_interior_extrema(package: Path) -> None:
    """Have the search for a turn between two points give the first of them."""
    head = r"(def locate_turn\(.*?\):\n    \"\"\".*?\"\"\"\n)"
    replace(package / "kernels" / "mathematics" / "polynomial_roots.py", head, r"\1    return a\n")


def with_friction_swapped(package: Path) -> None:
    """Hand kernels kinetic friction for static, and static for kinetic."""
    static, kinetic = "    slip_force: float\n", "    kinetic_slip_force: float\n"
    replace(package / "kernels" / "types.py", static + kinetic, kinetic + static)
    frame = package / "kernels" / "frame" / "model.py"
    replace(
        frame, r"\nSLIP_FORCE = 8\nKINETIC_SLIP_FORCE = 9\n", "\nSLIP_FORCE = 9\nKINETIC_SLIP_FORCE = 8\n"
    )


def untouched(package: Path) -> None:
    """Break nothing: what fails in the others is the breach, not the copy."""


def replace(path: Path, pattern: str, by: str) -> None:
    text, count = re.subn(pattern, by, path.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert count == 1, f"{path.name} no longer has what this test breaks"
    path.write_text(text, encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("breach", "only", "verdict"),
    [
        (untouched, ("closed-forms", "general-solver"), 0),
        (without_interior_extrema, ("closed-forms",), 1),
        (with_friction_swapped, ("general-solver",), 1),
    ],
)
def test_a_broken_kernel_fails(
    breach: Callable[[Path], None], only: tuple[str, ...], verdict: int, tmp_path: Path
) -> None:
    """In a copy of the package; the command runs the families that should tell."""
    shutil.copytree(ROOT / "fdspec", tmp_path / "fdspec", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "records").symlink_to(ROOT / "records")
    breach(tmp_path / "fdspec")
    options = [word for family in only for word in ("--only", family)]
    done = subprocess.run(
        [sys.executable, "-m", "fdspec", "verify", *options],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path), "FDSPEC_CACHE_DIR": str(tmp_path / "cache")},
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert "Traceback" not in done.stderr
    assert done.returncode == verdict, done.stdout + done.stderr
    assert ("FAIL" in done.stdout) == bool(verdict)
