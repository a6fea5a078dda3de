"""Synthetic datasets that look like what sweep and simulate return, made from the registry alone."""

from collections.abc import Iterable

import numpy as np
import xarray as xr

from fdspec.variables import (
    BUILDING_CUBE,
    BUILDING_DIMS,
    CUBE,
    HISTORY,
    STUDY_DIMS,
    TEXT,
    Registry,
    Variable,
    describe,
)

RECORDS = ("FSR1", "FMR2", "İzmit 1")

_PARAMETERS = '{"floor_mass": 20000.0, "certify": true, "records": [{"name": "FSR1"}]}'
_ATTRIBUTES = {
    "Conventions": "CF-1.11",
    "title": "Synthetic dataset",
    "source": "random numbers",
    "history": "2026-01-01T00:00:00Z made for tests",
    "references": "none",
    "fdspec_version": "0.0.0",
    "parameters": _PARAMETERS,
}


def synthetic_cube(
    records: Iterable[str] = RECORDS, shape: tuple[int, int, int] = (2, 3, 4), seed: int = 0
) -> xr.Dataset:
    """Return a cube of random numbers with every variable of the registry."""
    sizes = dict(zip(STUDY_DIMS, (len(tuple(records)), *shape), strict=True))
    known = {
        "record": np.array(list(records)),
        "stiffness_ratio": np.geomspace(0.5, 10.0, shape[0]),
        "pretension": np.linspace(10e3, 1010e3, shape[1]),
        "period": 0.05 * np.arange(1, shape[2] + 1),
    }
    return _filled(CUBE, sizes, known, set(STUDY_DIMS), seed)


def synthetic_building_cube(
    records: Iterable[str] = RECORDS, buildings: Iterable[str] = ("office", "hôtel 2"), seed: int = 0
) -> xr.Dataset:
    """Return a cube of buildings of random numbers with every variable of the registry."""
    known = {
        "record": np.array(list(records)),
        "building": np.array(list(buildings)),
        "stiffness_scale": np.array([0.5, 1.0, 2.0]),
        "slip_scale": np.array([0.0, 0.5, 1.0, np.inf]),
        "storey": np.arange(1, 4),
    }
    sizes = {name: values.size for name, values in known.items()} | {"link": 2}
    known["stands_on"] = np.array([[0, 1, 0]] * sizes["building"])
    return _filled(BUILDING_CUBE, sizes, known, {*BUILDING_DIMS, "storey", "stands_on"}, seed)


def synthetic_history(
    samples: int = 5, storeys: int = 2, transitions: int = 3, record: str = "FSR1", seed: int = 0
) -> xr.Dataset:
    """Return a history of random numbers with every variable of the registry."""
    sizes = {"time": samples, "storey": storeys, "transition": transitions, "link": 2, "state": 2}
    known = {
        "record": np.array(record),
        "time": 0.01 * np.arange(samples),
        "storey": np.arange(1, storeys + 1),
        "stands_on": np.arange(storeys),
    }
    return _filled(HISTORY, sizes, known, {"time", "storey", "record", "stands_on"}, seed)


def _filled(
    registry: Registry, sizes: dict[str, int], known: dict[str, np.ndarray], axes: set[str], seed: int
) -> xr.Dataset:
    random = np.random.default_rng(seed)
    data, coords = {}, {}
    for name, variable in registry.items():
        values = known.get(name)
        if values is None:
            values = _values(variable, tuple(sizes[dim] for dim in variable.dims), random)
        about = name in axes or variable.dims in {("record",), ("pretension",)} or variable.dtype == TEXT
        if about and variable.dtype == "float64":
            values = np.abs(values)  # no coordinate of a cube or a history is negative
        (coords if about else data)[name] = (variable.dims, values)
    return describe(xr.Dataset(data, coords, _ATTRIBUTES), registry)


def _values(variable: Variable, shape: tuple[int, ...], random: np.random.Generator) -> np.ndarray:
    if variable.dtype == TEXT:
        return np.array([f"{variable.name} {i}" for i in range(np.prod(shape, dtype=int))]).reshape(shape)
    if variable.dtype == "float64":
        return random.normal(size=shape)
    codes = variable.attributes.get("flag_values")
    return random.choice(np.arange(200) if codes is None else codes, size=shape).astype(variable.dtype)
