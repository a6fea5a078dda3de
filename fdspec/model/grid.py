"""The grid of a sweep: three axes and the scalars every point shares, validated once."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.model.device_check import checked_links
from fdspec.model.link import Link, TensionBrace

FloatArray = NDArray[np.float64]
Links = tuple[Link | TensionBrace, ...]

STUDY_STIFFNESS_RATIO: Final = (0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
STUDY_PRETENSION: Final = tuple(10e3 + 100e3 * k for k in range(11))
"""N; 10 to 1010 kN."""
STUDY_PERIOD: Final = tuple(k * 5 / 100 for k in range(1, 61))
"""s; 0.05 to 3.00, each the float nearest to its decimal (k * 0.05 is not)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Grid:
    """Hold the axes of a single-storey sweep and the numbers all its points share.

    Every array_like is copied into a read-only float64 array; all mistakes are reported at once.

    Parameters
    ----------
    stiffness_ratio : array_like, shape (n_sr,)
        Brace over frame stiffness, k_d / k_f.
    pretension : array_like, shape (n_f,), N
        Total normal force on the sliding surface; with 0 the damper slides freely, with infinity never.
    period : array_like, shape (n_t,), s
        Of the frame without its brace.
    floor_mass, brace_mass : float, kg
        A brace mass of 0 is the massless brace (bilinear hysteresis).
    damping_ratio, brace_damping_ratio : float
        Of the frame without its brace and of the brace on its own, 0 <= ratio < 1.
    friction_coefficient, kinetic_friction_coefficient : float
        At the start of slip and while sliding; the kinetic one is at most the static one, its default.
    normal_force_factor : float
        Newtons on the sliding surface for each newton of `pretension`: 2 n_b where `pretension` is the force
        of one of n_b bolts that clamp two faces.
    storey_height, yield_shear, hardening_ratio, gravity_load, slot_length, slot_stiffness, \
    recentring_stiffness, collapse_drift : float
        Devices of all frames alike, as for `fdspec.Building`.
    links : sequence of Link or TensionBrace
        Between the floor, 1, and the ground, 0, of all frames alike.
    intensity : array_like, shape (n_i,), optional
        Factors on the ground motions; without them the cube has no such axis.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text names it, the value and its index.

    Examples
    --------
    >>> grid = Grid(stiffness_ratio=[2, 4], pretension=[50e3, 100e3, 150e3], period=[0.3, 0.5])
    >>> grid.shape, grid.size
    ((2, 3, 2), 12)
    >>> grid.slip_force
    array([25000., 50000., 75000.])
    """

    stiffness_ratio: FloatArray
    pretension: FloatArray
    period: FloatArray
    floor_mass: float = 20e3
    brace_mass: float = 50.0
    damping_ratio: float = 0.05
    friction_coefficient: float = 0.5
    kinetic_friction_coefficient: float | None = None
    normal_force_factor: float = 1.0
    brace_damping_ratio: float = 0.0
    storey_height: float | None = None
    yield_shear: float | None = None
    hardening_ratio: float = 0.0
    gravity_load: float | None = None
    slot_length: float | None = None
    slot_stiffness: float | None = None
    recentring_stiffness: float | None = None
    collapse_drift: float | None = None
    links: tuple[Link | TensionBrace, ...] = ()
    intensity: FloatArray | None = None

    def __post_init__(self) -> None:
        mistakes = []
        for name in GRID_FIELDS:
            try:
                object.__setattr__(self, name, checked(name, getattr(self, name)))
            except ValueError as error:
                mistakes.append(f"{name}: {error}")
        if not mistakes:
            mistakes = [f"{name}: {sentence}" for name, sentence in contradictions(vars(self))]
        if mistakes:
            raise InvalidInput("; ".join(mistakes))

    @property
    def slip_force(self) -> FloatArray:
        """(n_f,) N, the static friction limit at each pretension."""
        return _scaled(self.pretension, self.friction_coefficient * self.normal_force_factor)

    @property
    def kinetic_slip_force(self) -> FloatArray:
        """(n_f,) N, the friction while sliding; infinite where the damper never slides."""
        coefficient = self.kinetic_friction_coefficient
        if coefficient is None:
            coefficient = self.friction_coefficient
        return _scaled(self.pretension, coefficient * self.normal_force_factor)

    @property
    def intensities(self) -> FloatArray:
        """(n_i,) factors on the ground motions, a single 1 where there is no such axis."""
        return np.ones(1) if self.intensity is None else self.intensity

    @property
    def devices(self) -> dict[str, Any]:
        """The device parameters that are given, by name; empty for frames without devices."""
        given = {name: getattr(self, name) for name in DEVICE_FIELDS if getattr(self, name) not in (None, ())}
        acting = [
            name for name in given if name not in ("hardening_ratio", "storey_height", "slot_stiffness")
        ]
        there = any(given[name] not in (0.0, np.inf) for name in acting)
        return given if there else {}

    @property
    def parameters(self) -> dict[str, Any]:
        """All fields by name, of devices and intensity those that are there: how a cube was made."""
        absent = set(DEVICE_FIELDS) - set(self.devices)
        if self.storey_height is not None:
            absent.discard("storey_height")
        if self.intensity is None:
            absent.add("intensity")
        told = {name: getattr(self, name) for name in GRID_FIELDS if name not in absent}
        return told | ({"links": [asdict(link) for link in self.links]} if self.links else {})

    @property
    def shape(self) -> tuple[int, int, int]:
        """Lengths of (stiffness_ratio, pretension, period), the cube's order of axes."""
        return self.stiffness_ratio.size, self.pretension.size, self.period.size

    @property
    def size(self) -> int:
        """Histories of one record."""
        n_sr, n_f, n_t = self.shape
        return self.intensities.size * n_sr * n_f * n_t

    @classmethod
    def study(cls) -> "Grid":
        """Give the study's grid: 7 stiffness ratios, 11 pretensions, 60 periods."""
        return cls(
            stiffness_ratio=np.array(STUDY_STIFFNESS_RATIO),
            pretension=np.array(STUDY_PRETENSION),
            period=np.array(STUDY_PERIOD),
        )


