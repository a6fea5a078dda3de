"""What a building's numbers must be: one a storey, of the right sign, and such that they fit together."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput

Array = NDArray[np.float64]


def read_only(array: Array) -> Array:
    """Return the array itself, closed to writing."""
    array.flags.writeable = False
    return array


def numbers(argument: str, value: ArrayLike) -> Array:
    """Return a copy as float64 of at most one dimension."""
    try:
        given = np.asarray(value)
    except ValueError as error:
        raise InvalidInput(f"{argument} must be a number or one number a storey ({error})") from error
    if given.dtype.kind not in "iuf":
        raise InvalidInput(f"{argument} must be a number or one number a storey, not {value!r}")
    if given.ndim > 1 or given.size == 0:
        raise InvalidInput(f"{argument} must be a number or have shape (N,), not shape {given.shape}")
    return np.array(given, dtype=np.float64)


def per_storey(argument: str, array: Array, size: int) -> Array:
    """Return one value a storey, or say that there are too many or too few."""
    if array.size not in (1, size):
        raise InvalidInput(
            f"{argument} has {array.size} values, but the building has {size} storeys: give 1 or {size}"
        )
    # A fresh contiguous copy: kernels take no strided views.
    return read_only(np.array(np.broadcast_to(array, (size,)), order="C"))


def require(argument: str, array: Array, right: NDArray[np.bool_], wanted: str) -> None:
    """Refuse the first value that is not right or not finite."""
    good = right & np.isfinite(array)
    if not good.all():
        _refuse(argument, array, good, wanted)


def _refuse(argument: str, array: Array, good: NDArray[np.bool_], wanted: str) -> None:
    first = int(np.argmin(good))
    where = f" in storey {first + 1}" if array.size > 1 else ""
    raise InvalidInput(f"{argument} must be {wanted}, not {float(array[first])!r}{where}")


def refuse_impossible(fields: dict[str, Array]) -> None:
    """Refuse values that no building has."""
    require("floor_mass", fields["floor_mass"], fields["floor_mass"] > 0.0, "positive and finite, in kg")
    stiffness = fields["storey_stiffness"]
    if stiffness.ndim == 1:
        require("storey_stiffness", stiffness, stiffness > 0.0, "positive and finite, in N/m")
    else:
        lowest = float(np.linalg.eigvalsh(stiffness)[0])
        if lowest <= 0.0:
            raise InvalidInput(
                f"stiffness must be positive definite, but its lowest eigenvalue is {lowest:g} N/m"
            )
    for name, unit in (("brace_mass", "kg"), ("brace_stiffness", "N/m"), ("brace_damping", "N s/m")):
        require(name, fields[name], fields[name] >= 0.0, f"0 or more and finite, in {unit}")
    static, kinetic = fields["slip_force"], fields["kinetic_slip_force"]
    for name, force in (("slip_force", static), ("kinetic_slip_force", kinetic)):
        good = force >= 0.0  # false for NaN; infinity is a damper that never slips
        if not good.all():
            _refuse(name, force, good, "0 or more, in N (inf never slips)")
    if not (kinetic <= static).all():
        first = int(np.argmin(kinetic <= static))
        raise InvalidInput(
            f"kinetic_slip_force must be at most slip_force, but storey {first + 1} has "
            f"{kinetic[first]:g} over {static[first]:g} N"
        )
    for name in ("brace_mass", "slip_force", "brace_damping"):
        good = (fields["brace_stiffness"] > 0.0) | (fields[name] == 0.0)
        if not good.all():
            _refuse(name, fields[name], good, "0 where there is no brace (brace_stiffness 0)")
