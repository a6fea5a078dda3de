"""Whether a cube's provenance is true of it: its axes, records and variables against its parameters."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import StoreError
from fdspec.variables import BUILDING_CUBE, CUBE

if TYPE_CHECKING:
    import xarray as xr

AXES: Final = ("intensity", "stiffness_ratio", "pretension", "period", "stiffness_scale", "slip_scale")
"""Axes of cubes that stand in the parameters, number by number."""

FORCES: Final = ("slip_force", "kinetic_slip_force")
"""Coordinates that follow from the pretension."""

_REMEDY: Final = (
    'sweep it as one, or take the parameters out, `del cube.attrs["parameters"]`, and say in the attribute '
    "history what it was made from"
)


def parameters_of(attributes: Mapping[Any, Any]) -> dict[str, Any] | None:
    """Return the parameters in a dataset's attributes, None where there are none.

    Raise ValueError, with a sentence, where they cannot be read.
    """
    text = attributes.get("parameters")
    if text is None:
        return None
    try:
        parameters = json.loads(text)
    except (TypeError, ValueError, RecursionError):
        raise ValueError("the attribute parameters is no JSON text") from None
    if not isinstance(parameters, dict):
        raise ValueError("the attribute parameters is no JSON object")
    return parameters


def records_of(parameters: Mapping[str, Any]) -> dict[str, str]:
    """Return the records of a sweep, name -> checksum; ValueError where they are not told so."""
    try:
        return {str(one["name"]): str(one["checksum"]) for one in parameters["records"]}
    except (KeyError, TypeError):
        raise ValueError(
            "the attribute parameters does not tell names and checksums of the records"
        ) from None


def is_cube(dataset: xr.Dataset) -> bool:
    """Whether the parameters are those of a sweep: of a history and of a choice nothing is to be compared."""
    try:
        parameters = parameters_of(dataset.attrs) or {}
    except ValueError:
        return False
    return isinstance(parameters.get("outputs"), list) and "records" in parameters


def untrue(cube: xr.Dataset) -> Iterator[str]:
    """Give a sentence for each axis that is not, bit for bit, the one in the parameters.

    Raise ValueError where the parameters cannot be read.
    """
    parameters = parameters_of(cube.attrs) or {}
    for name, told in _axes(parameters):
        if name in {"record", "checksum"}:
            continue  # names of records, not an axis of numbers
        if name not in cube.variables:
            yield f"{name} is not there"
        elif not _same(np.atleast_1d(cube[name].values), told):
            yield f"{name} is not that of the attribute parameters"
    outputs = parameters.get("outputs")
    if isinstance(outputs, list):
        for name in outputs:
            if name not in cube.variables:
                yield f"{name} is not there"


def with_true_parameters(dataset: xr.Dataset) -> xr.Dataset:
    """Return what may be saved: a part of a cube with the parameters of that part.

    Each cell of a sweep depends on itself alone, so that a part of a cube is the sweep over the part.  Raise
    StoreError for a cube whose axes are not of its parameters: joined, reduced or changed by hand.
    """
    if not is_cube(dataset):
        return dataset
    parameters = parameters_of(dataset.attrs) or {}
    changed = False
    for name, told in _axes(parameters):
        if name not in dataset.variables:
            raise StoreError(f"the cube has no {name} any more, which its parameters tell of; {_REMEDY}")
        held = np.atleast_1d(dataset[name].values)
        if name in FORCES or _same(held, told):
            continue
        if not _is_part(held, told):
            raise StoreError(
                f"{name} of the cube is not that of its parameters: it was joined or changed by hand; "
                f"{_REMEDY}"
            )
        changed = True
        if name in AXES:
            parameters[name] = [value if np.isfinite(value) else str(value) for value in held.tolist()]
        elif name == "record":
            by_name = {one["name"]: one for one in parameters["records"]}
            parameters["records"] = [by_name[one] for one in held.tolist()]
        elif name == "building":
            parameters["buildings"] = {one: parameters["buildings"][one] for one in held.tolist()}
    for name, told in _axes(parameters):
        if name in FORCES and not _same(np.atleast_1d(dataset[name].values), told):
            raise StoreError(f"{name} of the cube does not follow from its parameters; {_REMEDY}")
    if list(records_of(parameters).values()) != np.atleast_1d(dataset["checksum"].values).tolist():
        raise StoreError(f"the cube's checksums are not those of its records; {_REMEDY}")
    known = {name for name in parameters["outputs"] if name in CUBE or name in BUILDING_CUBE}
    kept = [name for name in parameters["outputs"] if name not in known or name in dataset.variables]
    if kept != parameters["outputs"]:
        parameters["outputs"], changed = kept, True
    if not changed:
        return dataset
    return dataset.assign_attrs(parameters=json.dumps(parameters, allow_nan=False))


def _axes(parameters: Mapping[str, Any]) -> Iterator[tuple[str, NDArray[Any]]]:
    """Give what the parameters say of a cube's coordinates."""
    for name in AXES:
        if isinstance(parameters.get(name), list):
            yield name, _numbers(name, parameters[name])
    if isinstance(parameters.get("pretension"), list) and "friction_coefficient" in parameters:
        yield from _forces(parameters)
    records = records_of(parameters)
    yield "record", np.array(list(records), dtype=object)
    yield "checksum", np.array(list(records.values()), dtype=object)
    if isinstance(parameters.get("buildings"), dict):
        yield "building", np.array(list(parameters["buildings"]), dtype=object)


def _forces(parameters: Mapping[str, Any]) -> Iterator[tuple[str, NDArray[np.float64]]]:
    pretension = _numbers("pretension", parameters["pretension"])
    for name, of in zip(FORCES, ("friction", "kinetic_friction"), strict=True):
        coefficient = parameters.get(f"{of}_coefficient")
        if coefficient is None:
            coefficient = parameters["friction_coefficient"]
        factor = _numbers(name, [coefficient, parameters.get("normal_force_factor", 1.0)]).prod()
        # An infinite pretension never slips, whatever the coefficient.
        force = np.full_like(pretension, np.inf)
        np.multiply(pretension, factor, out=force, where=np.isfinite(pretension))
        yield name, force


def _numbers(name: str, values: list[Any]) -> NDArray[np.float64]:
    try:
        return np.array([float(value) for value in values])
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"the attribute parameters does not tell {name} in numbers") from None


def _same(held: NDArray[Any], told: NDArray[Any]) -> bool:
    if held.dtype.kind == "f" and told.dtype.kind == "f":
        return held.shape == told.shape and held.astype("=f8").tobytes() == told.tobytes()
    return [str(one) for one in held.tolist()] == [str(one) for one in told.tolist()]


def _is_part(held: NDArray[Any], told: NDArray[Any]) -> bool:
    """Whether `held` is some of `told`, each once; numbers in their order, names in any."""
    known, mine = told.tolist(), held.tolist()
    if told.dtype.kind == "f":
        order = [known.index(one) for one in mine if one in known]
        return bool(mine) and len(order) == len(mine) and order == sorted(set(order))
    return bool(mine) and set(mine) <= set(known) and len(set(mine)) == len(mine)
