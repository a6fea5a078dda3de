"""What a study file says of how its records are scaled, and the doing of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final, get_args

import numpy as np

from fdspec.model.motion import GroundMotion
from fdspec.signals.scaling import UNITS, Combination, read_target, scaled_to_spectrum

GOALS: Final = ("factor", "pga", "sa", "target")


@dataclass(frozen=True)
class Scaling:
    """Say to what a record is scaled: one of `GOALS`.

    Parameters
    ----------
    factor : float
        By which the record is multiplied; a negative one mirrors it.
    pga : float
        Peak ground acceleration, m/s2.
    sa : float
        Pseudo-acceleration, m/s2, at `period`, or its geometric mean over a band of periods.
    target : str
        CSV file of periods and pseudo-accelerations that the record's come closest to over the band `period`.
    target_units : str
        g, m/s2 or cm/s2, where the file's heading does not say it.
    period : float or (float, float)
        s; two are the ends of a band.
    damping_ratio : float
    pair, pair_channel : str
        File, and channel, of the other horizontal component: the factor is then that of the pair.
    combination : str
        Of a pair's spectra: rotd50, rotd100 or geometric_mean.

    Raises
    ------
    ValueError
        When these contradict each other.
    """

    factor: float | None = None
    pga: float | None = None
    sa: float | None = None
    target: str | None = None
    target_units: str | None = None
    period: float | tuple[float, float] | None = None
    damping_ratio: float = 0.05
    pair: str | None = None
    pair_channel: str | None = None
    combination: Combination = "rotd50"

    def __post_init__(self) -> None:
        goals = [name for name in GOALS if getattr(self, name) is not None]
        if len(goals) != 1:
            raise ValueError(f"give one of {', '.join(GOALS)}, not {' and '.join(goals) or 'none'}")
        spectral = goals[0] in ("sa", "target")
        if spectral and self.period is None:
            raise ValueError(f"{goals[0]} needs period, in s: one, or the two ends of a band")
        given = {name for name in _OF_SPECTRA if getattr(self, name) != _DEFAULTS[name]}
        if not spectral and given:
            raise ValueError(f"{', '.join(sorted(given))} go with sa and target, not with {goals[0]}")
        if self.target_units is not None and self.target is None:
            raise ValueError("target_units goes with target")
        if goals[0] == "target" and not isinstance(self.period, tuple):
            raise ValueError("target needs the two ends of a band as period, as [0.2, 2.0]")

    def applied(
        self, motion: GroundMotion, folder: Path, read: Callable[[str, str | None], GroundMotion]
    ) -> GroundMotion:
        """Scale a motion; paths start in `folder`, and `read` reads the pair's file and channel."""
        if self.factor is not None:
            return motion.scaled(self.factor)
        if self.pga is not None:
            return motion.scaled_to_pga(self.pga)
        target = self.sa if self.target is None else read_target(folder / self.target, self.target_units)
        assert target is not None  # noqa: S101  one of the goals is given
        assert self.period is not None  # noqa: S101
        return scaled_to_spectrum(
            motion,
            target,
            self.period,
            damping_ratio=self.damping_ratio,
            pair=None if self.pair is None else read(self.pair, self.pair_channel),
            combination=self.combination,
        )

    @property
    def given(self) -> dict[str, Any]:
        """What differs from the defaults, as a study file writes it."""
        values = {name: getattr(self, name) for name in SCALING_FIELDS}
        return {
            name: list(value) if isinstance(value, tuple) else value
            for name, value in values.items()
            if value != _DEFAULTS[name]
        }


_DEFAULTS: Final = {field.name: field.default for field in fields(Scaling)}
SCALING_FIELDS: Final = tuple(_DEFAULTS)
_OF_SPECTRA: Final = ("period", "damping_ratio", "pair", "pair_channel", "combination", "target_units")


def scaling_of(table: object) -> Scaling:
    """Return the scaling that a table of a study file says; raise ValueError with one sentence."""
    if not isinstance(table, Mapping):
        raise ValueError(f"must be a table such as {{ sa = 4.0, period = 0.5 }}, got {table!r:.60}")
    if unknown := [key for key in table if key not in SCALING_FIELDS]:
        raise ValueError(f"unknown key {unknown[0]!r}; known are {', '.join(SCALING_FIELDS)}")
    return Scaling(**{key: _checked(key, value) for key, value in table.items()})


def _checked(key: str, value: object) -> Any:
    if key in ("target", "pair", "pair_channel"):
        if not isinstance(value, str) or not value:
            raise ValueError(f"{key} must be a string, got {value!r:.60}")
    elif key in ("combination", "target_units"):
        known = get_args(Combination) if key == "combination" else tuple(UNITS)
        if value not in known:
            raise ValueError(f"{key} must be one of {', '.join(known)}, got {value!r:.60}")
    elif key == "period" and isinstance(value, list | tuple):
        if len(value) != 2 or not all(_number(one) and one > 0.0 for one in value) or value[0] >= value[1]:
            raise ValueError(f"period must be one or two rising positive numbers, s, got {value!r:.60}")
        return (float(value[0]), float(value[1]))
    elif not _number(value) or value == 0.0:
        raise ValueError(f"{key} must be a number other than 0, got {value!r:.60}")
    elif key != "factor" and value < 0.0:  # type: ignore[operator]
        raise ValueError(f"{key} must be positive, got {value!r:.60}")
    elif key == "damping_ratio" and value >= 1.0:  # type: ignore[operator]
        raise ValueError(f"damping_ratio must be less than 1, got {value!r:.60}")
    return float(value) if isinstance(value, int | float) else value


def _number(value: object) -> bool:
    """Say whether this is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and bool(np.isfinite(value))
