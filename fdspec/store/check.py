"""What can be said of a cube on disk without computing it again: is it complete and plausible?"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable, Iterator
from itertools import repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, ParamSpec

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import DamagedError, DiskError, FdspecError
from fdspec.measures.statuses import meanings_of, status_counts
from fdspec.store import checksums, chunks, description, save
from fdspec.store import open as open_cube
from fdspec.store.netcdf import checksums_of
from fdspec.store.origin import is_cube, parameters_of, records_of, untrue
from fdspec.store.plausible import wrong, wrong_coordinates
from fdspec.store.refusals import no_resources
from fdspec.variables import (
    BUILDING_CUBE,
    CUBE,
    HISTORY,
    INTENSITY,
    INTENSITY_BUILDING_CUBE,
    INTENSITY_CUBE,
    NOT_COMPUTED,
    STATUSES,
    STUDY_DIMS,
    Registry,
    describe,
)

if TYPE_CHECKING:
    import xarray as xr

ENERGY: Final = 1e-9
"""Largest error of the energy balance, relative to the input energy."""

LISTED: Final = 5


class Finding(NamedTuple):
    """One thing that was looked at; passed is None where it could not be."""

    what: str
    passed: bool | None
    told: str


def check(path: str | os.PathLike[str]) -> Iterator[Finding]:
    """Look through what `save` or a sweep left: whether it is whole, and can be right.

    Of a cube, of single storeys or of buildings, and of a history that is schema, CF, records, axes,
    checksums, statuses, numbers and energy; of anything else that `save` wrote, such as a choice, CF and
    checksums alone.  What is read is read record by record.  Raise StoreError where there is no such file.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # what is missing is found below
            cube = open_cube(path, lazily=True)
    except DamagedError as error:
        yield Finding("checksums", False, str(error))
        return
    with cube:
        registry = _registry(cube)
        whole = (
            _guarded("checksums", _store_checksums, path, cube, registry or CUBE)
            if description.is_store(path)
            else _guarded("checksums", _file_checksums, path, cube)
        )
        if registry is None:
            yield Finding("schema", None, "neither cube nor history: CF and checksums alone are looked at")
            yield _guarded("CF", _conventions, path, cube)
            yield whole
            return
        yield _guarded("schema", _schema, cube, registry)
        yield _guarded("CF", _conventions, path, cube)
        yield _guarded("records", _records, cube)
        yield _guarded("axes", _axes, cube)
        yield whole
        if whole.passed:
            yield _guarded("statuses", _statuses, cube)
            yield _guarded("numbers", _numbers, cube)
            yield _guarded("energy", _energy, cube)


P = ParamSpec("P")


def _guarded(what: str, look: Callable[P, Finding], *given: P.args, **named: P.kwargs) -> Finding:
    """Look; what cannot be looked at, as something that it needs is missing or of another kind, fails."""
    try:
        return look(*given, **named)
    except FdspecError as error:
        return Finding(what, False, str(error))
    except (ArithmeticError, AttributeError, LookupError, OSError, RuntimeError, TypeError, ValueError):
        return Finding(what, False, "cannot be judged: a variable or an attribute is missing or damaged")


def _registry(cube: xr.Dataset) -> Registry | None:
    """Return what the dataset should hold; None where it is no cube and no history."""
    dims = set(cube.dims)
    if "statistic" in dims:
        return None
    if "building" in dims and "slip_scale" in dims:
        return INTENSITY_BUILDING_CUBE if INTENSITY in dims else BUILDING_CUBE
    if len(dims & set(STUDY_DIMS)) == len(STUDY_DIMS):
        return INTENSITY_CUBE if INTENSITY in dims else CUBE
    return HISTORY if "time" in dims and "displacement" in cube.variables else None


