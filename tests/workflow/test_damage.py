"""Cubes damaged in every part in turn: `check` sees what alters a number, and nothing ends in a traceback."""

from __future__ import annotations

import json
import os
import random
import shutil
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.cli import main
from fdspec.errors import DamagedError, FdspecError
from fdspec.explore.content import Content
from fdspec.store.check import check
from tests.unit.test_sweep import record

AXES = {"period": [0.2, 0.5], "pretension": [10e3, 30e3], "stiffness_ratio": [1.0, 4.0]}


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """The CF checker takes seconds, and knows nothing of damage."""
    monkeypatch.setattr("fdspec.store.check.shutil.which", lambda *_, **__: None)


@pytest.fixture(scope="module", autouse=True)
def same_time() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        yield


@pytest.fixture(scope="module")
def right() -> xr.Dataset:
    return fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES)


@pytest.fixture
def store(tmp_path: Path, whole: Path) -> Path:
    shutil.copytree(whole, tmp_path / "cube.zarr")
    return tmp_path / "cube.zarr"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "cube.zarr"
    fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES, store=path, columns_per_task=2)
    return path


def opened(path: Path) -> xr.Dataset | None:
    """Return what `open` gives, None where it is refused; anything but a clear refusal fails."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            return fdspec.open(path, lazily=False)
    except FdspecError:
        return None


def seen(path: Path) -> bool:
    """Whether `check` says that something is wrong."""
    try:
        return any(finding.passed is False for finding in check(path))
    except FdspecError:
        return True


def damages(content: bytes, chance: random.Random) -> dict[str, bytes | None]:
    at = chance.randrange(len(content)) if content else 0
    flipped = bytearray(content)
    if content:
        flipped[at] ^= 1 << chance.randrange(8)
    return {
        "a bit": bytes(flipped),
        "cut": content[: len(content) // 2],
        "zeros": bytes(len(content)),
        "empty": b"",
        "removed": None,
    }


@pytest.mark.slow
def test_every_file_of_a_store_in_every_way(store: Path, right: xr.Dataset) -> None:
    damage_every_file(store, right, 5)


def test_every_file_of_a_store(store: Path, right: xr.Dataset) -> None:
    damage_every_file(store, right, 1)


def damage_every_file(store: Path, right: xr.Dataset, ways: int) -> None:
    chance = random.Random(1)
    files = sorted(path for path in store.rglob("*") if path.is_file())
    for file in files if ways > 1 else chance.sample(files, 40):
        content = file.read_bytes()
        for kind, damaged in chance.sample(sorted(damages(content, chance).items()), ways):
            if damaged == content:
                continue
            told = f"{kind}: {file.relative_to(store)}"
            if damaged is None:
                file.unlink()
            else:
                file.write_bytes(damaged)
            assert seen(store), told
            given = opened(store)
            if given is not None:  # a block that is not computed says so
                there = given["status"] == 0
                assert not there.all() or file.name == "root.json", told
                for name in right.coords:
                    assert given[name].identical(right[name]), told
            file.write_bytes(content)
    assert not seen(store)


@pytest.mark.parametrize("kind", ["a bit", "cut", "removed", "a pipe", "a folder"])
def test_the_next_sweep_mends_a_store(store: Path, right: xr.Dataset, kind: str) -> None:
    chance = random.Random(2)
    files = sorted(path for path in store.rglob("*") if path.is_file())
    roots = [file for file in files if file.name == "root.json" or file.parent == store]
    for file in [chance.choice(roots), *chance.sample([file for file in files if file not in roots], 12)]:
        if kind in {"a bit", "cut", "removed"}:
            damaged = damages(file.read_bytes(), chance)[kind]
            file.unlink()
            if damaged is not None:
                file.write_bytes(damaged)
        else:
            file.unlink()
            if kind == "a pipe":
                os.mkfifo(file)
            else:
                file.mkdir()
    assert seen(store)
    fdspec.sweep([record("a", samples=60), record("b", 2, 50)], **AXES, store=store).close()
    assert not seen(store)
    xr.testing.assert_identical(fdspec.open(store, lazily=False), right)


@pytest.mark.slow
def test_many_bits_of_a_netcdf_file(tmp_path: Path, right: xr.Dataset) -> None:
    flip_bits(tmp_path / "cube.nc", right, 1500)


def test_bits_of_a_netcdf_file(tmp_path: Path, right: xr.Dataset) -> None:
    flip_bits(tmp_path / "cube.nc", right, 60)


def flip_bits(path: Path, right: xr.Dataset, count: int) -> None:
    fdspec.save(right, path)
    content = path.read_bytes()
    chance = random.Random(3)
    for _ in range(count):
        path.write_bytes(damages(content, chance)["a bit"] or b"")
        given = opened(path)
        assert given is None or given.identical(right)
        assert given is not None or seen(path)


@pytest.mark.parametrize("size", [0, 7, 100, 0.3, 0.9, 0.999])
def test_a_netcdf_file_that_is_cut(tmp_path: Path, right: xr.Dataset, size: float) -> None:
    path = tmp_path / "cube.nc"
    fdspec.save(right, path)
    content = path.read_bytes()
    path.write_bytes(content[: size if size >= 1 else int(size * len(content))])  # type: ignore[misc]
    assert opened(path) is None
    assert seen(path)


def changed(path: Path, change: Callable[[netCDF4.Dataset], None]) -> None:
    with netCDF4.Dataset(path, "a") as file:
        file.set_auto_maskandscale(False)
        change(file)


def put(name: str, value: float) -> Callable[[netCDF4.Dataset], None]:
    def change(file: netCDF4.Dataset) -> None:
        file[name][(0,) * file[name].ndim] = value

    return change


NUMBERS: dict[str, Callable[[netCDF4.Dataset], None]] = {
    "a period of NaN": put("period", np.nan),
    "a negative period": put("period", -0.2),
    "equal periods": put("period", 0.5),
    "periods that fall": put("period", 0.9),
    "a pretension of NaN": put("pretension", np.nan),
    "an acceleration of -1e308": put("peak_acceleration", -1e308),
    "an acceleration of 1e308": put("peak_acceleration", 1e308),
    "a negative error of energy": put("energy_error", -1e300),
    "a slip force": put("slip_force", 1.0),
    "a negative pga": put("pga", -1.0),
    "an unknown status": put("status", 77),
}


@pytest.mark.parametrize("kind", NUMBERS)
@pytest.mark.parametrize("old", [False, True], ids=["with checksums", "before checksums"])
def test_numbers_that_cannot_be(tmp_path: Path, right: xr.Dataset, kind: str, old: bool) -> None:
    path = tmp_path / "cube.nc"
    fdspec.save(right, path)
    changed(path, NUMBERS[kind])
    if old:
        changed(path, as_before)
        assert opened(path) is not None
    else:
        assert opened(path) is None
    assert seen(path)


def as_before(file: netCDF4.Dataset) -> None:
    file.delncattr("fdspec_checksums")
    file.setncattr("fdspec_format", np.int32(1))


def test_a_file_from_before_checksums_opens(tmp_path: Path, right: xr.Dataset) -> None:
    path = tmp_path / "cube.nc"
    fdspec.save(right, path)
    changed(path, as_before)
    xr.testing.assert_identical(fdspec.open(path), right)
    found = {finding.what: finding for finding in check(path)}
    assert all(finding.passed is not False for finding in found.values())
    assert "before axes and attributes had checksums" in found["checksums"].told


def deep(file: netCDF4.Dataset) -> None:
    file.setncattr("parameters", "[" * 100_000)


HOSTILE: dict[str, Callable[[netCDF4.Dataset], None]] = {
    "a variable lost": lambda file: file.renameVariable("peak_acceleration", "x"),
    "the status lost": lambda file: file.renameVariable("status", "x"),
    "the names lost": lambda file: file.renameVariable("record_id", "x"),
    "an axis lost": lambda file: file.renameVariable("period", "x"),
    "the labels lost": lambda file: file["record"].delncattr("fdspec_labels"),
    "labels of nothing": lambda file: file["record"].setncattr("fdspec_labels", "none"),
    "a version in words": lambda file: file.setncattr("fdspec_format", "two"),
    "versions": lambda file: file.setncattr("fdspec_format", np.array([1, 2], np.int32)),
    "deep JSON": deep,
    "JSON of another kind": lambda file: file.setncattr("parameters", "[1, 2]"),
    "a number for parameters": lambda file: file.setncattr("parameters", 3.0),
    "no parameters": lambda file: file.delncattr("parameters"),
    "no flags": lambda file: file["status"].delncattr("flag_values"),
    "flags of another length": lambda file: file["status"].setncattr("flag_meanings", "ok"),
    "a period of NaN": put("period", np.nan),
    "periods that fall": put("period", 9.0),
    "units of another kind": lambda file: file["period"].setncattr("units", np.float64(3.0)),
}


@pytest.mark.parametrize("kind", HOSTILE)
@pytest.mark.parametrize("old", [False, True], ids=["with checksums", "before checksums"])
def test_commands_on_hostile_files(
    tmp_path: Path,
    right: xr.Dataset,
    kind: str,
    old: bool,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    fdspec.save(right, "cube.nc")
    if old:
        changed(tmp_path / "cube.nc", as_before)
    changed(tmp_path / "cube.nc", HOSTILE[kind])
    for command in (
        ["check", "cube.nc"],
        ["claims", "cube.nc"],
        ["figures", "cube.nc", "--list"],
        ["export", "cube.nc", "-o", "a.csv", "--record", "a", "--force"],
        ["export", "cube.nc", "-o", "a.nc", "--record", "a", "--force"],
        ["export", "cube.nc", "-o", "a.html", "--force"],
    ):
        code = main(command)  # a traceback would be raised here
        out, err = capsys.readouterr()
        assert code in {0, 1, 2}, command
        errors = [line for line in err.splitlines() if line.startswith("fdspec: error")]
        assert len(errors) == (code != 0), (command, err)
        if command[0] == "check":
            assert code != 0, out
            assert "FAILED" in out or errors
        elif not old:
            assert code != 0, command


def test_commands_on_a_store_with_a_flipped_chunk(
    store: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(store.parent)
    chunk = store / "peak_acceleration/c/0/0/0/0"
    content = bytearray(chunk.read_bytes())
    content[3] ^= 1
    chunk.write_bytes(content)
    for command in (["check"], ["claims"], ["export", "-o", "a.csv", "--record", "a"]):
        assert main([*command[:1], "cube.zarr", *command[1:]]) in {1, 2}
        out, err = capsys.readouterr()
        assert "peak_acceleration/c/0/0/0/0" in out + err
        assert len(err.splitlines()) == 1


def test_attributes_of_a_store_that_are_of_another_kind(store: Path) -> None:
    for name, value in {
        "fdspec_format": "two",
        "fdspec_blocks": [1],
        "fdspec_identity": 3,
        "fdspec_order": None,
        "fdspec_files": "x",
    }.items():
        for root in (store / "zarr.json", store / "status/root.json"):
            told = json.loads(root.read_text())
            told["attributes"].pop("fdspec_checksum", None)
            root.write_text(json.dumps({**told, "attributes": {**told["attributes"], name: value}}))
        assert opened(store) is None
        assert seen(store)


def test_content_of_a_cube_that_is_damaged_after_it_was_opened(store: Path, right: xr.Dataset) -> None:
    file = store.with_name("cube.nc")
    fdspec.save(right, file)
    with fdspec.open(file, lazily=True) as cube, fdspec.open(store) as stored:
        with netCDF4.Dataset(file) as opened:
            assert opened["peak_acceleration"].filters()["fletcher32"]
        content = bytearray(file.read_bytes())
        # Deflated chunks begin with 78 01: all of them are broken, the rest stays.
        for at in range(len(content) - 1):
            if content[at : at + 2] == b"\x78\x01":
                content[at + 2] ^= 0xFF
        with file.open("r+b") as inside:
            inside.write(content)
        shutil.rmtree(store / "peak_acceleration/c")
        for opened_lazily in (cube, stored):
            with pytest.raises(DamagedError):
                Content(opened_lazily, "cube").record(0)
