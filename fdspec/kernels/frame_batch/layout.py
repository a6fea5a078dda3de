"""Where the numbers of eight histories stand: one flat array, eight neighbours to a place.

First come rows that each history has once, then all rows of each storey together, then dense matrices, room
for quadrature, and the series: of a storey two rows for each power of the fraction of the step.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.frame.taylor import TERMS
from fdspec.kernels.frame_batch.eight import WIDTH

# Rows of a history.
LENGTH, ORDER, GROUND, RISE, FRACTION, TAU, RATE, INPUT, MOST_INPUT, VISCOUS = range(10)
"""Length of the step (s) and order of its series; ground acceleration at its start and its change over it,
m/s2; part of the step that is taken; time since the record's sample, s; fastest rate, 1/s; work of the
ground, the largest it has been, and that into dashpots, J."""
HISTORY_ROWS: Final = 10

# Rows of a storey: what it is, and what its phase makes of it.
(
    SPRING,
    DASHPOT,
    COLUMNS,
    COLUMN_DASHPOTS,
    GROUND_SPRINGS,
    GROUND_DASHPOTS,
    COMPLIANCE,
    STUCK,
    FRICTION,
    OF_FLOOR,
    OF_BRACE,
    SLIDES,
    SIGN,
    LIMIT,
    SPECIAL,
    MASS,
    SLIDING_MASS,
    OVER_BRACE,
    SLOWNESS,
    OMEGA,
) = range(20)
"""COMPLIANCE, STUCK, FRICTION as in `fdspec.kernels.frame.model`.  OF_FLOOR and OF_BRACE weigh the forces on
floor and brace in what decides the storey's phase: its reaction while it sticks, the acceleration of
its sliding while it slips.  SLIDES is then 1, else 0, SIGN its direction, SLIDING_MASS the brace's mass,
else 0.  LIMIT: slip force, infinite without a brace; SPECIAL: 1 where a phase has just begun;
OVER_BRACE: 1 / m_d, SLOWNESS: sqrt(m_d / k_d), OMEGA its inverse, 0 without a brace."""

START, END, NOW = 20, 24, 28
"""First of the rows of a state, as in `fdspec.kernels.frame.taylor`: at the start of the step, at the end of
what is taken of it, and coefficients of the power in hand."""
PULL: Final = 32
"""What dense matrices ask for, N."""
REACH: Final = 33
INERTIA_REACH, JERK_REACH, BEND_REACH, SECOND_REACH = range(4)
"""Sums over k >= 1 of |I_k|, k |I_k|, k (k - 1) |I_k| and |Q_k|, series of `expand`."""
PEAK: Final = 37
PEAKS: Final = 6
"""Peaks so far, in the order of `fdspec.kernels.frame.peaks`."""
LAST, LAST_SECOND, RING = 43, 44, 45
"""I and Q at the end of what is taken; bound on the velocity with which a slipping brace swings about the
floor below, m/s."""
STOREY_ROWS: Final = 46

MOST_NODES: Final = 12
"""Nodes of the quadrature of losses."""

INERTIA, SECOND = range(2)
"""The two series of a storey."""


class Places(NamedTuple):
    """Where each block behind the storeys begins, in numbers."""

    stiffness: int
    damping: int
    speeds: int
    slides: int
    series: int
    thrust: int
    weights: int
    searched: int
    size: int


@inner
def places(storeys, dense_stiffness, dense_damping):
    """Lay out the blocks of frames of this many storeys, dense matrices of that many rows."""
    stiffness = (HISTORY_ROWS + STOREY_ROWS * storeys) * WIDTH
    damping = stiffness + dense_stiffness * dense_stiffness * WIDTH
    speeds = damping + dense_damping * dense_damping * WIDTH
    slides = speeds + MOST_NODES * storeys * WIDTH
    series = slides + MOST_NODES * storeys * WIDTH
    thrust = series + 2 * storeys * TERMS * WIDTH
    weights = thrust + TERMS * WIDTH
    searched = weights + 3 * TERMS * WIDTH
    size = searched + (TERMS + 2) * WIDTH
    return Places(stiffness, damping, speeds, slides, series, thrust, weights, searched, size)


@inlined
def row(which, i):
    """Place of a row of storey i."""
    return (HISTORY_ROWS + STOREY_ROWS * i + which) * WIDTH


@inlined
def term(at, which, i, k):
    """Place of coefficient k of a series of storey i."""
    return at.series + ((i * TERMS + k) * 2 + which) * WIDTH
