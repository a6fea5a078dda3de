"""The part of a cube that a measure reads: checked, and without the histories that did not end well."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from fdspec.errors import InvalidInput
from fdspec.variables import STUDY_DIMS

if TYPE_CHECKING:
    import xarray as xr


def require(cube: xr.Dataset, variables: Iterable[str], dims: Iterable[str] = STUDY_DIMS) -> None:
    """Raise InvalidInput unless the cube has these variables and, not empty, these dims."""
    lacking = [dim for dim in dims if dim not in cube.dims]
    if lacking:
        hint = "a cube of single-storey frames, as fdspec.sweep returns it; select with lists to keep dims"
        raise InvalidInput(f"the cube has no dimension {', '.join(lacking)}, and this measure needs {hint}")
    for name in variables:
        if name not in cube:
            raise InvalidInput(f"the cube has no {name}; sweep with it among the outputs")
    for dim in dims:
        if cube.sizes[dim] == 0:
            raise InvalidInput(f"the cube has no {dim} left; select a band that holds some")


def ended_well(cube: xr.Dataset, name: str) -> xr.DataArray:
    """Return a variable, NaN where the history did not end well."""
    values = cube[name]
    return values.where(cube["status"] == 0) if "status" in cube else values
