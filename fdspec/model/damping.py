"""Damping of the bare frame: a ratio in every mode, Rayleigh's two periods, or a given matrix.

Each choice turns into the frame's damping matrix C_f (N, N), N s/m, by ``matrix_of``; the damping of
the braces is the building's own, since a brace slips against the frame and shares none of its modes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import InitVar, dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput

Array = NDArray[np.float64]

SYMMETRY_TOLERANCE = 1e-9
"""Largest asymmetry of a given matrix, relative to its largest entry: what ten printed digits leave."""


def natural_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Return circular frequencies (n,), rad/s, lowest first, and mass-normalized shapes (n, n) by column."""
    scale = 1.0 / np.sqrt(mass)
    squares, shapes = np.linalg.eigh(stiffness * np.outer(scale, scale))
    return np.sqrt(np.maximum(squares, 0.0)), shapes * scale[:, None]


def symmetric(argument: str, matrix: ArrayLike, unit: str) -> Array:
    """Return a read-only symmetric copy of a matrix, or say what is wrong with it."""
    try:
        given = np.asarray(matrix)
        copy = np.array(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{argument} must be a square matrix of numbers in {unit} ({error})") from error
    if given.dtype.kind not in "iuf" or copy.ndim != 2 or copy.shape[0] != copy.shape[1] or copy.size == 0:
        raise InvalidInput(
            f"{argument} must be a square matrix of real numbers in {unit}, not of shape {copy.shape}"
        )
    if not np.isfinite(copy).all():
        row, column = np.argwhere(~np.isfinite(copy))[0]
        raise InvalidInput(
            f"{argument} must be finite, but its entry [{row}, {column}] is {copy[row, column]}"
        )
    difference = np.abs(copy - copy.T)
    if difference.max() > SYMMETRY_TOLERANCE * np.abs(copy).max():
        row, column = np.unravel_index(int(difference.argmax()), copy.shape)
        raise InvalidInput(
            f"{argument} must be symmetric, but its entries [{row}, {column}] and [{column}, {row}] are "
            f"{copy[row, column]:g} and {copy[column, row]:g} {unit}"
        )
    copy = 0.5 * (copy + copy.T)
    copy.flags.writeable = False
    return copy


def damping_ratio(argument: str, value: object, *, overdamped: bool = False) -> float:
    """Return a share of critical damping as a float, or say what is wrong with it.

    overdamped: whether it may be 1 or more; unless asked for, that is five per cent written as 5.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise InvalidInput(f"{argument} must be a number (0.05 is five per cent of critical), not {value!r}")
    number = float(value)
    if not 0.0 <= number < math.inf:
        raise InvalidInput(
            f"{argument} must be 0 or more (0.05 is five per cent of critical), not {number!r}"
        )
    if number >= 1.0 and not overdamped:
        raise InvalidInput(
            f"{argument} must be below 1 (0.05 is five per cent of critical), not {number!r}; "
            "where it is meant, say overdamped=True"
        )
    return number


@dataclass(frozen=True)
class ModalDamping:
    """Give the modes of the bare frame a share of critical damping.

    Parameters
    ----------
    ratio : float or sequence of N floats
        Damping ratio of every mode, or of each, lowest frequency first. From 0 to below 1.
    overdamped : bool
        Whether ratios may be 1 or more.

    Examples
    --------
    >>> ModalDamping(0.02).matrix_of([1.0], [[100.0]])
    array([[0.4]])
    """

    ratio: float | tuple[float, ...] = 0.05

    def __init__(self, ratio: float | Sequence[float] | Array = 0.05, *, overdamped: bool = False) -> None:
        checked: float | tuple[float, ...]
        if np.ndim(ratio) == 1:
            checked = tuple(
                damping_ratio(f"ratio of mode {mode}", value, overdamped=overdamped)
                for mode, value in enumerate(np.asarray(ratio), start=1)
            )
        else:
            checked = damping_ratio("ratio", ratio, overdamped=overdamped)
        object.__setattr__(self, "ratio", checked)

    def matrix_of(self, floor_mass: ArrayLike, stiffness: ArrayLike) -> Array:
        """Return C = sum over modes of 2 zeta omega (M phi)(M phi)^T, N s/m."""
        mass = np.asarray(floor_mass, dtype=np.float64)
        omega, shapes = natural_modes(mass, np.asarray(stiffness, dtype=np.float64))
        if isinstance(self.ratio, tuple) and len(self.ratio) != mass.size:
            raise InvalidInput(
                f"ModalDamping has {len(self.ratio)} ratios, but the frame has {mass.size} modes: "
                f"give one or {mass.size}"
            )
        loaded = shapes * mass[:, None]
        product = (loaded * (2.0 * np.asarray(self.ratio) * omega)) @ loaded.T
        return np.asarray(0.5 * (product + product.T), dtype=np.float64)


@dataclass(frozen=True)
class RayleighDamping:
    """Damp the bare frame by alpha M + beta K, with the same ratio at two periods.

    Parameters
    ----------
    ratio : float
        Damping ratio at both periods; smaller between them, larger outside.
    period_1, period_2 : float, s
        The two periods; they must differ.
    overdamped : bool
        Whether the ratio may be 1 or more.
    """

    ratio: float
    period_1: float
    period_2: float
    overdamped: InitVar[bool] = field(default=False, kw_only=True)

    def __post_init__(self, overdamped: bool) -> None:
        object.__setattr__(self, "ratio", damping_ratio("ratio", self.ratio, overdamped=overdamped))
        for name in ("period_1", "period_2"):
            period = getattr(self, name)
            if isinstance(period, bool) or not isinstance(period, (int, float, np.integer, np.floating)):
                raise InvalidInput(f"{name} must be a number of seconds, not {period!r}")
            if not 0.0 < float(period) < math.inf:
                raise InvalidInput(f"{name} must be positive and finite, in s, not {period!r}")
            object.__setattr__(self, name, float(period))
        if self.period_1 == self.period_2:
            raise InvalidInput(
                f"period_1 and period_2 must differ (both are {self.period_1:g} s): "
                "usual are the frame's first period and a higher mode's"
            )

    @property
    def coefficients(self) -> tuple[float, float]:
        """alpha in 1/s and beta in s."""
        omega_1, omega_2 = 2.0 * math.pi / self.period_1, 2.0 * math.pi / self.period_2
        beta = 2.0 * self.ratio / (omega_1 + omega_2)
        return beta * omega_1 * omega_2, beta

    def matrix_of(self, floor_mass: ArrayLike, stiffness: ArrayLike) -> Array:
        """Return alpha M + beta K, N s/m."""
        alpha, beta = self.coefficients
        return alpha * np.diag(np.asarray(floor_mass, dtype=np.float64)) + beta * np.asarray(
            stiffness, dtype=np.float64
        )


@dataclass(frozen=True, eq=False)
class DampingMatrix:
    """Give the frame's damping matrix C_f itself.

    Parameters
    ----------
    matrix : array_like, shape (N, N), N s/m
        Symmetric, so that velocity of one floor meets the force on another both ways; no negative power.
    """

    matrix: Array

    def __init__(self, matrix: ArrayLike) -> None:
        checked = symmetric("damping matrix", matrix, "N s/m")
        lowest = float(np.linalg.eigvalsh(checked)[0])
        if lowest < -SYMMETRY_TOLERANCE * float(np.abs(checked).max()):
            raise InvalidInput(
                "damping matrix must not feed energy into the frame, "
                f"but its lowest eigenvalue is {lowest:g} N s/m"
            )
        object.__setattr__(self, "matrix", checked)

    def matrix_of(self, floor_mass: ArrayLike, stiffness: ArrayLike) -> Array:  # noqa: ARG002 (one signature for all)
        """Return the matrix as given, N s/m."""
        size = np.asarray(floor_mass).size
        if self.matrix.shape != (size, size):
            raise InvalidInput(
                f"damping matrix has shape {self.matrix.shape}, but the frame has {size} storeys"
            )
        return self.matrix

    def __eq__(self, other: object) -> bool:
        return isinstance(other, DampingMatrix) and np.array_equal(self.matrix, other.matrix)

    def __hash__(self) -> int:
        return hash(self.matrix.tobytes())


Damping = ModalDamping | RayleighDamping | DampingMatrix
"""What ``Building`` takes as its frame's damping."""
