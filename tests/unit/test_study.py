"""Study files: what they may say, how they say it, and the line of every mistake."""

import time
from pathlib import Path

import numpy as np
import pytest

from fdspec.errors import RecordError, StudyError
from fdspec.model.grid import GRID_FIELDS, Grid
from fdspec.records import catalogue
from fdspec.runs.study import Study
from fdspec.runs.study_outputs import OUTPUTS
from fdspec.runs.study_records import STUDY_RECORDS, RecordFile, find_record
from fdspec.runs.study_text import even_axis


def same(one: Study, other: Study) -> bool:
    grids = all(np.array_equal(getattr(one.grid, name), getattr(other.grid, name)) for name in GRID_FIELDS)
    rest = ("records", "scaled", "outputs", "certify")
    return grids and all(getattr(one, name) == getattr(other, name) for name in rest)


def refused(text: str) -> list[str]:
    with pytest.raises(StudyError) as caught:
        Study.parse(text)
    return str(caught.value).splitlines()


def test_an_empty_file_is_the_study_on_the_nine() -> None:
    study = Study.parse("")
    assert study.grid.shape == (7, 11, 60)
    assert study.records == STUDY_RECORDS
    assert study.outputs is None
    assert study.scaled
    assert study.certify


def test_the_nine_are_the_catalogue() -> None:
    assert tuple(entry.name for entry in catalogue()) == STUDY_RECORDS


def test_every_field_of_the_grid_can_be_written() -> None:
    values = {
        "stiffness_ratio": [3.0],
        "pretension": [0.0, 5e3, np.inf],
        "period": [0.2, 0.9],
        "floor_mass": 1000.0,
        "brace_mass": 0.0,
        "damping_ratio": 0.02,
        "friction_coefficient": 0.4,
        "kinetic_friction_coefficient": 0.3,
        "normal_force_factor": 4.0,
        "brace_damping_ratio": 0.01,
        "storey_height": 3.0,
        "yield_shear": 5e3,
        "hardening_ratio": -0.02,
        "gravity_load": 1e3,
        "slot_length": 0.01,
        "slot_stiffness": 1e6,
        "recentring_stiffness": 1e5,
        "collapse_drift": 0.2,
        "intensity": [0.5, 2.0],
    }
    assert {*values, "links"} == set(GRID_FIELDS)  # links are tables, and tried with the devices
    study = Study.parse("\n".join(f"{name} = {value}" for name, value in values.items()))
    for name, value in values.items():
        assert np.array_equal(getattr(study.grid, name), value), name


def test_the_default_study_survives_being_written_and_read() -> None:
    text = Study().to_toml()
    assert same(Study.parse(text), Study())
    assert "period = { start = 0.05, stop = 3.0, step = 0.05 }" in text
    assert Study.parse(text).to_toml() == text


def test_any_study_survives_being_written_and_read() -> None:
    study = Study(
        grid=Grid(
            stiffness_ratio=[1 / 3, 2.0],
            pretension=[0.0, 1e3, np.inf],
            period=np.geomspace(0.02, 10, 7),
            brace_mass=0,
            kinetic_friction_coefficient=0.1,
        ),
        records=("FSR1", 'odd "name".AT2', RecordFile("ordner/größe.AT2", units="g", dt=0.01)),
        scaled=False,
        outputs=("peak_acceleration",),
        certify=False,
    )
    assert same(Study.parse(study.to_toml()), study)


def test_what_the_written_study_leaves_commented_is_right_when_uncommented() -> None:
    text = Study().to_toml().replace("# kinetic", "kinetic").replace("# outputs", "outputs")
    study = Study.parse(text)
    assert study.outputs == OUTPUTS
    assert study.grid.kinetic_friction_coefficient == 0.4


@pytest.mark.parametrize(
    ("spec", "points"),
    [
        ({"start": 0.05, "stop": 0.2, "step": 0.05}, [0.05, 0.1, 0.15, 0.2]),
        ({"start": 10e3, "stop": 210e3, "step": 100e3}, [10e3, 110e3, 210e3]),
        ({"start": 1, "stop": 1, "step": 0.5}, [1.0]),
        ({"start": 0.0, "stop": 1.0, "num": 3}, [0.0, 0.5, 1.0]),
    ],
)
def test_even_axes_include_both_ends(spec: dict[str, float], points: list[float]) -> None:
    assert even_axis(spec).tolist() == points


