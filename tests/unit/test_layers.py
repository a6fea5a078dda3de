"""The layer diagram that newcomers read is the import contract."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ("README.md", "CONTRIBUTING.md")


def _contract():
    with (ROOT / "pyproject.toml").open("rb") as file:
        contracts = tomllib.load(file)["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    return [layer for layer in layers if layer != "__main__"]


def _diagram():
    for page in PAGES:
        block = re.search(r"```text\ncli .*?```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)
        if block:
            lines = block.group(0).splitlines()[1:-1]
            return [re.split(r"\s{2,}", line)[0] for line in lines]
    return pytest.fail(f"none of {', '.join(PAGES)} has the layer diagram")


def test_the_diagram_is_the_contract():
    assert _diagram() == _contract()


def test_every_room_stands_in_the_diagram():
    rooms = {path.stem for path in (ROOT / "fdspec").iterdir() if path.suffix == ".py" or path.is_dir()}
    rooms -= {"__init__", "__main__", "__pycache__"}
    assert rooms == {name for layer in _diagram() for name in layer.split(" | ")}
