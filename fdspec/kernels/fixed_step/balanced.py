"""Discrete-time solution of a linear frame whose dampers' forces are balanced at the end of each step.

    z+ = A z + g0 a_g + g1 a_g+ + B0 w + B1 w+

is exact for a ground acceleration that is linear in the step.  What a damper adds, w, is known only with the
state it leads to, so each is first tried as if it stuck, and where friction cannot carry that, it slips:

- HELD: w is the friction force, held over the step.  y = Y z+ is the sliding velocity; sticking means y = 0.
- OFFSET: w is the slip offset of a damper in series with a spring k, linear over the step.  Y z+ - k w+ is
  the spring's force; sticking means that w stands still, slipping that the force is that of friction.

Several dampers act on each other; they are balanced one after the other until nothing moves.
"""

from __future__ import annotations

import math

from numba import types

from fdspec.compiler.options import entry, float1d, float2d, inner
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.types import ITERATION_NOT_CONVERGED, NON_FINITE_STATE, OK, STICK

HELD, OFFSET = 0, 1
"""What w is."""

MOST_ROUNDS = 10_000
BALANCE = 1e-12
"""Largest change of the last round, relative to w."""


@inner
def outcome(trial, phase, static, kinetic):
    """Phase that follows, from the force which sticking would take."""
    if phase != STICK and phase * trial > kinetic:
        return phase
    if abs(trial) <= static:
        return STICK
    return 1 if trial > 0.0 else -1


@entry(
    types.int64(
        float2d,
        float2d,
        float2d,
        float2d,
        float2d,
        float2d,
        float1d,
        float1d,
        float1d,
        float2d,
        types.int64,
        types.int64,
        float2d,
        float2d,
        types.Array(types.int64, 2, "C"),
    )
)
def march(a, pull, b0, b1, y, s, spring, static, kinetic, ground, parts, kind, states, dampers, phases):
    """March through the ground motion and return a status.

    a (n, n); pull (2, n): g0, g1; b0, b1 (n, N); y (N, n); s (N, N): what w+ takes off the trial force or
    velocity; spring, static, kinetic (N,); ground (m, 2): acceleration at both ends of each of m intervals,
    with ``parts`` steps in each.  Filled, from their first rows on, which hold the start: states (steps + 1,
    n), dampers (steps + 1, N): w; phases (steps + 1, N).
    """
    n, size = a.shape[0], s.shape[0]
    k = 0
    for interval in range(ground.shape[0]):
        rate = (ground[interval, 1] - ground[interval, 0]) / parts
        for part in range(parts):
            begin = ground[interval, 0] + rate * part
            end = ground[interval, 0] + rate * (part + 1)
            z, free, w, after = states[k], states[k + 1], dampers[k], dampers[k + 1]
            for i in range(n):
                total = pull[0, i] * begin + pull[1, i] * end
                for j in range(n):
                    total += a[i, j] * z[j]
                for j in range(size):
                    total += b0[i, j] * w[j]
                    if kind == OFFSET:
                        total += b1[i, j] * w[j]
                free[i] = total
            for i in range(size):
                after[i] = 0.0 if kind == OFFSET else w[i]
                phases[k + 1, i] = phases[k, i]
            settled = False
            for _ in range(MOST_ROUNDS):
                settled = True
                for i in range(size):
                    wanted = -spring[i] * w[i] if kind == OFFSET else 0.0
                    for j in range(n):
                        wanted += y[i, j] * free[j]
                    for j in range(size):
                        if j != i:
                            wanted -= s[i, j] * after[j]
                    trial = wanted if kind == OFFSET else wanted / s[i, i]
                    phase = outcome(trial, phases[k, i], static[i], kinetic[i])
                    phases[k + 1, i] = phase
                    if kind == OFFSET:
                        new = 0.0 if phase == STICK else (trial - sliding_force(phase, kinetic[i])) / s[i, i]
                    else:
                        new = trial if phase == STICK else sliding_force(phase, kinetic[i])
                    if not abs(new - after[i]) <= BALANCE * max(abs(new), abs(w[i])):
                        settled = False
                    after[i] = new
                if settled or size == 1:
                    settled = True
                    break
            if not settled:
                return ITERATION_NOT_CONVERGED
            for i in range(n):
                for j in range(size):
                    free[i] += b1[i, j] * after[j]
            if kind == OFFSET:
                for i in range(size):
                    after[i] += w[i]
            k += 1
            if not math.isfinite(free[n - 1]):
                return NON_FINITE_STATE
    return OK
