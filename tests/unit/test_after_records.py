"""Free vibration and rest from the command line and from study files: the same as in Python."""

from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.cli.main import main
from fdspec.errors import StudyError
from fdspec.runs.after import After
from fdspec.runs.building_study import BuildingStudy, read_study
from fdspec.runs.study import Study
from fdspec.store import open as open_cube

TWO = """
floor_mass = [20e3, 15e3]
storey_stiffness = [9e6, 7e6]
brace_stiffness = [20e6, 16e6]
brace_mass = 50.0
slip_force = [40e3, 25e3]
damping_ratio = 0.03
"""

FRAMES = """
records = ["FSR1"]
stiffness_ratio = [4]
pretension = [20e3, 60e3]
period = [0.5]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text(TWO)
    (tmp_path / "buildings.toml").write_text('buildings = ["two.toml"]\nrecords = ["FSR1"]\n')
    (tmp_path / "frames.toml").write_text(FRAMES)
    return tmp_path


@pytest.mark.parametrize("study", ["frames", "buildings"])
@pytest.mark.parametrize(
    "how", [["--free-vibration", "2.5"], ["--at-rest"]], ids=["free_vibration", "at_rest"]
)
@pytest.mark.parametrize("by_file", [False, True], ids=["option", "file"])
def test_a_sweep_goes_on_after_its_records(
    folder: Path, study: str, how: list[str], by_file: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    path = folder / f"{study}.toml"
    given = {"free_vibration": 2.5} if "2.5" in how else {"at_rest": True}
    if by_file:
        lines = "".join(f"{name} = {str(value).lower()}\n" for name, value in given.items())
        path.write_text(path.read_text() + lines)
        how = []
    assert main(["sweep", str(path), "-o", "cube.nc", *how]) == 0
    cube = open_cube("cube.nc")
    motion = fdspec.load_record("FSR1")
    if study == "frames":
        axes = {"stiffness_ratio": 4, "pretension": [20e3, 60e3], "period": 0.5}
        same = fdspec.sweep(motion, **axes, **given)
    else:
        building = fdspec.model.building_file.read_building("two.toml", design=True)
        scales = {"stiffness_scale": 1.0, "slip_scale": 1.0}
        same = fdspec.sweep_buildings(motion, {"two": building}, **scales, **given)
    assert set(cube.data_vars) == set(same.data_vars)
    for name in same.data_vars:
        np.testing.assert_array_equal(cube[name].values, same[name].values, err_msg=str(name))
    capsys.readouterr()
    assert main(["sweep", str(path), "-o", "cube.nc", *how]) == 0
    assert "holds this study already" in capsys.readouterr().out
    if how:  # another length is another study
        assert main(["sweep", str(path), "-o", "cube.nc"]) == 2


@pytest.mark.parametrize("by_file", [False, True], ids=["option", "file"])
def test_the_intensities_of_a_study_of_buildings_are_all_run(folder: Path, by_file: bool) -> None:
    path = folder / "buildings.toml"
    if by_file:
        path.write_text(path.read_text() + "intensity = [0.5, 2.0]\n")
    how = [] if by_file else ["--intensity", "0.5,2"]
    assert main(["sweep", str(path), "-o", "cube.nc", *how]) == 0
    cube = open_cube("cube.nc")
    assert cube["intensity"].values.tolist() == [0.5, 2.0]
    building = fdspec.model.building_file.read_building("two.toml", design=True)
    motion = fdspec.load_record("FSR1")
    for level in (0.5, 2.0):
        history = fdspec.simulate(building, motion.times(level))
        ours = cube["peak_drift"].sel(intensity=level).values.ravel()
        np.testing.assert_allclose(ours, history["peak_drift"].values, rtol=1e-9)


def test_a_history_goes_on_until_it_is_at_rest(folder: Path) -> None:
    assert main(["simulate", "--building", "two.toml", "--record", "FSR1", "--at-rest", "-o", "h.nc"]) == 0
    building = fdspec.model.building_file.read_building("two.toml", design=True)
    same = fdspec.simulate(building, fdspec.load_record("FSR1"), at_rest=True)
    history = open_cube("h.nc")
    np.testing.assert_array_equal(history["residual_displacement"], same["residual_displacement"])
    np.testing.assert_array_equal(history["time"], same["time"])


def test_study_files_keep_what_follows_the_records(folder: Path) -> None:
    path = folder / "buildings.toml"
    path.write_text(path.read_text() + "free_vibration = 3\nat_rest = true\n")
    study = read_study(path)
    assert study.after == After(3.0, True)
    assert BuildingStudy.parse(study.to_toml(), folder=folder).after == study.after
    frames = Study.parse(FRAMES + "free_vibration = 1.5\n")
    assert Study.parse(frames.to_toml()).after == After(1.5, False)


@pytest.mark.parametrize("value", ["-1", "true", '"long"', "inf"])
def test_what_free_vibration_cannot_be(value: str) -> None:
    with pytest.raises(StudyError, match="free_vibration: must be zero or a positive time in s"):
        Study.parse(FRAMES + f"free_vibration = {value}\n")


def test_the_expected_work_grows_with_what_follows() -> None:
    motion = fdspec.GroundMotion(np.ones(101), 0.01, name="m")
    assert After().times([motion]) == 1.0
    assert After(1.01).times([motion]) == pytest.approx(2.0)
    assert After(1.01, at_rest=True).times([motion]) == pytest.approx(4.0)
