"""Entry point of the single-storey engine for one history with its course in time."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, given1d, int1d, record_of
from fdspec.kernels.mathematics.oscillator import TERMS
from fdspec.kernels.storey.constants import plan, steps_per_sample
from fdspec.kernels.storey.energy import N_FORMS, put_losses
from fdspec.kernels.storey.history import history
from fdspec.kernels.types import Motion, Storey


@entry(
    types.int64(
        record_of(Storey),
        given1d,
        types.float64,
        types.int64,
        types.boolean,
        types.float64,
        record_of(Motion),
        types.boolean,
        float1d,
        float1d,
        int1d,
        types.float64,
        float2d,
        float1d,
    )
)
def integrate(
    storey, ground, dt, free_steps, at_rest, radians, start, resumes, s, times, phases, dt_out, traces, result
):
    """Integrate one history; arguments as in :func:`fdspec.kernels.storey.history.history`.

    s (N_STATE,): the state at the end, afterwards.
    """
    parts = steps_per_sample(storey, dt, radians)
    scheme = plan(storey, dt / parts, radians)
    forms = np.empty(N_FORMS)
    put_losses(scheme, forms)
    floor, brace, search = np.empty(TERMS), np.empty(TERMS), np.empty(TERMS)
    return history(
        scheme,
        forms,
        ground,
        dt,
        parts,
        free_steps,
        at_rest,
        start,
        resumes,
        s,
        floor,
        brace,
        search,
        times,
        phases,
        dt_out,
        traces,
        result,
    )
