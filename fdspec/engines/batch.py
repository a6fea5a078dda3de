"""Every slip force for each of many single storeys under one ground motion.

A storey whose slip force exceeds the largest reaction of the braced frame never slips: one history
serves all such slip forces, exactly.  The others run in lanes, side by side with whatever others take
as many steps a sample.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fdspec.kernels.batch.entry import prepare, run_lanes
from fdspec.kernels.batch.layout import N_PLAN, N_STRIDE, WIDTH
from fdspec.kernels.storey.constants import RADIANS
from fdspec.kernels.storey.energy import N_FORMS
from fdspec.kernels.storey.history import RESULTS
from fdspec.model.motion import GroundMotion

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def integrate_columns(
    frames: FloatArray,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    motion: GroundMotion,
    *,
    certify: bool,
    free_steps: int = 0,
    at_rest: bool = False,
    radians: float = RADIANS,
) -> tuple[FloatArray, FloatArray]:
    """Integrate frames (m, 6), braced and under each of the slip forces (p,).

    A frame's row: floor mass, damping, stiffness, brace mass, damping, stiffness, SI units.  certify:
    whether the balance of all energies is wanted.
    free_steps: steps of dt with the ground at rest that follow; at_rest: whether each goes on from there
    until nothing can slip any more.  Returns results of the braced frames
    (m, len(RESULTS)) and of all slip forces (m, p, len(RESULTS)).
    """
    run = partial(
        _integrate, motion=motion, certify=certify, free_steps=free_steps, at_rest=at_rest, radians=radians
    )
    never = np.full((frames.shape[0], 2), (np.inf, 0.0))
    braced, held = run(np.hstack([frames, never]), 0.0)
    results = np.repeat(braced[:, np.newaxis], slip_force.size, axis=1)
    column, force = np.nonzero(slip_force <= held[:, np.newaxis])
    slipping = np.column_stack([frames[column], slip_force[force], kinetic_slip_force[force]])
    # Neighbours should slip about as much: where none of them does, only stick is computed.
    likeness = slip_force[force] / np.maximum(held[column], np.finfo(float).tiny)
    results[column, force], _ = run(slipping, likeness)
    return braced, results


def _integrate(
    storeys: FloatArray,
    likeness: FloatArray | float,
    motion: GroundMotion,
    certify: bool,
    free_steps: int,
    at_rest: bool,
    radians: float,
) -> tuple[FloatArray, FloatArray]:
    """Integrate storeys (m, 8) in lanes, alike ones together; return results and the reactions they reach."""
    size = storeys.shape[0]
    parts = np.empty(size, np.int64)
    plans, forms, stride = np.empty((size, N_PLAN)), np.empty((size, N_FORMS)), np.empty((size, N_STRIDE))
    prepare(np.ascontiguousarray(storeys), motion.dt, radians, certify, parts, plans, forms, stride)
    results, held = np.empty((size, len(RESULTS))), np.empty(size)
    order = np.lexsort((np.broadcast_to(likeness, size), parts))
    for group in _groups(parts[order]):
        lanes = order[group]
        out, reached = np.empty((lanes.size, len(RESULTS))), np.empty(lanes.size)
        run_lanes(
            plans[lanes],
            forms[lanes],
            stride[lanes],
            motion.acceleration,
            motion.dt,
            int(parts[lanes[0]]),
            certify,
            free_steps,
            at_rest,
            out,
            reached,
        )
        results[lanes], held[lanes] = out, reached
    return results, held


def _groups(parts: IntArray) -> Iterator[slice]:
    """Slices of at most WIDTH neighbours that take the same number of steps a sample."""
    starts = np.flatnonzero(np.diff(parts, prepend=-1))
    for first, last in pairwise([*starts, parts.size]):
        for at in range(first, last, WIDTH):
            yield slice(at, min(at + WIDTH, last))
