"""Integration of a smooth law by scipy's LSODA, read at equal steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.model.motion import GroundMotion

MOST_STEPS_BETWEEN = 1_000_000
"""Of the integrator, between two instants at which the motion is read."""


def integrate_smooth(
    rates: Callable[[FloatArray, float, FloatArray], None],
    start: FloatArray,
    intervals: FloatArray,
    motion: GroundMotion,
    parts: int,
    rtol: float,
    atol: FloatArray,
) -> tuple[FloatArray, int]:
    """Return the states (k, n) at the ends of all steps, and a status.

    rates: fills its last argument with y' for a state y and a ground acceleration.  The kinks of the ground
    at its samples are met by the integrator's control of its own step, which is at most a sample long.
    """
    from scipy.integrate import odeint

    from fdspec.kernels.types import NON_FINITE_STATE

    dt, last = motion.dt, intervals.shape[0] - 1
    begin, slope = intervals[:, 0].tolist(), ((intervals[:, 1] - intervals[:, 0]) / dt).tolist()
    out = np.empty_like(start)

    def derivative(t: float, y: FloatArray) -> FloatArray:
        k = min(int(t / dt), last)
        rates(y, begin[k] + slope[k] * (t - k * dt), out)
        return out

    times = np.arange(intervals.shape[0] * parts + 1) * (dt / parts)
    states, told = odeint(
        derivative,
        start,
        times,
        tfirst=True,
        rtol=rtol,
        atol=atol,
        hmax=dt,
        mxstep=MOST_STEPS_BETWEEN,
        full_output=True,
    )
    whole = told["message"] == "Integration successful." and bool(np.isfinite(states).all())
    return states, 0 if whole else NON_FINITE_STATE
