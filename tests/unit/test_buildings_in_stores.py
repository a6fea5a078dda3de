"""A sweep over buildings that goes through a store: the same bits, however cut and wherever stopped."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.errors import InvalidInput, StoreError
from fdspec.store import chunks, to_netcdf
from fdspec.store.check import check
from tests.unit.test_sweep_buildings import motions, unlike

AXES: dict[str, Any] = {"slip_scale": [0.3, 1.0, np.inf], "stiffness_scale": [0.5, 1.0]}


@pytest.fixture(autouse=True)
def epoch(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture(scope="module")
def plain() -> xr.Dataset:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1700000000")
        return fdspec.sweep_buildings(motions(), unlike(), **AXES)


SELDOM = [pytest.param(cells, marks=pytest.mark.slow) for cells in (1, 2, 3, 6, 100)]


@pytest.mark.parametrize("cells_per_task", [None, 4, *SELDOM])
def test_the_bits_of_the_plain_sweep(plain: xr.Dataset, tmp_path: Path, cells_per_task: int | None) -> None:
    store = tmp_path / "cube.zarr"
    swept = fdspec.sweep_buildings(motions(), unlike(), **AXES, store=store, cells_per_task=cells_per_task)
    assert swept.load().identical(plain)
    to_netcdf(store, tmp_path / "cube.nc")
    assert fdspec.open(tmp_path / "cube.nc").identical(plain)
    for path in (store, tmp_path / "cube.nc"):
        assert {finding.what for finding in check(path) if finding.passed is False} == set()


def test_one_that_stopped_goes_on(plain: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "cube.zarr"
    how: dict[str, Any] = {"store": store, "cells_per_task": 1, "scheduler": "synchronous"}
    write, left = chunks.write, [5]

    def stopping(*given: Any) -> None:
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        write(*given)

    with monkeypatch.context() as patch:
        patch.setattr(chunks, "write", stopping)
        with pytest.raises(KeyboardInterrupt):
            fdspec.sweep_buildings(motions(), unlike(), **AXES, **how)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        assert int((fdspec.open(store)["status"] == -1).sum()) == plain["status"].size - 5
    assert {finding.what for finding in check(store) if finding.passed is False} >= {"checksums"}
    told: list[tuple[int, int]] = []
    swept = fdspec.sweep_buildings(
        motions(), unlike(), **AXES, **how, progress=lambda *both: told.append(both)
    )
    assert swept.load().identical(plain)
    assert told[0] == (5, plain["status"].size)  # histories, not storeys


def test_a_damaged_chunk_is_told_and_computed_again(plain: xr.Dataset, tmp_path: Path) -> None:
    store = tmp_path / "cube.zarr"
    fdspec.sweep_buildings(motions(), unlike(), **AXES, store=store, cells_per_task=2).close()
    chunk = next(file for file in sorted((store / "peak_drift" / "c").rglob("*")) if file.is_file())
    content = bytearray(chunk.read_bytes())
    content[len(content) // 2] ^= 1
    chunk.write_bytes(content)
    told = {finding.what: finding.told for finding in check(store) if finding.passed is False}
    assert "peak_drift" in told["checksums"]
    assert fdspec.sweep_buildings(motions(), unlike(), **AXES, store=store).load().identical(plain)


def test_another_building_is_refused_by_name_and_part(tmp_path: Path) -> None:
    store, buildings = tmp_path / "cube.zarr", unlike()
    fdspec.sweep_buildings(motions(), buildings, **AXES, store=store).close()
    name, building = next(iter(buildings.items()))
    other = {
        **buildings,
        name: fdspec.Building(
            building.floor_mass,
            building.storey_stiffness,
            building.brace_mass,
            building.brace_stiffness,
            building.slip_force * 1.01,
            building.kinetic_slip_force,
            building.damping,
            building.brace_damping,
        ),
    }
    with pytest.raises(StoreError, match=f"building {name} has another slip_force; name another store"):
        fdspec.sweep_buildings(motions(), other, **AXES, store=store)
    fewer = dict(list(buildings.items())[1:])
    with pytest.raises(StoreError, match=f"building {name} is not in the study"):
        fdspec.sweep_buildings(motions(), fewer, **AXES, store=store)
    turned = dict(reversed(buildings.items()))
    with pytest.raises(StoreError, match="the buildings stand in another order"):
        fdspec.sweep_buildings(motions(), turned, **AXES, store=store)
    swept = fdspec.sweep_buildings(motions(), other, **AXES, store=store, restart=True)
    assert (
        json.loads(swept.attrs["parameters"])["buildings"][name]["slip_force"][0] == other[name].slip_force[0]
    )


def test_a_task_has_a_cell_at_least(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="cells_per_task must be at least 1, got 0"):
        fdspec.sweep_buildings(motions(), unlike(), **AXES, store=tmp_path / "cube.zarr", cells_per_task=0)


@pytest.mark.slow
def test_blocks_with_and_without_devices_give_the_plain_sweep(tmp_path: Path) -> None:
    name, elastic = next(iter(unlike().items()))
    buildings = {name: elastic, "yielding": elastic.with_changes(yield_shear=60e3, storey_height=3.0)}
    plain = fdspec.sweep_buildings(motions(), buildings, **AXES)
    assert "ductility" in plain
    for cells in (1, 5):
        store = tmp_path / f"{cells}.zarr"
        swept = fdspec.sweep_buildings(motions(), buildings, **AXES, store=store, cells_per_task=cells)
        assert swept.load().identical(plain)
