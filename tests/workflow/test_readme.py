"""README keeps its word: the lines of Python in it run, and say what it says they do."""

import re
from pathlib import Path

import pytest

import fdspec
from fdspec.measures import study_claims
from fdspec.measures.claims import verdict_of_claim
from fdspec.model.grid import Grid
from fdspec.runs.study import STUDY_RECORDS

README = Path(__file__).parents[2] / "README.md"


def test_lines_of_python_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(compile(code, str(README), "exec"), names)
    assert "m/s2 after" in capsys.readouterr().out
    assert fdspec.open("cube.nc").identical(names["cube"])


@pytest.mark.parametrize("name", ["make", "test", "docs"])
def test_commands_that_ci_runs_are_marked(name: str) -> None:
    assert f"<!-- command: {name} -->\n```bash\n" in README.read_text(encoding="utf-8")


def test_links_lead_somewhere() -> None:
    for target in re.findall(r"\]\(([^)#:]+)\)", README.read_text(encoding="utf-8")):
        assert (README.parent / target).exists(), target


def test_what_it_says_of_the_study_is_what_the_claims_give() -> None:
    rows = re.findall(
        r"^\| (?:the|at|beyond) .* \| (.*) \|$", README.read_text(encoding="utf-8"), re.MULTILINE
    )
    said = [row for row in rows if row != "what comes out"]
    grid = Grid.study()
    cube = fdspec.sweep(
        [fdspec.load_record(name) for name in STUDY_RECORDS],
        period=grid.period,
        pretension=grid.pretension,
        stiffness_ratio=grid.stiffness_ratio,
        outputs=["peak_acceleration", "elastic_acceleration", "braced_acceleration"],
        certify=False,
    )
    claims = study_claims(cube)
    assert len(said) == 6
    for letter, row in zip("abcdef", said, strict=True):
        assert (
            verdict_of_claim(claims, letter).removeprefix("holds ") == row.partition(":")[0].partition(",")[0]
        )
    assert int((claims.share.sel(part="a") == 1.0).sum()) == 6
    assert "for six records" in said[0]
