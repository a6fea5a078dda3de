"""What a file says of every array in it, so that damage is seen whatever it met.

HDF5 and Zarr guard the chunks of large variables alone.  Here each variable, coordinates included, has a
CRC-32C over its dims, shape, type, attributes and numbers, and the dataset one over its attributes and the
names of its variables.  They are those of the dataset in memory: what `open` gives, not how a file holds it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.store.layout import is_text

if TYPE_CHECKING:
    import xarray as xr

CHECKSUMS: Final = "fdspec_checksums"
"""Global attribute on disk alone: name of a variable -> its checksum, as JSON; "" stands for the dataset."""


PORTION: Final = 1 << 24
"""Bytes that are copied at a time: the library takes no views of arrays."""

BYTES: Final = 4
"""Length of a chunk's own checksum, at its end."""


def is_whole(content: bytes) -> bool:
    """Whether a chunk ends in the checksum of what comes before."""
    return len(content) > BYTES and of_bytes(content[:-BYTES]) == int.from_bytes(content[-BYTES:], "little")


def of_bytes(content: bytes, before: int = 0) -> int:
    """Return the CRC-32C of bytes that follow those with the checksum `before`."""
    from google_crc32c import extend

    checksum: int = extend(before, content)
    return checksum


def of_variable(variable: xr.Variable) -> str:
    """Return the checksum of one variable, 8 hexadecimal digits; its numbers are read."""
    return f"{of_values(variable.values, started(variable)):08x}"


def started(variable: xr.Variable) -> int:
    """Return the checksum of all that a variable has but its numbers."""
    dtype = "text" if is_text(variable) else variable.dtype.newbyteorder("<").str
    head = [list(map(str, variable.dims)), list(variable.shape), dtype, _attributes(variable.attrs)]
    return of_bytes(json.dumps(head).encode())


def of_values(values: NDArray[Any], before: int) -> int:
    """Go on with numbers, or text, in the order of C."""
    if values.dtype.kind in "UTO":
        return of_bytes(json.dumps(values.tolist()).encode(), before)
    plain = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    flat = plain.reshape(-1).view(np.uint8)
    for first in range(0, flat.size, PORTION):
        before = of_bytes(flat[first : first + PORTION].tobytes(), before)
    return before


def of_dataset(dataset: xr.Dataset) -> str:
    """Return the checksum of a dataset's own attributes, and of which variables and coordinates it has."""
    names = [sorted(map(str, dataset.variables)), sorted(map(str, dataset.coords))]
    return f"{of_bytes(json.dumps([names, _attributes(dataset.attrs)]).encode()):08x}"


def of_all(dataset: xr.Dataset) -> dict[str, str]:
    """Return the checksums of a dataset that is in memory."""
    return {
        "": of_dataset(dataset),
        **{str(name): of_variable(variable) for name, variable in dataset.variables.items()},
    }


def differing(dataset: xr.Dataset, told: Mapping[str, str], names: Iterable[Any]) -> list[str]:
    """Return what of these variables, or of the dataset's attributes, is not as its checksum tells."""
    found = [] if told.get("") == of_dataset(dataset) else ["the attributes"]
    return found + [str(one) for one in names if told.get(str(one)) != of_variable(dataset.variables[one])]


def _attributes(attributes: Mapping[Any, Any]) -> list[list[Any]]:
    return [[str(key), *_plain(value)] for key, value in attributes.items()]


def _plain(value: Any) -> list[Any]:
    if isinstance(value, str):
        return [value]
    array = np.asarray(value)
    return [array.dtype.newbyteorder("<").str, array.tolist()]
