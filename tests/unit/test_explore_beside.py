"""Cubes beside each other on one page: whose record is whose, and which cubes do not go together."""

from pathlib import Path

import numpy as np
import pytest

from fdspec import store
from fdspec.cli import main
from fdspec.errors import InvalidInput
from fdspec.explore.beside import Beside, Reruns, files_of, located
from fdspec.explore.content import Content
from fdspec.explore.rerun import Rerun
from tests.cubes import synthetic_cube
from tests.explored import own_motion, record_numbers, small_cube


def test_records_are_counted_on_from_cube_to_cube() -> None:
    assert [located(k, [2, 3]) for k in range(5)] == [(0, 0), (0, 1), (1, 0), (1, 1), (1, 2)]
    for k in (-1, 5):
        with pytest.raises(InvalidInput, match=f"record must be a position from 0 to 4, got {k}"):
            located(k, [2, 3])


def test_the_page_gets_each_cubes_own_numbers() -> None:
    a, b = synthetic_cube(["x", "y"], seed=1), synthetic_cube(["y"], seed=2)
    both = Beside([Content(a, "a.nc"), Content(b, "b.nc")])
    assert both.records == ("x (a.nc)", "y (a.nc)", "y (b.nc)")
    told = both.about
    assert [(one["record"], one["cube"]) for one in told["records"]] == [("x", 0), ("y", 0), ("y", 1)]
    assert [one["name"] for one in told["cubes"]] == ["a.nc", "b.nc"]
    for k, (content, place) in enumerate([(a, 0), (a, 1), (b, 0)]):
        alone = record_numbers(Content(content, "c").record(place))
        for name, values in record_numbers(both.record(k)).items():
            np.testing.assert_array_equal(values, alone[name])


def test_only_what_both_hold_is_offered() -> None:
    few = synthetic_cube(["x"])[["peak_displacement", "status"]]
    both = Beside([Content(synthetic_cube(["x"]), "a.nc"), Content(few, "b.nc")])
    assert [index["name"] for index in both.about["indices"]] == ["displacement"]
    other = synthetic_cube(["x"])[["peak_velocity", "status"]]
    with pytest.raises(InvalidInput, match=r"b\.nc and v\.nc have no result in common"):
        Beside([Content(few, "b.nc"), Content(other, "v.nc")])


def test_each_cube_runs_its_own_histories() -> None:
    light, heavy = small_cube(own_motion("FSR1")), small_cube(own_motion("FSR1"), brace_mass=500.0)
    reruns = Reruns([Rerun(light), Rerun(heavy)])
    assert reruns.of(0) == (reruns.reruns[0], 0)
    rerun, place = reruns.of(1)
    assert place == 0
    assert rerun.frame["brace_mass"] == 500.0


def test_files_go_to_the_cubes_that_have_the_record() -> None:
    file = Path("q.txt")
    assert files_of({"q": file}, [["q", "r"], ["r"]]) == [{"q": file}, {}]
    with pytest.raises(InvalidInput, match="no cube has a record 's'; they have q, r"):
        files_of({"s": file}, [["q", "r"], ["r"]])


def test_cubes_that_do_not_go_together_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    store.save(synthetic_cube(["x"]), "a.nc")
    store.save(synthetic_cube(["x"], (2, 3, 5)), "b.nc")
    for arguments, said in (
        (["a.nc", "b.nc"], "a.nc and b.nc differ in period; cubes beside each other need the same"),
        (["a.nc", "a.nc"], "a.nc is given twice"),
    ):
        assert main(["explore", *arguments, "--no-browser"]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert said in err
        assert err.count("\n") == 1
