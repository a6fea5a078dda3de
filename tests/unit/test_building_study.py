"""Building files and studies of buildings: what they hold, and one clear line for each mistake."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.cli.main import main
from fdspec.errors import InvalidInput, StudyError
from fdspec.model.building_file import read_building
from fdspec.runs.building_study import BuildingStudy, read_study
from fdspec.runs.study import Study

TWO = """\
floor_mass = [30e3, 20e3]
storey_stiffness = 40e6
brace_stiffness = [80e6, 60e6]
slip_force = [60e3, 30e3]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text(TWO)
    shake = 0.3 * np.sin(np.arange(80) * 0.5)
    for name in ("a", "b"):
        np.savetxt(tmp_path / f"{name}.txt", shake)
    return tmp_path


def records(*names: str) -> str:
    tables = (f'{{ path = "{name}.txt", units = "g", dt = 0.02, name = "{name}" }}' for name in names)
    return f"records = [{', '.join(tables)}]\n"


def test_a_building_file_holds_the_whole_building(tmp_path: Path) -> None:
    path = tmp_path / "b.toml"
    path.write_text(
        "floor_mass = [30e3, 20e3]\nstorey_stiffness = [[8e7, -4e7], [-4e7, 4e7]]\n"
        "brace_stiffness = [8e7, 0]\nbrace_mass = 80\nbrace_damping = [2e3, 0]\nslip_force = inf\n"
        "kinetic_slip_force = [5e4, 0]\n"
        "rayleigh_damping = { ratio = 0.02, period_1 = 0.5, period_2 = 0.1 }\n"
    )
    stiffness = np.array([[8e7, -4e7], [-4e7, 4e7]])
    expected = fdspec.Building(
        [30e3, 20e3], stiffness, [80, 0], [8e7, 0], [np.inf, 0], [5e4, 0],
        fdspec.RayleighDamping(0.02, 0.5, 0.1), [2e3, 0],
    )  # fmt: skip
    assert read_building(path, design=True) == expected
    path.write_text(TWO + "damping_matrix = [[1e5, 0], [0, 1e5]]\nkinetic_ratio = 0.5\n")
    built = read_building(path)
    assert built.damping_matrix.tolist() == [[1e5, 0.0], [0.0, 1e5]]
    assert built.kinetic_slip_force.tolist() == [30e3, 15e3]


