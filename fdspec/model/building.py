"""Building: floors, braces and friction dampers, one of each a storey; checked when made."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from dataclasses import fields as dataclass_fields
from functools import cached_property
from typing import Any, TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.kernels.types import Storey
from fdspec.model.building_check import numbers, per_storey, read_only, refuse_impossible, require
from fdspec.model.damping import (
    Damping,
    DampingMatrix,
    ModalDamping,
    RayleighDamping,
    natural_modes,
    symmetric,
)
from fdspec.model.damping import damping_ratio as damping_ratio_of
from fdspec.model.device_check import NONE, checked_links, device_fields
from fdspec.model.device_frame import DeviceFrame, device_frame
from fdspec.model.link import Link, TensionBrace
from fdspec.model.number_check import not_negative_number, positive_number
from fdspec.model.springs import Frame, Linkage, shear_matrix
from fdspec.model.standing import IntArray, checked_stands_on, drifts, elevations, is_chain, spring_matrix

__all__ = [
    "Building",
    "DampingMatrix",
    "Frame",
    "Linkage",
    "ModalDamping",
    "RayleighDamping",
    "shear_matrix",
]

Array = NDArray[np.float64]


class DeviceParameters(TypedDict, total=False):
    """The parameters of a building's devices, as `Building` takes them."""

    storey_height: ArrayLike | None
    yield_shear: ArrayLike | None
    hardening_ratio: ArrayLike
    gravity_load: ArrayLike | None
    slot_length: ArrayLike | None
    slot_stiffness: ArrayLike | None
    recentring_stiffness: ArrayLike | None
    links: Sequence[Link | TensionBrace]
    collapse_drift: ArrayLike | None


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Building:
    """Hold a frame of N storeys, each with a brace below its floor and a friction damper between the two.

    Storey 1 stands on the ground. Every array argument has shape (N,), or is a number for all storeys;
    arrays are copied and kept read-only.

    Parameters
    ----------
    floor_mass : kg
        Mass of each floor, positive.
    storey_stiffness : N/m
        Stiffness between each floor and the one below, positive. A matrix (N, N) is the stiffness of a
        frame that is no shear building: see `from_matrices`.
    brace_mass : kg
        Mass that moves with the sliding plate. 0 is a massless brace, which slips quasi-statically.
    brace_stiffness : N/m
        Stiffness between the brace's top and the floor below it. 0 is a storey without a brace; its
        brace mass and slip force must then be 0 too.
    slip_force : N
        Static friction: the force that starts slip. 0 is free sliding, ``math.inf`` never slips.
    kinetic_slip_force : N, optional
        Friction while sliding, at most `slip_force` and by default the same.
    damping : ModalDamping, RayleighDamping or DampingMatrix
        Damping of the bare frame.
    brace_damping : N s/m, optional
        Dashpot beside each brace's spring, by default none.
    storey_height : m, optional
        Height of each storey; needed for `gravity_load`, and for drift ratios.
    yield_shear : N, optional
        The columns' own shear at first yield, without P-delta; by default, and where it is infinite, they
        stay elastic.
    hardening_ratio : float
        Stiffness of yielding columns over their elastic one, less than 1; 0 is elastoplastic, a negative
        one softens.
    gravity_load : N, optional
        Weight carried by each storey, that of all above it included. It takes gravity_load / storey_height
        off the storey's stiffness. The damping stays that of the elastic frame without it.
    slot_length : m, optional
        Free slip of each damper to either side before its bolts bear.
    slot_stiffness : N/m, optional
        Stiffness of the bolts in bearing, between floor and brace, beside friction.
    recentring_stiffness : N/m, optional
        Spring between floor and brace, across the slider.
    links : sequence of Link or TensionBrace
        Dampers and braces between any two floors, or a floor and the ground.
    collapse_drift : m, optional
        Drift at which a history ends with the status ``collapsed``. By default a tenth of the storey's
        height where gravity or softening columns may make the building unstable, else there is none.
    stands_on : sequence of N ints, optional
        The floor that each storey stands on, counted from 1 and before its own; 0 is the ground. By default
        each stands on the one before. ``[0, 1, 2, 0, 4]`` is a frame of three storeys beside one of two;
        `links` may join them. `side_by_side` makes it of two buildings.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text says which, its value and what would be right.

    Examples
    --------
    >>> building = Building([30e3, 20e3], 40e6, 50.0, 80e6, [100e3, 50e3], damping=ModalDamping(0.02))
    >>> building.n_storeys
    2
    >>> building.bare_periods
    array([0.2433, 0.0993])
    """

    floor_mass: Array
    storey_stiffness: Array
    brace_mass: Array
    brace_stiffness: Array
    slip_force: Array
    kinetic_slip_force: Array
    damping: Damping
    brace_damping: Array
    storey_height: Array
    yield_shear: Array
    hardening_ratio: Array
    gravity_load: Array
    slot_length: Array
    slot_stiffness: Array
    recentring_stiffness: Array
    links: tuple[Link | TensionBrace, ...]
    collapse_drift: Array
    stands_on: IntArray

    # A dataclass would demand the arrays themselves; callers may hand over any numbers.
    def __init__(
        self,
        floor_mass: ArrayLike,
        storey_stiffness: ArrayLike,
        brace_mass: ArrayLike,
        brace_stiffness: ArrayLike,
        slip_force: ArrayLike,
        kinetic_slip_force: ArrayLike | None = None,
        damping: Damping | None = None,
        brace_damping: ArrayLike | None = None,
        *,
        storey_height: ArrayLike | None = None,
        yield_shear: ArrayLike | None = None,
        hardening_ratio: ArrayLike = 0.0,
        gravity_load: ArrayLike | None = None,
        slot_length: ArrayLike | None = None,
        slot_stiffness: ArrayLike | None = None,
        recentring_stiffness: ArrayLike | None = None,
        links: Sequence[Link | TensionBrace] = (),
        collapse_drift: ArrayLike | None = None,
        stands_on: ArrayLike | None = None,
    ) -> None:
        given: dict[str, ArrayLike] = {
            "floor_mass": floor_mass,
            "brace_mass": brace_mass,
            "brace_stiffness": brace_stiffness,
            "slip_force": slip_force,
            "kinetic_slip_force": slip_force if kinetic_slip_force is None else kinetic_slip_force,
            "brace_damping": 0.0 if brace_damping is None else brace_damping,
        }
        devices: dict[str, ArrayLike | None] = {
            "storey_height": storey_height,
            "yield_shear": yield_shear,
            "hardening_ratio": hardening_ratio,
            "gravity_load": gravity_load,
            "slot_length": slot_length,
            "slot_stiffness": slot_stiffness,
            "recentring_stiffness": recentring_stiffness,
            "collapse_drift": collapse_drift,
        }
        arrays = {name: numbers(name, value) for name, value in given.items()}
        if np.ndim(storey_stiffness) == 2:
            stiffness = symmetric("stiffness", storey_stiffness, "N/m")
            size = stiffness.shape[0]
        else:
            stiffness = numbers("storey_stiffness", storey_stiffness)
            size = max(
                array.size
                for array in [
                    stiffness,
                    *arrays.values(),
                    *(numbers(name, value) for name, value in devices.items() if value is not None),
                ]
            )
            arrays["storey_stiffness"] = stiffness
        fields = {name: per_storey(name, array, size) for name, array in arrays.items()}
        fields.setdefault("storey_stiffness", stiffness)
        refuse_impossible(fields)
        standing = checked_stands_on(stands_on, size)
        object.__setattr__(self, "stands_on", standing)
        fields |= device_fields(devices, fields, standing)
        object.__setattr__(self, "links", checked_links(links, size))
        chosen = ModalDamping() if damping is None else damping
        if not isinstance(chosen, Damping):
            raise InvalidInput(
                f"damping must be ModalDamping, RayleighDamping or DampingMatrix, not {damping!r}"
            )
        for name, value in fields.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "damping", chosen)
        _ = self.damping_matrix  # a damping that does not fit is refused here, not at the first use

    @classmethod
    def single_storey(
        cls,
        period: float,
        stiffness_ratio: float,
        slip_force: float,
        floor_mass: float = 20e3,
        brace_mass: float = 50.0,
        damping_ratio: float = 0.05,
        kinetic_slip_force: float | None = None,
        brace_damping_ratio: float = 0.0,
        *,
        overdamped: bool = False,
        **devices: Unpack[DeviceParameters],
    ) -> Building:
        """Make the study's single-storey frame.

        Parameters
        ----------
        period : float, s
            Natural period of the bare frame: k_f = m_f (2 pi / period)^2, from the floor's mass alone.
        stiffness_ratio : float
            Brace stiffness over frame stiffness, k_d / k_f; 0 is a frame without brace.
        slip_force, kinetic_slip_force : float, N
            Friction that starts slip and that resists it; the second is by default the first.
        floor_mass, brace_mass : float, kg
            Masses of floor and brace.
        damping_ratio : float
            Share of critical damping of the bare frame: c_f = 2 zeta sqrt(k_f m_f).
        brace_damping_ratio : float
            The same of the brace standing by itself: c_d = 2 zeta sqrt(k_d m_d).
        overdamped : bool
            Whether these ratios may be 1 or more; unless asked for, that is taken for per cent and refused.
        **devices
            `storey_height`, `yield_shear`, `hardening_ratio`, `gravity_load`, `slot_length`,
            `slot_stiffness`, `recentring_stiffness`, `links` and `collapse_drift`, as for `Building`.

        Returns
        -------
        Building
            One storey.
        """
        mass = positive_number("floor_mass", floor_mass, "kg")
        stiffness = mass * (2.0 * math.pi / positive_number("period", period, "s")) ** 2
        ratio = not_negative_number("stiffness_ratio", stiffness_ratio)
        brace_ratio = damping_ratio_of("brace_damping_ratio", brace_damping_ratio, overdamped=overdamped)
        brace_stiffness = ratio * stiffness
        return cls(
            mass,
            stiffness,
            brace_mass,
            brace_stiffness,
            slip_force,
            kinetic_slip_force,
            ModalDamping(
                damping_ratio_of("damping_ratio", damping_ratio, overdamped=overdamped), overdamped=overdamped
            ),
            2.0 * brace_ratio * math.sqrt(brace_stiffness * not_negative_number("brace_mass", brace_mass)),
            **devices,
        )

    @classmethod
    def from_periods(
        cls,
        floor_mass: Sequence[float],
        bare_period: float,
        braced_period: float,
        slip_force: ArrayLike,
        brace_mass: ArrayLike = 0.0,
        damping: Damping | None = None,
        kinetic_slip_force: ArrayLike | None = None,
        brace_damping: ArrayLike | None = None,
        **devices: Unpack[DeviceParameters],
    ) -> Building:
        """Make a shear building from its masses and two first periods.

        Two periods fix two numbers, so it is assumed that every storey has the same stiffness and every
        brace the same stiffness. The braced period is that of floors and braces moving as one.

        Parameters
        ----------
        floor_mass : sequence of N floats, kg
            Mass of each floor.
        bare_period, braced_period : float, s
            First natural period without the braces and with all dampers stuck.
        slip_force, brace_mass, damping, kinetic_slip_force, brace_damping, **devices
            As for `Building`.

        Returns
        -------
        Building
            N storeys.

        Raises
        ------
        InvalidInput
            When no positive brace stiffness gives the braced period.

        Examples
        --------
        >>> frame = Building.from_periods([41610.0] * 3 + [40820.0], 1.006, 0.612, 50e3, brace_mass=23.0)
        >>> float(frame.bare_periods[0]), float(frame.braced_periods[0])
        (1.006, 0.612)
        """
        floors = np.atleast_1d(numbers("floor_mass", floor_mass))
        require("floor_mass", floors, floors > 0.0, "positive and finite, in kg")
        braces = per_storey("brace_mass", numbers("brace_mass", brace_mass), floors.size)
        require("brace_mass", braces, braces >= 0.0, "0 or more and finite, in kg")
        stiffness = _stiffness_for(positive_number("bare_period", bare_period, "s"), floors)
        together = _stiffness_for(positive_number("braced_period", braced_period, "s"), floors + braces)
        if together <= stiffness:
            raise InvalidInput(
                "braced_period must be short enough for a brace of positive stiffness, but "
                f"{braced_period!r} s beside a bare period of {bare_period!r} s is not"
            )
        return cls(
            floors,
            stiffness,
            braces,
            together - stiffness,
            slip_force,
            kinetic_slip_force,
            damping,
            brace_damping,
            **devices,
        )

    @classmethod
    def from_matrices(
        cls,
        floor_mass: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike | Damping,
        *,
        brace_stiffness: ArrayLike,
        slip_force: ArrayLike,
        brace_mass: ArrayLike = 0.0,
        kinetic_slip_force: ArrayLike | None = None,
        brace_damping: ArrayLike | None = None,
        stands_on: ArrayLike | None = None,
        **devices: Unpack[DeviceParameters],
    ) -> Building:
        """Make a building from the frame's matrices, as another program condensed them.

        Parameters
        ----------
        floor_mass : array_like, shape (N,), kg
            Lumped masses.
        stiffness : array_like, shape (N, N), N/m
            Stiffness of the bare frame for floor displacements relative to the ground, lowest floor
            first; symmetric and positive definite.
        damping : array_like, shape (N, N), N s/m, or a damping choice
            Damping of the bare frame.
        brace_stiffness, slip_force, brace_mass, kinetic_slip_force, brace_damping
            As for `Building`: brace i joins floor i to the floor below.
        stands_on
            The floor below each storey, as for `Building`; by default the one before.

        Returns
        -------
        Building
            N storeys; `storey_stiffness` is the whole matrix.
        """
        if np.ndim(stiffness) != 2:
            raise InvalidInput(
                f"stiffness must be a matrix of shape (N, N), in N/m, not of shape {np.shape(stiffness)}"
            )
        chosen = damping if isinstance(damping, Damping) else DampingMatrix(damping)
        return cls(
            floor_mass,
            stiffness,
            brace_mass,
            brace_stiffness,
            slip_force,
            kinetic_slip_force,
            chosen,
            brace_damping,
            stands_on=stands_on,
            **devices,
        )

    def with_changes(self, **changes: Any) -> Building:
        """Return this building with other values of some of its parameters, as `Building` takes them.

        Examples
        --------
        >>> frame = Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=100e3)
        >>> frame.with_changes(slip_force=50e3, kinetic_slip_force=40e3).slip_force
        array([50000.])
        """
        known = [field.name for field in dataclass_fields(self)]
        unknown = sorted(set(changes) - set(known))
        if unknown:
            raise InvalidInput(f"{unknown[0]!r} is no parameter of a building; known are {', '.join(known)}")
        return replace(self, **changes)

    @property
    def n_storeys(self) -> int:
        """Number of storeys N."""
        return int(self.floor_mass.size)

    @cached_property
    def stiffness_matrix(self) -> Array:
        """Stiffness of the bare frame, shape (N, N), N/m."""
        if self.storey_stiffness.ndim == 2:
            return self.storey_stiffness
        return read_only(self.spring_matrix(self.storey_stiffness))

    @cached_property
    def damping_matrix(self) -> Array:
        """Damping of the bare frame, shape (N, N), N s/m."""
        return read_only(self.damping.matrix_of(self.floor_mass, self.stiffness_matrix))

    @cached_property
    def bare_periods(self) -> Array:
        """Natural periods of the frame without braces, shape (N,), s, longest first."""
        return _periods(self.floor_mass, self.stiffness_matrix)

    @cached_property
    def braced_periods(self) -> Array:
        """Natural periods with every damper stuck, shape (N,), s, longest first."""
        return _periods(
            self.floor_mass + self.brace_mass,
            self.stiffness_matrix + self.spring_matrix(self.brace_stiffness),
        )

    @property
    def storey(self) -> Storey:
        """The numbers of a single-storey building, as its kernel takes them."""
        if self.n_storeys != 1:
            raise InvalidInput(f"storey is for buildings of one storey, and this one has {self.n_storeys}")
        return Storey(
            float(self.floor_mass[0]),
            float(self.damping_matrix[0, 0]),
            float(self.stiffness_matrix[0, 0]),
            float(self.brace_mass[0]),
            float(self.brace_damping[0]),
            float(self.brace_stiffness[0]),
            float(self.slip_force[0]),
            float(self.kinetic_slip_force[0]),
        )

    @property
    def has_devices(self) -> bool:
        """Whether anything beside one frame, its braces and their friction is in it."""
        return bool(
            self.links
            or not self.is_one_frame
            or (self.yield_shear < np.inf).any()
            or (self.gravity_load > 0.0).any()
            or (self.slot_length < np.inf).any()
            or (self.recentring_stiffness > 0.0).any()
            or (self.collapse_drift < np.inf).any()
        )

    @property
    def link_names(self) -> tuple[str, ...]:
        """Names of the links, in their order."""
        return tuple(link.name or f"link {number}" for number, link in enumerate(self.links, start=1))

    @property
    def is_one_frame(self) -> bool:
        """Whether every storey stands on the one counted before it."""
        return is_chain(self.stands_on)

    def drifts(self, displacement: Array) -> Array:
        """Return the drift of each storey from displacements of the floors, both (..., N), m."""
        return drifts(displacement, self.stands_on)

    def spring_matrix(self, springs: Array) -> Array:
        """Return the matrix (N, N) of springs or dashpots (N,), one a storey."""
        return shear_matrix(springs) if self.is_one_frame else spring_matrix(springs, self.stands_on)

    @property
    def floor_height(self) -> Array:
        """Height of each floor above the ground, shape (N,), m; not a number where one below is unknown."""
        return elevations(self.storey_height, self.stands_on)

    @cached_property
    def device_frame(self) -> DeviceFrame:
        """The numbers of the building as the kernel for devices takes them."""
        return device_frame(self, self._springs, Linkage.of(self.damping_matrix, self.stands_on))

    @property
    def _springs(self) -> Linkage:
        if self.storey_stiffness.ndim == 1:  # as given, untouched by the way through the matrix
            return Linkage(self.storey_stiffness, np.zeros(self.n_storeys), np.zeros((0, 0)))
        return Linkage.of(self.stiffness_matrix, self.stands_on)

    @cached_property
    def frame(self) -> Frame:
        """The numbers of the building as the kernel for N storeys takes them, without its devices."""
        stiffness = self._springs if self.is_one_frame else Linkage.of(self.stiffness_matrix)
        damping = Linkage.of(self.damping_matrix)
        rows = (
            self.floor_mass,
            self.brace_mass,
            stiffness.storey,
            stiffness.ground,
            damping.storey,
            damping.ground,
            self.brace_stiffness,
            self.brace_damping,
            self.slip_force,
            self.kinetic_slip_force,
        )
        return Frame(read_only(np.stack(rows)), stiffness.dense, damping.dense)

    @property
    def parameters(self) -> dict[str, Any]:
        """All that an answer depends on, by name, SI units: for a file that says where it comes from."""
        return {
            **self._device_parameters(),
            "floor_mass": self.floor_mass,
            "stiffness_matrix": self.stiffness_matrix,
            "damping_matrix": self.damping_matrix,
            "brace_mass": self.brace_mass,
            "brace_stiffness": self.brace_stiffness,
            "brace_damping": self.brace_damping,
            "slip_force": self.slip_force,
            "kinetic_slip_force": self.kinetic_slip_force,
        }

    def _device_parameters(self) -> dict[str, Any]:
        """Those of the devices that are there."""
        there = {
            name: getattr(self, name)
            for name, absent in NONE.items()
            if not np.array_equal(getattr(self, name), np.full(self.n_storeys, absent), equal_nan=True)
        }
        if not self.is_one_frame:
            there["stands_on"] = self.stands_on
        return there | ({"links": [asdict(link) for link in self.links]} if self.links else {})

    def _identity(self) -> tuple[Any, ...]:
        arrays = (
            self.floor_mass,
            self.storey_stiffness,
            self.brace_mass,
            self.brace_stiffness,
            self.slip_force,
            self.kinetic_slip_force,
            self.brace_damping,
            self.stands_on,
            *(getattr(self, name) for name in NONE),
        )
        return (self.damping, self.links, *(array.tobytes() for array in arrays))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Building):
            return NotImplemented
        return self._identity() == other._identity()

    def __hash__(self) -> int:
        return hash(self._identity())

    def __repr__(self) -> str:
        storeys = "1 storey" if self.n_storeys == 1 else f"{self.n_storeys} storeys"
        lowest, highest = float(self.slip_force.min()), float(self.slip_force.max())
        force = f"{lowest:g}" if lowest == highest else f"{lowest:g} to {highest:g}"
        return (
            f"<Building: {storeys}, first period {self.bare_periods[0]:.4g} s bare and "
            f"{self.braced_periods[0]:.4g} s braced, slip force {force} N>"
        )

    def __setstate__(self, state: dict[str, Any]) -> None:
        # An array forgets that it was read-only when it is pickled to another process.
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        self.__dict__.update(state)


def _stiffness_for(period: float, mass: Array) -> float:
    """The uniform storey stiffness that gives these masses this first period."""
    omega, _ = natural_modes(mass, shear_matrix(np.ones(mass.size)))
    return float((2.0 * math.pi / period / omega[0]) ** 2)


def _periods(mass: Array, stiffness: Array) -> Array:
    omega, _ = natural_modes(mass, stiffness)
    return read_only(2.0 * math.pi / omega)