def _schema(cube: xr.Dataset, registry: Registry) -> Finding:
    try:
        described = describe(cube, registry)
    except ValueError as error:
        return Finding("schema", False, str(error))
    needed = ("status", *(dim for dim in cube.dims if dim in registry))
    lacking = [str(name) for name in needed if name not in cube.variables]
    if lacking:
        return Finding("schema", False, f"there is no variable {', '.join(lacking)}")
    for name, array in described.variables.items():
        held = cube[name].attrs
        for key, value in array.attrs.items():
            if key.startswith("flag_"):
                continue
            if key not in held or not np.array_equal(held[key], value):
                told = f"attribute {key} of {name} is {held.get(key)!r:.80}; it should be {value!r}"
                return Finding("schema", False, told)
    known = {**STATUSES, NOT_COMPUTED: "not_computed"}
    for code, meaning in meanings_of(cube).items():
        if known.get(code) != meaning:
            return Finding("schema", False, f"status {code} is {meaning}; it should be {known.get(code)}")
    return Finding("schema", True, f"{len(cube.data_vars)} variables and {len(cube.coords)} coordinates")


def _conventions(path: str | os.PathLike[str], cube: xr.Dataset) -> Finding:
    """Ask the CF checker, where there is one; of a store, about a file of its first cell."""
    here = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    checker = shutil.which("compliance-checker", path=here)
    if checker is None:
        return Finding("CF", None, "not checked: pip install compliance-checker")
    with tempfile.TemporaryDirectory() as folder:
        file, report = Path(path), Path(folder, "report.json")
        if description.is_store(path):
            file = Path(folder, "first.nc")
            save(cube.isel(dict.fromkeys(cube.dims, slice(0, 1))).load(), file)
        options = ["--test", "cf:1.11", "--criteria", "strict", "--format", "json", "--output", str(report)]
        run = subprocess.run(  # noqa: S603
            [checker, *options, str(file)], capture_output=True, text=True, check=False
        )
        if not report.exists():
            return Finding("CF", None, f"the checker failed: {run.stderr.strip()[-200:]}")
        result = json.loads(report.read_text(encoding="utf-8"))["cf:1.11"]
    kinds = ("high_priorities", "medium_priorities", "low_priorities")
    said = [text for kind in kinds for one in result[kind] for text in one["msgs"]]
    if said:
        return Finding("CF", False, _listed(said))
    return Finding("CF", True, f"{cube.attrs.get('Conventions')}, {result['possible_points']} points")


def _records(cube: xr.Dataset) -> Finding:
    """Compare the records with those in the provenance."""
    try:
        told = records_of(parameters_of(cube.attrs) or {})
        held = {
            str(name): str(checksum)
            for name, checksum in zip(
                np.atleast_1d(cube["record"].values), np.atleast_1d(cube["checksum"].values), strict=True
            )
        }
    except (KeyError, ValueError, TypeError) as error:
        why = error if isinstance(error, ValueError) else "a variable is missing"
        return Finding("records", False, f"the provenance cannot be read: {why}")
    if told != held:
        return Finding("records", False, "names or checksums are not those in the attribute parameters")
    return Finding("records", True, f"{len(held)}, as in the attribute parameters")


def _axes(cube: xr.Dataset) -> Finding:
    """Compare the axes, bit for bit, with the provenance, and all coordinates with what they can be."""
    try:
        bad = [*untrue(cube)] if is_cube(cube) else []
    except ValueError as error:
        bad = [str(error)]
    bad += wrong_coordinates(cube)
    if bad:
        return Finding("axes", False, _listed(dict.fromkeys(bad)))
    return Finding(
        "axes", True, "as in the attribute parameters" if is_cube(cube) else "increasing and finite"
    )


