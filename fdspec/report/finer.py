"""A cube's records on pretensions close together: what a picture needs to show where the response changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.figures.acceleration import told_parameters
from fdspec.figures.surfaces import STUDY_PANELS
from fdspec.model.motion import GroundMotion
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

FRAME: Final = (
    "floor_mass",
    "brace_mass",
    "damping_ratio",
    "friction_coefficient",
    "kinetic_friction_coefficient",
    "normal_force_factor",
    "brace_damping_ratio",
)
"""What a cube has to tell for its histories to be computed at other pretensions."""

LOWEST: Final = 2e3
"""N; below it the study's damper does next to nothing."""

COUNT: Final = 36
"""Pretensions, in equal ratios of about 1.2."""

OUTPUTS: Final = ("peak_acceleration", "elastic_acceleration", "braced_acceleration")

CHART_PERIODS: Final = (0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0)
"""s."""

CHART_SHARES: Final = (0.01, 3.0)
"""Slip force over floor mass times PGA, the ends of the chart."""


class Finer:
    """Compute a cube's records again, on pretensions close together; each once.

    Parameters
    ----------
    cube : xarray.Dataset
        What `fdspec.sweep` returns.
    motions : sequence of GroundMotion
        Those that it was made with, as far as they are found.
    """

    def __init__(self, cube: xr.Dataset, motions: Sequence[GroundMotion]) -> None:
        self.cube = cube
        self.motions = {motion.name: motion for motion in motions}
        told = told_parameters(cube)
        self.frame: dict[str, Any] = {name: told[name] for name in FRAME if name in told}
        ratios = cube["stiffness_ratio"].values
        shown = [ratio for ratio in ratios if np.isclose(ratio, STUDY_PANELS).any()]
        self.ratios = shown or list(ratios)
        self._made: dict[str, xr.Dataset] = {}
        self._charted: xr.Dataset | None = None

    @property
    def able(self) -> bool:
        """Whether the cube tells its frame."""
        return len(self.frame) == len(FRAME)

    def of(self, record: str) -> xr.Dataset:
        """Return one record on finer pretensions; the cube itself where that cannot be had."""
        if record not in self.motions or not self.able:
            return self.cube
        if record not in self._made:
            self._made[record] = self._swept([self.motions[record]])
        return self._made[record]

    def count(self, record: str) -> int:
        """Return the number of pretensions that `of` has."""
        return COUNT if record in self.motions and self.able else self.cube.sizes["pretension"]

    def together(self) -> xr.Dataset:
        """Return all records that were found, on finer pretensions."""
        import xarray as xr

        return xr.concat(
            [self.of(name) for name in self.motions],
            "record",
            data_vars="minimal",
            coords="minimal",
            combine_attrs="override",
            join="exact",
        )

    def for_chart(self) -> xr.Dataset:
        """Return the records scaled to a PGA of 1 g, at few periods, over shares of floor mass times PGA."""
        if self._charted is None:
            self._charted = self._swept_for_chart()
        return self._charted

    def _swept_for_chart(self) -> xr.Dataset:
        from fdspec.runs.sweep import sweep

        per_newton = self.frame["friction_coefficient"] * self.frame["normal_force_factor"]
        shares = np.geomspace(*CHART_SHARES, COUNT)
        return sweep(
            [motion.scaled_to_pga(G) for motion in self.motions.values()],
            period=CHART_PERIODS,
            stiffness_ratio=self.ratios,
            pretension=shares * self.frame["floor_mass"] * G / per_newton,
            outputs=["peak_acceleration"],
            certify=False,
            **self.frame,
        )

    def _swept(self, motions: Sequence[GroundMotion]) -> xr.Dataset:
        from fdspec.runs.sweep import sweep

        given = self.cube["pretension"].values
        highest = float(given[np.isfinite(given)].max())
        return sweep(
            motions,
            period=self.cube["period"].values,
            stiffness_ratio=self.ratios,
            pretension=np.geomspace(min(LOWEST, 0.1 * highest), highest, COUNT),
            outputs=list(OUTPUTS),
            certify=False,
            **self.frame,
        )
