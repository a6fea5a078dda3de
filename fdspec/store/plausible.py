"""Whether numbers can be results at all: in which range each variable lies, whatever was swept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

HUGE: Final = 1e100
"""In SI units: far beyond any response of a building, far below where squares overflow."""

POSITIVE: Final = (
    "stiffness_ratio",
    "period",
    "stiffness_scale",
    "intensity",
    "dt",
    "samples",
    "bare_period",
    "braced_period",
)
NOT_NEGATIVE: Final = (
    "pretension",
    "slip_scale",
    "slip_force",
    "kinetic_slip_force",
    "brace_stiffness",
    "pga",
    "duration",
    "slip_travel",
    "transitions",
    "storey_transitions",
    "elastic_acceleration",
    "braced_acceleration",
    "strain_energy_area",
)
PREFIXES: Final = ("peak_", "bare_", "braced_")
ENDLESS: Final = ("pretension", "slip_scale", "slip_force", "kinetic_slip_force")
"""May be infinite: a damper that never slips."""

RISING: Final = (
    "stiffness_ratio",
    "pretension",
    "period",
    "stiffness_scale",
    "slip_scale",
    "intensity",
    "storey",
    "time",
)


def wrong_coordinates(dataset: xr.Dataset) -> Iterator[str]:
    """Give a sentence for each coordinate whose values cannot be right."""
    for key, array in dataset.coords.items():
        name, values = str(key), array.values
        if values.dtype.kind in "iuf":
            if told := wrong(name, values):
                yield f"{name} is {told}"
            elif name in RISING and array.dims == (name,) and not (np.diff(values) > 0).all():
                yield f"{name} does not increase"
        elif array.dims == (name,) and len(set(values.tolist())) < values.size:
            yield f"{name} holds a name twice"


def wrong(name: str, values: NDArray[Any]) -> str:
    """Say what is wrong with the values of a variable; empty where nothing is."""
    if values.size == 0:
        return ""
    if values.dtype.kind == "f":
        if np.isnan(values).any():
            return "not a number somewhere"
        if name not in ENDLESS and not np.isfinite(values).all():
            return "not finite somewhere"
        if (np.abs(values[np.isfinite(values)]) > HUGE).any():
            return "larger than any result somewhere"
    least = values.min()
    if name in POSITIVE and least <= 0:
        return "zero or negative somewhere"
    if (name in NOT_NEGATIVE or name.startswith(PREFIXES)) and least < 0:
        return "negative somewhere"
    return ""
