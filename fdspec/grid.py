"""The grid of a sweep: three axes and the scalars every point shares, validated once."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput

FloatArray = NDArray[np.float64]

STUDY_STIFFNESS_RATIO: Final = (0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
STUDY_PRETENSION: Final = tuple(10e3 + 100e3 * k for k in range(11))
"""N; 10 to 1010 kN."""
STUDY_PERIOD: Final = tuple(k * 5 / 100 for k in range(1, 61))
"""s; 0.05 to 3.00, each the float nearest to its decimal (k * 0.05 is not)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Grid:
    """Hold the axes of a single-storey sweep and the numbers all its points share.

    Every array-like is copied into a read-only float64 array; every mistake is reported, all at once.

    Args:
        stiffness_ratio: (n_sr,) brace over frame stiffness, k_d / k_f.
        pretension: (n_f,) N, the total normal force on the sliding surface; 0 slides freely, infinity never.
        period: (n_t,) s, of the frame without its brace.
        floor_mass: kg.
        brace_mass: kg; 0 is the massless brace (bilinear hysteresis).
        damping_ratio: of the frame without its brace, 0 <= ratio < 1.
        friction_coefficient: static; also kinetic unless that is given.
        kinetic_friction_coefficient: while sliding, at most the static one.
        normal_force_factor: normal force for each newton of `pretension`; for n_b bolts and two faces, where
            `pretension` is the force of one bolt, 2 n_b.
        brace_damping_ratio: of the brace on its own, 0 <= ratio < 1.

    Raises:
        InvalidInput: An argument is not usable; the message names it, the value and its index.
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

    def __post_init__(self) -> None:
        mistakes = []
        for name in GRID_FIELDS:
            try:
                object.__setattr__(self, name, checked(name, getattr(self, name)))
            except ValueError as error:
                mistakes.append(f"{name}: {error}")
        if not mistakes:
            mistakes = [f"{name}: {sentence}" for name, sentence in contradictions(self)]
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
    def shape(self) -> tuple[int, int, int]:
        """Lengths of (stiffness_ratio, pretension, period), the cube's order of axes."""
        return self.stiffness_ratio.size, self.pretension.size, self.period.size

    @property
    def size(self) -> int:
        """Histories of one record."""
        n_sr, n_f, n_t = self.shape
        return n_sr * n_f * n_t

    @classmethod
    def study(cls) -> "Grid":
        """Give the study's grid: 7 stiffness ratios, 11 pretensions, 60 periods."""
        return cls(
            stiffness_ratio=np.array(STUDY_STIFFNESS_RATIO),
            pretension=np.array(STUDY_PRETENSION),
            period=np.array(STUDY_PERIOD),
        )


GRID_FIELDS: Final = tuple(field.name for field in fields(Grid))


def checked(name: str, value: object) -> FloatArray | float | None:
    """Return the value of a field of `Grid` as it is kept, or raise ValueError saying what is wrong."""
    return _CHECKS[name](value)


def contradictions(grid: "Grid") -> list[tuple[str, str]]:
    """List (field, sentence) for fields that are right alone and wrong together."""
    found = []
    kinetic = grid.kinetic_friction_coefficient
    if kinetic is not None and kinetic > grid.friction_coefficient:
        found.append(
            (
                "kinetic_friction_coefficient",
                f"must be at most friction_coefficient, {grid.friction_coefficient:g}, got {kinetic:g}",
            )
        )
    if grid.friction_coefficient == 0.0 and np.isinf(grid.pretension[-1]):
        found.append(("friction_coefficient", "must be positive where pretension is infinite, got 0"))
    return found


def _scaled(pretension: FloatArray, factor: float) -> FloatArray:
    """Multiply, keeping an infinite pretension infinite also when the factor is zero."""
    scaled = np.full_like(pretension, np.inf)
    np.multiply(pretension, factor, out=scaled, where=np.isfinite(pretension))
    return scaled


def _axis(value: object, *, zero: bool = False, infinite: bool = False) -> FloatArray:
    """Check one axis: numbers, one dimension, finite, positive, strictly increasing."""
    try:
        axis = np.array(value, ndmin=1)
    except ValueError:
        raise ValueError("must be a list of numbers, all at one level") from None
    if axis.size == 0:
        raise ValueError("must hold at least one value, is empty")
    if axis.dtype.kind not in "iuf":
        raise ValueError(f"must be a list of numbers, got {value!r:.60}")
    if axis.ndim != 1:
        raise ValueError(f"must be a list of numbers, got an array of shape {axis.shape}")
    axis = np.ascontiguousarray(axis, dtype=np.float64)
    _first(axis, np.isnan(axis), "must be numbers")
    if not infinite:
        _first(axis, np.isinf(axis), "must be finite")
    if zero:
        _first(axis, axis < 0.0, "must be zero or positive")
    else:
        _first(axis, axis <= 0.0, "must be positive")
    repeated = np.flatnonzero(axis[1:] == axis[:-1])
    if repeated.size:
        k = int(repeated[0])
        raise ValueError(f"values must differ, {axis[k]:.12g} stands at index {k} and {k + 1}")
    falling = np.flatnonzero(axis[1:] < axis[:-1])
    if falling.size:
        k = int(falling[0])
        raise ValueError(
            f"values must increase, got {axis[k + 1]:.12g} at index {k + 1} after {axis[k]:.12g}"
        )
    axis.flags.writeable = False
    return axis


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


def _optional_number(value: object) -> float | None:
    return None if value is None else _number(value, zero=True)


_CHECKS: Final[Mapping[str, Callable[[object], FloatArray | float | None]]] = {
    "stiffness_ratio": _axis,
    "pretension": lambda value: _axis(value, zero=True, infinite=True),
    "period": _axis,
    "floor_mass": _number,
    "brace_mass": lambda value: _number(value, zero=True),
    "damping_ratio": lambda value: _number(value, zero=True, below=1.0),
    "friction_coefficient": lambda value: _number(value, zero=True),
    "kinetic_friction_coefficient": _optional_number,
    "normal_force_factor": _number,
    "brace_damping_ratio": lambda value: _number(value, zero=True, below=1.0),
}
