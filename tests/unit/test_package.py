"""The front door: a dozen names, cheap to import, and functions where modules share the name."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fdspec

HEAVY = {
    *("click", "dask", "matplotlib", "netCDF4", "numba", "numpy"),
    *("pandas", "pydantic", "rich", "scipy", "xarray"),
}


def run(code: str) -> str:
    """Run code in a fresh interpreter; return what it prints."""
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", code], check=True, capture_output=True, text=True
    ).stdout.strip()


def test_import_is_cheap() -> None:
    loaded = set(run("import sys, fdspec; print(*{name.partition('.')[0] for name in sys.modules})").split())
    assert loaded & HEAVY == set()


@pytest.mark.parametrize("name", fdspec.__all__)
def test_every_public_name_exists(name: str) -> None:
    assert getattr(fdspec, name) is not None
    assert name in dir(fdspec)


def test_unknown_name_raises_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'fdspec' has no attribute 'swep'"):
        _ = fdspec.swep


@pytest.mark.parametrize("name", ["simulate", "sweep", "sweep_buildings"])
@pytest.mark.parametrize(
    "first", ["import fdspec.runs.{0}", "from fdspec.runs.{0} import {0}", "import fdspec; fdspec.{0}"]
)
def test_function_wins_over_module_of_the_same_name(name: str, first: str) -> None:
    kind = run(f"{first.format(name)}; import fdspec; print(type(fdspec.{name}).__name__)")
    assert kind == "function"


def promised() -> list[str]:
    """Every name that the page of the Python interface documents."""
    pages = sorted((Path(__file__).parents[2] / "docs" / "api").glob("*.md"))
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    return re.findall(r"^\.\. auto(?:function|class|module):: (\S+)", text, re.MULTILINE)


def test_import_fdspec_alone_reaches_every_documented_name() -> None:
    names = promised()
    assert len(names) > 60
    code = f"import fdspec\nfor name in {names}:\n    eval(name)\nprint(fdspec.sweep, fdspec.RecordError)"
    assert run(code).startswith("<function sweep at")


def test_type_checkers_are_told_the_same_names() -> None:
    told = re.findall(r"import (\w+) as \1\b", Path(fdspec.__file__).read_text(encoding="utf-8"))
    assert sorted(told) == sorted(fdspec.__all__)


def test_a_module_that_needs_what_is_missing_says_what() -> None:
    code = (
        "import sys, fdspec\nsys.modules['tornado'] = None\n"
        "try:\n    fdspec.explore\nexcept ModuleNotFoundError as error:\n    print(error.name)"
    )
    assert run(code).startswith("tornado")


NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.py"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_no_picture_twice(path: Path) -> None:
    """Pyplot shows its figures at a cell's end; the figure's name there would show it once more."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    made = {
        name.id
        for node in body
        if isinstance(node, ast.Assign) and ast.unparse(node.value).startswith("plt.")
        for name in ast.walk(node.targets[0])
        if isinstance(name, ast.Name)
    }
    told = {node.value.id for node in body if isinstance(node, ast.Expr) and isinstance(node.value, ast.Name)}
    assert not made & told


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_names_no_ipython(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert not {"get_ipython", "IPython"} & {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def test_notebooks_need_no_ipython_as_scripts() -> None:
    """The imports of each, run by a Python that has none."""
    lines = ["import sys, matplotlib", "matplotlib.use('agg')", "sys.modules['IPython'] = None"]
    for path in NOTEBOOKS:
        lines += [
            ast.unparse(node)
            for node in ast.parse(path.read_text(encoding="utf-8")).body
            if isinstance(node, ast.Import | ast.ImportFrom)
            or (isinstance(node, ast.Try) and "Error" in ast.unparse(node))
        ]
    run("\n".join(lines))