def test_steps_are_counted_in_decimals() -> None:
    assert even_axis({"start": 0.05, "stop": 3.0, "step": 0.05}).tolist() == [
        k * 5 / 100 for k in range(1, 61)
    ]


def test_an_axis_may_be_a_table() -> None:
    study = Study.parse("[period]\nstart = 0.1\nstop = 0.3\nstep = 0.1\n")
    assert study.grid.period.tolist() == [0.1, 0.2, 0.3]


UNKNOWN_KEY = (
    "records: unknown key 'unit' of a record; "
    "known are path, units, dt, channel, name, skip, layout, resample_to, factor, pga, sa, target, "
    "target_units, period, damping_ratio, pair, pair_channel, combination"
)


@pytest.mark.parametrize(
    ("line", "mistake"),
    [
        ("perod = [1]", "perod: is not a field of a study; did you mean period?"),
        ("period = []", "period: must hold at least one value, is empty"),
        ("period = [0.2, 0.1]", "period: values must increase, got 0.1 at index 1 after 0.2"),
        ("period = [0.1, nan]", "period: values must be numbers, got nan at index 1"),
        (
            "period = { start = 1, stop = 2, step = 0.3 }",
            "period: steps of 0.3 from 1 do not end on 2",
        ),
        (
            "period = { start = 1, stop = 2, stp = 0.5 }",
            "period: unknown key 'stp'; { start, stop, step } or { start, stop, num } is known",
        ),
        (
            "period = { start = 1, stop = 2 }",
            "period: needs start, stop and one of step and num, got start, stop",
        ),
        (
            "period = { start = 1, stop = 2, step = -1 }",
            "period: step must be positive and stop not before start, got 1 to 2 by -1",
        ),
        (
            "period = { start = 1, stop = 2, num = 1 }",
            "period: num must be an integer from 2 to 1000000, got 1",
        ),
        (
            "period = { start = 1, stop = 2, step = 1e-9 }",
            "period: has more than 1000000 points: 1 to 2 by 1E-9",
        ),
        ("period = { start = 'a', stop = 2, num = 3 }", "period: start must be a finite number, got 'a'"),
        ("floor_mass = -1", "floor_mass: must be positive, got -1"),
        ("floor_mass = true", "floor_mass: must be a number, got True"),
        (
            "kinetic_friction_coefficient = 0.6",
            "kinetic_friction_coefficient: must be at most friction_coefficient, 0.5, got 0.6",
        ),
        ("certify = 1", "certify: must be true or false"),
        ("records = 'FSR1'", "records: must be a list"),
        ("records = ['FSR1', 2]", "records: must be a name, a path or a table, got 2"),
        (
            "records = [{ path = 'a.txt', unit = 'g' }]",
            UNKNOWN_KEY,
        ),
        ("records = [{ units = 'g' }]", "records: a record given as a table needs path, its file"),
        (
            "records = [{ path = 'a', dt = -1 }]",
            "records: dt of a record must be positive seconds, got -1",
        ),
        ("records = [{ path = 1 }]", "records: path of a record must be a string, got 1"),
        ("outputs = [3]", "outputs: must be a string at index 0"),
        ("records = []", "records: must name at least one, is empty"),
        ("records = ['a', 'b', 'a']", "records: names 'a' twice"),
        (
            "outputs = ['peak_aceleration']",
            "outputs: does not know 'peak_aceleration'; did you mean 'peak_acceleration'?",
        ),
    ],
)
def test_a_mistake_names_its_field_and_its_line(line: str, mistake: str) -> None:
    assert refused(f"# a comment\n\n{line}\n") == [f"study, line 3: {mistake}"]


def test_all_mistakes_come_at_once_in_the_order_of_the_file() -> None:
    text = "scaled = 'yes'\nfloor_mass = 0\n[period]\nstart = 1\nstop = 2\nstepp = 1\n"
    assert [mistake.split(":")[0] for mistake in refused(text)] == [
        "study, line 1",
        "study, line 2",
        "study, line 3",
    ]


def test_a_far_off_field_is_answered_with_the_known_ones() -> None:
    (mistake,) = refused("colour = 'red'")
    assert mistake.startswith("study, line 1: colour: is not a field of a study; known are records, ")


def test_what_is_not_toml_says_where() -> None:
    (mistake,) = refused("period = [0.1\nfloor_mass = 2")
    assert mistake.startswith("study: is not TOML: ")
    assert "line 2" in mistake


