"""Statistics over records against numpy's, and cubes joined against one sweep over all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.cli.main import main
from fdspec.errors import InvalidInput
from fdspec.figures import encode, plot_profiles
from fdspec.store.check import check
from tests.unit.test_sweep_buildings import motions, record, unlike

FRAMES: dict[str, Any] = {
    "period": [0.2, 0.5],
    "pretension": [0.0, 50e3, np.inf],
    "stiffness_ratio": [1.0, 4.0],
}
SCALES: dict[str, Any] = {"slip_scale": [0.5, 1.0], "stiffness_scale": [1.0, 2.0]}


@pytest.fixture(autouse=True)
def epoch(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture(scope="module")
def frames() -> xr.Dataset:
    return fdspec.sweep([*motions(), record("c", 3)], **FRAMES)


@pytest.fixture(scope="module")
def buildings() -> xr.Dataset:
    return fdspec.sweep_buildings(motions(), unlike(), **SCALES)


def test_statistics_are_those_of_numpy(frames: xr.Dataset) -> None:
    told = fdspec.summary(frames, percentiles=[16, 84, 97.5])
    values = frames["peak_acceleration"].values
    got = told["peak_acceleration"]
    for name, wanted in {
        "median": np.median(values, axis=0),
        "mean": values.mean(axis=0),
        "p16": np.percentile(values, 16, axis=0),
        "p97.5": np.percentile(values, 97.5, axis=0),
        "worst": values.max(axis=0),
    }.items():
        np.testing.assert_array_equal(got.sel(statistic=name).values, wanted)
    residual = frames["residual_displacement"].values
    worst = np.take_along_axis(residual, np.abs(residual).argmax(axis=0)[np.newaxis], axis=0)[0]
    np.testing.assert_array_equal(told["residual_displacement"].sel(statistic="worst").values, worst)
    assert (told["records"] == 3).all()
    assert got.attrs == frames["peak_acceleration"].attrs


def test_a_history_that_did_not_end_well_does_not_count(frames: xr.Dataset) -> None:
    changed = frames.copy(deep=True)
    changed["status"][2, 0, 0, 0] = 2
    changed["peak_acceleration"][2, 0, 0, 0] = np.nan
    changed["status"][:, 1, 1, 1] = 2
    told = fdspec.summary(changed, ["peak_acceleration"])
    at = {"stiffness_ratio": 0, "pretension": 0, "period": 0}
    assert int(told["records"].isel(at)) == 2
    two = frames["peak_acceleration"].isel(at).values[:2]
    assert float(told["peak_acceleration"].isel(at).sel(statistic="median")) == np.median(two)
    assert np.isnan(told["peak_acceleration"].isel(stiffness_ratio=1, pretension=1, period=1)).all()


def test_it_saves_and_exports(buildings: xr.Dataset, tmp_path: Path) -> None:
    told = fdspec.summary(buildings)
    fdspec.save(told, tmp_path / "s.nc")
    assert fdspec.open(tmp_path / "s.nc").identical(told)
    assert not [finding for finding in check(tmp_path / "s.nc") if finding.passed is False]
    fdspec.export(told, tmp_path / "s.csv")
    lines = [line for line in (tmp_path / "s.csv").read_text().splitlines() if not line.startswith("#")]
    assert len(lines) == 1 + told["peak_drift"].size
    fdspec.export(told, tmp_path / "t.nc")


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"percentiles": [101]}, "percentiles must be from 0 to 100, got 101"),
        ({"variables": ["peak"]}, "variables: 'peak' is none of"),
        ({"over": "time"}, "cube must have the dim 'time'"),
    ],
)
def test_what_cannot_be_summed_up_is_told(frames: xr.Dataset, how: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        fdspec.summary(frames, **how)


@pytest.mark.parametrize(
    ("along", "parts"),
    [
        ("record", [["a"], ["b", "c"]]),
        ("pretension", [[50e3], [0.0, np.inf]]),
        ("period", [[0.5], [0.2]]),
        ("stiffness_ratio", [[1.0], [4.0]]),
    ],
)
def test_parts_joined_are_the_one_sweep(
    frames: xr.Dataset, along: str, parts: list[list[Any]], tmp_path: Path
) -> None:
    cubes = [frames.sel({along: part}) for part in parts]
    joined = fdspec.combine(cubes, along)
    whole = frames.copy()
    assert json.loads(joined.attrs["parameters"]) == json.loads(whole.attrs["parameters"])
    fdspec.save(joined, tmp_path / "joined.nc")
    assert not [finding for finding in check(tmp_path / "joined.nc") if finding.passed is False]
    assert "fdspec.combine along" in joined.attrs["history"]
    joined.attrs, whole.attrs = {}, {}
    assert joined.identical(whole)


@pytest.mark.parametrize("along", ["record", "building", "slip_scale", "stiffness_scale"])
def test_buildings_joined_are_the_one_sweep(buildings: xr.Dataset, along: str) -> None:
    count = buildings.sizes[along]
    cubes = [buildings.isel({along: [k]}) for k in range(count)]
    joined, whole = fdspec.combine(cubes, along), buildings.copy()
    assert json.loads(joined.attrs["parameters"]) == json.loads(whole.attrs["parameters"])
    joined.attrs, whole.attrs = {}, {}
    assert joined.identical(whole)


def test_what_cannot_be_joined_is_told_with_the_remedy(frames: xr.Dataset) -> None:
    one, two = frames.isel(record=[0]), frames.isel(record=[1])
    lighter = fdspec.sweep(motions()[1:], **FRAMES, floor_mass=10e3)
    fewer = fdspec.sweep(motions()[1:], **FRAMES, outputs=["peak_acceleration"])
    cases: list[tuple[list[Any], str, str]] = [
        ([one], "record", "cubes must be two or more, got 1"),
        ([one, two], "storeys", "along must be one of record"),
        ([one, one], "record", "record 'a' stands in two of the cubes; leave it out of one"),
        ([one, lighter], "record", r"differ in floor_mass \(20000.0 and 10000.0\): sweep them with the same"),
        ([one, fewer], "record", "outputs .*sweep them with the same outputs"),
        ([one, two], "period", r"differ in records .*take cube.sel\(record"),
        ([one.isel(period=[0]), one.isel(period=[1])], "record", "--along period"),
        ([one, two.isel(record=0)], "record", "cube 2 has no dimension record"),
        ([one, two.drop_attrs()], "record", "cube 2 is no cube with its parameters"),
    ]
    for cubes, along, said in cases:
        with pytest.raises(InvalidInput, match=said):
            fdspec.combine(cubes, along)
    other = two.copy()
    other.attrs["fdspec_version"] = "0.0.1"
    with pytest.raises(InvalidInput, match="differ in fdspec_version"):
        fdspec.combine([one, other])


def test_profiles_draw_what_is_there(buildings: xr.Dataset) -> None:
    name = str(buildings["building"].values[0])
    figure = plot_profiles(buildings, name)
    assert encode(figure, "png")
    labels = [axis.get_xlabel() for axis in figure.axes]
    assert labels[0].startswith("drift")
    assert any("slip" in label for label in labels)
    assert any("kN" in label for label in labels)
    acceleration = figure.axes[labels.index("acceleration, g")]
    median = next(line for line in acceleration.lines if line.get_label() == "median")
    at = {"building": 0, "stiffness_scale": 0, "slip_scale": 1}
    wanted = buildings["peak_acceleration"].isel(at).median("record").values / fdspec.units.G
    np.testing.assert_allclose(median.get_xdata(), wanted, rtol=1e-12)
    for how, said in (
        ({"building": "none"}, "has no building 'none'"),
        ({"building": None}, "name one of"),
        ({"building": name, "slip_scale": 0.7}, "has no slip_scale 0.7; it has 0.5, 1"),
    ):
        with pytest.raises(InvalidInput, match=said):
            plot_profiles(buildings, **how)


def test_the_commands(
    buildings: xr.Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    fdspec.save(buildings, "all.nc")
    for k, name in enumerate("ab"):
        fdspec.save(buildings.isel(record=[k]), f"{name}.nc")
    assert main(["combine", "a.nc", "b.nc", "-o", "joined.nc"]) == 0
    assert main(["check", "joined.nc", "--json"]) == 0
    told = capsys.readouterr().out
    findings = json.loads(told[told.index("{") :])["findings"]
    assert not [finding for finding in findings if finding["passed"] is False]
    place = f"building={buildings['building'].values[0]}"
    options = ["--at", "slip_scale=1", "--at", place, "--at", "stiffness_scale=1", "--variable", "peak_drift"]
    assert main(["summary", "joined.nc", *options, "-o", "s.csv", "--json"]) == 0
    drift = json.loads(capsys.readouterr().out)["variables"]["peak_drift"]
    wanted = fdspec.summary(buildings, ["peak_drift"]).sel(slip_scale=1, stiffness_scale=1).isel(building=0)
    np.testing.assert_array_equal(drift["values"], wanted["peak_drift"].values)
    assert main(["summary", "joined.nc", *options]) == 0
    assert "peak drift" in capsys.readouterr().out
    assert main(["figures", "joined.nc", "-o", "pictures", "--format", "png"]) == 0
    assert len(list(Path("pictures").glob("profiles-*.png"))) == buildings.sizes["building"]
    capsys.readouterr()
    for arguments, said in (
        (["summary", "joined.nc", "--at", "slip_scale=0.9"], "slip_scale has no 0.9; nearest are 1 and 0.5"),
        (["summary", "joined.nc", "--at", "storeys=1"], "'storeys' is no axis of the cube"),
        (["figures", "joined.nc", "--only", "nobody", "-o", "p"], "has no building 'nobody'"),
        (["combine", "a.nc", "a.nc", "-o", "twice.nc"], "record 'a' stands in two of the cubes"),
        (["claims", "joined.nc"], "'fdspec figures' draws its profiles"),
    ):
        assert main(arguments) == 2
        errors = capsys.readouterr().err
        assert said in errors
        assert len(errors.splitlines()) == 1