DEVICE_FIELDS: Final = (
    "storey_height",
    "yield_shear",
    "hardening_ratio",
    "gravity_load",
    "slot_length",
    "slot_stiffness",
    "recentring_stiffness",
    "collapse_drift",
    "links",
)

GRID_FIELDS: Final = tuple(field.name for field in fields(Grid))


def checked(name: str, value: object) -> FloatArray | float | Links | None:
    """Return the value of a field of `Grid` as it is kept, or raise ValueError saying what is wrong."""
    return _CHECKS[name](value)


def contradictions(values: Mapping[str, Any]) -> list[tuple[str, str]]:
    """List (field, sentence) for fields of `Grid` that are right alone and wrong together."""
    found = []
    static, kinetic = values["friction_coefficient"], values["kinetic_friction_coefficient"]
    if kinetic is not None and kinetic > static:
        found.append(
            (
                "kinetic_friction_coefficient",
                f"must be at most friction_coefficient, {static:g}, got {kinetic:g}",
            )
        )
    if static == 0.0 and np.isinf(values["pretension"][-1]):
        found.append(("friction_coefficient", "must be positive where pretension is infinite, got 0"))
    length, bearing = values["slot_length"], values["slot_stiffness"]
    if length is not None and length < np.inf and not bearing:
        found.append(("slot_stiffness", f"must be positive where slot_length is given ({length:g} m)"))
    gravity, height = values["gravity_load"], values["storey_height"]
    if gravity:
        longest = float(values["period"][-1])
        stiffness = values["floor_mass"] * (2.0 * np.pi / longest) ** 2
        if height is None:
            found.append(("storey_height", "must be given, in m, where gravity_load is"))
        elif gravity / height >= stiffness:
            taken = f"{gravity / height:g} N/m over storey_height"
            left = f"{stiffness:g} N/m of the frame of {longest:g} s"
            found.append(("gravity_load", f"is beyond elastic stability: {taken}, against {left}"))
    return found


def _scaled(pretension: FloatArray, factor: float) -> FloatArray:
    """Multiply, keeping an infinite pretension infinite also when the factor is zero."""
    scaled = np.full_like(pretension, np.inf)
    np.multiply(pretension, factor, out=scaled, where=np.isfinite(pretension))
    return scaled


