"""A building with devices as the kernel for them takes it: springs between nodes, and links."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from fdspec.kernels.devices import layout as row
from fdspec.model.building_check import Array, read_only
from fdspec.model.link import Link, TensionBrace
from fdspec.model.springs import Linkage
from fdspec.model.standing import carried

IntArray = NDArray[np.int64]

COLLAPSE_DRIFT_RATIO = 0.1
"""Share of a storey's height at whose drift a frame that may lose its stability counts as collapsed."""

BEYOND_STRENGTH = 10.0
"""Where no height is known: multiple of the drift at which softening columns have lost all their strength."""


class DeviceFrame(NamedTuple):
    """Arrays of `fdspec.kernels.devices.layout.Frame`, and which link is what."""

    mass: Array
    ends: IntArray
    springs: Array
    dense_stiffness: Array
    dense_damping: Array
    places: IntArray
    links: Array
    drift_limit: Array
    below: IntArray
    carried: NDArray[np.bool_]
    dampers: IntArray
    """(N,) place of each storey's damper among the links, -1 where it has none."""
    columns: IntArray
    """(N,) place of the yielding part of each storey's columns, -1 where they stay elastic."""
    others: IntArray
    """(M,) places of the building's `links`, in their order."""
    fastened: Array
    """(L,) slip offset of each link in the frame at rest, m: the slack of a one-sided brace."""


class _Storeys(Protocol):
    """What is asked of a `fdspec.Building`, which imports this module: arrays over storeys, and its links."""

    @property
    def floor_mass(self) -> Array: ...
    @property
    def brace_mass(self) -> Array: ...
    @property
    def brace_stiffness(self) -> Array: ...
    @property
    def brace_damping(self) -> Array: ...
    @property
    def slip_force(self) -> Array: ...
    @property
    def kinetic_slip_force(self) -> Array: ...
    @property
    def slot_length(self) -> Array: ...
    @property
    def slot_stiffness(self) -> Array: ...
    @property
    def recentring_stiffness(self) -> Array: ...
    @property
    def yield_shear(self) -> Array: ...
    @property
    def hardening_ratio(self) -> Array: ...
    @property
    def gravity_load(self) -> Array: ...
    @property
    def storey_height(self) -> Array: ...
    @property
    def collapse_drift(self) -> Array: ...
    @property
    def stands_on(self) -> IntArray: ...
    @property
    def links(self) -> tuple[Link | TensionBrace, ...]: ...


