"""Where the numbers of eight histories stand: one flat array, eight neighbours to a place.

First come rows that each history has once, then blocks of one row a storey, then the series: of a storey
one row for each power of the fraction of the step.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from fdspec.jit import inner
from fdspec.kernels.frame_batch.eight import WIDTH
from fdspec.kernels.quadrature import NODES
from fdspec.kernels.taylor import TERMS

# Rows of a history.
LENGTH, ORDER, GROUND, RISE, FRACTION, TAU, RATE, INPUT, VISCOUS = range(9)
"""Length of the step (s) and order of its series; ground acceleration at its start and its change over it,
m/s2; part of the step that is taken; time since the record's sample, s; fastest rate, 1/s; energies, J."""
N_ROWS: Final = 9

# Rows of a storey: what it is, and what its phase makes of it.
(
    SPRING,
    DASHPOT,
    COLUMNS,
    COLUMN_DASHPOTS,
    GROUND_SPRINGS,
    GROUND_DASHPOTS,
    COMPLIANCE,
    HELD,
    FRICTION,
    OF_FLOOR,
    OF_BRACE,
    SLIDES,
    SIGN,
    LIMIT,
    SPECIAL,
    MASS,
    LOOSE_MASS,
    OVER_BRACE,
    SLOWNESS,
) = range(19)
"""COMPLIANCE, HELD, FRICTION as in `fdspec.kernels.frame`.  OF_FLOOR and OF_BRACE weigh the forces on floor
and brace in what decides the storey's phase: its reaction while it sticks, the acceleration of its sliding
while it slips.  SLIDES is then 1, else 0, SIGN its direction, LOOSE_MASS the brace's mass, else 0.  LIMIT: slip
force, infinite without a brace; SPECIAL: 1 where a phase has just begun; OVER_BRACE: 1 / m_d, SLOWNESS:
sqrt(m_d / k_d), 0 without a brace."""
MODEL_ROWS: Final = 19

INERTIA_REACH, JERK_REACH, SECOND_REACH = range(3)
"""Sums over k >= 1 of |I_k|, k |I_k|, |Q_k|; see :mod:`fdspec.kernels.frame_batch.expand`."""
REACHES: Final = 3

PEAKS: Final = 6


class Places(NamedTuple):
    """Where each block begins, in numbers."""

    model: int
    stiffness: int
    damping: int
    state: int
    end: int
    now: int
    pull: int
    reach: int
    peaks: int
    speeds: int
    slides: int
    inertia: int
    second: int
    thrust: int
    weights: int
    size: int


@inner
def places(storeys, dense_stiffness, dense_damping):
    """Lay out the blocks of frames of this many storeys, dense matrices of that many rows."""
    model = N_ROWS * WIDTH
    stiffness = model + MODEL_ROWS * storeys * WIDTH
    damping = stiffness + dense_stiffness * dense_stiffness * WIDTH
    state = damping + dense_damping * dense_damping * WIDTH
    end = state + 4 * storeys * WIDTH
    now = end + 4 * storeys * WIDTH
    pull = now + 4 * storeys * WIDTH
    reach = pull + storeys * WIDTH
    peaks = reach + REACHES * storeys * WIDTH
    speeds = peaks + PEAKS * storeys * WIDTH
    slides = speeds + len(NODES) * storeys * WIDTH
    inertia = slides + len(NODES) * storeys * WIDTH
    second = inertia + storeys * TERMS * WIDTH
    thrust = second + storeys * TERMS * WIDTH
    weights = thrust + TERMS * WIDTH
    size = weights + 2 * TERMS * WIDTH
    return Places(
        model, stiffness, damping, state, end, now, pull, reach, peaks, speeds, slides, inertia, second, thrust,
        weights, size,
    )  # fmt: skip


@inner
def turned(at):
    """Let the end of a step be the start of the next."""
    return Places(
        at.model, at.stiffness, at.damping, at.end, at.state, at.now, at.pull, at.reach, at.peaks, at.speeds,
        at.slides, at.inertia, at.second, at.thrust, at.weights, at.size,
    )  # fmt: skip


@inner
def of(block, row, storeys, i):
    """Place of a storey's row in a block."""
    return block + (row * storeys + i) * WIDTH


@inner
def term(block, i, k):
    """Place of a storey's coefficient k."""
    return block + (i * TERMS + k) * WIDTH
