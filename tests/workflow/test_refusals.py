"""Files, disks and datasets that cannot be used: one clear line, and nothing is lost."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.cli import main
from fdspec.errors import DiskError, InvalidInput, StoreError
from fdspec.measures.statuses import status_counts
from fdspec.store.replacing import check_writable
from tests.cubes import synthetic_building_cube, synthetic_cube, synthetic_history
from tests.unit.test_sweep import AXES, record


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES)


def parameters(path: Path) -> dict[str, object]:
    return dict(json.loads(fdspec.open(path).attrs["parameters"]))


def test_a_part_of_a_cube_has_the_parameters_of_the_part(cube: xr.Dataset, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    part = cube.isel(period=[0, 2], pretension=slice(1, 3)).sel(record=["b"])
    fdspec.save(part, path)
    told = parameters(path)
    assert told["period"] == part.period.values.tolist()
    assert told["pretension"] == part.pretension.values.tolist()
    assert [one["name"] for one in told["records"]] == ["b"]  # type: ignore[attr-defined,index]
    again = fdspec.sweep(
        record("b", 2, 50),
        **{**AXES, "period": part.period.values, "pretension": part.pretension.values},  # type: ignore[arg-type]
    )
    xr.testing.assert_identical(fdspec.open(path).drop_attrs(), again.drop_attrs())
    assert main(["check", str(path)]) == 0
    fdspec.save(cube.isel(period=1)[["peak_velocity", "status"]], path)
    assert parameters(path)["period"] == [cube.period.values[1]]
    assert parameters(path)["outputs"] == ["peak_velocity", "status"]
    fdspec.save(cube, path)
    xr.testing.assert_identical(fdspec.open(path), cube)


def test_a_cube_changed_by_hand_is_refused_until_it_says_so(cube: xr.Dataset, tmp_path: Path) -> None:
    other = fdspec.sweep(record("c", 3, 50), **AXES, floor_mass=10e3)
    longer = fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **{**AXES, "period": [2.0, 3.0]})
    for changed in (
        xr.concat([cube, other], "record"),
        xr.concat([cube, longer], "period"),
        cube.assign_coords(period=2 * cube.period),
        cube.isel(period=[1, 0]),
        cube.max("record"),
        cube.assign_coords(slip_force=2 * cube.slip_force),
    ):
        with pytest.raises(StoreError, match="parameters"):
            fdspec.save(changed, tmp_path / "a.nc")
        told = changed.copy()
        told.attrs = {name: text for name, text in changed.attrs.items() if name != "parameters"}
        fdspec.save(told, tmp_path / "a.nc")
        xr.testing.assert_identical(fdspec.open(tmp_path / "a.nc"), told)


def test_only_datasets_are_saved(cube: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"must be an xarray.Dataset, such as array.to_dataset.*DataArray"):
        fdspec.save(cube.peak_velocity, tmp_path / "a.nc")  # type: ignore[arg-type]
    with pytest.raises(InvalidInput, match="got dict"):
        fdspec.save({}, tmp_path / "a.nc")  # type: ignore[arg-type]


def test_a_list_of_one_number_comes_back_as_a_list(tmp_path: Path) -> None:
    given = xr.Dataset({"a": ("x", [1.0], {"one": [3], "number": 3.0})}, attrs={"codes": np.array([7], "i1")})
    fdspec.save(given, tmp_path / "a.nc")
    opened = fdspec.open(tmp_path / "a.nc")
    xr.testing.assert_identical(opened, given)
    assert np.shape(opened.a.attrs["one"]) == (1,)
    assert np.shape(opened.a.attrs["number"]) == ()
    assert opened.attrs["codes"].dtype == np.int8


def test_cells_that_were_not_computed_never_replace_a_file(cube: xr.Dataset, tmp_path: Path) -> None:
    fdspec.save(cube, tmp_path / "cube.nc")
    lacking = cube.copy(deep=True)
    lacking["status"][0, 0, 0, 0] = -1
    lacking.status.attrs["flag_values"] = np.append(lacking.status.attrs["flag_values"], np.int8(-1))
    lacking.status.attrs["flag_meanings"] += " not_computed"
    with pytest.raises(StoreError, match="were not computed, and a file is there"):
        fdspec.save(lacking, tmp_path / "cube.nc")
    xr.testing.assert_identical(fdspec.open(tmp_path / "cube.nc"), cube)
    fdspec.save(lacking, tmp_path / "other.nc")
    lacking.status.attrs = cube.status.attrs
    assert status_counts(lacking)["not_computed"] == 1


def test_a_small_file_that_opens_to_a_large_one_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "cube.nc"
    fdspec.save(xr.Dataset({"a": ("x", np.zeros(10))}), path)
    with netCDF4.Dataset(path, "a") as file:
        file.createDimension("y", 400_000_000)
        file.createVariable("b", "f8", ("y",), zlib=True, fill_value=False)
    with pytest.raises(
        StoreError, match=r"MB on disk would become 3\.2 GB in memory|needs 3\.2 GB of memory"
    ):
        fdspec.open(path)
    monkeypatch.setattr("fdspec.store.memory.available", lambda: 1_000_000_000)
    with pytest.raises(
        StoreError, match=r"needs 3\.2 GB of memory, 1\.0 GB are free; open it with lazily=True"
    ):
        fdspec.open(path)


def test_names_that_no_file_can_have(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("loop.nc").symlink_to("loop.nc")
    for name, told in {
        "loop.nc": "circle",
        f"{'n' * 300}.nc": "too long",
        "a\0b.nc": "can have that name",
    }.items():
        with pytest.raises(StoreError, match=told):
            check_writable(name)
        with pytest.raises(StoreError, match=rf"{told}|no such file"):
            fdspec.open(name)
        assert main(["check", name]) == 2
        assert main(["sweep", "-o", name]) in {1, 2}
    assert main(["sweep", "-o", f"{'n' * 300}.zarr"]) in {1, 2}


@pytest.mark.parametrize("command", [["sweep"], ["export", "cube.nc", "--record", "FSR1"]])
def test_a_dash_is_no_file(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    fdspec.save(synthetic_cube(), "cube.nc")
    assert main([*command, "-o", "-"]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert not Path("-").exists()


def test_a_working_folder_that_was_deleted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    with pytest.raises(StoreError, match="the working folder was deleted"):
        check_writable("cube.nc")


def test_too_few_file_handles_are_no_damage(cube: xr.Dataset, tmp_path: Path) -> None:
    fdspec.save(cube, tmp_path / "cube.nc")
    fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES, store=tmp_path / "cube.zarr").close()
    fdspec.open(tmp_path / "cube.nc")
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    free = os.dup(0)
    os.close(free)
    resource.setrlimit(resource.RLIMIT_NOFILE, (free, before[1]))
    try:
        for name in ("cube.nc", "cube.zarr"):
            with pytest.raises(StoreError, match="too many files are open"):
                fdspec.open(tmp_path / name)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


def test_restart_follows_a_link_to_the_store(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "cube.zarr").symlink_to(tmp_path / "disk" / "real.zarr")
    motion = record("a", samples=60)
    for restart in (False, True, False):
        fdspec.sweep(motion, **AXES, store=tmp_path / "cube.zarr", restart=restart).close()
        assert (tmp_path / "cube.zarr").is_symlink()
        assert (tmp_path / "disk" / "real.zarr" / "zarr.json").is_file()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_behind_stdout_and_a_closed_stderr(tmp_path: Path) -> None:
    run = [sys.executable, "-m", "fdspec", "sweep", "--print-study"]
    with Path("/dev/full").open("w") as full:
        ended = subprocess.run(run, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert ended.returncode == 1
    assert ended.stderr == "fdspec: error: cannot write to standard output: No space left on device\n"
    closed = f"{sys.executable} -m fdspec check {tmp_path}/none.nc 2>&-"
    assert subprocess.run(closed, shell=True, check=False).returncode == 2


OTHERS = {
    "buildings": synthetic_building_cube,
    "history": synthetic_history,
    "a record": lambda: synthetic_cube().sel(record="FSR1"),
    "no record": lambda: synthetic_cube().max("record"),
    "no period": lambda: synthetic_cube().isel(period=slice(0, 0)),
    "something else": lambda: xr.Dataset({"a": ("x", [1.0])}),
}


@pytest.mark.parametrize("what", OTHERS)
def test_commands_say_which_cube_they_need(
    what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    fdspec.save(OTHERS[what](), "cube.nc")
    commands = [["claims", "cube.nc"]]
    if what != "buildings":  # of which figures and page show profiles
        commands += [["figures", "cube.nc"], ["export", "cube.nc", "--html"]]
    for command in commands:
        assert main(command) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert len(err.splitlines()) == 1
        assert "need a cube of single-storey frames" in err
    assert main(["check", "cube.nc"]) in {0, 1}
    capsys.readouterr()


def test_two_records_never_become_one_picture(cube: xr.Dataset) -> None:
    from fdspec.report.study_figures import study_pictures

    names = ["a/b", "a:b", "A_b", "a_b-2", "x" * 300, "x" * 301]
    motions = [
        fdspec.GroundMotion(record("a", k + 1, 30).acceleration, 0.01, name=name)
        for k, name in enumerate(names)
    ]
    swept = fdspec.sweep(motions, period=[0.5, 1.0], pretension=[10e3, 20e3], stiffness_ratio=[2.0])
    files = [picture.name.casefold() for picture in study_pictures(swept)]
    assert len(set(files)) == len(files)
    assert max(map(len, files)) < 120


def test_a_disk_that_refuses_is_no_damage(tmp_path: Path) -> None:
    with pytest.raises(DiskError, match="cannot write"):
        check_writable("/proc/cube.nc")
