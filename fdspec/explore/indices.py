"""The indices that the page offers: what is read off a cell, in units a reader has at hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

from fdspec.measures import index_of, needs_of, reduction
from fdspec.measures.cells import ended_well
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

Values = Callable[["xr.Dataset"], "xr.DataArray"]
"""From a cube to an index over all four of its dims, NaN where a history did not end well."""


@dataclass(frozen=True, slots=True)
class Index:
    """One index of the page.

    `reads` are the variables of the cube that `values` needs; `best` says which end is good, or that neither
    is and no best pretension can be told. Where `fdspec.best_pretension` can search between the cube's
    pretensions, `measure` is its name for the index and `refined` reads the index off what it returns.
    Colours end at `colours`, low and high, where the index goes far beyond what anybody would choose.
    `neutral` is the value at which the damper neither helps nor harms: colours part there.
    """

    name: str
    title: str
    unit: str
    best: Literal["least", "most", ""]
    reads: tuple[str, ...]
    values: Values
    measure: str = ""
    refined: Values | None = None
    colours: tuple[float | None, float | None] = (None, None)
    neutral: float | None = None


def _scaled(name: str, factor: float) -> Values:
    return lambda cube: ended_well(cube, name) * factor


def _reduced(against: str) -> Values:
    return lambda cube: 100.0 * reduction(cube)[against]


def _judged(name: str) -> Values:
    return lambda cube: index_of(cube, name)


def _judged_index(name: str, title: str) -> Index:
    return Index(
        f"{name}_index",
        title,
        "",
        "least",
        needs_of(name),
        _judged(name),
        name,
        lambda best: best["index"],
        (None, 2.0),
        1.0,
    )


INDICES: Final = (
    Index(
        "acceleration",
        "Peak absolute acceleration",
        "g",
        "least",
        ("peak_acceleration",),
        _scaled("peak_acceleration", 1.0 / G),
        "acceleration",
        lambda best: best["peak_acceleration"] / G,
    ),
    Index(
        "reduction_to_bare",
        "Reduction of acceleration against the bare frame",
        "%",
        "most",
        ("peak_acceleration", "elastic_acceleration", "braced_acceleration"),
        _reduced("against_bare"),
        "acceleration",
        lambda best: 100.0 * (1.0 - best["index"]),
        (-100.0, None),
        0.0,
    ),
    Index(
        "reduction_to_braced",
        "Reduction of acceleration against the braced frame",
        "%",
        "most",
        ("peak_acceleration", "elastic_acceleration", "braced_acceleration"),
        _reduced("against_braced"),
        "acceleration",
        lambda best: 100.0 * (1.0 - best["peak_acceleration"] / best["braced_acceleration"]),
        (-100.0, None),
        0.0,
    ),
    Index(
        "displacement",
        "Peak displacement",
        "mm",
        "least",
        ("peak_displacement",),
        _scaled("peak_displacement", 1e3),
        "displacement",
        lambda best: best["peak_displacement"] * 1e3,
    ),
    Index("velocity", "Peak velocity", "m/s", "least", ("peak_velocity",), _scaled("peak_velocity", 1.0)),
    Index(
        "base_shear",
        "Peak base shear",
        "kN",
        "least",
        ("peak_base_shear",),
        _scaled("peak_base_shear", 1e-3),
        "base_shear",
        lambda best: best["peak_base_shear"] * 1e-3,
    ),
    _judged_index("displacement", "Displacement over the bare frame's"),
    _judged_index("base_shear", "Base shear over the bare frame's"),
    _judged_index("rpi", "Relative performance index of strain energy"),
    _judged_index("weighted", "Acceleration and displacement over the bare frame's, mean"),
    Index(
        "residual",
        "Residual displacement",
        "mm",
        "least",
        ("residual_displacement",),
        lambda cube: abs(ended_well(cube, "residual_displacement")) * 1e3,
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
        needs_of("dissipated_energy"),
        lambda cube: 100.0 * (1.0 - index_of(cube, "dissipated_energy")),
        "dissipated_energy",
        lambda best: 100.0 * (1.0 - best["index"]),
    ),
    Index("travel", "Slip travel", "m", "", ("slip_travel",), _scaled("slip_travel", 1.0)),
    Index("transitions", "Changes of phase", "", "", ("transitions",), _scaled("transitions", 1.0)),
)


def known_indices(cube: xr.Dataset) -> tuple[Index, ...]:
    """Return the indices that a cube holds all variables for."""
    return tuple(index for index in INDICES if all(name in cube for name in index.reads))
