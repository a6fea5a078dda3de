"""Nothing that a file says of itself reaches the terminal as a command to it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.printable import UNSAFE, printable
from tests.cubes import synthetic_cube

EVIL = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202e\rok"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a working folder whose name, files, records and attributes all hold escapes."""
    folder = tmp_path / f"a{EVIL}"
    folder.mkdir()
    monkeypatch.chdir(folder)
    cube = synthetic_cube([f"FSR1{EVIL}", "b"], (2, 3, 4))
    cube["peak_acceleration"].values[:] = np.abs(cube["peak_acceleration"].values)
    cube.attrs |= {"comment": f"c{EVIL}", "title": f"t{EVIL}", "history": f"h{EVIL}"}
    cube["status"].attrs["flag_meanings"] = " ".join(
        f"{word}\x1b[31m" for word in cube["status"].attrs["flag_meanings"].split()
    )
    store.save(cube, f"cube{EVIL}.nc")
    noise = np.random.default_rng(3).standard_normal(200)
    lines = "\n".join(f"{0.01 * k:.2f} {a:.4f}" for k, a in enumerate(noise))
    Path(f"r{EVIL}.txt").write_text(f"# station {EVIL.replace(chr(13), '')}\n{lines}\n", encoding="utf-8")
    Path(f"s{EVIL}.toml").write_text(
        f"records = [{json.dumps('x' + EVIL)}]\nkey{json.dumps(EVIL)} = 1\n", encoding="utf-8"
    )
    return folder


CUBE, RECORD, STUDY = f"cube{EVIL}.nc", f"r{EVIL}.txt", f"s{EVIL}.toml"


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", CUBE],
        ["check", CUBE, "--all"],
        ["claims", CUBE],
        ["claims", CUBE, "--markdown"],
        ["figures", CUBE, "--list"],
        ["figures", CUBE, "--only", f"9{EVIL}"],
        ["export", CUBE, "-o", f"out{EVIL}.csv"],
        ["export", CUBE, "-o", f"none{EVIL}/out.csv"],
        ["records", "show", RECORD, "--units", "g"],
        ["records", "show", RECORD, "--units", "g", "--json"],
        ["records", "show", f"none{EVIL}"],
        ["records", "check", "."],
        ["records", "convert", RECORD, "--units", "g", "-o", f"new{EVIL}.at2"],
        ["records", "link", "FSR1", f"none{EVIL}.at2"],
        ["sweep", STUDY],
        ["sweep", f"none{EVIL}.toml"],
        ["sweep", "--record", RECORD, "--units", "g", "--dry-run", "-o", CUBE],
        ["sweep", "--record", f"none{EVIL}.at2"],
        ["simulate", f"none{EVIL}"],
        ["choose", f"none{EVIL}"],
        [f"swep{EVIL}"],
        ["sweep", f"--opt{EVIL}"],
        ["explore", f"none{EVIL}.nc"],
    ],
    ids=lambda arguments: printable(" ".join(arguments)).replace("\\", "_")[:40],
)
def test_every_command_prints_text_as_text(
    folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    main(arguments)
    out, err = capsys.readouterr()
    assert out + err
    assert UNSAFE.findall(out + err) == []


def test_a_warning_prints_text_as_text(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.warns(UserWarning, match="looks wrong"):
        fdspec.GroundMotion([0.0, 9e4], 0.01, name=EVIL)
    from fdspec.cli.main import _show_warning

    _show_warning(f"of {EVIL}")
    assert UNSAFE.findall(capsys.readouterr().err) == []


def test_letters_of_every_kind_stay() -> None:
    text = "İzmit 1, µ = 0.5\tkN, 東京\nnext"
    assert printable(text) == text
    assert printable("a\udcffb\r") == r"a\udcffb\r"
