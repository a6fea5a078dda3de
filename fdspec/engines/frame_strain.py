"""Strain energy of a frame's history, its area and its maximum, for Filiatrault and Cherry's index."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fdspec.kernels.frame.results import RADIANS
from fdspec.kernels.frame.strain_entry import integrate_frame_strain
from fdspec.kernels.storey.strain import STRAIN_RESULTS
from fdspec.model.building import Frame
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]


def strain_of_frame(frame: Frame, motion: GroundMotion, radians: float = RADIANS) -> FloatArray:
    """Integrate a frame of N storeys; return (len(STRAIN_RESULTS),)."""
    result = np.empty(len(STRAIN_RESULTS))
    integrate_frame_strain(
        frame.properties,
        frame.dense_stiffness,
        frame.dense_damping,
        motion.acceleration,
        motion.dt,
        radians,
        result,
    )
    return result
