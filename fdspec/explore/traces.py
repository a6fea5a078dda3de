"""A history as the page draws it: its course, its energies, its loop, and its peaks beside the cube's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from fdspec.explore.packing import pack
from fdspec.measures import hysteresis
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

TRACES: Final[Mapping[str, float]] = {
    "displacement": 1e3,
    "brace_displacement": 1e3,
    "friction_force": 1e-3,
    "acceleration": 1.0 / G,
    "ground_acceleration": 1.0 / G,
}
"""What is drawn of a history, and the factor to the page's mm, kN and g."""

LOOP_FINER: Final = 8
"""Outputs computed for each sample of the motion, so that the loop knows the slip of short sticks too."""

COMPARED: Final = (
    ("peak_acceleration", "Peak absolute acceleration", "g", 1.0 / G),
    ("peak_displacement", "Peak displacement", "mm", 1e3),
    ("peak_velocity", "Peak velocity", "m/s", 1.0),
    ("peak_base_shear", "Peak base shear", "kN", 1e-3),
    ("residual_displacement", "Residual displacement", "mm", 1e3),
    ("dissipated_energy", "Energy dissipated by friction", "kJ", 1e-3),
    ("transitions", "Changes of phase", "", 1.0),
)
"""What a history and its cell both tell: variable, words, unit, factor to it."""

ENERGIES: Final = ("friction_energy", "viscous_energy", "strain_energy", "kinetic_energy", "input_energy")
"""Drawn over time, in kJ."""


def packed_history(history: xr.Dataset, bare: xr.Dataset, notice: str, cell: xr.Dataset | None) -> bytes:
    """Pack a history whose outputs are `LOOP_FINER` a sample, beside the bare frame's and the cube's cell.

    Over time, one output a sample: what `TRACES` names, the bare frame's displacement and acceleration, the
    energies in kJ; the hysteresis loop corner by corner.
    """
    one = history.isel(storey=0)
    slip_force = one["slip_force"].item() / 1e3
    about = {
        "record": str(history["record"].item()),
        "notice": notice,
        "slip_force": slip_force if np.isfinite(slip_force) else None,
        "compared": [
            {
                "title": title,
                "unit": unit,
                "history": one[name].item() * factor,
                "cube": _of_cell(cell, name, factor),
            }
            for name, title, unit, factor in COMPARED
        ],
    }
    arrays = {name: one[name].values[::LOOP_FINER] * factor for name, factor in TRACES.items()}
    arrays["time"] = one["time"].values[::LOOP_FINER]
    arrays |= {
        f"bare_{name}": bare[name].values[:, 0] * TRACES[name] for name in ("displacement", "acceleration")
    }
    arrays |= {name: history[name].values[::LOOP_FINER] / 1e3 for name in ENERGIES}
    corners = hysteresis(history)
    arrays |= {"loop_slip": corners["slip"].values * 1e3, "loop_force": corners["force"].values / 1e3}
    return pack(about, arrays)


def _of_cell(cell: xr.Dataset | None, name: str, factor: float) -> float | None:
    if cell is None or name not in cell:
        return None
    value = float(cell[name].item()) * factor
    return value if np.isfinite(value) else None
