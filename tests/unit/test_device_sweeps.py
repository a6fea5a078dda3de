"""Sweeps, files and choose with devices: the engine is picked, the numbers are those of `simulate`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fdspec
from fdspec import Building, Link, ModalDamping, TensionBrace
from fdspec.cli import main
from fdspec.errors import InvalidInput, StudyError
from fdspec.model.building_file import read_building
from fdspec.model.grid import Grid
from fdspec.runs.study import Study
from fdspec.variables import STATUSES, link_variables
from tests.reference import numbers

GROUND, DT = numbers.motion("mdof_peaks.json")
SHORT = fdspec.GroundMotion(GROUND[200:501] * 1.5, DT, name="short")
BRIEF = fdspec.GroundMotion(GROUND[300:361] * 2.0, DT, name="brief")
DEVICES: dict[str, Any] = {
    "storey_height": 3.0,
    "yield_shear": 60e3,
    "hardening_ratio": 0.02,
    "gravity_load": 300e3,
    "slot_length": 0.004,
    "slot_stiffness": 20e6,
}
AXES: dict[str, Any] = {"period": [0.3, 0.5], "pretension": [40e3, 120e3], "stiffness_ratio": [2.0, 6.0]}
DEMANDS = ("peak_slip", "ductility", "plastic_drift", "column_energy", "peak_brace_force", "peak_drift_ratio")


def test_a_sweep_gives_what_simulate_gives() -> None:
    cube = fdspec.sweep(SHORT, **AXES, **DEVICES)
    assert (cube["status"] == 0).all()
    assert (cube["energy_error"] < 1e-9).all()
    for period in AXES["period"]:
        for pretension in AXES["pretension"]:
            frame = Building.single_storey(
                period=period, stiffness_ratio=6.0, slip_force=0.5 * pretension, **DEVICES
            )
            history = fdspec.simulate(frame, SHORT)
            cell = cube.sel(record="short", period=period, pretension=pretension, stiffness_ratio=6.0)
            for name in ("peak_acceleration", "residual_displacement", *DEMANDS):
                np.testing.assert_array_equal(cell[name], history[name][0], err_msg=name)
            assert int(cell["transitions"]) == int(history["transitions"])
            assert int(cell["column_events"]) == int(history["column_events"][0])
    assert (cube["column_events"] > 0).any()


def test_a_store_and_a_file_keep_them(tmp_path: Path) -> None:
    cube = fdspec.sweep(SHORT, **AXES, **DEVICES)
    stored = fdspec.sweep(SHORT, **AXES, **DEVICES, store=tmp_path / "cube.zarr").load()
    for name in cube.data_vars:
        np.testing.assert_array_equal(cube[name], stored[name], err_msg=str(name))
    fdspec.save(cube, tmp_path / "cube.nc")
    assert fdspec.open(tmp_path / "cube.nc").identical(cube)


ENDS = "upper = 1\nlower = 0\n"
LINKS = (
    Link(1, 0, 30e6, 25e3, mass=40.0, slot_length=0.01, slot_stiffness=5e7, name="second"),
    TensionBrace(1, 0, 10e6, 60e3, slack=0.002),
)


def test_links_and_the_drift_of_collapse_in_sweeps_and_study_files() -> None:
    cube = fdspec.sweep(SHORT, **AXES, links=LINKS, collapse_drift=0.5)
    frame = Building.single_storey(
        period=0.5, stiffness_ratio=2.0, slip_force=20e3, links=LINKS, collapse_drift=0.5
    )
    history = fdspec.simulate(frame, SHORT)
    cell = cube.sel(record="short", period=0.5, pretension=40e3, stiffness_ratio=2.0)
    for name in ("peak_acceleration", "residual_displacement", "peak_slip"):
        np.testing.assert_array_equal(cell[name], history[name][0], err_msg=name)
    assert (cube["peak_displacement"] < fdspec.sweep(SHORT, **AXES)["peak_displacement"]).mean() > 0.5
    study = Study(grid=Grid(**AXES, links=LINKS, collapse_drift=0.5))
    again = Study.parse(study.to_toml())
    assert again.grid.links == LINKS
    assert again.grid.collapse_drift == 0.5
    assert again.grid.parameters["links"] == study.grid.parameters["links"]
    fallen = fdspec.sweep(SHORT, **AXES, collapse_drift=0.001)
    assert (fallen["status"] == 5).any()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "[[links]]\nupper = 1\nlower = 0\nstiffness = -1.0\nslip_force = 1.0",
            "links: stiffness: Input should",
        ),
        ("[[links]]\nupper = 2\nlower = 0\nstiffness = 1.0\nslip_force = 1.0", "links: link 1 joins floor 2"),
        (
            "[[tension_braces]]\nupper = 1\nlower = 0\nstiffness = 1.0\nslack = -1.0",
            "tension_braces: slack: ",
        ),
        ("links = 3", r"links: must be tables, \[\[links\]\], got 3"),
        ("collapse_drift = 0.0", "collapse_drift: must be positive, got 0"),
    ],
)
def test_what_a_study_file_refuses_of_links(text: str, sentence: str) -> None:
    with pytest.raises(StudyError, match=f"study, line 1: {sentence}"):
        Study.parse(text)


def test_an_elastic_sweep_says_nothing_of_devices() -> None:
    cube = fdspec.sweep(SHORT, **AXES, hardening_ratio=0.02, storey_height=3.0, yield_shear=math.inf)
    plain = fdspec.sweep(SHORT, **AXES, storey_height=3.0)
    assert "ductility" not in cube
    np.testing.assert_array_equal(cube["peak_drift_ratio"], cube["peak_displacement"] / 3.0)
    assert cube.attrs["parameters"] == plain.attrs["parameters"]
    np.testing.assert_array_equal(cube["peak_acceleration"], plain["peak_acceleration"])
    with pytest.raises(InvalidInput, match="'ductility' is none of"):
        fdspec.sweep(SHORT, **AXES, outputs=["ductility"])


def test_a_frame_that_collapses_is_a_cell_with_a_status() -> None:
    cube = fdspec.sweep(
        SHORT.scaled(3.0),
        period=[0.8],
        pretension=[1.0],
        stiffness_ratio=[1.0],
        storey_height=2.0,
        yield_shear=3e3,
        gravity_load=300e3,
    )
    assert STATUSES[int(cube["status"].item())] == "collapsed"
    assert cube["peak_drift_ratio"].item() == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"gravity_load": 1e5}, "storey_height: must be given"),
        ({"gravity_load": 1e9, "storey_height": 3.0}, "gravity_load: is beyond elastic stability"),
        ({"slot_length": 0.01}, "slot_stiffness: must be positive where slot_length is given"),
        ({"hardening_ratio": 1.5}, "hardening_ratio: must be less than 1, got 1.5"),
        ({"yield_shear": 0.0}, "yield_shear: must be positive, got 0"),
        ({"yield_shear": 5e4, "method": "newmark"}, "method 'newmark': not for frames with"),
        ({"yield_shear": 5e4, "outputs": ["strain_energy_area"]}, "outputs strain_energy_area: not for"),
    ],
)
def test_what_a_sweep_refuses(given: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidInput, match=text):
        fdspec.sweep(SHORT, **AXES, **given)


def test_a_study_file_takes_devices() -> None:
    study = Study.parse("yield_shear = 60e3\nhardening_ratio = 0.02\nslot_length = inf\nperiod = [0.5]\n")
    assert study.grid.devices == {"yield_shear": 60e3, "hardening_ratio": 0.02, "slot_length": math.inf}
    again = Study.parse(study.to_toml())
    assert again.grid.devices == study.grid.devices
    assert Study.parse(Study().to_toml()).grid.devices == {}
    with pytest.raises(StudyError, match="line 1: storey_height: must be given"):
        Study.parse("gravity_load = 1e5\n")


@pytest.mark.slow
def test_best_pretension_with_devices() -> None:
    best = fdspec.best_pretension(BRIEF, period=0.4, stiffness_ratio=4.0, yield_shear=60e3)
    pretension = float(best["pretension"].item())
    cube = fdspec.sweep(BRIEF, period=[0.4], stiffness_ratio=[4.0], pretension=[pretension], yield_shear=60e3)
    assert best["peak_acceleration"].item() == cube["peak_acceleration"].item()


def office(**devices: Any) -> Building:
    return Building(
        [40e3, 30e3], [40e6, 25e6], 60.0, [80e6, 50e6], [60e3, 40e3], damping=ModalDamping(0.03), **devices
    )


def test_sweep_buildings_with_and_without_devices() -> None:
    yielding = office(yield_shear=[150e3, 80e3], links=[Link(2, 0, 20e6, 30e3)])
    cube = fdspec.sweep_buildings(
        SHORT, {"plain": office(), "yielding": yielding}, slip_scale=[0.5, 1.0], stiffness_scale=1.0
    )
    alone = fdspec.sweep_buildings(SHORT, {"plain": office()}, slip_scale=[0.5, 1.0], stiffness_scale=1.0)
    for name in alone.data_vars:
        if "building" in alone[name].dims:
            np.testing.assert_array_equal(
                alone[name][:, 0], cube[name].sel(building="plain"), err_msg=str(name)
            )
    history = fdspec.simulate(yielding, SHORT)
    cell = cube.sel(record="short", building="yielding", slip_scale=1.0, stiffness_scale=1.0)
    for name in (
        "peak_drift",
        "peak_storey_shear",
        "ductility",
        "plastic_drift",
        "column_energy",
        "peak_slip",
    ):
        np.testing.assert_array_equal(cell[name], history[name], err_msg=name)
    plain = cube.sel(building="plain")
    assert (plain["ductility"] == 0.0).all()
    assert (plain["peak_slip"] > 0.0).all()
    assert "peak_drift_ratio" not in cube
    assert (cube["status"] == 0).all()


def test_cubes_have_what_each_link_takes(tmp_path: Path) -> None:
    links = [Link(2, 0, 20e6, 20e3, name="high"), Link(1, 0, 30e6, 40e3, mass=50.0)]
    pair = {"linked": office(links=links), "yielding too": office(links=links, yield_shear=60e3)}
    axes: dict[str, Any] = {"slip_scale": [0.5, 1.0], "stiffness_scale": [1.0, 2.0]}
    cube = fdspec.sweep_buildings([SHORT, BRIEF], pair, **axes)
    assert cube["link"].values.tolist() == ["high", "link 2"]
    history = fdspec.simulate(pair["yielding too"], SHORT)
    cell = cube.sel(record="short", building="yielding too", slip_scale=1.0, stiffness_scale=1.0)
    for variable in link_variables(()):
        np.testing.assert_array_equal(cell[variable.name], history[variable.name], err_msg=variable.name)
    assert (cube["peak_link_slip"] > 0.0).all()
    stored = fdspec.sweep_buildings([SHORT, BRIEF], pair, **axes, store=tmp_path / "cube.zarr").load()
    for name in cube.data_vars:
        np.testing.assert_array_equal(cube[name], stored[name], err_msg=str(name))
    fdspec.save(cube, tmp_path / "cube.nc")
    assert fdspec.open(tmp_path / "cube.nc", lazily=False).identical(cube)
    levels = fdspec.sweep_buildings(SHORT, pair["linked"], **axes, intensity=[1.0, 2.0])
    assert levels["peak_link_slip"].sizes["intensity"] == 2
    assert (levels["peak_link_slip"].sel(intensity=2.0) > cube["peak_link_slip"].sel(record="short")[0]).all()


def test_links_that_differ_have_no_axis(tmp_path: Path) -> None:
    pair = {"linked": office(links=[Link(2, 0, 20e6, 20e3)]), "plain": office()}
    axes: dict[str, Any] = {"slip_scale": [1.0], "stiffness_scale": [1.0]}
    cube = fdspec.sweep_buildings(BRIEF, pair, **axes)
    assert "link" not in cube.dims
    stored = fdspec.sweep_buildings(
        BRIEF, pair, **axes, store=tmp_path / "cube.zarr", cells_per_task=1
    ).load()
    for name in cube.data_vars:
        np.testing.assert_array_equal(cube[name], stored[name], err_msg=str(name))


def test_choose_with_devices() -> None:
    found = fdspec.choose(office(yield_shear=[150e3, 80e3]), BRIEF)
    force = found["slip_force"].values
    assert (force > 0.0).all()


def test_a_building_file_takes_devices(tmp_path: Path) -> None:
    path = tmp_path / "office.toml"
    path.write_text(
        "floor_mass = [40e3, 30e3]\nstorey_stiffness = [40e6, 25e6]\nbrace_stiffness = 60e6\n"
        "storey_height = 3.2\nyield_shear = [150e3, inf]\nhardening_ratio = -0.02\n"
        "gravity_load = [7e5, 3e5]\n"
        "slot_length = 0.03\nslot_stiffness = 50e6\n"
        "[[links]]\nupper = 2\nlower = 0\nstiffness = 20e6\nslip_force = 30e3\nname = 'long'\n"
    )
    building = read_building(path)
    assert building.yield_shear.tolist() == [150e3, math.inf]
    assert building.links == (Link(2, 0, 20e6, 30e3, name="long"),)
    path.write_text(
        "floor_mass = [40e3]\nstorey_stiffness = 4e7\nbrace_stiffness = 6e7\nhardening_ratio = 1.2\n"
    )
    with pytest.raises(InvalidInput, match="line 4: hardening_ratio"):
        read_building(path)
    path.write_text(
        "floor_mass = [40e3]\nstorey_stiffness = 4e7\nbrace_stiffness = 6e7\ngravity_load = 1e5\n"
    )
    with pytest.raises(InvalidInput, match=r"office.toml: storey_height must be given"):
        read_building(path)


def test_the_command_takes_devices(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "history.nc"
    options = [
        "--yield-shear",
        "5e3",
        "--hardening-ratio",
        "0.02",
        "--slot-length",
        "0.002",
        "--slot-stiffness",
        "2e7",
    ]
    frame = ["--period", "0.4", "--stiffness-ratio", "4", "--slip-force", "30e3"]
    assert main(["simulate", "--record", "FSR1", *frame, *options, "-o", str(out)]) == 0
    assert "ductility" in capsys.readouterr().out
    history = fdspec.open(out)
    assert int(history["column_events"][0]) > 0
    assert (
        main(["simulate", "--record", "FSR1", *frame, "--slot-length", "0.002", "-o", str(out), "--force"])
        == 2
    )
    assert "slot_stiffness must be positive, in N/m, where slot_length is given" in capsys.readouterr().err


def test_the_page_runs_a_cell_with_its_devices() -> None:
    from fdspec.explore.rerun import _parameters

    cube = fdspec.sweep(SHORT, **AXES, **DEVICES)
    frame, _ = _parameters(cube)
    assert {name: frame[name] for name in DEVICES} == DEVICES
    plain, _ = _parameters(fdspec.sweep(SHORT, **AXES))
    assert not set(DEVICES) & set(plain)