def device_frame(building: _Storeys, stiffness: Linkage, damping: Linkage) -> DeviceFrame:
    """Return the arrays of a building; stiffness and damping are those of its elastic bare frame."""
    size = building.floor_mass.size
    yields = building.yield_shear < np.inf
    share = np.where(yields, building.hardening_ratio, 1.0)
    with np.errstate(invalid="ignore"):
        gravity = np.nan_to_num(building.gravity_load / building.storey_height)
    floors, below = np.arange(1, size + 1), building.stands_on
    ends = np.stack([np.concatenate([floors, floors]), np.concatenate([below, np.zeros(size)])])
    nothing = np.zeros(size)
    springs = np.stack(
        [
            np.concatenate([share * stiffness.storey, stiffness.ground]),
            np.concatenate([damping.storey, damping.ground]),
            np.concatenate([gravity, nothing]),
        ]
    )
    there = springs.any(axis=0)
    places: list[list[int]] = []
    links: list[dict[int, float]] = []
    dampers = np.full(size, -1)
    columns = np.full(size, -1)
    for i in range(size):
        if building.brace_stiffness[i] > 0.0:
            dampers[i] = len(places)
            mass, dashpot = float(building.brace_mass[i]), float(building.brace_damping[i])
            places.append([i + 1, int(below[i]), _kind(mass, dashpot), 0])
            links.append(
                {
                    row.MASS: mass,
                    row.STIFFNESS: building.brace_stiffness[i],
                    row.DAMPING: dashpot,
                    row.STATIC: building.slip_force[i],
                    row.KINETIC: building.kinetic_slip_force[i],
                    row.SLOT_LENGTH: building.slot_length[i],
                    row.SLOT_STIFFNESS: building.slot_stiffness[i],
                    row.RECENTRING: building.recentring_stiffness[i],
                }
            )
    for i in map(int, np.flatnonzero(yields)):
        columns[i] = len(places)
        places.append([i + 1, int(below[i]), row.WITHOUT_MASS, 0])
        force = (1.0 - share[i]) * building.yield_shear[i]
        links.append(
            {
                row.STIFFNESS: (1.0 - share[i]) * stiffness.storey[i],
                row.STATIC: force,
                row.KINETIC: force,
                row.SLOT_LENGTH: np.inf,
                row.BESIDE: share[i] * stiffness.storey[i],
            }
        )
    others = len(places) + np.arange(len(building.links))
    for link in building.links:
        place, numbers = _numbers(link)
        places.append(place)
        links.append(numbers)
    fastened = np.zeros(len(links))
    fastened[others] = [link.slack if isinstance(link, TensionBrace) else 0.0 for link in building.links]
    table = np.zeros((row.LINK_ROWS, len(links)))
    for j, numbers in enumerate(links):
        for at, value in numbers.items():
            table[at, j] = value
    return DeviceFrame(
        read_only(np.append(np.inf, building.floor_mass)),
        _places(ends[:, there]),
        read_only(np.ascontiguousarray(springs[:, there])),
        stiffness.dense,
        damping.dense,
        _places(np.asarray(places, dtype=np.int64).reshape(-1, row.PLACE_ROWS).T),
        read_only(table),
        read_only(_drift_limit(building, gravity, stiffness)),
        below,
        carried(below),
        dampers,
        columns,
        others,
        read_only(fastened),
    )


def _places(array: NDArray[np.generic]) -> IntArray:
    places = np.ascontiguousarray(array, dtype=np.int64)
    places.flags.writeable = False
    return places


def _kind(mass: float, dashpot: float) -> int:
    if mass > 0.0:
        return row.WITH_MASS
    return row.WITH_DASHPOT if dashpot > 0.0 else row.WITHOUT_MASS


def _numbers(link: Link | TensionBrace) -> tuple[list[int], dict[int, float]]:
    if isinstance(link, TensionBrace):
        return [link.upper, link.lower, row.ONE_SIDED, 0], {
            row.STIFFNESS: link.stiffness,
            row.STATIC: link.yield_force,
            row.KINETIC: link.yield_force,
            row.SLOT_LENGTH: np.inf,
            row.DIRECTION: float(link.direction),
        }
    kinked = link.recentring_preload > 0.0 or link.friction_stiffness > 0.0
    return [link.upper, link.lower, _kind(link.mass, 0.0), int(kinked)], {
        row.MASS: link.mass,
        row.STIFFNESS: link.stiffness,
        row.STATIC: link.slip_force,
        row.KINETIC: link.kinetic_slip_force,
        row.SLOT_LENGTH: link.slot_length,
        row.SLOT_STIFFNESS: link.slot_stiffness,
        row.RECENTRING: link.recentring_stiffness,
        row.PRELOAD: link.recentring_preload,
        row.FRICTION_GROWTH: link.friction_stiffness,
    }


def _drift_limit(building: _Storeys, gravity: Array, stiffness: Linkage) -> Array:
    """Return the drift at which each storey counts as collapsed, m, (N,)."""
    softens = (building.yield_shear < np.inf) & (building.hardening_ratio < 0.0)
    usual = np.full(building.floor_mass.size, np.inf)
    if gravity.any() or softens.any():
        with np.errstate(divide="ignore", invalid="ignore"):
            lost = building.yield_shear / stiffness.storey * (1.0 - 1.0 / building.hardening_ratio)
        usual = np.where(softens, BEYOND_STRENGTH * lost, np.inf)
        known = ~np.isnan(building.storey_height)
        usual[known] = COLLAPSE_DRIFT_RATIO * building.storey_height[known]
    return np.where(np.isnan(building.collapse_drift), usual, building.collapse_drift)
