"""README keeps its word: the lines of Python in it run, and say what it says they do."""

import re
from pathlib import Path

import pytest

import fdspec

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
