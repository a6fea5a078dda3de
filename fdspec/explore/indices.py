"""The indices that the page offers: what is read off a cell, in units a reader has at hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True)
class Index:
    """One index over (stiffness_ratio, pretension, period) of one record.

    `reads` are the variables of the cube that `values` needs; `best` says which end is good, or that neither
    is and no best pretension can be told.
    """

    name: str
    title: str
    unit: str
    best: Literal["least", "most", ""]
    reads: tuple[str, ...]
    values: Callable[[xr.Dataset], xr.DataArray]


def _scaled(name: str, factor: float) -> Callable[[xr.Dataset], xr.DataArray]:
    return lambda one: one[name] * factor


def _share(name: str, of: str) -> Callable[[xr.Dataset], xr.DataArray]:
    return lambda one: one[name] / one[of] * 100.0


INDICES: Final = (
    Index(
        "acceleration",
        "Peak absolute acceleration",
        "g",
        "least",
        ("peak_acceleration",),
        _scaled("peak_acceleration", 1.0 / G),
    ),
    Index(
        "acceleration_to_bare",
        "Acceleration against the bare frame",
        "%",
        "least",
        ("peak_acceleration", "elastic_acceleration"),
        _share("peak_acceleration", "elastic_acceleration"),
    ),
    Index(
        "acceleration_to_braced",
        "Acceleration against the braced frame",
        "%",
        "least",
        ("peak_acceleration", "braced_acceleration"),
        _share("peak_acceleration", "braced_acceleration"),
    ),
    Index(
        "displacement",
        "Peak displacement",
        "mm",
        "least",
        ("peak_displacement",),
        _scaled("peak_displacement", 1e3),
    ),
    Index("velocity", "Peak velocity", "m/s", "least", ("peak_velocity",), _scaled("peak_velocity", 1.0)),
    Index(
        "base_shear",
        "Peak base shear",
        "kN",
        "least",
        ("peak_base_shear",),
        _scaled("peak_base_shear", 1e-3),
    ),
    Index(
        "residual",
        "Residual displacement",
        "mm",
        "least",
        ("residual_displacement",),
        lambda one: abs(one["residual_displacement"]) * 1e3,
    ),
    Index(
        "dissipated",
        "Energy dissipated by friction",
        "kJ",
        "most",
        ("dissipated_energy",),
        _scaled("dissipated_energy", 1e-3),
    ),
    Index(
        "dissipated_share",
        "Share of the input energy dissipated by friction",
        "%",
        "most",
        ("dissipated_energy", "input_energy"),
        _share("dissipated_energy", "input_energy"),
    ),
    Index("travel", "Slip travel", "m", "", ("slip_travel",), _scaled("slip_travel", 1.0)),
    Index("transitions", "Changes of phase", "", "", ("transitions",), _scaled("transitions", 1.0)),
)


def known_indices(cube: xr.Dataset) -> tuple[Index, ...]:
    """Return the indices that a cube holds all variables for."""
    return tuple(index for index in INDICES if all(name in cube for name in index.reads))
