"""What a choice says of its limits: which are met, how much of each is used, which is missed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from fdspec.choice.targets import Target, target_of
from fdspec.report.numbers import kilonewtons, percent, rounded
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr


class Shown(NamedTuple):
    """How a demand is written: its words, its unit, and the factor from SI."""

    words: str
    unit: str
    scale: float

    def written(self, value: float) -> str:
        """Write a demand, given in SI units, with its unit."""
        return f"{rounded(value * self.scale)} {self.unit}"


SHOWN: Final = {
    "acceleration": Shown("peak acceleration", "g", 1.0 / G),
    "drift": Shown("peak drift", "mm", 1e3),
    "drift_ratio": Shown("drift ratio", "%", 1e2),
    "base_shear": Shown("base shear", "kN", 1e-3),
    "residual_drift": Shown("residual drift", "mm", 1e3),
    "slip": Shown("slip", "mm", 1e3),
    "slip_travel": Shown("slip travel", "m", 1.0),
}

HEAD: Final = ("level", "demand", "value", "limit", "used")


def has_limits(choice: xr.Dataset) -> bool:
    """Say whether the choice was made to meet limits."""
    return "used" in choice


def met(choice: xr.Dataset) -> bool:
    """Say whether it was made to meet limits, and does."""
    return has_limits(choice) and bool(choice["limits_met"].item())


def missed(target: Target) -> str:
    """Say which limit cannot be met, and by how much."""
    worst = target.worst
    shown = SHOWN[worst.name]
    return (
        f"{shown.words} at level {worst.level:g} is over its limit by "
        f"{100.0 * (worst.value / worst.limit - 1.0):.1f} % "
        f"at best, {shown.written(worst.value)} of {shown.written(worst.limit)}"
    )


def limit_sentence(choice: xr.Dataset) -> str:
    """Say whether all limits are met, and how much of each is used."""
    target = target_of(choice)
    if not target.met:
        return f"no slip force meets all: {missed(target)}"
    told = [
        f"{SHOWN[one.name].words} {SHOWN[one.name].written(one.value)} of "
        f"{SHOWN[one.name].written(one.limit)} at level {one.level:g}"
        for one in target.demands
    ]
    return f"all met: {'; '.join(told)}"


def stretches(target: Target) -> str:
    """Return the stretches of slip force that meet all limits."""
    told = [
        f"{kilonewtons(start)} kN and more"
        if end == float("inf")
        else f"{kilonewtons(start)} to {kilonewtons(end)} kN"
        for start, end in target.bands
    ]
    return "; ".join(told)


def limit_rows(target: Target) -> list[list[str]]:
    """Return a row a limit and level under `HEAD`."""
    return [
        [
            f"{one.level:g}",
            SHOWN[one.name].words,
            SHOWN[one.name].written(one.value),
            SHOWN[one.name].written(one.limit),
            percent(one.value / one.limit),
        ]
        for one in target.demands
    ]
