"""The history of one cell: its frame from the cube's own parameters, its motion found again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.explore.motions import Motions
from fdspec.explore.packing import pack
from fdspec.model.building import Building
from fdspec.runs.simulate import simulate
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

TRACES: Final[Mapping[str, float]] = {
    "displacement": 1e3,
    "brace_displacement": 1e3,
    "friction_force": 1e-3,
    "acceleration": 1.0 / G,
    "ground_acceleration": 1.0 / G,
}
"""What is drawn of a history, and the factor to the page's mm, kN and g."""

LOOP_FINER: Final = 8
"""Outputs of the hysteresis loop for each sample of the motion: a damper sticks and slips within a sample."""

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


class Rerun:
    """Run the histories of a cube's cells.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns, with its provenance.
    files : mapping of str to path, optional
        Record name -> its file; see `fdspec.explore.motions.Motions`.
    folder : path
        The cube's folder.

    Raises
    ------
    InvalidInput
        When the cube does not say with which parameters it was made, or `files` names an unknown record.
    """

    def __init__(
        self, cube: xr.Dataset, files: Mapping[str, Path] | None = None, folder: Path = Path()
    ) -> None:
        self.cube = cube
        self.motions = Motions(cube, files or {}, folder)
        self.frame, self.friction = _parameters(cube)

    def building(self, stiffness_ratio: int, pretension: int, period: int) -> Building:
        """Return the frame at these positions of the cube."""
        at = self.cube.coords.to_dataset().isel(
            stiffness_ratio=stiffness_ratio, pretension=pretension, period=period
        )
        return Building.single_storey(
            period=float(at["period"]),
            stiffness_ratio=float(at["stiffness_ratio"]),
            slip_force=float(at["slip_force"]),
            kinetic_slip_force=float(at["kinetic_slip_force"]),
            **self.frame,
        )

    def history(
        self, record: int, stiffness_ratio: int, pretension: int, period: int, finer: int = 1
    ) -> tuple[xr.Dataset, str]:
        """Return the history of a cell, `finer` outputs a sample, and what a reader must know of its motion.

        Raises
        ------
        InvalidInput
            When a position is not in the cube, or the record cannot be found.
        IntegrationError
            When the history cannot be completed.
        """
        self.check(record=record, stiffness_ratio=stiffness_ratio, pretension=pretension, period=period)
        found = self.motions.find(str(self.cube["record"].values[record]))
        frame = self.building(stiffness_ratio, pretension, period)
        return simulate(frame, found.motion, dt_out=found.motion.dt / finer), found.notice

    def check(self, **place: int) -> None:
        """Raise InvalidInput for a position outside the cube."""
        for dim, position in place.items():
            if not 0 <= position < self.cube.sizes[dim]:
                raise InvalidInput(
                    f"{dim} must be a position from 0 to {self.cube.sizes[dim] - 1}, got {position}"
                )

    def packed(self, record: int, stiffness_ratio: int, pretension: int, period: int) -> bytes:
        """Return the history of a cell for the page: traces, and its peaks beside the cube's."""
        history, notice = self.history(record, stiffness_ratio, pretension, period, LOOP_FINER)
        cell = self.cube.isel(
            record=record, stiffness_ratio=stiffness_ratio, pretension=pretension, period=period
        )
        one = history.isel(storey=0)
        about = {
            "record": str(history["record"].item()),
            "notice": notice,
            "slip_force": _finite(one["slip_force"].item() / 1e3),
            "compared": [
                {
                    "title": title,
                    "unit": unit,
                    "history": one[name].item() * factor,
                    "cube": _finite(cell[name].item() * factor) if name in cell else None,
                }
                for name, title, unit, factor in COMPARED
            ],
        }
        fine = {name: one[name].values * factor for name, factor in TRACES.items()}
        slip, force = loop(fine["displacement"] - fine["brace_displacement"], fine["friction_force"])
        arrays = {name: values[::LOOP_FINER] for name, values in fine.items()}
        arrays |= {"time": one["time"].values[::LOOP_FINER], "loop_slip": slip, "loop_force": force}
        return pack(about, arrays)


def loop(slip: FloatArray, force: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the corners of a hysteresis loop, without the points that lie straight between two others.

    slip, force: (n,); both constant to a millionth of their largest value count as constant.
    """
    still = [
        np.abs(np.diff(values)) <= 1e-6 * max(float(np.abs(values).max()), 1e-300) for values in (slip, force)
    ]
    steps = [
        np.where(calm, 0.0, np.sign(np.diff(values)))
        for calm, values in zip(still, (slip, force), strict=True)
    ]
    straight = (steps[0] == 0.0) | (steps[1] == 0.0)
    same = (steps[0][1:] == steps[0][:-1]) & (steps[1][1:] == steps[1][:-1]) & straight[1:] & straight[:-1]
    kept = np.concatenate(([True], ~same, [True]))
    return slip[kept], force[kept]


FRAME: Final = ("floor_mass", "brace_mass", "damping_ratio", "brace_damping_ratio")
FRICTION: Final = ("friction_coefficient", "kinetic_friction_coefficient", "normal_force_factor")


def _parameters(cube: xr.Dataset) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the cube's provenance says of frame and friction, as `fdspec.sweep` names it."""
    try:
        told: dict[str, Any] = json.loads(str(cube.attrs["parameters"]))
        frame = {name: float(told[name]) for name in FRAME}
        return frame, {name: None if told[name] is None else float(told[name]) for name in FRICTION}
    except (KeyError, TypeError, ValueError) as error:
        raise InvalidInput(
            f"the cube's attribute parameters does not tell {', '.join((*FRAME, *FRICTION))} ({error}); "
            "histories need a cube that fdspec sweep made"
        ) from error


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
