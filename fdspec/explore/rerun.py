"""The history of one cell: its frame from the cube's own parameters, its motion found again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from fdspec.errors import InvalidInput
from fdspec.explore.motions import Found, Motions
from fdspec.explore.traces import LOOP_FINER, packed_history
from fdspec.model.building import Building
from fdspec.model.grid import DEVICE_FIELDS
from fdspec.model.link import link_of
from fdspec.runs.bounds import refuse_long
from fdspec.runs.cost import seconds_of_history
from fdspec.runs.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

PAGE_HOURS: Final = 1.0 / 60.0
"""h that a history for the page may take."""


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

    def of(self, record: int) -> tuple[Rerun, int]:
        """Return who runs the histories of a record, this, and its position here."""
        return self, record

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
        return self.simulated(self.building(stiffness_ratio, pretension, period), found, finer)

    @staticmethod
    def simulated(frame: Building, found: Found, finer: int) -> tuple[xr.Dataset, str]:
        """Return a frame's history, refused where it would keep the page waiting, and its notice."""
        seconds = seconds_of_history(frame, found.motion.dt, found.motion.n)
        refuse_long(seconds, PAGE_HOURS, "this history")
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
        bare = Building.single_storey(
            period=float(cell["period"]),
            stiffness_ratio=0.0,
            slip_force=0.0,
            **{**self.frame, "brace_mass": 0.0, "brace_damping_ratio": 0.0},
        )
        found = self.motions.find(str(self.cube["record"].values[record]))
        return packed_history(history, simulate(bare, found.motion), notice, cell)


FRAME: Final = ("floor_mass", "brace_mass", "damping_ratio", "brace_damping_ratio")
FRICTION: Final = ("friction_coefficient", "kinetic_friction_coefficient", "normal_force_factor")


def _parameters(cube: xr.Dataset) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the cube's provenance says of frame and friction, as `fdspec.sweep` names it."""
    try:
        told: dict[str, Any] = json.loads(str(cube.attrs["parameters"]))
        frame: dict[str, Any] = {name: float(told[name]) for name in FRAME}
        scalars = [name for name in DEVICE_FIELDS if name != "links" and told.get(name) is not None]
        frame |= {name: float(told[name]) for name in scalars}
        if told.get("links"):
            frame["links"] = [link_of(link) for link in told["links"]]
        return frame, {name: None if told[name] is None else float(told[name]) for name in FRICTION}
    except (KeyError, TypeError, ValueError) as error:
        raise InvalidInput(
            f"the cube's attribute parameters does not tell {', '.join((*FRAME, *FRICTION))} ({error}); "
            "histories need a cube that fdspec sweep made"
        ) from error
