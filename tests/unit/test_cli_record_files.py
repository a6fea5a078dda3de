"""Files on the command line: what they are taken for, the options to read them, patterns of names."""

import json
import subprocess
import sys
from pathlib import Path

import click
import pytest

from fdspec.cli import main
from fdspec.cli.record_options import RecordsOption, named_records
from fdspec.records import read_record


def at2(folder: Path, name: str) -> Path:
    path = folder / name
    rows = "\n".join(f"{0.1 * ((k * 7) % 11 - 5):.3f} {0.05 * (k % 3 - 1):.3f}" for k in range(30))
    path.write_text(f"PEER\nA, B, C\nACCELERATION TIME HISTORY IN UNITS OF G\nNPTS= 60, DT= .01\n{rows}\n")
    return path


def output(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> tuple[str, str]:
    assert main(["records", *arguments]) == code
    return capsys.readouterr()


def test_show_says_what_each_column_and_statement_was_taken_for(tmp_path, capsys) -> None:
    path = tmp_path / "mine.txt"
    rows = "\n".join(f"{10 * k}\t{(k * 7) % 11 - 5}\t{k}" for k in range(30))
    path.write_text(f"Old Mill, PGA (g): 0.3\nTime (ms)\tAcc [gal]\tVelocity (cm/s)\n{rows}\n")
    out, _ = output(capsys, "show", str(path))
    assert "'Time (ms)': time in ms, step 0.01 s" in out
    assert "'Acc [gal]': acceleration in cm/s2" in out
    assert "'Velocity (cm/s)': velocity in 0.01 m/s, passed over" in out
    about = json.loads(output(capsys, "show", str(path), "--json")[0])
    assert about["dt_s"] == 0.01
    assert any("Velocity" in line for line in about["taken_for"])


def test_show_says_it_of_a_refused_file_too(tmp_path, capsys) -> None:
    path = tmp_path / "spectrum.txt"
    path.write_text(
        "Period [s]\tAcceleration [g]\n" + "\n".join(f"{0.02 * k:.2f}\t{1 + k}" for k in range(9))
    )
    out, err = output(capsys, "show", str(path), "--units", "g", code=2)
    assert "'Period [s]': period in s" in out
    assert "'Period [s]' is a period: expected acceleration over time" in err
    assert "Traceback" not in err


def test_convert_takes_every_option_of_reading(tmp_path, capsys) -> None:
    path = tmp_path / "raw.dat"
    path.write_text("what is 7 9\n" + "\n".join("1.0 2.0 -3.0 4.0" for _ in range(6)))
    target = tmp_path / "new.txt"
    options = ["--skip", "1", "--layout", "rows", "--units", "GAL", "--dt", "0.02", "--name", "B1"]
    output(capsys, "convert", str(path), *options, "-o", str(target))
    motion = read_record(target)
    assert (motion.n, motion.dt, motion.pga) == (24, 0.02, 0.04)
    film = tmp_path / "film.csv"
    film.write_text("t (s),a (m/s2)\n0,0\n0.01,1\n0.03,-1\n0.04,2\n")
    output(capsys, "convert", str(film), "--resample-to", "0.01", "-o", str(target), "--force")
    assert read_record(target).acceleration.tolist() == pytest.approx([0.0, 1.0, 0.0, -1.0, 2.0])


def test_a_name_on_read_is_the_motion_s(tmp_path, capsys) -> None:
    path = at2(tmp_path, "RSN1.AT2")
    assert read_record(path, name="mine").name == "mine"
    assert json.loads(output(capsys, "show", str(path), "--name", "mine", "--json")[0])["name"] == "mine"


def test_a_pattern_stands_for_its_files(tmp_path, monkeypatch) -> None:
    for name in ("b.AT2", "a.AT2", "c.txt"):
        at2(tmp_path, name)
    monkeypatch.chdir(tmp_path)
    assert named_records(["*.AT2"], None, None, None) == ("a.AT2", "b.AT2")
    assert named_records(["FSR1", "c.*"], None, None, None) == ("FSR1", "c.txt")
    assert [one.path for one in named_records(["*.AT2"], "g", None, None)] == ["a.AT2", "b.AT2"]
    with pytest.raises(click.UsageError, match=r"No file matches '\*\.V2'"):
        named_records(["*.V2"], None, None, None)
    (tmp_path / "odd[1].AT2").write_text(Path("a.AT2").read_text())
    assert named_records(["odd[1].AT2"], None, None, None) == ("odd[1].AT2",)


@pytest.mark.parametrize(
    ("arguments", "records", "rest"),
    [
        (["--record", "a", "b", "c"], ("a", "b", "c"), None),
        (["--record", "a", "b", "study.toml"], ("a", "b"), "study.toml"),
        (["study.toml", "--record", "a", "--record", "b"], ("a", "b"), "study.toml"),
        (["--record", "a", "b", "--flag", "study.toml"], ("a", "b"), "study.toml"),
        (["--record=a", "b"], ("a", "b"), None),
    ],
)
def test_what_a_shell_makes_of_a_pattern_is_taken_whole(arguments, records, rest) -> None:
    @click.command()
    @click.argument("study", required=False)
    @click.option("--record", "names", cls=RecordsOption, multiple=True)
    @click.option("--flag", is_flag=True)
    def command(study: str | None, names: tuple[str, ...], flag: bool) -> tuple[object, ...]:
        return names, study

    assert command.main(arguments, standalone_mode=False) == (records, rest)


def test_figures_of_what_the_shell_expands(tmp_path) -> None:
    for name in ("a.AT2", "b.AT2"):
        at2(tmp_path, name)
    command = f"'{sys.executable}' -m fdspec records figures --record *.AT2 -o drawn"
    done = subprocess.run(["sh", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "drawn").iterdir())) == 2
