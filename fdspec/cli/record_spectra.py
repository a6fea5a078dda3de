"""The elastic spectra that pictures of records show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.model.motion import GroundMotion

LONGEST: Final = 3.0
"""s; the longest period of the study's grid."""

STEP: Final = 0.01
"""s between periods; a spectrum of a real record is jagged at a tenth of its corner period."""


def drawn_spectra(motions: Sequence[GroundMotion], damping_ratio: Sequence[float]) -> xr.Dataset:
    """Compute spectra over even periods to the study's longest, from the shortest that all motions allow."""
    import numpy as np

    from fdspec.signals.spectra import SHORTEST, elastic_spectra

    shortest = max(motion.dt for motion in motions) * SHORTEST
    periods = STEP * np.arange(1, round(max(LONGEST, 10.0 * shortest) / STEP) + 1)
    return elastic_spectra(motions, periods[periods >= shortest], list(damping_ratio))
