"""What the numbers of columns, slots and gravity must be: one a storey, and such that they fit together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.building_check import Array, numbers, per_storey, read_only
from fdspec.model.link import Link, TensionBrace
from fdspec.model.standing import IntArray, spring_matrix

NONE = {
    "storey_height": np.nan,
    "yield_shear": np.inf,
    "hardening_ratio": 0.0,
    "gravity_load": 0.0,
    "slot_length": np.inf,
    "slot_stiffness": 0.0,
    "recentring_stiffness": 0.0,
    "collapse_drift": np.nan,
}
"""What stands for a device that is not there."""

_WANTED = {
    "storey_height": "positive and finite, in m",
    "yield_shear": "positive, in N (inf never yields)",
    "hardening_ratio": "less than 1 (0 is elastoplastic, negative softens)",
    "gravity_load": "0 or more and finite, in N",
    "slot_length": "positive, in m (inf has no end)",
    "slot_stiffness": "0 or more and finite, in N/m",
    "recentring_stiffness": "0 or more and finite, in N/m",
    "collapse_drift": "positive, in m (inf never counts as collapsed)",
}


def device_fields(
    given: Mapping[str, ArrayLike | None], fields: Mapping[str, Array], stands_on: IntArray
) -> dict[str, Array]:
    """Return one number a storey of each device parameter, or say which cannot be used.

    given: what the caller handed over, by name.  fields: the building's other numbers, checked;
    stands_on: the floor below each storey.
    """
    size = fields["floor_mass"].size
    arrays = {name: numbers(name, NONE[name] if value is None else value) for name, value in given.items()}
    devices = {name: per_storey(name, array, size) for name, array in arrays.items()}
    with np.errstate(invalid="ignore"):
        good = {
            "storey_height": (devices["storey_height"] > 0.0) & np.isfinite(devices["storey_height"]),
            "yield_shear": devices["yield_shear"] > 0.0,
            "hardening_ratio": (devices["hardening_ratio"] < 1.0) & np.isfinite(devices["hardening_ratio"]),
            "gravity_load": (devices["gravity_load"] >= 0.0) & np.isfinite(devices["gravity_load"]),
            "slot_length": devices["slot_length"] > 0.0,
            "slot_stiffness": (devices["slot_stiffness"] >= 0.0) & np.isfinite(devices["slot_stiffness"]),
            "recentring_stiffness": (devices["recentring_stiffness"] >= 0.0)
            & np.isfinite(devices["recentring_stiffness"]),
            "collapse_drift": devices["collapse_drift"] > 0.0,
        }
    for name, right in good.items():
        # Not a number throughout is what an unknown height is kept as; `dataclasses.replace` hands it back.
        if given[name] is not None and not (np.isnan(NONE[name]) and np.isnan(devices[name]).all()):
            _demand(name, devices[name], right, _WANTED[name])
    _fit_together(devices, fields, stands_on)
    return devices


def _demand(name: str, array: Array, right: NDArray[np.bool_], wanted: str) -> None:
    if not right.all():
        first = int(np.argmin(right))
        where = f" in storey {first + 1}" if array.size > 1 else ""
        raise InvalidInput(f"{name} must be {wanted}, not {float(array[first])!r}{where}")


def _fit_together(devices: Mapping[str, Array], fields: Mapping[str, Array], stands_on: IntArray) -> None:
    _needs(
        devices["slot_length"] < np.inf,
        devices["slot_stiffness"] > 0.0,
        "slot_stiffness must be positive, in N/m, where slot_length is given",
    )
    _needs(
        devices["gravity_load"] > 0.0,
        ~np.isnan(devices["storey_height"]),
        "storey_height must be given, in m, where gravity_load is",
    )
    braced = fields["brace_stiffness"] > 0.0
    for name, there in (
        ("slot_length", devices["slot_length"] < np.inf),
        ("recentring_stiffness", devices["recentring_stiffness"] > 0.0),
    ):
        _needs(there, braced, f"{name} needs a brace: it acts across the damper, and brace_stiffness is 0")
    stiffness = fields["storey_stiffness"]
    if stiffness.ndim == 2 and (devices["yield_shear"] < np.inf).any():
        raise InvalidInput(
            "yield_shear needs storey_stiffness as one number a storey: a matrix does not say which part of "
            "it a storey's columns are"
        )
    with np.errstate(invalid="ignore"):
        gravity = np.nan_to_num(devices["gravity_load"] / devices["storey_height"])
    if not gravity.any():
        return
    if stiffness.ndim == 1:
        _needs(
            gravity > 0.0,
            stiffness > gravity,
            "gravity_load is beyond elastic stability: gravity_load / storey_height must be less than "
            "storey_stiffness",
            lambda i: f"{gravity[i]:g} N/m against {stiffness[i]:g} N/m",
        )
    elif float(np.linalg.eigvalsh(stiffness - spring_matrix(gravity, stands_on))[0]) <= 0.0:
        raise InvalidInput(
            "gravity_load is beyond elastic stability: stiffness less gravity_load / storey_height between "
            "the floors must be positive definite"
        )


def _needs(where: NDArray[np.bool_], what: NDArray[np.bool_], text: str, figures: object = None) -> None:
    good = ~where | what
    if not good.all():
        first = int(np.argmin(good))
        more = f": {figures(first)}" if callable(figures) else ""
        place = f" (storey {first + 1})" if good.size > 1 else ""
        raise InvalidInput(f"{text}{more}{place}")


def checked_links(links: object, size: int) -> tuple[Link | TensionBrace, ...]:
    """Return the links as a tuple, or say which does not fit a building of this many storeys."""
    if isinstance(links, Link | TensionBrace):
        links = (links,)
    if not isinstance(links, Iterable):
        raise InvalidInput(f"links must be a sequence of Link or TensionBrace, not {links!r}")
    members = tuple(links)
    for number, link in enumerate(members, start=1):
        if not isinstance(link, Link | TensionBrace):
            raise InvalidInput(f"links must be Link or TensionBrace, but number {number} is {link!r}")
        if max(link.upper, link.lower) > size:
            raise InvalidInput(
                f"link {link.name or number} joins floor {max(link.upper, link.lower)}, but the building has "
                f"{size} storeys"
            )
    names = [link.name for link in members if link.name is not None]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InvalidInput(f"links must have different names, but {', '.join(twice)} comes twice")
    return members


def no_devices(size: int) -> dict[str, Array]:
    """Return the parameters of a building of so many storeys without any device."""
    return {name: read_only(np.full(size, value)) for name, value in NONE.items()}
