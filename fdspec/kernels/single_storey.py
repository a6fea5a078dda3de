"""Entry points of the single-storey engine."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.jit import entry, float1d, float2d, ground1d, int1d, record_of
from fdspec.kernels.energy import losses
from fdspec.kernels.plan import plan
from fdspec.kernels.sdof import WORK_SHAPE, history
from fdspec.kernels.types import Motion, Storey

RADIANS = 1.0
"""Longest phase of a piece that is searched for roots; no result depends on it."""


@entry(
    types.void(
        record_of(Storey),
        ground1d,
        types.float64,
        types.int64,
        types.float64,
        types.boolean,
        record_of(Motion),
        float1d,
        int1d,
        types.float64,
        float2d,
        float1d,
    )
)
def integrate(storey, ground, dt, free_steps, radians, certify, start, times, phases, dt_out, traces, result):
    """Integrate one history; arguments as in :func:`fdspec.kernels.sdof.history`."""
    work = np.empty(WORK_SHAPE)
    scheme = plan(storey, dt, radians)
    history(
        scheme,
        losses(scheme, certify, dt),
        ground,
        dt,
        free_steps,
        certify,
        start,
        work,
        times,
        phases,
        dt_out,
        traces,
        result,
    )