def test_a_file_is_read_and_named(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("period = 0.5\n", encoding="utf-8")
    study = Study.read(path)
    assert study.grid.period.tolist() == [0.5]
    assert study.folder == tmp_path
    path.write_text("\nperiod = -1\n", encoding="utf-8")
    with pytest.raises(StudyError, match=r"mine\.toml, line 2: period: values must be positive"):
        Study.read(path)


def test_a_missing_file_and_one_that_is_no_text(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"none\.toml: cannot be read \(No such file or directory\)"):
        Study.read(tmp_path / "none.toml")
    (tmp_path / "latin.toml").write_bytes(b"# gr\xf6\xdfe\n")
    with pytest.raises(StudyError, match="is not a text file in UTF-8"):
        Study.read(tmp_path / "latin.toml")


def two_columns(path: Path, n: int = 200, dt: float = 0.01) -> Path:
    time = np.arange(n) * dt
    np.savetxt(path, np.column_stack([time, 0.2 * np.sin(9 * time)]), fmt="%.4f %.10g")
    return path


def test_records_are_names_or_files_beside_the_study(tmp_path: Path) -> None:
    two_columns(tmp_path / "mine.txt")
    text = "records = ['fsr1', { path = 'mine.txt', units = 'cm/s2', name = 'mine 1' }]"
    named, read = Study.parse(text, folder=tmp_path).motions()
    assert named.name == "FSR1"
    assert (read.name, read.n) == ("mine 1", 200)
    assert read.pga == pytest.approx(0.2 / 100, rel=1e-3)
    with pytest.raises(RecordError, match="does not say the unit"):
        Study.parse("records = ['mine.txt']", folder=tmp_path).motions()


def test_scaled_is_handed_to_the_catalogue() -> None:
    raw, scaled = find_record("FSR1", scaled=False), find_record("FSR1")
    assert raw.scale_factor == 1.0
    assert scaled.pga == pytest.approx(0.345 * 9.80665)


def test_every_record_that_cannot_be_used_is_told(tmp_path: Path) -> None:
    study = Study.parse("records = ['FSR11', 'none.AT2', 'FSR2']", folder=tmp_path)
    with pytest.raises(RecordError) as caught:
        study.motions()
    wrong_name, no_file = str(caught.value).splitlines()
    assert "FSR1" in wrong_name
    assert "none.AT2" in no_file


MANY = "9" * 400


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("period = " + "[" * 3000 + "1" + "]" * 3000, "lists or tables stand in one another too deeply"),
        ("period = " + "[" * 90 + "1" + "]" * 90, "line 1: period: must be a list of numbers"),
        (
            "records = [" + "{path=" * 99 + '"a"' + "}" * 99 + "]",
            "line 1: records: path of a record must be a s",
        ),
        (f"floor_mass = {MANY}", "line 1: floor_mass: must be a number, got 999"),
        (f"floor_mass = {MANY * 20}", "has a number of too many digits"),
        (f"period = [{MANY}]", "line 1: period: must be a list of numbers, got [999"),
        (
            f"period = {{ start = {MANY}, stop = 1, num = 3 }}",
            "period: start must be a finite number, got 999",
        ),
        (f"period = {{ start = 1, stop = 2, num = {MANY} }}", "period: num must be a finite number, got 999"),
        (
            f'records = [{{ path = "a", dt = {MANY} }}]',
            "records: dt of a record must be positive seconds, got 999",
        ),
    ],
)
def test_odd_depths_and_numbers_are_a_short_line(text: str, sentence: str) -> None:
    with pytest.raises(StudyError) as caught:
        Study.parse(text)
    assert sentence in str(caught.value)
    assert len(str(caught.value)) < 300


def test_unknown_records_are_told_with_the_other_mistakes(tmp_path: Path) -> None:
    (tmp_path / "there.at2").touch()
    (tmp_path / "s.toml").write_text(
        'records = ["FSR1", "FSR99",\n  "there.at2", { path = "gone.at2" }]\nperiods = [1.0]\n',
        encoding="utf-8",
    )
    with pytest.raises(StudyError) as caught:
        Study.read(tmp_path / "s.toml")
    first, second, third = str(caught.value).splitlines()
    assert "FSR99" in first
    assert f"there is no file {tmp_path / 'gone.at2'}" in second
    assert "periods: is not a field of a study; did you mean period?" in third


def test_a_hundred_thousand_records_are_read_in_seconds() -> None:
    names = ", ".join(f'"r{k}.at2"' for k in range(100_000))
    began = time.process_time()
    assert len(Study.parse(f"records = [{names}]").records) == 100_000
    assert time.process_time() - began < 5.0
