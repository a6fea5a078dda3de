"""`fdspec figures` and `fdspec export`: what they write, and what they leave alone."""

import csv
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fdspec import store
from fdspec.cli import main
from fdspec.cli.output import free, save_picture
from fdspec.errors import StoreError
from fdspec.figures import plot_acceleration_maps
from fdspec.records import load_record
from tests.cubes import synthetic_cube

SIGNATURES = {"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the working folder, with the cube of two records in it."""
    monkeypatch.chdir(tmp_path)
    cube = synthetic_cube(["FSR1", "odd/name"], (2, 3, 4))
    cube["peak_acceleration"].values[:] = np.abs(cube["peak_acceleration"].values)
    cube["status"].values[:] = 0
    motion = load_record("FSR1")
    told = {"checksum": [motion.checksum, "of another"], "source": [motion.source, "nowhere.txt"]}
    store.save(cube.assign_coords({name: ("record", values) for name, values in told.items()}), "cube.nc")
    return tmp_path


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    return err


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@pytest.mark.parametrize("kind", SIGNATURES)
def test_a_picture_of_each_kind(folder: Path, kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "cube.nc", "-o", "pictures", "--format", kind, "--only", "10, odd/name"]) == 0
    printed = [Path(line) for line in capsys.readouterr().out.splitlines()]
    wanted = [f"figure-10-FSR1.{kind}", f"record-odd_name.{kind}"]
    assert [path.name for path in printed] == wanted
    assert names(folder / "pictures") == set(wanted)
    assert all(path.read_bytes().startswith(SIGNATURES[kind]) for path in printed)


def test_all_figures_come_with_a_sheet_and_captions(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "cube.nc", "-o", "pictures", "--format", "pdf"]) == 0
    told = capsys.readouterr()
    stems = [
        *(
            "figure-04-additional-frame",
            "figure-06-four-storeys",
            "figure-07-damper",
            "figure-08-records",
            "figure-09-spectra",
        ),
        *("figure-10-FSR1", "record-odd_name", "contact-sheet"),
    ]
    assert [Path(line).name for line in told.out.splitlines()] == [f"{stem}.pdf" for stem in stems]
    assert names(folder / "pictures") == {*(f"{stem}.pdf" for stem in stems), "captions.md"}
    assert told.err == (
        "fdspec: warning: figures 8 and 9 are without odd/name: no record found with the cube's checksum; "
        "name its study file with --study\n"
    )
    captions = (folder / "pictures" / "captions.md").read_text(encoding="utf-8")
    assert [line.split("**")[1] for line in captions.splitlines() if line] == stems[:-1]
    motion = load_record("FSR1")
    (eighth,) = [line for line in captions.splitlines() if "**figure-08" in line]
    assert motion.source.removeprefix("stand-in for the study's FSR1: ") in eighth
    assert f"times {motion.scale_factor:.3g}." in eighth


def test_both_kinds_unless_one_is_asked_for(folder: Path) -> None:
    assert main(["figures", "cube.nc", "--only", "10"]) == 0
    assert names(folder / "figures") == {"figure-10-FSR1.png", "figure-10-FSR1.pdf"}


def test_the_script_makes_the_same_bytes_in_another_process(folder: Path) -> None:
    assert main(["figures", "cube.nc", "-o", "a", "--only", "10"]) == 0
    script = Path(__file__).parents[2] / "scripts" / "make_figures.py"
    done = subprocess.run(
        [sys.executable, str(script), "cube.nc", "-o", "b", "--only", "10"],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(script.parents[1])},
    )
    assert done.stdout.splitlines() == ["b/figure-10-FSR1.png", "b/figure-10-FSR1.pdf"]
    for kind in ("png", "pdf"):
        name = f"figure-10-FSR1.{kind}"
        assert (folder / "a" / name).read_bytes() == (folder / "b" / name).read_bytes()


def test_the_figures_are_listed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "cube.nc", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["4", "6", "7", "8", "9", "10", "odd/name"]
    assert names(folder) == {"cube.nc"}


def test_a_picture_that_exists_is_kept_unless_forced(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = folder / "figures" / "figure-10-FSR1.pdf"
    mine.parent.mkdir()
    mine.write_text("mine")
    assert "--force" in refused(capsys, "figures", "cube.nc", "--only", "10")
    assert names(folder / "figures") == {mine.name}
    assert mine.read_text() == "mine"
    assert main(["figures", "cube.nc", "--only", "10", "--format", "pdf", "--force"]) == 0
    assert mine.read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize("only", ["11", "10,FSR2", "10, 5"])
def test_a_figure_that_the_cube_does_not_give(
    folder: Path, only: str, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = only.rpartition(",")[2].strip()
    err = refused(capsys, "figures", "cube.nc", "--only", only)
    assert f"there is no figure '{wrong}'; this cube gives 4, 6, 7, 8, 9, 10, odd/name" in err
    assert "--only must name figures" in refused(capsys, "figures", "cube.nc", "--only", ",")
    assert names(folder) == {"cube.nc"}


def test_a_folder_that_cannot_be_made(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "cannot make the folder cube.nc" in refused(capsys, "figures", "cube.nc", "-o", "cube.nc")


@pytest.mark.parametrize("kind", SIGNATURES)
def test_two_runs_give_the_same_bytes(folder: Path, kind: str) -> None:
    cube = store.open("cube.nc")
    for name in ("a", "b"):
        save_picture(plot_acceleration_maps(cube, "FSR1"), folder / f"{name}.{kind}")
    assert (folder / f"a.{kind}").read_bytes() == (folder / f"b.{kind}").read_bytes()


def test_a_file_that_is_no_cube(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "text.nc").write_text("nothing")
    assert "cannot open text.nc" in refused(capsys, "figures", "text.nc")
    assert "there is no such file" in refused(capsys, "export", "none.nc", "-o", "a.csv")


def test_export_writes_one_record(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "cube.nc", "-o", "a.csv", "--record", "FSR1"]) == 0
    assert capsys.readouterr().out == "a.csv\n"
    lines = [line for line in (folder / "a.csv").read_text().splitlines() if not line.startswith("#")]
    assert len(list(csv.DictReader(lines))) == 2 * 3 * 4
    assert main(["export", "cube.nc", "-o", "a.nc", "--record", "odd/name"]) == 0
    with xr.open_dataset(folder / "a.nc") as one:
        assert dict(one.sizes) == {"stiffness_ratio": 2, "pretension": 3, "period": 4}


def test_export_wants_one_record_a_known_suffix_and_a_free_name(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "name one of FSR1, odd/name" in refused(capsys, "export", "cube.nc", "-o", "a.nc")
    assert ".nc or .nc4" in refused(capsys, "export", "cube.nc", "-o", "a.xls")
    assert "exists already" in refused(capsys, "export", "cube.nc", "-o", "cube.nc", "--record", "FSR1")
    assert names(folder) == {"cube.nc"}


def test_a_name_is_free_only_where_nothing_is_lost(folder: Path) -> None:
    assert free("new.nc", force=False) == Path("new.nc")
    assert free("cube.nc", force=True) == Path("cube.nc")
    with pytest.raises(StoreError, match=r"cube\.nc exists already; name another with -o, or replace it"):
        free("cube.nc", force=False)
    with pytest.raises(StoreError, match=r"cannot write picture: the name should end in \.png or \.svg"):
        free("picture", force=False, suffixes=(".png", ".svg"))
    with pytest.raises(StoreError, match="there is no folder nowhere"):
        free("nowhere/cube.nc", force=False)
