"""What the tests of fdspec explore share: a small cube, and the counterpart of its packing."""

import gzip
import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import fdspec
from fdspec.model.motion import GroundMotion

PERIOD = [0.2, 0.35, 0.5, 0.8, 1.2, 2.0]
PRETENSION = [20e3, 60e3, 110e3, 210e3, 500e3]
STIFFNESS_RATIO = [1.0, 4.0, 8.0]


def own_motion(name: str = "mine") -> GroundMotion:
    """Return 6 s of a decaying sine of 0.3 g."""
    time = 0.01 * np.arange(600)
    return GroundMotion(3.0 * np.sin(9.0 * time) * np.exp(-0.3 * time), 0.01, name=name)


def small_cube(*motions: GroundMotion, **changed: Any) -> xr.Dataset:
    """Sweep FSR1 and FMR1, or these motions, over 90 cells each."""
    given = motions or (fdspec.load_record("FSR1"), fdspec.load_record("FMR1"))
    axes: dict[str, Any] = {"period": PERIOD, "pretension": PRETENSION, "stiffness_ratio": STIFFNESS_RATIO}
    return fdspec.sweep(given, **{**axes, **changed})


def unpack(packed: bytes) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
    """Take what `fdspec.explore.packing.pack` returns apart, by its description."""
    length = int.from_bytes(packed[:4], "little")
    about = json.loads(packed[4 : 4 + length])
    numbers = np.frombuffer(packed[4 + length :], "<f8")
    places = about.pop("arrays")
    return about, {name: numbers[first : first + count] for name, (first, count) in places.items()}


def record_numbers(compressed: bytes) -> dict[str, NDArray[np.float64]]:
    """Return the arrays of what `Content.record` returns."""
    return unpack(gzip.decompress(compressed))[1]
