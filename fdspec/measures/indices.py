"""Performance indices: one number a history that says how well the damper serves.

Each is written so that 1 is the bare frame and less is better, and so one record weighs as much as another
in an ensemble. The formulas take anything that maps names of variables to numbers or arrays: a cube, or the
plain arrays of a search.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from fdspec.errors import InvalidInput
from fdspec.measures.cells import ended_well, require

if TYPE_CHECKING:
    import xarray as xr

Values = Mapping[str, Any]
"""Name of a variable -> its numbers."""

Weights = Mapping[str, float]


@dataclass(frozen=True)
class Index:
    """An index: what it is called, which variables it takes, and its formula."""

    name: str
    long_name: str
    needs: tuple[str, ...]
    formula: Callable[[Values], Any]


def _rpi(values: Values) -> Any:
    """Filiatrault and Cherry (1990): RPI = (SEA / SEA_0 + U_max / U_max,0) / 2, index 0 the bare frame."""
    area = values["strain_energy_area"] / values["bare_strain_energy_area"]
    peak = values["peak_strain_energy"] / values["bare_peak_strain_energy"]
    return 0.5 * (area + peak)


INDICES: Final[Mapping[str, Index]] = MappingProxyType(
    {
        index.name: index
        for index in (
            Index(
                "acceleration",
                "peak absolute acceleration over the bare frame's",
                ("peak_acceleration", "elastic_acceleration"),
                lambda values: values["peak_acceleration"] / values["elastic_acceleration"],
            ),
            Index(
                "displacement",
                "peak displacement over the bare frame's",
                ("peak_displacement", "bare_peak_displacement"),
                lambda values: values["peak_displacement"] / values["bare_peak_displacement"],
            ),
            Index(
                "base_shear",
                "peak base shear over the bare frame's",
                ("peak_base_shear", "bare_peak_base_shear"),
                lambda values: values["peak_base_shear"] / values["bare_peak_base_shear"],
            ),
            Index(
                "rpi",
                "relative performance index of strain energy",
                (
                    "strain_energy_area",
                    "peak_strain_energy",
                    "bare_strain_energy_area",
                    "bare_peak_strain_energy",
                ),
                _rpi,
            ),
            Index(
                "dissipated_energy",
                "share of the input energy that friction does not dissipate",
                ("dissipated_energy", "input_energy"),
                lambda values: 1.0 - values["dissipated_energy"] / values["input_energy"],
            ),
        )
    }
)
"""The indices by name."""

WEIGHTED: Final = "weighted"
"""The name of a weighted sum of indices."""

EQUAL_WEIGHTS: Final[Weights] = MappingProxyType({"acceleration": 0.5, "displacement": 0.5})
"""What is weighted, and how, unless the user says otherwise."""


def weights_of(index: str | Weights) -> dict[str, float]:
    """Return an index as weights of the indices in `INDICES`, which add up to 1.

    index: a name of `INDICES`, "weighted" for `EQUAL_WEIGHTS`, or name -> weight.  Raises InvalidInput.
    """
    given: dict[str, Any] = {index: 1.0} if isinstance(index, str) else dict(index)
    if index == WEIGHTED:
        given = dict(EQUAL_WEIGHTS)
    if not given:
        raise InvalidInput("index must weigh at least one index, is empty")
    for name, weight in given.items():
        if name not in INDICES:
            raise InvalidInput(f"index: {name!r} is none of {', '.join((*INDICES, WEIGHTED))}")
        if not (isinstance(weight, int | float) and 0.0 < weight < float("inf")):
            raise InvalidInput(f"index: the weight of {name} must be positive and finite, got {weight!r}")
    total = sum(given.values())
    return {name: weight / total for name, weight in given.items()}


def needs_of(index: str | Weights) -> tuple[str, ...]:
    """Return the variables that an index takes; `fdspec.sweep` gives them as outputs."""
    needed = [name for part in weights_of(index) for name in INDICES[part].needs]
    return tuple(dict.fromkeys(needed))


def value_of(index: str | Weights, values: Values) -> Any:
    """Return an index, or the weighted sum of several, of these values."""
    parts = [weight * INDICES[name].formula(values) for name, weight in weights_of(index).items()]
    return sum(parts[1:], start=parts[0])


def name_of(index: str | Weights) -> str:
    """Return an index as a person reads it: acceleration, or 0.7 acceleration + 0.3 displacement."""
    weights = weights_of(index)
    if len(weights) == 1:
        return next(iter(weights))
    return " + ".join(f"{weight:.3g} {name}" for name, weight in weights.items())


def index_of(cube: xr.Dataset, index: str | Weights = "acceleration") -> xr.DataArray:
    """Compute one performance index of every cell of a cube: 1 is the bare frame, less is better.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with the outputs that `needs_of` names.
    index : str or mapping of str to float
        "acceleration", "displacement", "base_shear", "rpi" or "dissipated_energy"; "weighted", which is
        acceleration and displacement in equal parts; or name -> weight for a sum of your own, whose
        weights are scaled to add up to 1.

    Returns
    -------
    xarray.DataArray
        Over (record, stiffness_ratio, pretension, period), dimensionless; NaN where the history did
        not end well.

    Raises
    ------
    InvalidInput
        When the index is unknown or the cube lacks a variable.

    Notes
    -----
    "rpi" is the relative performance index of Filiatrault and Cherry (1990), J. Struct. Eng. 116(5), of the
    area under the strain-energy history and of its maximum.  The others are ratios of peaks, but for
    "dissipated_energy", which is the share of the input energy that friction leaves to the structure: the
    bare frame has no friction and leaves all of it.
    """
    needs = needs_of(index)
    require(cube, needs)
    values = {
        name: ended_well(cube, name) if "pretension" in cube[name].dims else cube[name] for name in needs
    }
    dims = ("record", "stiffness_ratio", "pretension", "period")
    found: xr.DataArray = value_of(index, values).transpose(*dims)
    weights = weights_of(index)
    long_name = INDICES[next(iter(weights))].long_name if len(weights) == 1 else name_of(index)
    return found.rename("index").assign_attrs(units="1", long_name=long_name)


def indices(
    cube: xr.Dataset, names: Iterable[str] | None = None, weights: Weights = EQUAL_WEIGHTS
) -> xr.Dataset:
    """Compute several performance indices side by side.

    The best pretension depends on the index, which the study names as an open question: put them beside
    each other before you choose.

    Parameters
    ----------
    cube : xarray.Dataset
        As for `index_of`.
    names : iterable of str, optional
        Indices, "weighted" among them; unless given, all for which the cube has the variables.
    weights : mapping of str to float
        What "weighted" means.

    Returns
    -------
    xarray.Dataset
        A variable an index, each as `index_of` returns it.
    """
    import xarray as xr

    def meant(name: str) -> str | Weights:
        return weights if name == WEIGHTED else name

    if names is None:
        names = [name for name in (*INDICES, WEIGHTED) if all(need in cube for need in needs_of(meant(name)))]
    found = {name: index_of(cube, meant(name)) for name in names}
    return xr.Dataset({name: value.rename(name) for name, value in found.items()})
