"""Arrays with words about them, as bytes that a browser unpacks in one step."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def pack(about: Mapping[str, Any], arrays: Mapping[str, ArrayLike]) -> bytes:
    """Return a length (uint32), JSON of that length, and float64 numbers, all little-endian.

    The JSON holds `about` and, under ``arrays``, name -> [first number, count]. It is padded with blanks so
    that the numbers start at a multiple of 8, as a browser's Float64Array demands. NaN passes as a number;
    JSON has none, so `about` must hold none.
    """
    numbers = {name: np.ravel(np.asarray(values, dtype="<f8")) for name, values in arrays.items()}
    places, first = {}, 0
    for name, values in numbers.items():
        places[name] = [first, values.size]
        first += values.size
    head = json.dumps({**about, "arrays": places}, allow_nan=False).encode()
    head += b" " * (-(4 + len(head)) % 8)
    return len(head).to_bytes(4, "little") + head + b"".join(values.tobytes() for values in numbers.values())
