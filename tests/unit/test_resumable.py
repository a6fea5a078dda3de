"""A sweep into a store: the bits of the plain one, and only what is missing is computed again."""

from __future__ import annotations

import itertools
import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from zarr.storage import LocalStore

import fdspec
from fdspec.errors import DiskError, StoreError
from fdspec.runs import resumable
from fdspec.runs.resumable import differences, identity_of, plan_blocks
from fdspec.runs.sweep import COLUMNS
from fdspec.store import chunks, description
from fdspec.store.conversion import to_netcdf
from fdspec.variables import CUBE, STUDY_DIMS
from tests.unit.test_sweep import AXES, record

Motions = list[fdspec.GroundMotion]


@pytest.fixture(scope="module")
def motions() -> Motions:
    return [record("a", samples=60), record("b", 2, 50)]


@pytest.fixture(autouse=True)
def same_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture
def store(tmp_path: Path) -> Path:
    return tmp_path / "cube.zarr"


def computed(monkeypatch: pytest.MonkeyPatch, *, until: int | None = None) -> list[int]:
    """List the blocks that are written from now on; the one after `until` of them fails."""
    written: list[int] = []
    write = chunks.write

    def counting(path: Path, blocks: Any, number: int, *rest: Any) -> None:
        if until is not None and len(written) == until:
            raise KeyboardInterrupt
        write(path, blocks, number, *rest)
        written.append(number)

    monkeypatch.setattr(chunks, "write", counting)
    return written


def removed_at(monkeypatch: pytest.MonkeyPatch, call: int, remove: Callable[[], None]) -> list[str]:
    """Remove something just before a file of the store is read or written for the call-th time."""
    calls: list[str] = []

    def watched(name: str) -> None:
        plain = getattr(LocalStore, name)

        async def watching(self: LocalStore, key: str, *rest: Any, **named: Any) -> Any:
            if len(calls) == call:
                remove()
            calls.append(key)
            return await plain(self, key, *rest, **named)

        monkeypatch.setattr(LocalStore, name, watching)

    watched("get")
    watched("set")
    return calls


