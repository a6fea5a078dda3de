"""`fdspec records`: lists and descriptions that a person and a program can read."""

import json
from pathlib import Path

import numpy as np
import pytest

from fdspec.cli import main
from fdspec.records import catalogue


def output(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["records", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_list_has_a_line_for_each_of_the_nine(capsys: pytest.CaptureFixture[str]) -> None:
    head, *rows = output(capsys, "list").splitlines()
    assert head.split()[:3] == ["name", "event", "date"]
    assert [row.split()[0] for row in rows] == [entry.name for entry in catalogue()]
    assert "Shin-Osaka 090" in rows[0]
    assert "0.345" in rows[0]
    assert not any("\x1b" in row for row in rows)


def test_list_as_json_holds_the_whole_catalogue(capsys: pytest.CaptureFixture[str]) -> None:
    entries = json.loads(output(capsys, "list", "--json"))
    assert [entry["name"] for entry in entries] == [entry.name for entry in catalogue()]
    assert entries[0]["stand_in"]["station"] == "Shin-Osaka"
    assert entries[0]["date"] == "1995-01-16"


def test_show_tells_the_stand_in_and_its_scale(capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads(output(capsys, "show", "fsr1", "--json"))
    assert about["name"] == "FSR1"
    assert about["pga_g"] == pytest.approx(0.345)
    assert about["scale_factor"] == pytest.approx(0.345 / 0.211916, rel=1e-5)
    assert about["source"].startswith("stand-in for the study's FSR1")
    assert about["soil"] == "soft"


def test_show_raw_is_as_recorded(capsys: pytest.CaptureFixture[str]) -> None:
    about = json.loads(output(capsys, "show", "FSR1", "--raw", "--json"))
    assert about["scale_factor"] == 1.0
    assert about["pga_g"] == pytest.approx(0.211916, rel=1e-5)


def test_show_says_the_same_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    lines = dict(line.split(maxsplit=1) for line in output(capsys, "show", "FSR1").splitlines())
    assert lines["name"] == "FSR1"
    assert lines["pga_g"] == "0.345"
    assert lines["history"].startswith("scaled by")


def test_show_reads_a_file_with_what_it_does_not_say(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "FSR1.txt"
    np.savetxt(path, 100 * np.sin(0.1 * np.arange(300)), fmt="%.6f")
    about = json.loads(output(capsys, "show", str(path), "--units", "cm/s2", "--dt", "0.02", "--json"))
    assert about["samples"] == 300
    assert about["dt_s"] == 0.02
    assert about["pga_g"] == pytest.approx(1.0 / 9.80665, rel=1e-3)
    assert "study_pga_g" not in about  # a file of a catalogue name is no record of the catalogue


@pytest.mark.parametrize(
    ("name", "words"),
    [("FSR9", ["FSR9", "did you mean"]), ("none.AT2", ["none.AT2"])],
)
def test_an_unknown_record_is_refused(
    capsys: pytest.CaptureFixture[str], name: str, words: list[str]
) -> None:
    assert main(["records", "show", name]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert all(word in err for word in words)
