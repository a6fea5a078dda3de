"""How a Dataset stands in a file where the file cannot say it as memory does, and the way back.

Text: netCDF strings (NC_STRING) crash some versions of the netCDF4 library when files are reopened, and
Octave cannot read them, so text is stored as arrays of characters. Text as index, whichever way it is stored,
fails the CF checker; on disk an integer index takes its place and the text stands beside it: `record`,
`record_id`.

Time: CF keeps the dim `time` for dates. Seconds since the start of a ground motion are none, so on disk the
dim is `sample` and `time` stands along it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import StoreError

if TYPE_CHECKING:
    import xarray as xr

LABELS: Final = "fdspec_labels"
"""Attribute of an integer index on disk: the name of the variable that holds the index's text."""

DTYPE: Final = "fdspec_dtype"
"""Attribute of text on disk whose type in memory is not the narrowest fixed width."""

DIM: Final = "fdspec_dim"
"""Attribute of a variable on disk whose dim has another name there: the dim that it indexes in memory."""

_ON_DISK: Final = {"time": "sample"}
"""Dims in memory -> their names on disk."""


def is_text(variable: xr.Variable) -> bool:
    """Say whether a variable holds text, whichever way numpy stores it."""
    return getattr(variable.dtype, "kind", "O") in "UTO"


def to_disk(dataset: xr.Dataset) -> xr.Dataset:
    """Return `dataset` as a file holds it: text as narrow numpy strings, text indices as whole numbers."""
    renamed = {dim: other for dim, other in _ON_DISK.items() if dim in dataset.indexes}
    for name in renamed.values():
        _claim(name, dataset)
    coords = {str(name) for name in dataset.coords}
    variables: dict[str, xr.Variable] = {}
    for key, variable in dataset.variables.items():
        name = str(key)
        stored = _narrowest(name, variable) if is_text(variable) else variable.to_base_variable()
        if is_text(variable) and variable.dims == (name,):
            label = f"{name}_id"
            _claim(label, dataset)
            coords.add(label)
            variables[name] = _positions(name, stored)
            variables[label] = stored
        else:
            variables[name] = stored
        if name in renamed:
            variables[name] = _with_attrs(variables[name], {**variables[name].attrs, DIM: name})
    return _assemble(variables, coords, dataset.attrs, renamed)


def from_disk(dataset: xr.Dataset) -> xr.Dataset:
    """Return what `to_disk` was given; only text is loaded into memory."""
    labels = {
        str(variable.attrs[LABELS]) for variable in dataset.variables.values() if LABELS in variable.attrs
    }
    coords = {str(name) for name in dataset.coords} - labels
    renamed: dict[str, str] = {}
    variables: dict[str, xr.Variable] = {}
    for key, variable in dataset.variables.items():
        name = str(key)
        if name in labels:
            continue
        if DIM in variable.attrs:
            renamed[str(variable.dims[0])] = str(variable.attrs[DIM])
        of_text = LABELS in variable.attrs
        stored = (dataset.variables[variable.attrs[LABELS]] if of_text else variable).to_base_variable()
        stored = _with_attrs(stored, {key: value for key, value in stored.attrs.items() if key != DIM})
        variables[name] = _restored(stored) if is_text(stored) else stored
    return _assemble(variables, coords, dataset.attrs, renamed)


def _assemble(
    variables: dict[str, xr.Variable], coords: set[str], attrs: dict[Any, Any], renamed: dict[str, str]
) -> xr.Dataset:
    import xarray as xr

    for name, variable in variables.items():
        if renamed.keys() & set(variable.dims):
            dims = [renamed.get(str(dim), str(dim)) for dim in variable.dims]
            variables[name] = variable.copy(deep=False)
            variables[name].dims = dims
    return xr.Dataset(variables, attrs=attrs).set_coords(coords)


def _claim(name: str, dataset: xr.Dataset) -> None:
    if name in dataset.dims or name in dataset.variables:
        raise StoreError(f"a file needs the name {name!r} for itself; rename that variable or dim")


def _positions(name: str, labels: xr.Variable) -> xr.Variable:
    import xarray as xr

    about = {"long_name": f"position along {name}, counted from 0", LABELS: f"{name}_id"}
    return xr.Variable(labels.dims, np.arange(labels.size, dtype=np.int32), about)


def _with_attrs(variable: xr.Variable, attrs: dict[Any, Any]) -> xr.Variable:
    changed = variable.copy(deep=False)
    changed.attrs = attrs
    return changed


def _narrowest(name: str, variable: xr.Variable) -> xr.Variable:
    import xarray as xr

    values = np.asarray(variable.values)
    if not all(isinstance(value, str) for value in values.flat):
        raise StoreError(
            f"variable {name!r} holds objects that are no text; a file has numbers and text only"
        )
    narrow = _as_narrow(values)
    attrs = dict(variable.attrs)
    if narrow.dtype != values.dtype:
        attrs[DTYPE] = "StringDType" if values.dtype.kind == "T" else values.dtype.str
    return xr.Variable(variable.dims, narrow, attrs)


def _restored(variable: xr.Variable) -> xr.Variable:
    import xarray as xr

    attrs = dict(variable.attrs)
    values = _as_narrow(np.asarray(variable.values))
    dtype = attrs.pop(DTYPE, None)
    if dtype is not None:
        values = values.astype(np.dtypes.StringDType() if dtype == "StringDType" else dtype)
    return xr.Variable(variable.dims, values, attrs)


def _as_narrow(values: NDArray[Any]) -> NDArray[Any]:
    """Return text at the width of its longest; numpy measures it only on the way from objects."""
    return values.astype(object).astype(str)
