"""The grid of a sweep over buildings: these and two axes of factors on their dampers, validated once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import natural_modes
from fdspec.model.grid import FloatArray, axis

IntArray = NDArray[np.int64]
Buildings = Building | Sequence[Building] | Mapping[str, Building]


@dataclass(frozen=True, init=False, eq=False)
class BuildingGrid:
    """Hold the axes of a sweep over buildings.

    Parameters
    ----------
    buildings : Building, sequence of them, or mapping of names to them
        All with the same number of storeys. Without names they are "1", "2" and so on.
    stiffness_scale : array_like, shape (n_k,)
        Factors on the stiffness of all braces, positive. The dashpot beside each brace goes with the
        square root, so that the brace keeps its own damping ratio.
    slip_scale : array_like, shape (n_s,)
        Factors on all slip forces, static and kinetic: 0 slides freely, infinity never. A slip force that
        is 0 or infinite stays so under every factor.
    intensity : array_like, shape (n_i,), optional
        Factors on the ground motions, positive; without them the cube has no such axis.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text names it, the value and its index.
    """

    names: tuple[str, ...]
    buildings: tuple[Building, ...]
    stiffness_scale: FloatArray
    slip_scale: FloatArray
    intensity: FloatArray | None

    # A dataclass would demand the checked fields themselves; callers may hand over any numbers.
    def __init__(
        self,
        buildings: Buildings,
        stiffness_scale: ArrayLike,
        slip_scale: ArrayLike,
        intensity: ArrayLike | None = None,
    ) -> None:
        names, members = _named(buildings)
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "buildings", members)
        for name, value, free in (
            ("stiffness_scale", stiffness_scale, False),
            ("slip_scale", slip_scale, True),
            ("intensity", intensity, False),
        ):
            try:
                given = (
                    None if value is None and name == "intensity" else axis(value, zero=free, infinite=free)
                )
                object.__setattr__(self, name, given)
            except ValueError as error:
                raise InvalidInput(f"{name}: {error}") from None

    def with_intensity(self, intensity: ArrayLike) -> BuildingGrid:
        """Return the same grid over these factors on the ground motions."""
        members = dict(zip(self.names, self.buildings, strict=True))
        return BuildingGrid(members, self.stiffness_scale, self.slip_scale, intensity)

    def part(self, building: IntArray, stiffness: IntArray, slip: IntArray) -> BuildingGrid:
        """Return the grid of these positions along each axis."""
        return BuildingGrid(
            {self.names[k]: self.buildings[k] for k in building},
            self.stiffness_scale[stiffness],
            self.slip_scale[slip],
            self.intensity,
        )

    @property
    def n_storeys(self) -> int:
        """Number of storeys of every building."""
        return self.buildings[0].n_storeys

    @property
    def shape(self) -> tuple[int, int, int]:
        """Lengths of (building, stiffness_scale, slip_scale), the cube's order of axes."""
        return len(self.buildings), self.stiffness_scale.size, self.slip_scale.size

    @property
    def intensities(self) -> FloatArray:
        """(n_i,) factors on the ground motions, a single 1 where there is no such axis."""
        return np.ones(1) if self.intensity is None else self.intensity

    @cached_property
    def slip_force(self) -> FloatArray:
        """(building, slip_scale, storey) N, the static friction limit."""
        return self._scaled("slip_force")

    @cached_property
    def kinetic_slip_force(self) -> FloatArray:
        """(building, slip_scale, storey) N, the friction while sliding."""
        return self._scaled("kinetic_slip_force")

    @cached_property
    def brace_stiffness(self) -> FloatArray:
        """(building, stiffness_scale, storey) N/m."""
        given = np.stack([building.brace_stiffness for building in self.buildings])
        return np.asarray(given[:, np.newaxis] * self.stiffness_scale[:, np.newaxis])

    @cached_property
    def brace_damping(self) -> FloatArray:
        """(building, stiffness_scale, storey) N s/m."""
        given = np.stack([building.brace_damping for building in self.buildings])
        return np.asarray(given[:, np.newaxis] * np.sqrt(self.stiffness_scale)[:, np.newaxis])

    @cached_property
    def braced_period(self) -> FloatArray:
        """(building, stiffness_scale) s, the first period with every damper stuck."""
        periods = np.empty(self.shape[:2])
        for b, building in enumerate(self.buildings):
            mass = building.floor_mass + building.brace_mass
            for k, brace in enumerate(self.brace_stiffness[b]):
                omega, _ = natural_modes(mass, building.stiffness_matrix + building.spring_matrix(brace))
                periods[b, k] = 2.0 * np.pi / omega[0]
        return periods

    def _scaled(self, name: str) -> FloatArray:
        given = np.stack([getattr(building, name) for building in self.buildings])[:, np.newaxis]
        scale = self.slip_scale[:, np.newaxis]
        scaled = np.broadcast_to(given, np.broadcast_shapes(given.shape, scale.shape)).copy()
        np.multiply(given, scale, out=scaled, where=(given > 0.0) & np.isfinite(given))
        return scaled


def _named(buildings: Buildings) -> tuple[tuple[str, ...], tuple[Building, ...]]:
    names: tuple[object, ...]
    members: tuple[object, ...]
    if isinstance(buildings, Building):
        buildings = (buildings,)
    if isinstance(buildings, Mapping):
        names, members = tuple(buildings), tuple(buildings.values())
    else:
        members = tuple(buildings)
        names = tuple(str(k) for k in range(1, len(members) + 1))
    if not members:
        raise InvalidInput("buildings must hold at least one Building, is empty")
    told, checked = [], []
    for name, building in zip(names, members, strict=True):
        if not isinstance(name, str) or not name:
            raise InvalidInput(f"buildings must have names that are text, got {name!r}")
        if not isinstance(building, Building):
            raise InvalidInput(f"building {name!r} must be a Building, got {type(building).__name__}")
        told.append(name)
        checked.append(building)
        if building.n_storeys != checked[0].n_storeys:
            raise InvalidInput(
                f"buildings must all have the same number of storeys, but {told[0]!r} has "
                f"{checked[0].n_storeys} and {name!r} has {building.n_storeys}: sweep them apart"
            )
    return tuple(told), tuple(checked)
