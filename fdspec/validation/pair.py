"""A frame with its dampers beside the same frame without them, under one motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate

DT_OUT = 2e-3
"""Time between outputs, s; no result depends on it."""


class Pair(NamedTuple):
    """Two histories with the same outputs, as `fdspec.simulate` returns them."""

    bare: xr.Dataset
    damped: xr.Dataset


def both(building: Building, motion: GroundMotion) -> Pair:
    """Simulate a building and its bare frame, the same floors and columns without braces."""
    none = np.zeros(building.n_storeys)
    bare = Building(
        building.floor_mass,
        building.storey_stiffness,
        brace_mass=none,
        brace_stiffness=none,
        slip_force=none,
        damping=building.damping,
    )
    return Pair(*(simulate(frame, motion, dt_out=DT_OUT) for frame in (bare, building)))
