"""Many single-storey histories under one ground motion: every slip force for each of many storeys."""

from __future__ import annotations

import numpy as np
from numba import types

from fdspec.jit import entry, float1d, float2d, float3d, ground1d
from fdspec.kernels.energy import losses
from fdspec.kernels.plan import plan
from fdspec.kernels.sdof import RESULTS, WORK_SHAPE, history
from fdspec.kernels.types import Motion, Storey

N_RESULTS = len(RESULTS)


@entry(types.void(float2d, float1d, float1d, ground1d, types.float64, types.float64, types.boolean, float3d))
def sweep_columns(storeys, slip_force, kinetic_slip_force, ground, dt, radians, certify, out):
    """Integrate storeys (m, 6) under each of the slip forces (p,); fill out (m, p, N_RESULTS).

    A storey's row: floor mass, damping, stiffness, brace mass, damping, stiffness.
    """
    work = np.empty(WORK_SHAPE)
    times = np.empty(0)
    phases = np.empty(0, np.int64)
    traces = np.empty((0, 0))
    rest = Motion(0.0, 0.0, 0.0, 0.0)
    for i in range(storeys.shape[0]):
        for j in range(slip_force.size):
            s = storeys[i]
            storey = Storey(s[0], s[1], s[2], s[3], s[4], s[5], slip_force[j], kinetic_slip_force[j])
            scheme = plan(storey, dt, radians)
            history(
                scheme,
                losses(scheme, certify, dt),
                ground,
                dt,
                0,
                certify,
                rest,
                work,
                times,
                phases,
                0.0,
                traces,
                out[i, j],
            )
