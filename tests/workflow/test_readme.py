"""README keeps its word: the lines of Python in it run, and say what it says they do."""

import re
from pathlib import Path

import pytest

import fdspec
from fdspec.measures import study_claims
from fdspec.measures.claims import CLAIMS, verdict_of_claim
from fdspec.model.grid import Grid
from fdspec.runs.study_records import STUDY_RECORDS

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
    rows = re.findall(r"^\| ([a-h]) \| .* \| (.*) \|$", README.read_text(encoding="utf-8"), re.MULTILINE)
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
    assert [letter for letter, _ in rows] == list(CLAIMS)
    said = dict(rows)
    for letter, row in rows:
        verdict = row.partition(":")[0].partition(",")[0]
        assert verdict_of_claim(claims, letter).removeprefix("holds ") == verdict, letter
    assert int((claims.share.sel(part="a") == 1.0).sum()) == 6
    assert "for six records" in said["a"]
    for part, letter in (("d3", "d"), ("d2", "d"), ("g1", "g"), ("g2", "g")):
        share = 100.0 * claims.share.sel(part=part)
        assert f"{int(share.min())} to {int(share.max())} %" in said[letter], part
    verdicts = {part: str(claims.verdict_of_part.sel(part=part).item()) for part in ("h1", "h4")}
    assert verdicts == {"h1": "holds", "h4": "does not hold"}


def test_it_opens_with_what_it_answers_and_a_picture() -> None:
    """A structural engineer gives it thirty seconds: a question, what it is, two pictures, two commands."""
    text = README.read_text(encoding="utf-8")
    opening = text[: text.index("## Two commands")]
    assert "?" in opening.splitlines()[2]
    assert len(opening.split()) < 190
    assert len(re.findall(r"!\[[^\]]{40,}\]\(docs/images/\w+\.png\)", opening)) == 2
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
