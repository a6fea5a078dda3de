"""The page as text, the command that writes it, and what stands in its way."""

import base64
import re
import sys
from pathlib import Path

import pytest

from fdspec import store
from fdspec.cli import main
from fdspec.explore.content import Content
from fdspec.explore.page import BUILDINGS, FRAMES, NO_NETWORK, SHARED, served_page, written_page
from tests.cubes import synthetic_building_cube, synthetic_cube
from tests.explored import record_numbers

EVIL = "</script><img src=x onerror=alert(1)>"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the working folder, with a cube of two records in it."""
    monkeypatch.chdir(tmp_path)
    store.save(synthetic_cube(["FSR1", EVIL]), "cube.nc")
    store.save(synthetic_building_cube(), "buildings.nc")
    return tmp_path


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    return err


def sources(page: str) -> list[str]:
    """Return what the page's elements would load."""
    tags = re.findall(r"<(?:script|link|img|iframe|source|video|audio|object|embed)\b[^>]*>", page)
    return [
        found for tag in tags for found in re.findall(r"\b(?:src|href|data)\s*=\s*[\"']?([^\"'\s>]+)", tag)
    ]


def own_text(page: str) -> str:
    """Return the page without the drawing library, which is one long script."""
    return re.sub(r"<script>/\*\*.*?</script>", "", page, flags=re.DOTALL)


def test_the_written_page_holds_all_it_needs() -> None:
    content = Content(synthetic_cube(["a", "b"]), "cube.nc")
    page = written_page(content)
    assert NO_NETWORK in page
    assert "plotly.js v" in page
    for k in range(2):
        (numbers,) = re.findall(f'<script type="text/plain" id="record-{k}">([^<]*)</script>', page)
        found = record_numbers(base64.b64decode(numbers))
        assert found["acceleration"].size == 2 * 3 * 4
    assert {source.split(";")[0] for source in sources(own_text(page))} == {"data:,", "data:image/svg+xml"}
    assert not re.search(r"<!-- \w+ -->", own_text(page))


def test_the_served_page_asks_its_own_server_alone() -> None:
    page = served_page(Content(synthetic_cube(["a", "b"]), "cube.nc"))
    loaded = [source.split(";")[0] for source in sources(page)]
    assert loaded == ["data:,", "data:image/svg+xml", "plotly.js"]
    assert 'id="record-0"' in page
    assert 'id="record-1"' not in page
    assert not re.search(r"https?://", page)


def test_every_script_is_part_of_the_page() -> None:
    assets = Path(sys.modules["fdspec.explore.page"].__file__ or "").parent / "assets"
    assert {path.name for path in assets.glob("*.js")} == {*SHARED, *FRAMES, *BUILDINGS}


def test_export_writes_a_page_of_all_records_or_one(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "cube.nc", "--html"]) == 0
    assert capsys.readouterr().out == "cube.html\n"
    assert main(["export", "cube.nc", "-o", "one.html", "--record", "FSR1"]) == 0
    both, one = (folder / name for name in ("cube.html", "one.html"))
    assert 'id="record-1"' in both.read_text(encoding="utf-8")
    assert 'id="record-1"' not in one.read_text(encoding="utf-8")
    assert EVIL not in both.read_text(encoding="utf-8")
    assert capsys.readouterr().out == "one.html\n"
    assert "exists already" in refused(capsys, "export", "cube.nc", "--html")
    assert {path.name for path in folder.iterdir()} == {"cube.nc", "buildings.nc", "cube.html", "one.html"}


def test_what_cannot_be_shown_leaves_no_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "has no record 'FSR9'; it has FSR1" in refused(
        capsys, "export", "cube.nc", "--html", "--record", "FSR9"
    )
    assert "Give -o FILE.nc, .csv, .xlsx or .mat, or --format, or --html" in refused(
        capsys, "export", "cube.nc"
    )
    assert {path.name for path in folder.iterdir()} == {"cube.nc", "buildings.nc"}


def test_explore_refuses_before_it_listens(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    several = refused(capsys, "explore", "cube.nc", "buildings.nc")
    assert "a cube of buildings has a page of its own; name one cube" in several
    (folder / "a.txt").write_text("0.0\n")
    with_record = refused(capsys, "explore", "buildings.nc", "--record", "FSR1=a.txt")
    assert "--record is for histories, which the page of buildings has none of" in with_record
    assert "there is no such file" in refused(capsys, "explore", "none.nc")
    assert "takes NAME=FILE" in refused(capsys, "explore", "cube.nc", "--record", "FSR1")
    assert "does not tell" in refused(capsys, "explore", "cube.nc", "--no-browser")


@pytest.mark.parametrize("command", [["explore", "cube.nc"], ["export", "cube.nc", "--html"]])
def test_without_the_extra_it_is_named(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, command: list[str]
) -> None:
    for name in [name for name in sys.modules if name.startswith("fdspec.explore")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "tornado", None)
    monkeypatch.setitem(sys.modules, "tornado.httpserver", None)
    assert "pip install 'fdspec[explore]'" in refused(capsys, *command)
