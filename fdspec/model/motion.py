"""GroundMotion: one ground acceleration, linear between its samples, with what is known of its origin."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.number_check import finite_number, positive_number

IMPLAUSIBLE_PGA: Final = 50.0
"""m/s2, about 5 g: above it a record is more likely in cm/s2 than real."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class GroundMotion:
    """Hold one component of ground acceleration; immutable, checked when made.

    Parameters
    ----------
    acceleration : array_like, shape (n,), m/s2
        Samples at ``k * dt``, n >= 2, all finite. Copied; kept read-only.
    dt : float, s
        Time between samples, positive.
    name : str
        What the ``record`` coordinate of a cube will say.
    event, station, component : str
        Where the record comes from, empty when unknown.
    source : str
        The record that was really read: a file, or a data set with its identifier.
    history : tuple of str
        What was done to the samples since they were read, first step first.
    scale_factor : float
        Product of all scalings in `history`.

    Raises
    ------
    InvalidInput
        When an argument cannot be used; the text says which and what would be right.

    Warns
    -----
    UserWarning
        When the peak is over 50 m/s2, which looks like cm/s2 given as m/s2.

    Examples
    --------
    >>> motion = GroundMotion([0.0, 1.5, -2.0, 0.0], 0.01, name="mine")
    >>> motion.pga, motion.duration
    (2.0, 0.03)
    >>> motion.scaled_to_pga(3.0).scale_factor
    1.5
    """

    acceleration: NDArray[np.float64]
    dt: float
    name: str = ""
    event: str = field(default="", kw_only=True)
    station: str = field(default="", kw_only=True)
    component: str = field(default="", kw_only=True)
    source: str = field(default="", kw_only=True)
    history: tuple[str, ...] = field(default=(), kw_only=True)
    scale_factor: float = field(default=1.0, kw_only=True)

    # A dataclass would demand the array itself; callers may hand over any sequence of numbers.
    def __init__(
        self,
        acceleration: ArrayLike,
        dt: float,
        name: str = "",
        *,
        event: str = "",
        station: str = "",
        component: str = "",
        source: str = "",
        history: Sequence[str] = (),
        scale_factor: float = 1.0,
    ) -> None:
        samples = _samples(acceleration)
        texts = {"name": name, "event": event, "station": station, "component": component, "source": source}
        for argument, text in texts.items():
            if not isinstance(text, str):
                raise InvalidInput(f"{argument} must be a string, not {text!r}")
        if isinstance(history, str) or not all(isinstance(step, str) for step in history):
            raise InvalidInput(f"history must be a sequence of strings, one a step, not {history!r}")
        checked = {
            "acceleration": samples,
            "dt": positive_number("dt", dt, "s"),
            **texts,
            "history": tuple(history),
            "scale_factor": finite_number("scale_factor", scale_factor),
        }
        for key, value in checked.items():
            object.__setattr__(self, key, value)
        if self.pga > IMPLAUSIBLE_PGA:
            warnings.warn(
                f"{self._title()} has a peak of {self.pga:.4g} m/s2, over {IMPLAUSIBLE_PGA:g}: "
                "the unit looks wrong (acceleration is expected in m/s2, not cm/s2)",
                UserWarning,
                stacklevel=2,
            )

    @property
    def n(self) -> int:
        """Number of samples."""
        return int(self.acceleration.shape[0])

    @property
    def duration(self) -> float:
        """Time from the first to the last sample, s."""
        return (self.n - 1) * self.dt

    @property
    def time(self) -> NDArray[np.float64]:
        """Time of each sample from the first, s, shape (n,); from ``k * dt``: rounding does not pile up."""
        return np.arange(self.n, dtype=np.float64) * self.dt

    @cached_property
    def pga(self) -> float:
        """Largest absolute sample, m/s2."""
        return float(np.abs(self.acceleration).max())

    @cached_property
    def checksum(self) -> str:
        """SHA-256 of samples and dt (little-endian float64), hexadecimal: same numbers, same text."""
        digest = hashlib.sha256(self.acceleration.astype("<f8", copy=False).tobytes())
        digest.update(np.array(self.dt, dtype="<f8").tobytes())
        return digest.hexdigest()

    def scaled(self, factor: float) -> GroundMotion:
        """Return this motion times `factor` (a negative one mirrors it)."""
        factor = finite_number("factor", factor)
        return self.rescaled(factor, f"scaled by {factor!r}")

    def times(self, factor: float) -> GroundMotion:
        """Return this motion at another intensity of a sweep: the same record, name and history included.

        A peak beyond what was ever recorded is meant here, and passes without a warning.
        """
        louder = object.__new__(GroundMotion)
        samples = _samples(self.acceleration * finite_number("factor", factor))
        louder.__dict__.update({one.name: getattr(self, one.name) for one in fields(self)})
        louder.__dict__["acceleration"] = samples
        return louder

    def scaled_to_pga(self, pga: float) -> GroundMotion:
        """Return this motion scaled to a peak of `pga`, m/s2."""
        pga = positive_number("pga", pga, "m/s2")
        if self.pga == 0.0:
            raise InvalidInput(
                f"{self._title()} is zero throughout: no factor gives it a PGA of {pga!r} m/s2"
            )
        factor = pga / self.pga
        return self.rescaled(factor, f"scaled by {factor!r} to a PGA of {pga!r} m/s2")

    def rescaled(self, factor: float, step: str) -> GroundMotion:
        """Return this motion times `factor`, with `step`, which says what it was for, in its history."""
        with np.errstate(over="ignore"):  # an overflow is refused, with its reason, by the new motion
            acceleration = self.acceleration * factor
        return replace(
            self,
            acceleration=acceleration,
            history=(*self.history, step),
            scale_factor=self.scale_factor * factor,
        )

    def _title(self) -> str:
        return f"record {self.name}" if self.name else "the record"

    def __len__(self) -> int:
        return self.n

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, GroundMotion):
            return NotImplemented
        return self._identity() == other._identity()

    def __hash__(self) -> int:
        return hash(self._identity())

    def _identity(self) -> tuple[object, ...]:
        origin = (self.name, self.event, self.station, self.component, self.source)
        return (self.checksum, *origin, self.history, self.scale_factor)

    def __repr__(self) -> str:
        return f"<GroundMotion {self.name!r}: {self.n} samples, dt {self.dt:g} s, PGA {self.pga:.4g} m/s2>"

    def __setstate__(self, state: dict[str, Any]) -> None:
        # An array forgets that it was read-only when it is pickled to another process.
        self.__dict__.update(state)
        self.acceleration.flags.writeable = False


def _samples(acceleration: ArrayLike) -> NDArray[np.float64]:
    """Return a read-only copy of the samples, or say what is wrong with them."""
    try:
        given = np.asarray(acceleration)
    except ValueError as error:  # rows of unequal length
        raise InvalidInput(f"acceleration must be a one-dimensional array of numbers ({error})") from error
    if given.dtype.kind not in "iuf":
        raise InvalidInput(f"acceleration must be real numbers in m/s2, not of type {given.dtype}")
    if given.ndim != 1:
        raise InvalidInput(
            f"acceleration must have one dimension, shape (n,), not shape {given.shape}: give one component"
        )
    if given.size < 2:
        raise InvalidInput(f"acceleration must have at least 2 samples, not {given.size}")
    samples = np.array(given, dtype=np.float64, order="C")
    finite = np.isfinite(samples)
    if not finite.all():
        first = int(np.argmin(finite))
        raise InvalidInput(
            f"acceleration must be finite, but sample {first} (counted from 0) is {samples[first]}"
        )
    samples.flags.writeable = False
    return samples
