"""What a designer reads off of each storey of a frame beside the floors' peaks: slip, brace and columns."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import (
    COLUMNS,
    DASHPOT,
    GIVEN_FORCE,
    GROUND_SPRINGS,
    GROUND_STIFFNESS,
    SLIDING_COMPLIANCE,
    SPRING,
    STOREY_STIFFNESS,
)
from fdspec.kernels.frame.peaks import PEAK_DRIFT, shorten
from fdspec.kernels.frame.taylor import (
    ACCELERATION_REACH,
    DISPLACEMENT,
    INERTIA,
    OFFSET,
    REACTION_REACH,
    SLIDING,
    VELOCITY,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude

PEAK_SLIP = 0
PEAK_BRACE_FORCE = 1
PEAK_COLUMN_SHEAR = 2
"""Rows of ``demands`` (DEMAND_ROWS, N): m, N, N."""


@inner
def raise_demands(model, series, reach, state, n, h, x, ground, rise, c, demands):
    """Raise the peaks to those of the first part x of the step, at whose end ``state`` stands.

    Sliding keeps its sign on a step, so that the largest slip stands at one of its ends.  The brace's stretch
    accelerates by no more than both floors and the sliding do together: that bounds how far its force leaves
    the larger of its values at both ends, and only where this leaves room for a new peak is it searched.
    """
    strongest = abs(ground) + abs(rise)
    for i in range(state.shape[1]):
        demands[PEAK_SLIP, i] = max(
            demands[PEAK_SLIP, i], max(abs(series[OFFSET, i + 1, 0]), abs(state[OFFSET, i]))
        )
        demands[PEAK_BRACE_FORCE, i] = max(demands[PEAK_BRACE_FORCE, i], abs(model[GIVEN_FORCE, i]))
        spring, dashpot = model[SPRING, i], model[DASHPOT, i]
        if spring == 0.0 and dashpot == 0.0:
            continue
        stretch0 = series[DISPLACEMENT, i + 1, 0] - series[DISPLACEMENT, i, 0] - series[OFFSET, i + 1, 0]
        rate0 = series[VELOCITY, i + 1, 0] - series[VELOCITY, i, 0] - series[SLIDING, i + 1, 0]
        stretch1 = state[DISPLACEMENT, i] - state[OFFSET, i]
        rate1 = state[VELOCITY, i] - state[SLIDING, i]
        below = strongest
        if i > 0:
            stretch1 -= state[DISPLACEMENT, i - 1]
            rate1 -= state[VELOCITY, i - 1]
            below = abs(series[INERTIA, i, 0]) + reach[ACCELERATION_REACH, i - 1]
        pull = abs(series[INERTIA, i + 1, 0]) + reach[ACCELERATION_REACH, i] + below
        pull += model[SLIDING_COMPLIANCE, i] * reach[REACTION_REACH, i] + abs(series[SLIDING, i + 1, 1]) / h
        ends = max(abs(spring * stretch0 + dashpot * rate0), abs(spring * stretch1 + dashpot * rate1))
        demands[PEAK_BRACE_FORCE, i] = max(demands[PEAK_BRACE_FORCE, i], ends)
        if ends + pull * h * (0.125 * spring * h + dashpot) > demands[PEAK_BRACE_FORCE, i]:
            pace = dashpot / h
            for k in range(n):
                stretch = (
                    series[DISPLACEMENT, i + 1, k] - series[DISPLACEMENT, i, k] - series[OFFSET, i + 1, k]
                )
                more = (
                    series[DISPLACEMENT, i + 1, k + 1]
                    - series[DISPLACEMENT, i, k + 1]
                    - series[OFFSET, i + 1, k + 1]
                )
                c[k] = spring * stretch + pace * (k + 1) * more
            shorten(c, n - 1, x)
            demands[PEAK_BRACE_FORCE, i] = largest_magnitude(c, n - 1, demands[PEAK_BRACE_FORCE, i])


@inner
def raise_column_shears(dense_stiffness, model, series, n, x, c, demands):
    """Raise the peaks of the columns' shear where the frame has more than springs between neighbours."""
    size = demands.shape[1]
    for storey in range(size):
        most = 0.0
        for k in range(n + 1):
            c[k] = model[COLUMNS, storey] * (
                series[DISPLACEMENT, storey + 1, k] - series[DISPLACEMENT, storey, k]
            )
            for i in range(storey, size):
                c[k] += model[GROUND_SPRINGS, i] * series[DISPLACEMENT, i + 1, k]
                for j in range(dense_stiffness.shape[0]):
                    c[k] += dense_stiffness[i, j] * series[DISPLACEMENT, j + 1, k]
            most += abs(c[k])
        if most > demands[PEAK_COLUMN_SHEAR, storey]:
            shorten(c, n, x)
            demands[PEAK_COLUMN_SHEAR, storey] = largest_magnitude(c, n, demands[PEAK_COLUMN_SHEAR, storey])


@inner
def has_only_columns(frame, dense_stiffness):
    """Whether the frame's stiffness is that of springs between neighbours alone."""
    if dense_stiffness.shape[0] > 0:
        return False
    for i in range(frame.shape[1]):
        if frame[GROUND_STIFFNESS, i] != 0.0:
            return False
    return True


@inner
def finish_demands(frame, only_columns, peaks, demands):
    """Fill in what follows from other peaks.

    Columns that are springs between neighbours carry as much as the drift makes of them.
    """
    if only_columns:
        for i in range(demands.shape[1]):
            demands[PEAK_COLUMN_SHEAR, i] = frame[STOREY_STIFFNESS, i] * peaks[PEAK_DRIFT, i]
