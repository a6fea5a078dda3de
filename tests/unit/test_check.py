"""`fdspec check` finds what is wrong with a cube, and nothing with one that is right."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec import store
from fdspec.cli import main
from fdspec.errors import StoreError
from fdspec.store.check import check
from tests.cubes import synthetic_cube
from tests.unit.test_sweep import AXES, record


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("swept") / "cube.zarr"
    motions = [record("a", samples=60), record("b", 2, 50)]
    fdspec.sweep(motions, **AXES, store=path, columns_per_task=3)
    return path


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """The CF checker takes seconds; it is met in the first test."""
    monkeypatch.setattr("fdspec.store.check.shutil.which", lambda *_, **__: None)


def failed(path: Path) -> dict[str, str]:
    return {finding.what: finding.told for finding in check(path) if finding.passed is False}


FOUND = ("schema", "CF", "records", "axes", "checksums", "statuses", "numbers", "energy")


def test_a_store_that_is_right_passes(swept: Path) -> None:
    assert [(finding.what, finding.passed) for finding in check(swept)] == [(what, True) for what in FOUND]


@pytest.mark.usefixtures("quick")
def test_a_file_that_is_right_passes(cube: xr.Dataset, tmp_path: Path) -> None:
    store.save(cube, tmp_path / "cube.nc")
    found = [(finding.what, finding.passed) for finding in check(tmp_path / "cube.nc")]
    assert found == [(what, None if what == "CF" else True) for what in FOUND]


def broken(cube: xr.Dataset, what: str) -> xr.Dataset:
    cube = cube.copy(deep=True)
    if what == "statuses":
        cube["status"][1, 2, 0, 3] = 1
    elif what == "numbers":
        cube["slip_travel"][0, 1, 2, 3] = np.nan
    elif what == "energy":
        cube["energy_error"][1, 0, 0, 0] = 2e-9
    elif what == "records":
        cube["checksum"][0] = "0" * 64
    elif what == "schema":
        cube["pga"].attrs["units"] = "g"
    return cube


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("what", ["statuses", "numbers", "energy", "records", "schema"])
def test_what_is_wrong_is_named(
    cube: xr.Dataset, tmp_path: Path, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fdspec.store.netcdf.with_true_parameters", lambda dataset: dataset)
    store.save(broken(cube, what), tmp_path / "cube.nc")
    assert list(failed(tmp_path / "cube.nc")) == [what]


@pytest.mark.usefixtures("quick")
def test_cells_that_failed_are_listed_by_their_coordinates(
    cube: xr.Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(tmp_path / "cube.nc")
    store.save(broken(cube, "statuses"), path)
    assert main(["check", path]) == 1
    out, err = capsys.readouterr()
    cell = "transition cap reached: record b, stiffness ratio 10, pretension 0, period 1"
    assert f"FAILED  statuses   119 ok, 1 transition cap reached\n        {cell}\n" in out
    assert err == f"fdspec: error: {path}: statuses failed\n"
    # What did not end well owes no numbers.
    cube = broken(cube, "statuses")
    cube["slip_travel"][1, 2, 0, 3] = cube["energy_error"][1, 2, 0, 3] = np.nan
    store.save(cube, path)
    assert list(failed(Path(path))) == ["statuses"]


@pytest.mark.usefixtures("quick")
def test_a_flipped_bit_of_a_file_is_found(tmp_path: Path) -> None:
    path = tmp_path / "cube.nc"
    store.save(synthetic_cube(["a"], (4, 20, 100)), path)  # random numbers: nearly all of the file
    content = path.read_bytes()
    found = []
    for position in np.random.default_rng(3).integers(len(content) // 4, len(content), 8):
        flipped = bytearray(content)
        flipped[position] ^= 0x10
        path.write_bytes(flipped)
        try:
            found.append("checksums" in failed(path))
        except StoreError:
            found.append(True)
    assert sum(found) >= 7


@pytest.mark.usefixtures("quick")
def test_a_damaged_or_missing_chunk_is_found(swept: Path, tmp_path: Path) -> None:
    import shutil

    path = tmp_path / "cube.zarr"
    shutil.copytree(swept, path)
    chunk = path / "peak_velocity/c/1/0/0/0"
    content = bytearray(chunk.read_bytes())
    content[len(content) // 2] ^= 4
    chunk.write_bytes(content)
    assert failed(path) == {
        "checksums": "damaged: peak_velocity/c/1/0/0/0; start the sweep again to compute them anew"
    }
    chunk.unlink()
    (path / "status/c/1/0/0/0").unlink()
    told = failed(path)
    assert list(told) == ["checksums"]
    assert told["checksums"].startswith("1 of ")


@pytest.mark.usefixtures("quick")
def test_a_history_and_a_cube_of_buildings_are_looked_through(tmp_path: Path) -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=10e3)
    motion = record("a", samples=60)
    store.save(fdspec.simulate(frame, motion), tmp_path / "history.nc")
    swept = fdspec.sweep_buildings(motion, {"b": frame}, slip_scale=[0.5, 1.0], stiffness_scale=1.0)
    store.save(swept, tmp_path / "buildings.nc")
    for name in ("history.nc", "buildings.nc"):
        found = [(finding.what, finding.passed) for finding in check(tmp_path / name)]
        assert found == [(what, None if what == "CF" else True) for what in FOUND]
    store.save(swept.assign(peak_drift=-swept.peak_drift), tmp_path / "buildings.nc")
    assert failed(tmp_path / "buildings.nc") == {"numbers": "peak_drift is negative somewhere"}


@pytest.mark.usefixtures("quick")
def test_of_anything_else_the_checksums_are_compared(tmp_path: Path) -> None:
    store.save(xr.Dataset({"a": ("x", [1.0])}), tmp_path / "a.nc")
    found = {finding.what: finding.passed for finding in check(tmp_path / "a.nc")}
    assert found == {"schema": None, "CF": None, "checksums": True}


def test_what_is_no_file_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(tmp_path / "none.nc")]) == 2
    assert "there is no such file" in capsys.readouterr().err
