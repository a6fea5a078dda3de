"""The force and the work of friction in motion are written in `fdspec.kernels.friction` and nowhere else."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import fdspec.kernels
from fdspec.kernels.friction import friction_work, sliding_force

KERNELS = Path(fdspec.kernels.__file__).parent
ELSEWHERE = sorted(path for path in KERNELS.rglob("*.py") if path.name != "friction.py")
LEVELS = {"kinetic_slip_force", "KINETIC_SLIP_FORCE", "kinetic", "KINETIC", "PUSH_FLOOR", "PUSH_BRACE"}
"""Names of the kinetic slip force, and of what it is over a mass."""

RULES = {"sliding_force", "friction_work"}


def is_level(node: ast.expr) -> bool:
    """Whether an operand is a level: by its name, as a column of an array, or handed to an accessor."""
    if isinstance(node, ast.Subscript):
        inside = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return any(map(is_level, [node.value, *inside]))
    if isinstance(node, ast.Call):
        named = isinstance(node.func, ast.Name) and node.func.id in RULES
        return not named and any(map(is_level, node.args))
    if isinstance(node, ast.Attribute):
        return node.attr in LEVELS
    return isinstance(node, ast.Name) and node.id in LEVELS


def products(source: str) -> list[str]:
    """Return what multiplies a level in a kernel, save an index into packed rows."""
    tree = ast.parse(source)
    indices = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript)
        for part in ast.walk(node.slice)
    }
    return [
        f"line {node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(tree)
        if isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Mult)
        and id(node) not in indices
        and (is_level(node.left) or is_level(node.right))
    ]


@pytest.mark.parametrize("path", ELSEWHERE, ids=lambda path: path.relative_to(KERNELS).as_posix())
def test_no_other_kernel_writes_it(path: Path) -> None:
    assert products(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "line",
    [
        "force = sign * storey.kinetic_slip_force",
        "work += frame[KINETIC_SLIP_FORCE, i] * travel",
        "base = -sign * at(p, PUSH_FLOOR, lane)",
        "new = (trial - phase * kinetic[i]) / s",
    ],
)
def test_the_search_finds_it(line: str) -> None:
    assert len(products(line)) == 1


def test_what_it_says() -> None:
    assert sliding_force(-1, 5e4) == -5e4
    assert friction_work(5e4, 0.02) == 1e3
