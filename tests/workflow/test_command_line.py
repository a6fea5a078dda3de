"""A user's way through the command line: record, study, cube, pictures, exports; and ways to go wrong."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.runs.study import Study
from fdspec.units import G

STUDY = """\
records = [{ path = "mine.txt", units = "g" }, "FSR1"]
stiffness_ratio = [1, 4]
pretension = [0, 50e3, 200e3]
period = { start = 0.3, stop = 0.9, step = 0.2 }
"""

ONE = ["--period", "0.5", "--stiffness-ratio", "4"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the working folder, with a record and a study in it."""
    monkeypatch.chdir(tmp_path)
    time = 0.02 * np.arange(300)
    motion = 0.3 * np.sin(9.0 * time) * np.exp(-0.3 * time)
    np.savetxt("mine.txt", np.column_stack([time, motion]), fmt="%.2f %.8f")
    Path("mine.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def done(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that should say nothing on stderr; return what it prints."""
    assert main(list(arguments)) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("fdspec: error: ")
    assert err.count("\n") == 1
    return err


def test_from_study_to_cube_to_pictures_and_export(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = done(capsys, "sweep", "mine.toml")
    assert "mine.nc" in out
    assert "2 records x 2 stiffness ratios x 3 pretensions x 4 periods = 48 histories" in out
    cube = store.open("mine.nc")
    peak = cube["peak_acceleration"].sel(record="FSR1") / G
    (row,) = [line.split() for line in out.splitlines() if line.startswith("FSR1")]
    assert row[1:4] == ["0.345", f"{peak.min().item():.3f}", f"{peak.max().item():.3f}"]
    assert done(capsys, "figures", "mine.nc", "--only", "mine") == (
        "figures/record-mine.png\nfigures/record-mine.pdf\n"
    )
    told = done(capsys, "figures", "mine.nc", "--study", "mine.toml", "--only", "8", "--format", "svg")
    assert told == "figures/figure-08-records.svg\n"
    assert done(capsys, "export", "mine.nc", "--record", "FSR1", "-o", "fsr1.csv") == "fsr1.csv\n"
    assert names(folder) == {"mine.txt", "mine.toml", "mine.nc", "figures", "fsr1.csv"}


def test_the_cube_of_the_command_is_the_cube_of_python(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done(capsys, "sweep", "mine.toml", "-o", "a.nc", "--threads", "1")
    study = Study.read("mine.toml")
    grid = study.grid
    cube = fdspec.sweep(
        study.motions(),
        period=grid.period,
        pretension=grid.pretension,
        stiffness_ratio=grid.stiffness_ratio,
    )
    assert store.open("a.nc").equals(cube)


def test_the_printed_study_is_the_study(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = done(capsys, "sweep", "--print-study")
    assert Study.parse(text).grid.shape == (7, 11, 60)
    Path("printed.toml").write_text(text, encoding="utf-8")
    assert done(capsys, "sweep", "printed.toml", "--print-study") == text
    assert names(folder) == {"mine.txt", "mine.toml", "printed.toml"}


def test_a_dry_run_counts_and_writes_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = done(capsys, "sweep", "--dry-run")
    assert "41 580" in out
    assert "FHR3" in out
    assert "study.nc" in out
    assert "48\n" in done(capsys, "sweep", "mine.toml", "--dry-run")
    assert names(folder) == {"mine.txt", "mine.toml"}


def test_options_stand_in_for_what_the_study_says(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--records", "FSR2,FSR3", "--raw", "--no-certify", "-o", "other.nc"]
    done(capsys, "sweep", "mine.toml", *options)
    cube = store.open("other.nc")
    assert cube["record"].values.tolist() == ["FSR2", "FSR3"]
    assert cube["scale_factor"].values.tolist() == [1.0, 1.0]
    assert "energy_error" not in cube


def test_outputs_of_a_study_are_the_variables_of_the_cube(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("few.toml").write_text(STUDY + 'outputs = ["slip_travel"]\n', encoding="utf-8")
    out = done(capsys, "sweep", "few.toml")
    assert set(store.open("few.nc").data_vars) == {"slip_travel", "status"}
    assert "48 histories" in out


def test_a_cube_that_exists_is_kept_unless_forced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mine = folder / "mine.nc"
    mine.write_text("mine")
    assert "replace it with --force" in refused(capsys, "sweep", "mine.toml")
    assert mine.read_text() == "mine"
    done(capsys, "sweep", "mine.toml", "--force")
    assert store.open(mine).sizes["period"] == 4


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("perod = [0.5]", "mine.toml, line 1: perod: is not a field of a study; did you mean period?"),
        ("period = [-0.5]", "mine.toml, line 1: period: values must be positive, got -0.5 at index 0"),
        ("period = []", "mine.toml, line 1: period: must hold at least one value, is empty"),
        ("period = [0.5, 0.5]", "period: values must differ, 0.5 stands at index 0 and 1"),
        ("period = [0.5, 0.2]", "period: values must increase"),
        ("records = ['FSR11']", "did you mean FSR1"),
        ("records = ['none.AT2']", "none.AT2"),
        ("records = ['nan.txt']", "nan.txt"),
        ("records = ['single.txt']", "single.txt"),
        ("records = ['FSR1', 'fsr1']", "FSR1"),
    ],
)
def test_a_wrong_study_is_refused_and_leaves_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], line: str, words: str
) -> None:
    (folder / "mine.toml").write_text(f"{line}\n", encoding="utf-8")
    (folder / "nan.txt").write_text("# acceleration [g]\n0.00 0.1\n0.02 nan\n0.04 0.1\n", encoding="utf-8")
    (folder / "single.txt").write_text("# acceleration [g]\n0.00 0.1\n", encoding="utf-8")
    before = names(folder)
    assert words in refused(capsys, "sweep", "mine.toml")
    assert names(folder) == before


@pytest.mark.parametrize("output", ["nowhere/cube.nc", "mine.txt/cube.nc", ".", "cube.txt"])
def test_an_output_that_cannot_be_written_is_told_before_the_work(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, output: str
) -> None:
    monkeypatch.setattr("fdspec.runs.study.Study.motions", lambda _: pytest.fail("the work had started"))
    assert "cannot write" in refused(capsys, "sweep", "mine.toml", "-o", output)
    assert "cannot write" in refused(
        capsys, "simulate", "--record", "FSR1", *ONE, "--slip-force", "1", "-o", output
    )
    assert names(folder) == {"mine.txt", "mine.toml"}


def test_a_unit_that_looks_wrong_is_warned_of(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["simulate", "--record", "mine.txt", "--units", "g", *ONE, "--slip-force", "1e5"]
    time, motion = np.loadtxt("mine.txt", unpack=True)
    np.savetxt("mine.txt", np.column_stack([time, 981 * motion]), fmt="%.2f %.8f")
    assert main(arguments) == 0
    err = capsys.readouterr().err
    assert err.startswith("fdspec: warning: ")
    assert "the unit looks wrong" in err
    assert err.count("\n") == 1


def test_one_history_and_its_picture(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["simulate", "--record", "mine.txt", "--units", "g", *ONE, "--pretension", "50e3"]
    out = done(capsys, *arguments, "--free-vibration", "1", "--figure", "mine.svg")
    history = store.open("history.nc")
    assert history["slip_force"].item() == 25e3
    assert history["time"].values[-1] == pytest.approx(299 * 0.02 + 1.0)
    assert f"peak acceleration      {history['peak_acceleration'].item() / G:.4g} g" in out
    assert out.splitlines()[-2:] == ["history.nc", "mine.svg"]
    assert (folder / "mine.svg").read_text(encoding="utf-8").startswith("<?xml")


def test_one_history_is_one_cell_of_the_cube(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    done(capsys, "sweep", "mine.toml")
    done(capsys, "simulate", "--record", "mine.txt", "--units", "g", *ONE, "--pretension", "50e3")
    cell = store.open("mine.nc").sel(record="mine", stiffness_ratio=4, pretension=50e3, period=0.5)
    history = store.open("history.nc")
    assert history["peak_acceleration"].item() == pytest.approx(cell["peak_acceleration"].item(), rel=1e-12)
    assert history["transitions"].item() == cell["transitions"].item()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "either --slip-force or --pretension"),
        (["--slip-force", "1", "--pretension", "1"], "either --slip-force or --pretension"),
        (["--slip-force", "1", "--friction-coefficient", "0.4"], "goes with --pretension"),
        (["--slip-force", "-1"], "slip_force"),
        (["--slip-force", "1", "--figure", "picture"], "the name should end in .png or .pdf or .svg"),
        (["--slip-force", "1", "--figure", "picture.gif"], "the name should end in"),
        (["--slip-force", "1", "--damping-ratio", "-2"], "-2"),
        (["--slip-force", "1", "--free-vibration", "-2"], "free_vibration"),
        (["--slip-force", "strong"], "'strong' is not a valid float"),
    ],
)
def test_a_wrong_history_is_refused_and_leaves_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], options: list[str], words: str
) -> None:
    assert words in refused(capsys, "simulate", "--record", "FSR1", *ONE, *options)
    assert names(folder) == {"mine.txt", "mine.toml"}