def test_devices_and_links_stand_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "b.toml"
    path.write_text(
        TWO + "storey_height = 3.0\nyield_shear = [2e5, inf]\nslot_length = 0.02\nslot_stiffness = 1e8\n"
        "[[links]]\nupper = 2\nlower = 0\nstiffness = 2e7\nslip_force = 4e4\n"
        "[[tension_braces]]\nupper = 1\nlower = 0\nstiffness = 1e7\ndirection = -1\n"
    )
    links = [fdspec.Link(2, 0, 2e7, 4e4), fdspec.TensionBrace(1, 0, 1e7, direction=-1)]
    assert read_building(path, design=True) == fdspec.Building(
        [30e3, 20e3], 40e6, 50.0, [80e6, 60e6], [60e3, 30e3],
        storey_height=3.0, yield_shear=[2e5, np.inf], slot_length=0.02, slot_stiffness=1e8, links=links,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (TWO + "[[links]]\nupper = 2\n", "line 5: links: needs lower at index 0"),
        (TWO + "[[links]]\nupper = 2\nlower = 0\nstiffness = 1e7\nslip_force = 1\nx = 1\n", "no key x"),
        (TWO + "[[links]]\nupper = 9\nlower = 0\nstiffness = 1e7\nslip_force = 1\n", "9"),
        (TWO + "yield_shear = -1\n", "line 5: yield_shear: should be greater than 0"),
        (TWO.replace("slip_force = [60e3, 30e3]\n", ""), "has no slip_force"),
        (
            TWO.replace("60e3, 30e3", "60e3, -1"),
            "line 4: slip_force: should be greater than or equal to 0 at",
        ),
        (TWO.replace("60e3, 30e3", "1, 2, 3"), "line 4: slip_force has 3 values, but the building has 2"),
        (TWO.replace("[60e3, 30e3]", '"big"'), "line 4: slip_force: should be a valid"),
        (TWO.replace("[60e3, 30e3]", "true"), "line 4: slip_force: should be a valid"),
        (TWO + "kinetic_slip_force = 1e6\n", "line 5: kinetic_slip_force must be at most slip_force"),
        (TWO + "kinetic_slip_force = 1\nkinetic_ratio = 0.5\n", "give either kinetic_slip_force or kinetic"),
        (TWO + "damping_ratio = 5\n", "line 5: damping_ratio: should be less than 1"),
        (TWO + "damping_ratio = 0.1\ndamping_matrix = [[1]]\n", "give one of damping_ratio"),
        (TWO + "damping_matrix = [[1, 2]]\n", "as many values in each row as rows"),
        (TWO + "rayleigh_damping = { ratio = 0.05, period_1 = 1 }\n", "rayleigh_damping: needs period_2"),
        (TWO + "height = 3\n", "line 5: height: is no key of a building file"),
        (TWO.replace("floor_mass = [30e3, 20e3]", "floor_mass = []"), "line 1: floor_mass: must have one"),
        (TWO.replace("floor_mass = [30e3, 20e3]\n", ""), "floor_mass: must be given"),
    ],
)
def test_a_mistake_in_a_building_is_one_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "b.toml"
    path.write_text(text)
    with pytest.raises(InvalidInput) as error:
        read_building(path, design=True)
    assert said in str(error.value)
    assert len(str(error.value).splitlines()) == 1


def test_a_study_of_buildings_is_known_by_what_it_holds(folder: Path) -> None:
    (folder / "s.toml").write_text(
        'buildings = { office = "two.toml" }\n' + records("a")
        + "slip_scale = { start = 0.5, stop = 2, step = 0.5 }\n[buildings.other]\n"
    )  # fmt: skip
    with pytest.raises(StudyError, match="is not TOML"):
        read_study(folder / "s.toml")
    (folder / "s.toml").write_text(
        records("a")
        + "slip_scale = { start = 0.5, stop = 2, step = 0.5 }\n[buildings]\noffice = 'two.toml'\n"
        + "[buildings.other]\n" + TWO.replace("60e3, 30e3", "inf, 0")
    )  # fmt: skip
    study = read_study(folder / "s.toml")
    assert isinstance(study, BuildingStudy)
    assert study.grid.names == ("office", "other")
    assert study.grid.slip_scale.tolist() == [0.5, 1.0, 1.5, 2.0]
    assert study.grid.buildings[1].slip_force.tolist() == [np.inf, 0.0]
    alone = read_study(folder / "two.toml")
    assert isinstance(alone, BuildingStudy)
    assert alone.grid.names == ("two",)
    (folder / "frames.toml").write_text("period = [0.5]\n")
    assert isinstance(read_study(folder / "frames.toml"), Study)


