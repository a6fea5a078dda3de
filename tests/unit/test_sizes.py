"""No function grows beyond what a reader takes in at once: lines of its body, and arguments."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2] / "fdspec"

BODY = 90
ARGUMENTS = 12
"""Outside kernels: lines without signature and docstring; arguments."""

KERNEL_BODY = 129
KERNEL_ARGUMENTS = 20

PUBLIC = "the public face: keywords that a user reads in one place, each with its default"
TIME_LOOP = "a time loop, from one event to the next: what it calls are the named steps"
BUNDLED = "within a time loop, where bundles of arrays cost 8 to 20 % at one to four storeys"
HANDED = "an entry: what Python hands over, array by array"

LONG = {
    "cli/choose.py choose": "a command: its options, one call, and what becomes of the outcome",
    "report/page.py page": "a page: its parts in the order in which they are read",
    "kernels/bilinear/history.py history": TIME_LOOP,
    "kernels/frame/history.py history": TIME_LOOP,
    "kernels/frame_batch/entry.py run": TIME_LOOP,
    "kernels/storey/step.py take_step": TIME_LOOP,
}
MANY_ARGUMENTS = {
    "choice/pretension.py best_pretension": PUBLIC,
    "choice/recommendation.py choose": PUBLIC,
    "model/building.py Building.__init__": PUBLIC,
    "runs/sweep.py sweep": PUBLIC,
    "runs/sweep_buildings.py sweep_buildings": PUBLIC,
    "kernels/devices/history.py history": TIME_LOOP,
    "kernels/frame_batch/entry.py run": TIME_LOOP,
    "kernels/frame/step.py look_ahead": BUNDLED,
    "kernels/frame_batch/entry.py change": BUNDLED,
    "kernels/frame_batch/search.py search": BUNDLED,
    "kernels/devices/history.py integrate": HANDED,
}
"""Functions that exceed a limit, each with the reason."""


class Function(NamedTuple):
    name: str
    body: int
    arguments: int
    is_command: bool


def functions(tree: ast.AST, within: str = "") -> Iterator[Function]:
    """Measure all functions of a module, those of classes by both names."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ClassDef):
            yield from functions(node, f"{within}{node.name}.")
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            given = node.args
            count = len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)
            count += (given.vararg is not None) + (given.kwarg is not None)
            count -= within != "" and given.args[:1] != [] and given.args[0].arg in {"self", "cls"}
            statements = node.body[1:] if ast.get_docstring(node) is not None else node.body
            lines = 0 if not statements else (node.end_lineno or 0) - statements[0].lineno + 1
            options = {ast.unparse(d).partition("(")[0] for d in node.decorator_list}
            yield Function(
                f"{within}{node.name}", lines, count, bool(options & {"click.command", "click.option"})
            )
            yield from functions(node, f"{within}{node.name}.")


def measured(root: Path) -> Iterator[tuple[str, Function, bool]]:
    """Return place and name of every function, its size, and whether it is a kernel."""
    for path in sorted(root.rglob("*.py")):
        place = path.relative_to(root).as_posix()
        for one in functions(ast.parse(path.read_text(encoding="utf-8"))):
            yield f"{place} {one.name}", one, place.startswith("kernels/")


def long(root: Path) -> dict[str, int]:
    """Return the functions whose body is too long, with its lines."""
    return {
        name: one.body
        for name, one, is_kernel in measured(root)
        if one.body > (KERNEL_BODY if is_kernel else BODY)
    }


def many_arguments(root: Path) -> dict[str, int]:
    """Return the functions that take too much.  Commands do not count: an argument is an option there."""
    return {
        name: one.arguments
        for name, one, is_kernel in measured(root)
        if one.arguments > (KERNEL_ARGUMENTS if is_kernel else ARGUMENTS) and not one.is_command
    }


def test_functions_are_short_but_for_those_named() -> None:
    assert long(ROOT).keys() == LONG.keys()


def test_functions_take_little_but_for_those_named() -> None:
    assert many_arguments(ROOT).keys() == MANY_ARGUMENTS.keys()


def test_the_measure() -> None:
    source = 'class A:\n    def f(self, a, *, b=1):\n        """Say."""\n        x = 1\n\n        return x\n'
    assert list(functions(ast.parse(source))) == [Function("A.f", 3, 2, False)]
