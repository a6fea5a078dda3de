"""The front door: a dozen names, cheap to import, and functions where modules share the name."""

import subprocess
import sys

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
