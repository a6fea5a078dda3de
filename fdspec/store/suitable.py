"""Whether a dataset that was opened is what a command can work on; else one sentence that says why not."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from fdspec.errors import DamagedError, DiskError, FdspecError, InvalidInput
from fdspec.measures.statuses import meanings_of
from fdspec.store.layout import is_text
from fdspec.store.origin import parameters_of
from fdspec.store.plausible import wrong_coordinates
from fdspec.store.refusals import no_resources
from fdspec.variables import INTENSITY, STUDY_DIMS

if TYPE_CHECKING:
    import xarray as xr


def require_cube(dataset: xr.Dataset, path: str | os.PathLike[str], what: str) -> None:
    """Raise InvalidInput unless this is a sound cube of single-storey frames, which `what` needs."""
    needs = f"{what} need a cube of single-storey frames, as fdspec sweep writes it"
    lacking = [dim for dim in STUDY_DIMS if dim not in dataset.dims]
    if "building" in dataset.dims:
        raise InvalidInput(
            f"{os.fspath(path)} is a cube of buildings; {needs} without them; 'fdspec figures' "
            "draws its profiles, 'fdspec summary' and 'fdspec export' give its numbers"
        )
    if "time" in dataset.dims:
        raise InvalidInput(f"{os.fspath(path)} is a history; {needs}")
    if lacking:
        raise InvalidInput(
            f"{os.fspath(path)} has no dimension {', '.join(lacking)}; {needs} (select with lists to keep "
            "dims)"
        )
    if INTENSITY in dataset.dims:
        levels = ", ".join(f"{level:g}" for level in np.atleast_1d(dataset[INTENSITY].values)[:20])
        raise InvalidInput(
            f"{os.fspath(path)} is a cube over intensities ({levels}); {what} need one of them: "
            "fdspec.save(cube.sel(intensity=...), path) writes it"
        )
    empty = [dim for dim in STUDY_DIMS if not dataset.sizes[dim]]
    if empty:
        raise InvalidInput(f"{os.fspath(path)} has no {empty[0]} in it; {needs}")
    for dim in STUDY_DIMS:
        if dim not in dataset.variables or is_text(dataset.variables[dim]) != (dim == "record"):
            raise _damaged(path, f"{dim} is not there, or of another kind")
    if "status" not in dataset.variables:
        raise _damaged(path, "status is not there")
    require_sound(dataset, path)


def require_sound(dataset: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Raise DamagedError for coordinates, flags or parameters that no file of fdspec's holds."""
    for told in wrong_coordinates(dataset):
        raise _damaged(path, told)
    try:
        if not isinstance(parameters_of(dataset.attrs), dict | None):
            raise _damaged(path, "the attribute parameters is of another kind")
        if "status" in dataset.variables:
            meanings_of(dataset)
    except ValueError as error:
        raise _damaged(path, str(error)) from None
    for name, variable in dataset.variables.items():
        codes = np.atleast_1d(variable.attrs.get("flag_values", ()))
        if codes.size != len(str(variable.attrs.get("flag_meanings", "")).split()):
            raise _damaged(path, f"{name} has not as many meanings as codes")


def loaded(dataset: xr.Dataset, path: str | os.PathLike[str]) -> xr.Dataset:
    """Read what was opened lazily; raise DamagedError, or DiskError, where it cannot be read."""
    try:
        return dataset.load()
    except FdspecError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        if told := no_resources(error):
            raise DiskError(f"cannot read {os.fspath(path)}: {told}") from error
        raise _damaged(path, "numbers in it cannot be read") from error


def _damaged(path: str | os.PathLike[str], told: str) -> DamagedError:
    return DamagedError(f"{os.fspath(path)} is damaged: {told}; 'fdspec check {os.fspath(path)}' says more")
