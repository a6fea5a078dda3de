"""Cubes of parts joined to the cube that one sweep over all would have given, provenance and all."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.store.netcdf import is_complete
from fdspec.store.origin import AXES, is_cube, parameters_of, with_true_parameters
from fdspec.store.provenance import provenance

if TYPE_CHECKING:
    import xarray as xr

KEYS: Final = {"record": "records", "building": "buildings", **{axis: axis for axis in AXES}}
"""Dim along which cubes are joined -> its key in the parameters."""


@dataclass(frozen=True)
class _Record:
    """What the parameters tell of a record."""

    name: str
    checksum: str
    source: str
    history: tuple[str, ...]


def combine(cubes: Sequence[xr.Dataset], along: str = "record") -> xr.Dataset:
    """Join cubes along one dim into the cube that one sweep over all of it would have given.

    Nothing else may differ: not the other axes, no parameter, not the version.  Along a dim of numbers the
    cells come in the order of the numbers, along ``record`` and ``building`` in that of the cubes.

    Parameters
    ----------
    cubes : sequence of xarray.Dataset
        Two or more, as `sweep` or `sweep_buildings` returns them, or parts of such.
    along : str
        "record", "building", or an axis: "stiffness_ratio", "pretension", "period", "stiffness_scale",
        "slip_scale".

    Returns
    -------
    xarray.Dataset
        With the parameters of the whole; its history tells of the parts.

    Raises
    ------
    InvalidInput
        For what cannot be joined, with what differs and what would be right.

    Examples
    --------
    >>> import fdspec
    >>> frame = dict(period=[0.5], pretension=[20e3], stiffness_ratio=[4])
    >>> parts = [
    ...     fdspec.sweep(fdspec.GroundMotion([0.0, 3.0, -2.0, 0.0], 0.1, name=name), **frame) for name in "ab"
    ... ]
    >>> fdspec.combine(parts).sizes["record"]
    2
    """
    import xarray as xr

    cubes = list(cubes)
    if along not in KEYS:
        raise InvalidInput(f"along must be one of {', '.join(KEYS)}, got {along!r}")
    if len(cubes) < 2:
        raise InvalidInput(f"cubes must be two or more, got {len(cubes)}")
    told = [_parameters(cube, number, along) for number, cube in enumerate(cubes, 1)]
    for number, other in enumerate(told[1:], 2):
        _require_alike(told[0], other, number, along)
    for number, cube in enumerate(cubes[1:], 2):
        _require_same(cubes[0], cube, number, along)
    values = np.concatenate([np.atleast_1d(cube[along].values) for cube in cubes])
    seen: set[Any] = set()
    for value in values.tolist():
        if value in seen:
            raise InvalidInput(
                f"{along} {value!r} stands in two of the cubes; leave it out of one, with "
                f"cube.drop_sel({along}=[{value!r}])"
            )
        seen.add(value)
    joined = xr.concat(
        cubes, dim=along, data_vars="minimal", coords="minimal", compat="override", join="override",
        combine_attrs="override",
    )  # fmt: skip
    if values.dtype.kind == "f":
        joined = joined.isel({along: np.argsort(values)})
    joined = joined.transpose(*cubes[0].dims)[list(cubes[0].variables)]
    parameters = _joined(told, along)
    records = [
        _Record(one["name"], one["checksum"], one.get("source", ""), tuple(one.get("history", ())))
        for one in parameters.pop("records")
    ]
    joined.attrs = provenance(
        str(cubes[0].attrs.get("title", "")), parameters, records, command=f"fdspec.combine along {along}"
    )
    lines = [line for cube in cubes for line in str(cube.attrs.get("history", "")).splitlines()]
    joined.attrs["history"] = "\n".join([joined.attrs["history"], *dict.fromkeys(lines)])
    for name in joined.variables:
        joined[name].attrs = dict(cubes[0][name].attrs)
    return joined


def _parameters(cube: object, number: int, along: str) -> dict[str, Any]:
    import xarray as xr

    if not isinstance(cube, xr.Dataset) or not is_cube(cube):
        raise InvalidInput(
            f"cube {number} is no cube with its parameters: combine takes what fdspec.sweep returns"
        )
    if along not in cube.dims:
        raise InvalidInput(
            f"cube {number} has no dimension {along}; it has {', '.join(map(str, cube.dims))} (select with "
            "lists to keep dims)"
        )
    if not is_complete(cube):
        raise InvalidInput(f"cube {number} has cells that were not computed; finish its sweep first")
    told = parameters_of(with_true_parameters(cube).attrs) or {}
    return {**told, "fdspec_version": cube.attrs.get("fdspec_version")}


def _require_alike(one: Mapping[str, Any], other: Mapping[str, Any], number: int, along: str) -> None:
    """Refuse parameters that differ in more than what is joined."""
    different = [
        name
        for name in dict.fromkeys([*one, *other])
        if name != KEYS[along] and one.get(name) != other.get(name)
    ]
    if not different:
        return
    hints = []
    if "records" in different:
        hints.append("the same records in the same order are needed: take cube.sel(record=[...]) of each")
    if "outputs" in different or "certify" in different:
        hints.append("sweep them with the same outputs and certify")
    axes = [name for name in different if name in KEYS and name not in {"record", "building"}]
    if len(different) == 1 and axes:
        hints.append(f"along={axes[0]!r} (--along {axes[0]}) joins them along it")
    remedy = "; ".join(hints) or "sweep them with the same parameters"
    parts = ", ".join(f"{name} ({_short(one.get(name))} and {_short(other.get(name))})" for name in different)
    raise InvalidInput(f"cube 1 and cube {number} differ in {parts}: {remedy}")


def _require_same(one: xr.Dataset, other: xr.Dataset, number: int, along: str) -> None:
    """Refuse cubes whose other axes, or what lacks the dim, are not the same to the bit."""
    if set(map(str, one.variables)) != set(map(str, other.variables)):
        apart = sorted(set(map(str, one.variables)) ^ set(map(str, other.variables)))
        raise InvalidInput(
            f"{', '.join(apart)} is in one of cube 1 and cube {number} alone; drop it from both"
        )
    for name, variable in one.variables.items():
        if along in variable.dims:
            continue
        held, wanted = variable.values, other.variables[name].values
        if variable.dims != other.variables[name].dims or not _same(held, wanted):
            raise InvalidInput(
                f"{name} of cube 1 and cube {number} is not the same: only what lies along {along} may differ"
            )


def _same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    if one.dtype.kind == "f" and other.dtype.kind == "f":
        return np.array_equal(one, other, equal_nan=True)
    return np.array_equal(one, other)


def _joined(told: Sequence[Mapping[str, Any]], along: str) -> dict[str, Any]:
    key = KEYS[along]
    parts = [one[key] for one in told]
    whole: Any
    if isinstance(parts[0], dict):
        whole = {name: building for part in parts for name, building in part.items()}
    elif along == "record":
        whole = [one for part in parts for one in part]
    else:
        whole = sorted((value for part in parts for value in part), key=float)
    joined = {**told[0], key: whole}
    del joined["fdspec_version"]
    return joined


def _short(value: Any) -> str:
    if isinstance(value, list) and len(value) > 3:
        if isinstance(value[0], dict):
            return f"{len(value)} of them"
        return f"{len(value)} values from {value[0]} to {value[-1]}"
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return ", ".join(str(one.get("name", one)) for one in value)
    if isinstance(value, dict):
        return ", ".join(map(str, value))
    return json.dumps(value)