@pytest.mark.parametrize("part", ["", "status", "peak_displacement/zarr.json"])
def test_what_is_removed_at_any_instant_of_a_write_is_told(
    motions: Motions, store: Path, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    fdspec.sweep(motions, **AXES, store=store).close()
    blocks = description.described(store)[0]
    cube = fdspec.open(store, lazily=False)
    variables = [CUBE[name] for name in map(str, cube.data_vars) if name in CUBE]
    values = {v.name: cube[v.name].values[blocks.region(0, v)] for v in variables if blocks.owns(0, v)}
    elsewhere = store.with_name("elsewhere")
    for call in range(200):
        with monkeypatch.context() as patch:
            calls = removed_at(patch, call, lambda: (store / part).rename(elsewhere))
            told = None
            try:
                chunks.write(store, blocks, 0, values, variables)
            except DiskError as error:
                told = str(error)
        if len(calls) <= call:
            break
        if part:
            assert told is None or f"cannot write {store}: parts of it were removed meanwhile" in told
        else:
            assert told is not None
            assert "there is no such store; it was removed" in told
            assert not store.exists(), "an empty store is in the way of the next"
        if store.joinpath(part).is_dir():  # Zarr made the folder anew
            shutil.rmtree(store / part)
        store.joinpath(part).unlink(missing_ok=True)
        elsewhere.rename(store / part)
    assert call > 10
    assert told is None


@pytest.mark.parametrize("columns_per_task", [None, 1, 2, 3, 5, 8, 12])
def test_the_bits_of_the_plain_sweep(motions: Motions, store: Path, columns_per_task: int | None) -> None:
    plain = fdspec.sweep(motions, **AXES)
    swept = fdspec.sweep(motions, **AXES, store=store, columns_per_task=columns_per_task)
    xr.testing.assert_identical(swept.load(), plain)
    to_netcdf(store, store.with_suffix(".nc"))
    xr.testing.assert_identical(fdspec.open(store.with_suffix(".nc")), plain)


def test_chosen_outputs_and_no_certificate(motions: Motions, store: Path) -> None:
    for number, chosen in enumerate((["slip_travel", "elastic_acceleration"], ["strain_energy_area"])):
        named = {"outputs": chosen, "certify": False}
        swept = fdspec.sweep(motions, **AXES, **named, store=store.with_stem(str(number)), columns_per_task=4)
        xr.testing.assert_identical(swept.load(), fdspec.sweep(motions, **AXES, **named))


def test_it_is_read_when_it_is_used(motions: Motions, store: Path) -> None:
    swept = fdspec.sweep(motions, **AXES, store=store)
    assert not swept.peak_acceleration.variable._in_memory
    assert fdspec.open(store, lazily=False).peak_acceleration.variable._in_memory


def test_what_is_finished_is_not_computed_again(
    motions: Motions, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = fdspec.sweep(motions, **AXES)
    how: dict[str, Any] = {"store": store, "columns_per_task": 1, "scheduler": "synchronous"}
    seen: list[int] = []
    for until in (1, 0, 7, 12, None):
        with monkeypatch.context() as patch:
            written = computed(patch, until=until)
            if until is None:
                swept = fdspec.sweep(motions, **AXES, **how)
            else:
                with pytest.raises(KeyboardInterrupt):
                    fdspec.sweep(motions, **AXES, **how)
            assert not set(seen) & set(written)
            seen += written
        if until is not None:
            with pytest.warns(UserWarning, match=f"{24 - len(seen)} of 24 blocks are not computed yet"):
                half = fdspec.open(store)
            there = half.status != chunks.NOT_COMPUTED
            assert int(there.sum()) == 5 * len(seen)
            assert half.status.attrs["flag_meanings"].split()[-1] == "not_computed"
            for name, values in plain.data_vars.items():
                if values.dims == STUDY_DIMS:
                    xr.testing.assert_equal(half[name].where(there), values.where(there))
    assert sorted(seen) == list(range(24))
    xr.testing.assert_identical(swept.load(), plain)
    with monkeypatch.context() as patch:
        assert computed(patch, until=0) == []
        fdspec.sweep(motions, **AXES, **how)


def test_what_is_damaged_is_computed_again(
    motions: Motions, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = fdspec.sweep(motions, **AXES)
    fdspec.sweep(motions, **AXES, store=store, columns_per_task=1)
    torn, flipped, gone = (
        store / name
        for name in ("peak_acceleration/c/0/0/0/0", "elastic_acceleration/c/1/3", "status/c/1/2/0/1")
    )
    torn.write_bytes(torn.read_bytes()[:20])
    content = bytearray(flipped.read_bytes())
    content[3] ^= 1
    flipped.write_bytes(content)
    gone.unlink()
    (store / "status/c/1/2/0/1.0123.partial").write_bytes(b"left by a killed process")
    with pytest.warns(UserWarning, match="1 of 24 blocks"):
        damaged = fdspec.open(store)
    with pytest.raises(StoreError, match="peak_acceleration/c/0/0/0/0 is damaged; start the sweep again"):
        damaged.peak_acceleration.load()
    with pytest.warns(UserWarning, match="1 of 24 blocks"), pytest.raises(StoreError, match="damaged"):
        fdspec.open(store, lazily=False)
    written = computed(monkeypatch)
    swept = fdspec.sweep(motions, **AXES, store=store)
    assert sorted(written) == [0, 12 + 3, 12 + 9]
    xr.testing.assert_identical(swept.load(), plain)
    assert not list(store.glob("**/*.partial"))


OTHERS: dict[str, tuple[dict[str, Any], str]] = {
    "an axis": ({"period": [0.05, 0.2, 0.5]}, r"period is \[0.05, 0.2, 0.5, 1.0\] in the store, \[0.05"),
    "a number": ({"floor_mass": 1e4}, "floor_mass is 20000.0 in the store, 10000.0 in the study"),
    "outputs": ({"outputs": ["slip_travel"]}, "outputs is 17 values"),
    "certify": ({"certify": False}, "certify is true in the store, false in the study"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_study_is_refused(motions: Motions, store: Path, name: str) -> None:
    change, said = OTHERS[name]
    fdspec.sweep(motions, **AXES, store=store)
    before = {path: path.read_bytes() for path in store.rglob("*") if path.is_file()}
    with pytest.raises(StoreError, match=said):
        fdspec.sweep(motions, **{**AXES, **change}, store=store)
    assert {path: path.read_bytes() for path in store.rglob("*") if path.is_file()} == before
    swept = fdspec.sweep(motions, **{**AXES, **change}, store=store, restart=True)
    xr.testing.assert_identical(swept.load(), fdspec.sweep(motions, **{**AXES, **change}))
    assert [path.name for path in store.parent.iterdir()] == [store.name]


def test_other_records_are_refused(motions: Motions, store: Path) -> None:
    fdspec.sweep(motions, **AXES, store=store)
    for others, said in (
        ([motions[0], motions[1].scaled(1.001)], "record b has other numbers"),
        ([motions[0]], "record b is not in the study"),
        ([*motions, record("c", 3, 50)], "record c is not in the store"),
        (motions[::-1], "the records stand in another order"),
    ):
        with pytest.raises(StoreError, match=said):
            fdspec.sweep(others, **AXES, store=store)


def test_another_version_is_refused(motions: Motions, store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fdspec.sweep(motions, **AXES, store=store)
    with monkeypatch.context() as patch:
        patch.setattr(sys.modules["fdspec.store.provenance"], "__version__", "9.9")
        with pytest.raises(StoreError, match='fdspec_version is "0.1.0" in the store, "9.9" in the study'):
            fdspec.sweep(motions, **AXES, store=store)
    monkeypatch.setattr("fdspec.compiler.options.source_key", lambda: "another")
    with pytest.raises(StoreError, match='kernels_source is "[0-9a-f]{16}" in the store, "another" in'):
        fdspec.sweep(motions, **AXES, store=store)


def test_every_parameter_tells_two_studies_apart(motions: Motions) -> None:
    cube = fdspec.sweep(motions, **AXES)
    identity = identity_of(cube)
    assert set(json.loads(cube.attrs["parameters"])) < set(identity)
    assert differences(identity, identity) == []
    for name in identity:
        if name != "records":
            assert len(differences(identity, {**identity, name: -1})) == 1, name


def test_a_store_that_is_not_ours_is_left_alone(motions: Motions, tmp_path: Path) -> None:
    alien = tmp_path / "alien.zarr"
    xr.Dataset({"a": ("x", [1.0])}).to_zarr(alien, zarr_format=3, consolidated=False)
    (tmp_path / "folder.zarr").mkdir()
    (tmp_path / "file.zarr").touch()
    for path in (alien, tmp_path / "folder.zarr", tmp_path / "file.zarr"):
        for restart in (False, True):
            with pytest.raises(StoreError, match="cannot open .*Zarr store"):
                fdspec.sweep(motions, **AXES, store=path, restart=restart)
        assert path.exists()
    with pytest.raises(StoreError, match="another program's"):
        fdspec.open(alien)


def test_a_name_that_is_no_zarr_is_refused(motions: Motions, tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"the name should end in \.zarr"):
        fdspec.sweep(motions, **AXES, store=tmp_path / "cube.nc")
    with pytest.raises(StoreError, match="there is no folder"):
        fdspec.sweep(motions, **AXES, store=tmp_path / "none" / "cube.zarr")


def test_a_store_that_is_removed_at_work_is_told(
    motions: Motions, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write = chunks.write

    def removing(path: Path, blocks: Any, number: int, *rest: Any) -> None:
        if number == 5:
            shutil.rmtree(path)
        write(path, blocks, number, *rest)

    monkeypatch.setattr(chunks, "write", removing)
    with pytest.raises(DiskError, match="there is no such store"):
        fdspec.sweep(motions, **AXES, store=store, columns_per_task=1, scheduler="synchronous")
    assert not store.exists()


def test_blocks_are_of_a_length_worth_a_task() -> None:
    sizes = {"record": 1000, "stiffness_ratio": 20, "pretension": 100, "period": 100}
    seconds = 1e4
    blocks = plan_blocks(sizes, COLUMNS, seconds, None)
    assert blocks.edges["record"] == 1
    length = seconds / len(blocks)
    assert 0.8 * resumable.LONGEST < length <= resumable.LONGEST


def test_names_of_chunks_are_zarrs(motions: Motions, store: Path) -> None:
    fdspec.sweep(motions, **AXES, store=store, columns_per_task=2)
    blocks, _ = description.described(store)
    variables = [CUBE[str(name)] for name in fdspec.open(store).data_vars]
    mine = {
        chunks.chunk_path(store, blocks, number, variable)
        for number, variable in itertools.product(range(len(blocks)), variables)
        if blocks.owns(number, variable)
    }
    assert len(variables) == 17
    assert mine == {path for v in variables for path in (store / v.name / "c").rglob("*") if path.is_file()}
