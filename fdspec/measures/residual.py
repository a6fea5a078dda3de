"""Residual displacement: what is left when the ground has come to rest."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.measures.cells import ended_well, require

if TYPE_CHECKING:
    import xarray as xr


def residual(cube: xr.Dataset) -> xr.Dataset:
    """Compute residual displacement, against the peak and against the largest that can stay.

    A floor at rest is held off its middle by friction alone, k_f u = R and \\|R\\| <= F, so no more than
    F / k_f can stay; MacRae and Kawashima (1997), Earthq. Eng. Struct. Dyn. 26, divide by the largest
    possible residual of their oscillators in the same way.  The cube's residual is the displacement at
    the record's last sample: where the record ends in motion, some of it is motion, and the ratio may
    exceed 1.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with residual_displacement and peak_displacement.

    Returns
    -------
    xarray.Dataset
        Over (record, stiffness_ratio, pretension, period): `residual_displacement`, magnitude, m;
        `share_of_peak` and `share_of_possible`, 1 (NaN where nothing moves, or nothing can stay).

    Raises
    ------
    InvalidInput
        When the cube lacks a variable or does not tell its floor mass.
    """
    import xarray as xr

    require(cube, ("residual_displacement", "peak_displacement", "slip_force"))
    parameters = json.loads(cube.attrs.get("parameters", "{}"))
    if "floor_mass" not in parameters:
        raise InvalidInput("the cube does not tell its floor_mass, which attrs['parameters'] of a sweep does")
    stays = abs(ended_well(cube, "residual_displacement"))
    peak = ended_well(cube, "peak_displacement")
    stiffness = parameters["floor_mass"] * (2.0 * math.pi / cube["period"]) ** 2
    possible = cube["slip_force"] / stiffness
    found = xr.Dataset(
        {
            "residual_displacement": stays,
            "share_of_peak": stays / peak.where(peak > 0.0),
            "share_of_possible": (stays / possible.where(possible > 0.0)).transpose(*stays.dims),
        }
    )
    found["share_of_possible"] = found["share_of_possible"].where(np.isfinite(cube["slip_force"]))
    told = {
        "residual_displacement": ("m", "magnitude of the displacement at the end"),
        "share_of_peak": ("1", "residual over peak displacement"),
        "share_of_possible": ("1", "residual displacement over slip force / frame stiffness"),
    }
    for name, (units, long_name) in told.items():
        found[name].attrs = {"units": units, "long_name": long_name}
    return found
