"""Kernels fill their results and their trajectory by name, never by number."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import fdspec.kernels
from fdspec.compiler.positions import positions

KERNELS = Path(fdspec.kernels.__file__).parent
FILES = sorted(KERNELS.rglob("*.py"))
TRACES = {"traces", "energies", "floor_traces", "link_traces"}
"""What the arrays over time are called; the first index of one counts instants."""

ROWS = {"result", "results", "totals", "by_storey", "row", *TRACES}
"""What the arrays that kernels hand back are called."""


def numbered(source: str) -> list[str]:
    """Return the subscripts of these arrays that hold a number."""
    return [
        f"line {node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id in ROWS
        for index in (node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice])[
            node.value.id in TRACES :
        ]
        if isinstance(index, ast.Constant) and isinstance(index.value, int)
    ]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(KERNELS).as_posix())
def test_no_kernel_counts(path: Path) -> None:
    assert numbered(path.read_text(encoding="utf-8")) == []


def test_the_search_finds_one() -> None:
    assert len(numbered("totals[4] = error")) == len(numbered("traces[row, 3, i] += 1.0")) == 1


def test_names_stand_for_their_positions() -> None:
    place = positions(("peak", "status"))
    assert (place.peak, place.status) == (0, 1)