def axis(value: object, *, zero: bool = False, infinite: bool = False) -> FloatArray:
    """Return one axis, checked: numbers, one dimension, finite, positive, strictly increasing.

    zero, infinite: whether these are allowed too.  Raises ValueError.
    """
    try:
        values = np.array(value, ndmin=1)
    except ValueError:
        raise ValueError("must be a list of numbers, all at one level") from None
    if values.size == 0:
        raise ValueError("must hold at least one value, is empty")
    if values.dtype.kind not in "iuf":
        raise ValueError(f"must be a list of numbers, got {value!r:.60}")
    if values.ndim != 1:
        raise ValueError(f"must be a list of numbers, got an array of shape {values.shape}")
    values = np.ascontiguousarray(values, dtype=np.float64)
    _first(values, np.isnan(values), "must be numbers")
    if not infinite:
        _first(values, np.isinf(values), "must be finite")
    if zero:
        _first(values, values < 0.0, "must be zero or positive")
    else:
        _first(values, values <= 0.0, "must be positive")
    repeated = np.flatnonzero(values[1:] == values[:-1])
    if repeated.size:
        k = int(repeated[0])
        raise ValueError(f"values must differ, {values[k]:.12g} stands at index {k} and {k + 1}")
    falling = np.flatnonzero(values[1:] < values[:-1])
    if falling.size:
        k = int(falling[0])
        raise ValueError(
            f"values must increase, got {values[k + 1]:.12g} at index {k + 1} after {values[k]:.12g}"
        )
    values.flags.writeable = False
    return values


def _first(axis: FloatArray, wrong: NDArray[np.bool_], what: str) -> None:
    if wrong.any():
        k = int(np.argmax(wrong))
        raise ValueError(f"values {what}, got {axis[k]:.12g} at index {k}")


def _number(value: object, *, zero: bool = False, below: float = np.inf) -> float:
    """Check one scalar: finite, positive (or zero where allowed), under `below`."""
    given = np.asarray(value)
    if given.ndim != 0 or given.dtype.kind not in "iuf":
        raise ValueError(f"must be a number, got {value!r:.60}")
    number = float(given)
    if not np.isfinite(number):
        raise ValueError(f"must be finite, got {number:g}")
    if number < 0.0 or (number == 0.0 and not zero):
        raise ValueError(f"must be {'zero or ' if zero else ''}positive, got {number:g}")
    if number >= below:
        raise ValueError(f"must be less than {below:g}, got {number:g}")
    return number


def _optional_number(value: object, *, zero: bool = True, infinite: bool = False) -> float | None:
    if value is None or (infinite and isinstance(value, float | int) and value == np.inf):
        return value
    return _number(value, zero=zero)


def _less_than_one(value: object) -> float:
    given = np.asarray(value)
    if given.ndim != 0 or given.dtype.kind not in "iuf" or not np.isfinite(given):
        raise ValueError(f"must be a number, got {value!r:.60}")
    if float(given) >= 1.0:
        raise ValueError(f"must be less than 1, got {float(given):g}")
    return float(given)


_CHECKS: Final[Mapping[str, Callable[[object], FloatArray | float | Links | None]]] = {
    "stiffness_ratio": axis,
    "pretension": lambda value: axis(value, zero=True, infinite=True),
    "period": axis,
    "floor_mass": _number,
    "brace_mass": lambda value: _number(value, zero=True),
    "damping_ratio": lambda value: _number(value, zero=True, below=1.0),
    "friction_coefficient": lambda value: _number(value, zero=True),
    "kinetic_friction_coefficient": _optional_number,
    "normal_force_factor": _number,
    "brace_damping_ratio": lambda value: _number(value, zero=True, below=1.0),
    "storey_height": lambda value: _optional_number(value, zero=False),
    "yield_shear": lambda value: _optional_number(value, zero=False, infinite=True),
    "hardening_ratio": _less_than_one,
    "gravity_load": _optional_number,
    "slot_length": lambda value: _optional_number(value, zero=False, infinite=True),
    "slot_stiffness": _optional_number,
    "recentring_stiffness": _optional_number,
    "collapse_drift": lambda value: _optional_number(value, zero=False, infinite=True),
    "links": lambda value: checked_links(value, 1),
    "intensity": lambda value: None if value is None else axis(value),
}
