"""Patterns for records in study files of both kinds."""

from pathlib import Path

import numpy as np
import pytest

from fdspec.cli.main import main
from fdspec.errors import StudyError
from fdspec.runs.building_study import read_study
from fdspec.runs.study_records import RecordFile
from fdspec.store import open as open_cube
from tests.unit.test_after_records import TWO

FRAMES = "stiffness_ratio = [4]\npretension = [50e3]\nperiod = [0.5]\n"
BUILDINGS = 'buildings = ["two.toml"]\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "two.toml").write_text(TWO)
    records = tmp_path / "records"
    records.mkdir()
    rng = np.random.default_rng(4)
    for name in ("b.txt", "a.txt", "c[1].txt"):
        rows = "".join(f"{value:.6f}\n" for value in rng.uniform(-0.3, 0.3, 200))
        (records / name).write_text(rows)
    (records / "folder.txt").mkdir()
    return tmp_path


@pytest.mark.parametrize("rest", [FRAMES, BUILDINGS], ids=["frames", "buildings"])
def test_a_pattern_stands_for_its_files_in_order(folder: Path, rest: str) -> None:
    path = folder / "study.toml"
    path.write_text('records = ["FSR1", { path = "records/[ab].txt", units = "g", dt = 0.01 }]\n' + rest)
    study = read_study(path)
    about = {"units": "g", "dt": 0.01}
    files = [RecordFile(f"records/{name}.txt", **about) for name in "ab"]
    assert study.records == ("FSR1", *files)
    assert main(["sweep", str(path), "-o", str(folder / "cube.nc")]) == 0
    assert open_cube(folder / "cube.nc")["record"].values.tolist() == ["FSR1", "a", "b"]
    assert [motion.name for motion in study.motions()] == ["FSR1", "a", "b"]


@pytest.mark.parametrize("rest", [FRAMES, BUILDINGS], ids=["frames", "buildings"])
@pytest.mark.parametrize(
    ("records", "said"),
    [
        ('["FSR1", "none/*.AT2"]', "line 1: records: no file matches 'none/*.AT2' in "),
        (
            '[{ path = "records/*.txt", name = "x", units = "g", dt = 0.01 }]',
            "line 1: records: 'records/*.txt' matches 3 files, which cannot all be named 'x'",
        ),
        ('["records/a.txt", "records/a*"]', "line 1: records: names 'records/a.txt' twice"),
    ],
)
def test_mistakes_are_told_with_their_line(folder: Path, rest: str, records: str, said: str) -> None:
    path = folder / "study.toml"
    path.write_text(f"records = {records}\n{rest}")
    with pytest.raises(StudyError) as caught:
        read_study(path)
    assert said in str(caught.value)


def test_a_pattern_is_looked_at_beside_other_mistakes(folder: Path) -> None:
    path = folder / "study.toml"
    path.write_text(f'records = ["records/*.txt", "none*.AT2"]\n{FRAMES}speed = 3\n')
    with pytest.raises(StudyError) as caught:
        read_study(path)
    lines = str(caught.value).splitlines()
    assert len(lines) == 2
    assert "no file matches 'none*.AT2'" in lines[0]
    assert "speed" in lines[1]
