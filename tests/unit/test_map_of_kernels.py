"""The developers' page names every kernel module, and none that is not there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
KERNELS = ROOT / "fdspec" / "kernels"
PAGE = (ROOT / "docs" / "developers.md").read_text(encoding="utf-8")
MODULES = {
    path.relative_to(KERNELS).with_suffix("").as_posix()
    for path in KERNELS.rglob("*.py")
    if path.name != "__init__.py"
}
ENGINES = {path.name for path in KERNELS.iterdir() if path.is_dir() and path.name != "__pycache__"}


def mapped(page: str) -> set[str]:
    """Return the modules that the map names: `folder/module`, and those that stand beside the folders."""
    text = page.partition("## Map of the kernels")[2]
    names = set(re.findall(r"`([a-z_]+(?:/[a-z_]+)?)`", text))
    return {name for name in names if "/" in name or name in MODULES}


def test_the_map_names_every_module_and_no_other() -> None:
    named = {name for name in mapped(PAGE) if not name.startswith("fdspec/")}
    assert named == MODULES


def test_every_engine_has_its_table() -> None:
    assert set(re.findall(r"^### ([a-z_]+):", PAGE, re.MULTILINE)) == ENGINES


@pytest.mark.parametrize("engine", sorted(ENGINES - {"mathematics"}))
def test_each_table_has_the_parts(engine: str) -> None:
    table = PAGE.partition(f"### {engine}:")[2].partition("\n### ")[0]
    parts = re.findall(r"^\| ([a-z ]+) \|", table, re.MULTILINE)
    assert [part for part in parts if part in {"data in", "loop", "guards", "resets", "data out"}] == [
        "data in",
        "loop",
        "guards",
        "resets",
        "data out",
    ]


def test_a_missing_module_is_found() -> None:
    assert mapped("## Map of the kernels\n`friction`, `storey/nothing`") == {"friction", "storey/nothing"}


def test_each_word_is_defined_once() -> None:
    words = PAGE.partition("| word | meaning |\n|---|---|\n")[2].partition("\n## ")[0]
    terms = re.findall(r"^\| ([a-z ]+) \|", words, re.MULTILINE)
    assert terms == sorted(terms)
    assert len(terms) == len(set(terms)) > 30
