"""The same sweep twice in one folder: nothing is computed again, and nothing that is there is lost."""

from pathlib import Path

import pytest
import xarray as xr

from fdspec import store
from fdspec.cli import main
from tests.cubes import synthetic_cube

STUDY = 'records = ["FSR1"]\nstiffness_ratio = [2, 4]\npretension = [10e3, 50e3, inf]\nperiod = [0.5]\n'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.toml").write_text(STUDY)
    assert main(["sweep", "small.toml"]) == 0
    return tmp_path


def test_the_same_study_is_not_computed_again(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = (folder / "small.nc").stat()
    capsys.readouterr()
    assert main(["sweep", "small.toml"]) == 0
    out, err = capsys.readouterr()
    assert out == "small.nc holds this study already: nothing to compute; --force computes it again\n"
    assert err == ""
    after = (folder / "small.nc").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert main(["sweep", "small.toml", "--force"]) == 0
    assert (folder / "small.nc").stat().st_ino != before.st_ino


@pytest.mark.parametrize(
    ("old", "new"),
    [("0.5", "0.6"), ('"FSR1"', '"FSR2"'), ("10e3, ", ""), ("period", "floor_mass = 10e3\nperiod")],
)
def test_another_study_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str], old: str, new: str
) -> None:
    before = (folder / "small.nc").read_bytes()
    study = (folder / "small.toml").read_text()
    (folder / "small.toml").write_text(study.replace(old, new))
    assert main(["sweep", "small.toml"]) == 2
    assert "small.nc exists already; name another with -o" in capsys.readouterr().err
    assert (folder / "small.nc").read_bytes() == before


@pytest.mark.parametrize("option", ["--raw", "--no-certify"])
def test_options_make_another_study(folder: Path, option: str) -> None:
    assert main(["sweep", "small.toml", option]) == 2


def test_other_versions_and_other_files_are_refused(folder: Path) -> None:
    with xr.open_dataset("small.nc") as cube:
        older = cube.load().assign_attrs(fdspec_version="0.0.0")
    older.to_netcdf("older.nc")
    assert main(["sweep", "small.toml", "-o", "older.nc"]) == 2
    store.save(synthetic_cube(["FSR1"], (2, 3, 1)), "other.nc")
    assert main(["sweep", "small.toml", "-o", "other.nc"]) == 2
    store.save(synthetic_cube(["FSR1"], (2, 3, 1)).assign_attrs(parameters="[1, "), "damaged.nc")
    assert main(["sweep", "small.toml", "-o", "damaged.nc"]) == 2
    (folder / "mine.nc").write_text("mine")
    assert main(["sweep", "small.toml", "-o", "mine.nc"]) == 2
    assert (folder / "mine.nc").read_text() == "mine"
