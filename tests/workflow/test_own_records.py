"""The user's own record, from a folder of files to a cube on disk that says whose it is."""

import json
import math

import pytest

import fdspec
from fdspec.cli import main


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("FDSPEC_RECORDS", str(tmp_path / "links.toml"))
    monkeypatch.chdir(tmp_path)
    rows = [f"{math.exp(-0.02 * k) * math.cos(0.2 * k) * 0.3447:.7E}" for k in range(300)]
    head = ["PEER STRONG MOTION DATABASE RECORD", "KOBE 01/16/95 2046, KAKOGAWA, 090 (CUE)"]
    lines = [*head, "ACCELERATION TIME HISTORY IN UNITS OF G", "NPTS= 300, DT= .01 SEC", *rows, ""]
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "KAK090.AT2").write_text("\n".join(lines))
    return tmp_path / "own"


def test_a_linked_record_reaches_the_cube(folder, capsys):
    study = 'records = ["FSR1", "FMR1"]\nstiffness_ratio = [4]\npretension = [100e3]\nperiod = [0.5]\n'
    (folder.parent / "small.toml").write_text(study)
    assert main(["records", "check", str(folder), "--link"]) == 0
    assert main(["sweep", "small.toml", "-o", "small.nc"]) == 0
    assert capsys.readouterr().err == ""
    cube = fdspec.open("small.nc")
    assert cube.attrs["comment"].startswith("From the user's own files: FSR1. Stand-ins: FMR1.")
    own, stand_in = (str(source) for source in cube["source"].values)
    assert own.startswith(
        "the user's own FSR1: KAK090.AT2 (PEER AT2), KOBE 01/16/95 2046, KAKOGAWA 090; SHA-256 "
    )
    assert stand_in.startswith("stand-in for the study's FMR1: ")
    told = json.loads(cube.attrs["parameters"])["records"]
    assert [record["source"] for record in told] == [own, stand_in]
    assert cube["pga"].values.tolist() == [fdspec.load_record(name).pga for name in ("FSR1", "FMR1")]


def test_after_unlinking_the_cube_has_a_stand_in_again(folder):
    assert main(["records", "check", str(folder), "--link"]) == 0
    assert main(["records", "unlink"]) == 0
    motion = fdspec.load_record("FSR1")
    cube = fdspec.sweep([motion], period=[0.5], pretension=[1e5], stiffness_ratio=[4.0])
    assert cube.attrs["comment"].startswith("Stand-ins: FSR1.")