def test_units_are_of_a_file_that_is_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "named with --record" in refused(capsys, "sweep", "--units", "g", "--dry-run")


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_ctrl_c_under_a_progress_bar_ends_cleanly(folder: Path) -> None:
    import pty

    (folder / "long.toml").write_text("period = { start = 0.05, stop = 3, num = 4000 }\n", encoding="utf-8")
    before = names(folder)
    terminal, stderr = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "fdspec", "sweep", "long.toml", "--resumable"],
        stdout=subprocess.PIPE,
        stderr=stderr,
        env={**os.environ, "TERM": "xterm", "PYTHONPATH": str(Path(fdspec.__file__).parents[1])},
    )
    os.close(stderr)
    try:
        text = b""
        while b"histories" not in text:  # the bar has appeared: the work runs
            text += os.read(terminal, 4096)
        process.send_signal(signal.SIGINT)
        text += _rest(terminal)
        assert process.wait() == 130
    finally:
        process.kill()
        process.wait()
        os.close(terminal)
    assert process.stdout is not None
    with process.stdout as stdout:
        assert stdout.read() == b""
    assert text.rstrip().endswith(b"fdspec: interrupted")
    assert b"long.unfinished.zarr keeps what is finished; the same command goes on from there" in text
    assert b"Traceback" not in text
    assert names(folder) == before | {"long.unfinished.zarr"}


def _rest(terminal: int) -> bytes:
    """Read until the other side closes, which Linux tells as an error."""
    text = b""
    while True:
        try:
            part = os.read(terminal, 4096)
        except OSError:
            return text
        if not part:
            return text
        text += part