def test_a_study_reads_back_from_its_own_text(folder: Path) -> None:
    (folder / "s.toml").write_text(
        'buildings = ["two.toml"]\n' + records("a", "b") + "slip_scale = [0.5, inf]\n"
    )
    study = BuildingStudy.read(folder / "s.toml")
    again = BuildingStudy.parse(study.to_toml(), folder=folder)
    assert again.grid.buildings == study.grid.buildings
    assert again.records == study.records
    assert again.grid.slip_scale.tolist() == [0.5, np.inf]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("buildings = []\n", "line 1: buildings: must be building files"),
        ("buildings = 3\n", "line 1: buildings: must be building files"),
        ('buildings = ["no.toml"]\n', "line 1: buildings: no.toml: cannot be read"),
        ('buildings = ["two.toml", "two.toml"]\n', "line 1: buildings: two are called 'two'"),
        ("buildings = [3]\n", "line 1: buildings: 0 must be a file"),
        ('buildings = ["two.toml"]\nslip_scale = [2, 1]\n', "line 2: slip_scale: "),
        ('buildings = ["two.toml"]\nslip_scale = "x"\n', "line 2: slip_scale: must be numbers"),
        ('buildings = ["two.toml"]\nstiffness_scale = [0]\n', "line 2: stiffness_scale: "),
        ('buildings = ["two.toml"]\nrecords = ["no.txt"]\n', "no.txt: there is no such file"),
        ('buildings = ["two.toml"]\noutputs = ["peak_drif"]\n', "did you mean 'peak_drift'?"),
        ('buildings = ["two.toml"]\nperiod = [1]\n', "line 2: period: is not a field of a study"),
        ("[buildings.a]\nfloor_mass = [1]\n", "buildings: a: give either storey_stiffness"),
        ("[buildings.a]\n" + TWO.replace("60e3", "-1"), "line 5: buildings: a: slip_force: should be"),
    ],
)
def test_a_mistake_in_a_study_is_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], text: str, said: str
) -> None:
    (folder / "s.toml").write_text(text)
    assert main(["sweep", "s.toml"]) == 2
    errors = capsys.readouterr().err
    assert said in errors
    assert len(errors.splitlines()) == 1


def test_buildings_of_other_heights_are_refused(folder: Path) -> None:
    (folder / "one.toml").write_text(
        "floor_mass = [3e4]\nstorey_stiffness = 4e7\nbrace_stiffness = 8e7\nslip_force = 5e4\n"
    )
    (folder / "s.toml").write_text('buildings = ["two.toml", "one.toml"]\n')
    with pytest.raises(StudyError, match="line 1: buildings must all have the same number of storeys"):
        read_study(folder / "s.toml")


def test_a_design_is_swept_and_simulated_from_files(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    (folder / "s.toml").write_text(
        'buildings = ["two.toml"]\n' + records("a", "b") + "slip_scale = [0.5, 1]\n"
    )
    assert main(["sweep", "s.toml", "--dry-run", "--json"]) == 0
    plan = json.loads(capsys.readouterr().out)
    assert (plan["buildings"], plan["storeys"], plan["histories"]) == (1, 2, 4)
    assert main(["sweep", "s.toml", "-o", "plain.nc", "--not-resumable"]) == 0
    table = capsys.readouterr().out
    assert "2 records x 1 building x 1 stiffness scale x 2 slip scales = 4 histories of 2 storeys" in table
    assert main(["sweep", "s.toml", "-o", "plain.nc"]) == 0
    assert "holds this study already" in capsys.readouterr().out
    assert main(["sweep", "s.toml", "-o", "other.nc", "--resumable", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["statuses"] == {"ok": 4}
    assert not list(folder.glob("*.zarr"))
    plain = fdspec.open("plain.nc")
    assert fdspec.open("other.nc").identical(plain)
    about = ["--record", "a.txt", "--units", "g", "--dt", "0.02"]
    assert main(["simulate", "--building", "two.toml", *about, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["variables"]
    wanted = plain["peak_drift"].sel(record="a", slip_scale=1.0).squeeze().values
    np.testing.assert_allclose(told["peak_drift"]["values"], wanted, rtol=1e-12)
    assert main(["simulate", "--building", "two.toml", *about, "--force"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[0].split()[:4] == ["storey", "slips", "at", "kN"]
    assert [row.split()[0] for row in rows[1:3]] == ["2", "1"]
    for options, said in (
        (
            ["--building", "two.toml", "--period", "1"],
            "--period is of the single-storey frame; two.toml tells",
        ),
        ([], "Give --period and --stiffness-ratio of a frame, or --building B.toml"),
        (["--building", "no.toml"], "no.toml: cannot be read"),
    ):
        assert main(["simulate", *about, *options, "-o", "h.nc"]) == 2
        assert said in capsys.readouterr().err