def _store_checksums(path: str | os.PathLike[str], cube: xr.Dataset, registry: Registry) -> Finding:
    blocks, _ = description.described(path)
    variables = [registry[str(name)] for name in cube.data_vars if name in registry]
    missing, damaged = 0, []
    for _, state, files in chunks.states(path, blocks, variables):
        missing += state is chunks.State.MISSING
        damaged += [file.relative_to(path) for file in files]
    if damaged:
        told = f"damaged: {_listed(damaged)}; start the sweep again to compute them anew"
    elif missing:
        told = f"{missing} of {len(blocks)} blocks are missing; start the sweep again to go on"
    else:
        told = f"{len(blocks)} blocks of {len(variables)} variables are whole"
        told += "" if description.described_files(path) else _OLDER
    return Finding("checksums", not damaged and not missing, told)


def _file_checksums(path: str | os.PathLike[str], cube: xr.Dataset) -> Finding:
    """Read all of a file; HDF5 compares each chunk with its checksum, and each variable has its own."""
    told = checksums_of(path)
    damaged = []
    for name, variable in cube.variables.items():
        try:
            found = checksums.started(variable)
            for values in _parts(variable):
                found = checksums.of_values(values, found)
        except (OSError, RuntimeError) as error:
            if why := no_resources(error):
                raise DiskError(f"cannot read {os.fspath(path)}: {why}") from error
            damaged.append(str(name))
        else:
            if told is not None and told.get(str(name)) != f"{found:08x}":
                damaged.append(str(name))
    if told is not None:
        damaged += [f"{name}, which is not there" for name in told if name and name not in cube.variables]
        damaged += [] if told.get("") == checksums.of_dataset(cube) else ["the attributes"]
    if damaged:
        return Finding("checksums", False, f"damaged: {_listed(damaged)}; write the file again")
    older = _OLDER if told is None else ""
    return Finding("checksums", True, f"{len(cube.variables)} variables are whole{older}")


_OLDER: Final = "; written before axes and attributes had checksums, so of these nothing is known"


def _statuses(cube: xr.Dataset) -> Finding:
    counts = status_counts(cube)
    told = ", ".join(f"{number:,} {meaning}".replace(",", " ") for meaning, number in counts.items())
    return Finding("statuses", set(counts) == {"ok"}, told)


def _numbers(cube: xr.Dataset) -> Finding:
    """Where the status is ok, every number must be one that a result can be."""
    status = cube["status"].variable
    bad = []
    for name, array in cube.data_vars.items():
        if array.dtype.kind not in "iuf" or name == "status":
            continue
        each = array.dims[: status.ndim] == status.dims
        codes = _parts(status) if each and status.ndim else repeat(None)
        for values, code in zip(_parts(array.variable), codes, strict=False):
            judged = values
            if code is not None:
                judged = values[code == 0]  # what each storey has of its own has one status for all storeys
            elif status.ndim == 0 and int(status) != 0:
                continue
            if told := wrong(str(name), judged):
                bad.append(f"{name} is {told}")
                break
    return Finding(
        "numbers", not bad, _listed(bad) if bad else "what results can be wherever the status is ok"
    )


def _energy(cube: xr.Dataset) -> Finding:
    if "energy_error" not in cube:
        return Finding("energy", None, "the sweep was made without the energy balance")
    worst = 0.0
    for errors, codes in zip(
        _parts(cube["energy_error"].variable), _parts(cube["status"].variable), strict=True
    ):
        worst = max(worst, float(np.abs(errors[codes == 0]).max(initial=0.0)))
    return Finding("energy", worst <= ENERGY, f"error at most {worst:.2g} of the input, {ENERGY:g} allowed")


def _parts(variable: xr.Variable) -> Iterator[NDArray[Any]]:
    """Give the numbers record by record where there are records, in the order of C."""
    if variable.dims[:1] != ("record",) or variable.ndim < 2:
        yield np.asarray(variable.values)
        return
    for record in range(variable.shape[0]):
        yield variable[record].values


def _listed(things: Iterable[object]) -> str:
    texts = [str(thing) for thing in things]
    more = f" and {len(texts) - LISTED} more" if len(texts) > LISTED else ""
    return ", ".join(texts[:LISTED]) + more
