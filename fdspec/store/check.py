"""What can be said of a cube on disk without computing it again: is it whole, and is in it what should be?"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import StoreError
from fdspec.measures.statuses import meanings_of, status_counts
from fdspec.store import chunks, save
from fdspec.store import open as open_cube
from fdspec.variables import BUILDING_CUBE, CUBE, STATUSES, describe

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
    """Look through a cube that `save` or a sweep left: schema, CF, records, checksums, statuses, energy.

    What is read is read record by record.  Raise StoreError where there is no cube.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # what is missing is found below
        cube = open_cube(path, lazily=True)
    with cube:
        if "record" not in cube.dims:
            raise StoreError(f"cannot check {os.fspath(path)}: it is no cube of a sweep")
        whole = _store_checksums(path, cube) if chunks.is_store(path) else _file_checksums(cube)
        yield _schema(cube)
        yield _conventions(path, cube)
        yield _records(cube)
        yield whole
        if whole.passed:
            yield _statuses(cube)
            yield _numbers(cube)
            yield _energy(cube)


def _schema(cube: xr.Dataset) -> Finding:
    registry = BUILDING_CUBE if "building" in cube.dims else CUBE
    try:
        described = describe(cube, registry)
    except ValueError as error:
        return Finding("schema", False, str(error))
    lacking = [str(name) for name in ("status", *cube.dims) if name not in cube.variables]
    if lacking:
        return Finding("schema", False, f"there is no variable {', '.join(lacking)}")
    for name, array in described.variables.items():
        held = cube[name].attrs
        for key, value in array.attrs.items():
            if key.startswith("flag_"):
                continue
            if key not in held or not np.array_equal(held[key], value):
                told = f"attribute {key} of {name} is {held.get(key)!r}; it should be {value!r}"
                return Finding("schema", False, told)
    known = {**STATUSES, chunks.NOT_COMPUTED: "not_computed"}
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
        if chunks.is_store(path):
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
        told = {one["name"]: one["checksum"] for one in json.loads(cube.attrs["parameters"])["records"]}
        held = dict(zip(cube["record"].values.tolist(), cube["checksum"].values.tolist(), strict=True))
    except (KeyError, ValueError, TypeError) as error:
        return Finding("records", False, f"the provenance cannot be read ({error!r})")
    if told != held:
        return Finding("records", False, "names or checksums are not those in the attribute parameters")
    return Finding("records", True, f"{len(held)}, as in the attribute parameters")


def _store_checksums(path: str | os.PathLike[str], cube: xr.Dataset) -> Finding:
    blocks, _ = chunks.described(path)
    variables = [CUBE[str(name)] for name in cube.data_vars if name in CUBE]
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
    return Finding("checksums", not damaged and not missing, told)


def _file_checksums(cube: xr.Dataset) -> Finding:
    """Read all of a file; HDF5 compares each chunk with its checksum."""
    damaged = []
    for name in cube.data_vars:
        try:
            for _ in _by_record(cube[name]):
                pass
        except (OSError, RuntimeError) as error:
            damaged.append(f"{name} ({error})")
    if damaged:
        return Finding("checksums", False, f"cannot be read: {_listed(damaged)}; write the file again")
    return Finding("checksums", True, f"{len(cube.data_vars)} variables are whole")


def _statuses(cube: xr.Dataset) -> Finding:
    counts = status_counts(cube)
    told = ", ".join(f"{number} {meaning}" for meaning, number in counts.items())
    return Finding("statuses", set(counts) == {"ok"}, told)


def _numbers(cube: xr.Dataset) -> Finding:
    """Where the status is ok, every number must be one."""
    status = cube["status"]
    bad = []
    for name, array in cube.data_vars.items():
        if array.dtype.kind != "f":
            continue
        for values, codes in zip(_by_record(array), _by_record(status), strict=True):
            finite = np.isfinite(values)
            if array.dims[: status.ndim] == status.dims:
                # What each storey has of its own has one status for all storeys.
                finite |= (codes != 0).reshape(codes.shape + (1,) * (values.ndim - codes.ndim))
            if not finite.all():
                bad.append(str(name))
                break
    told = f"not finite in {', '.join(bad)}" if bad else "finite wherever the status is ok"
    return Finding("numbers", not bad, told)


def _energy(cube: xr.Dataset) -> Finding:
    if "energy_error" not in cube:
        return Finding("energy", None, "the sweep was made without the energy balance")
    worst = 0.0
    for errors, codes in zip(_by_record(cube["energy_error"]), _by_record(cube["status"]), strict=True):
        worst = max(worst, float(errors[codes == 0].max(initial=0.0)))
    return Finding("energy", worst <= ENERGY, f"error at most {worst:.2g} of the input, {ENERGY:g} allowed")


def _by_record(array: xr.DataArray) -> Iterator[NDArray[Any]]:
    for record in range(array.sizes["record"]):
        yield array.isel(record=record).values


def _listed(things: Iterable[object]) -> str:
    texts = [str(thing) for thing in things]
    more = f" and {len(texts) - LISTED} more" if len(texts) > LISTED else ""
    return ", ".join(texts[:LISTED]) + more
