"""A history anywhere: at values that the cube has not, of a frame with another mass, damping or friction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import xarray as xr

from fdspec.errors import InvalidInput
from fdspec.explore.rerun import Rerun
from fdspec.explore.traces import LOOP_FINER, packed_history
from fdspec.model.building import Building
from fdspec.runs.simulate import simulate


@dataclass(frozen=True, slots=True)
class Field:
    """A number of the point: its unit on the page, the factor to SI, and what it may be, in SI."""

    name: str
    title: str
    unit: str
    factor: float
    low: float
    high: float


FIELDS: Final = (
    Field("period", "Period", "s", 1.0, 0.01, 100.0),
    Field("stiffness_ratio", "Stiffness ratio", "", 1.0, 0.0, 1e4),
    Field("pretension", "Pretension", "kN", 1e3, 0.0, 1e12),
    Field("floor_mass", "Floor mass", "t", 1e3, 1.0, 1e12),
    Field("brace_mass", "Brace mass", "kg", 1.0, 1e-3, 1e12),
    Field("damping_ratio", "Damping ratio", "", 1.0, 0.0, 0.99),
    Field("friction_coefficient", "Friction coefficient", "", 1.0, 0.0, 10.0),
)
"""What the page has a field for. The bounds keep a history short."""


def point_of(given: Mapping[str, str]) -> dict[str, float]:
    """Take a point from an address, in the page's units; return it in SI.

    Raises
    ------
    InvalidInput
        For what is missing, no number, or out of its bounds.
    """
    found = {}
    for field in FIELDS:
        try:
            value = float(given.get(field.name, "")) * field.factor
        except ValueError:
            raise InvalidInput(
                f"{field.title.lower()} must be a number, got {given.get(field.name, '')[:40]!r}"
            ) from None
        if not (math.isfinite(value) and field.low <= value <= field.high):
            low, high = (
                f"{bound / field.factor:g} {field.unit}".strip() for bound in (field.low, field.high)
            )
            raise InvalidInput(
                f"{field.title.lower()} must be from {low} to {high}, got {value / field.factor:g}"
            )
        found[field.name] = value
    return found


def frame_at(rerun: Rerun, point: Mapping[str, float]) -> Building:
    """Return the frame at a point (SI); what the point does not say is the cube's."""
    told = rerun.friction
    coefficient, factor = point["friction_coefficient"], told["normal_force_factor"]
    static = coefficient * factor * point["pretension"]
    kinetic = told["kinetic_friction_coefficient"]
    share = 1.0 if kinetic is None else kinetic / told["friction_coefficient"]
    return Building.single_storey(
        period=point["period"],
        stiffness_ratio=point["stiffness_ratio"],
        slip_force=static,
        kinetic_slip_force=share * static,
        floor_mass=point["floor_mass"],
        brace_mass=point["brace_mass"],
        damping_ratio=point["damping_ratio"],
        brace_damping_ratio=rerun.frame["brace_damping_ratio"],
    )


def history_at(
    rerun: Rerun, record: int, point: Mapping[str, float], finer: int = 1
) -> tuple[xr.Dataset, str]:
    """Return the history at a point (SI) and what a reader must know of its motion."""
    rerun.check(record=record)
    found = rerun.motions.find(str(rerun.cube["record"].values[record]))
    return rerun.simulated(frame_at(rerun, point), found, finer)


def packed_point(rerun: Rerun, record: int, point: Mapping[str, float]) -> bytes:
    """Return the history at a point for the page, as `packed_history` describes."""
    history, notice = history_at(rerun, record, point, LOOP_FINER)
    bare = Building.single_storey(
        period=point["period"],
        stiffness_ratio=0.0,
        slip_force=0.0,
        floor_mass=point["floor_mass"],
        brace_mass=0.0,
        damping_ratio=point["damping_ratio"],
    )
    motion = rerun.motions.find(str(rerun.cube["record"].values[record])).motion
    return packed_history(history, simulate(bare, motion), notice, None)
