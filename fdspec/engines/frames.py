"""Many histories of frames of N storeys: side by side where the frames allow it, else one by one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fdspec.engines.trajectory import FloatArray
from fdspec.kernels.frame.model import (
    BRACE_DAMPING,
    BRACE_MASS,
    BRACE_STIFFNESS,
    GROUND_DAMPING,
    GROUND_STIFFNESS,
    STOREY_DAMPING,
)
from fdspec.kernels.frame.results import DEMAND_ROWS, DEMANDS, RADIANS, STOREY_RESULTS, TOTALS
from fdspec.kernels.frame_batch.entry import integrate_frames
from fdspec.model.building import Frame
from fdspec.model.motion import GroundMotion


def runs_beside_others(frame: Frame) -> bool:
    """Whether a frame is one of those that run side by side: none of its braces is massless."""
    massless = (frame.properties[BRACE_MASS] == 0.0) & (frame.properties[BRACE_STIFFNESS] > 0.0)
    return not massless.any()


def peaks_of_frames(
    frames: Sequence[Frame], motion: GroundMotion, *, certify: bool
) -> tuple[FloatArray, FloatArray]:
    """Integrate frames of equally many storeys from rest, without their trajectory.

    certify: whether the balance of all energies is wanted.  Returns the rows of STOREY_RESULTS for each
    storey (m, rows, N), and TOTALS (m, entries).  No history depends on which others are asked for.
    The peaks of slip, brace force and column shear are NaN: `fdspec.engines.many_storeys.peaks_of` has them.
    """
    size = frames[0].properties.shape[1]
    by_storey = np.empty((len(frames), len(STOREY_RESULTS), size))
    totals = np.empty((len(frames), len(TOTALS)))
    alike: dict[tuple[bool, ...] | None, list[int]] = {}
    for item, frame in enumerate(frames):
        key = _parts(frame) if runs_beside_others(frame) else None
        alike.setdefault(key, []).append(item)
    for parts, items in alike.items():
        if parts is None:
            from fdspec.engines.many_storeys import peaks_of

            for item in items:
                by_storey[item], totals[item] = peaks_of(frames[item], motion, certify=certify)
        else:
            found = _side_by_side([frames[item] for item in items], parts, motion, certify)
            by_storey[items], totals[items] = found
    by_storey[:, DEMANDS : DEMANDS + DEMAND_ROWS] = np.nan
    return by_storey, totals


def _parts(frame: Frame) -> tuple[bool, ...]:
    """Tell which parts a frame has: dense matrices; dashpots, ties to the ground, dashpots of braces."""
    rows = frame.properties
    damped_braces = bool(rows[BRACE_DAMPING].any())
    return (
        frame.dense_stiffness.size > 0,
        frame.dense_damping.size > 0,
        damped_braces or bool(rows[STOREY_DAMPING].any()),
        bool(rows[[GROUND_STIFFNESS, GROUND_DAMPING]].any()),
        damped_braces,
    )


def _side_by_side(
    frames: Sequence[Frame], parts: tuple[bool, ...], motion: GroundMotion, certify: bool
) -> tuple[FloatArray, FloatArray]:
    _, _, damped, grounded, damped_braces = parts
    properties = np.stack([frame.properties for frame in frames])
    which: dict[tuple[int, int], int] = {}
    matrices: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
    dense = np.empty(len(frames), np.int64)
    for item, frame in enumerate(frames):
        key = id(frame.dense_stiffness), id(frame.dense_damping)
        if key not in which:
            which[key] = len(matrices)
            matrices.append((frame.dense_stiffness, frame.dense_damping))
        dense[item] = which[key]
    by_storey = np.empty((len(frames), len(STOREY_RESULTS), properties.shape[2]))
    totals = np.empty((len(frames), len(TOTALS)))
    integrate_frames(
        properties,
        dense,
        np.stack([stiffness for stiffness, _ in matrices]),
        np.stack([damping for _, damping in matrices]),
        damped,
        grounded,
        damped_braces,
        motion.acceleration,
        motion.dt,
        certify,
        RADIANS,
        by_storey,
        totals,
    )
    return by_storey, totals
