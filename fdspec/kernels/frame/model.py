"""A frame of N storeys as kernels see it: its numbers, and what a storey's phase makes of them.

The unknowns are, per storey, the floor's displacement u relative to the ground and the slip offset
o = u - u_d of the damper, not the brace's own displacement: while a storey sticks o stands still, and
the sliding velocity o' is known to its own rounding instead of as the difference of two velocities.

With the storey drift g_i = u_i - u_{i-1} and the brace's stretch e_i = u_d,i - u_{i-1} = g_i - o_i:

    brace force       B_i = k_d e_i + c_d e_i'
    force on floor i  P_i = B_{i+1} - (frame's springs and dashpots)                 without its own damper
    reaction          R_i = (m_d P_i + m_f B_i) / (m_f + m_d)                        that keeps o_i' constant
    stick             u_i'' + a_g = (P_i - B_i) / (m_f + m_d),   o_i'' = 0
    slip              u_i'' + a_g = (P_i - s F) / m_f,           o_i'' = (1/m_f + 1/m_d) (R_i - s F)

so every storey decides by its own R_i, a linear function of displacements and velocities alone.  A
massless brace that slips has B_i = s F at all times, and its offset follows from the drift.

The frame's stiffness and damping are springs and dashpots between neighbours and to the ground; what
does not fit into these (modal damping, a general matrix) is a dense matrix beside them.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.types import STICK

FLOOR_MASS = 0
BRACE_MASS = 1
STOREY_STIFFNESS = 2
GROUND_STIFFNESS = 3
STOREY_DAMPING = 4
GROUND_DAMPING = 5
BRACE_STIFFNESS = 6
BRACE_DAMPING = 7
SLIP_FORCE = 8
KINETIC_SLIP_FORCE = 9
FRAME_ROWS = 10
"""Rows of the ``frame`` array (FRAME_ROWS, N), SI units: what the building is."""

COMPLIANCE = 0
"""1 / mass that the floor moves with, 1/kg."""
STUCK = 1
"""1 where floor and brace move as one, else 0."""
SLIDING_COMPLIANCE = 2
"""1/m_f + 1/m_d of a slipping brace, else 0."""
SPRING = 3
DASHPOT = 4
"""The brace's stiffness and damping, 0 while a massless brace slips."""
GIVEN_FORCE = 5
"""Force in a slipping massless brace, N, else 0."""
FRICTION = 6
"""s F_sl while the storey slips, else 0, N."""
FLOOR_SHARE = 7
BRACE_SHARE = 8
"""m_d / (m_f + m_d) and its complement: the shares of P and B in the reaction."""
SLIP_RATE = 9
"""Bound on the rates that a slip of this storey adds, 1/s; of a massless brace, while they last."""
COLUMNS = 10
COLUMN_DASHPOTS = 11
GROUND_SPRINGS = 12
GROUND_DASHPOTS = 13
"""The frame's own springs and dashpots, as in ``frame``."""
SLOWNESS = 14
"""sqrt(m_d / k_d), s: the brace's time of a radian."""
MASS = 15
BRACE = 16
"""m_f + m_d and m_d, kg."""
MODEL_ROWS = 17
"""Rows of the ``model`` array (MODEL_ROWS, lanes): what the phases make of the building.  Its columns
are the storeys and as many empty ones as fill the last group of four."""

PLAIN = 0
MASSLESS = 1
NO_BRACE = 2
"""Kinds of storey."""


@inner
def is_damped(frame):
    """Whether any dashpot stands between neighbours."""
    for i in range(frame.shape[1]):
        if frame[STOREY_DAMPING, i] != 0.0 or frame[BRACE_DAMPING, i] != 0.0:
            return True
    return False


@inner
def is_grounded(frame):
    """Whether any spring or dashpot joins a floor to the ground."""
    for i in range(frame.shape[1]):
        if frame[GROUND_STIFFNESS, i] != 0.0 or frame[GROUND_DAMPING, i] != 0.0:
            return True
    return False


@inner
def kind_of(frame, i):
    """Whether storey i has a brace with mass, one without, or none."""
    if frame[BRACE_MASS, i] > 0.0:
        return PLAIN
    return MASSLESS if frame[BRACE_STIFFNESS, i] > 0.0 else NO_BRACE


@inner
def set_phase(frame, model, phase, i):
    """Bring the model's column i in line with the storey's phase."""
    floor = frame[FLOOR_MASS, i]
    brace = frame[BRACE_MASS, i]
    model[SPRING, i] = frame[BRACE_STIFFNESS, i]
    model[DASHPOT, i] = frame[BRACE_DAMPING, i]
    model[GIVEN_FORCE, i] = 0.0
    model[SLIDING_COMPLIANCE, i] = 0.0
    if phase[i] == STICK:
        model[COMPLIANCE, i] = 1.0 / (floor + brace)
        model[STUCK, i] = 1.0
        model[FRICTION, i] = 0.0
        return
    force = sliding_force(phase[i], frame[KINETIC_SLIP_FORCE, i])
    model[COMPLIANCE, i] = 1.0 / floor
    model[STUCK, i] = 0.0
    model[FRICTION, i] = force
    if brace > 0.0:
        model[SLIDING_COMPLIANCE, i] = 1.0 / floor + 1.0 / brace
    else:
        model[SPRING, i] = 0.0
        model[DASHPOT, i] = 0.0
        model[GIVEN_FORCE, i] = force


@inner
def held_rates(frame, dense_stiffness, dense_damping):
    """Bounds on the norms of M^-1 K (1/s2) and M^-1 C (1/s) with every damper stuck.

    Gershgorin's circles of M^-1/2 K M^-1/2: the symmetric scaling keeps a light mass beside a heavy
    one from spoiling the bound.
    """
    n = frame.shape[1]
    stiffness = 0.0
    damping = 0.0
    for i in range(n):
        mass = frame[FLOOR_MASS, i]
        k = frame[GROUND_STIFFNESS, i]
        c = frame[GROUND_DAMPING, i]
        for j in (i, i + 1):
            if j == n:
                break
            k_j = frame[STOREY_STIFFNESS, j] + frame[BRACE_STIFFNESS, j]
            c_j = frame[STOREY_DAMPING, j] + frame[BRACE_DAMPING, j]
            other = i - 1 if j == i else j
            share = 1.0 + (math.sqrt(mass / frame[FLOOR_MASS, other]) if other >= 0 else 0.0)
            k += k_j * share
            c += c_j * share
        k /= mass
        c /= mass
        for j in range(dense_stiffness.shape[0]):
            k += abs(dense_stiffness[i, j]) / math.sqrt(mass * frame[FLOOR_MASS, j])
        for j in range(dense_damping.shape[0]):
            c += abs(dense_damping[i, j]) / math.sqrt(mass * frame[FLOOR_MASS, j])
        stiffness = max(stiffness, abs(k))
        damping = max(damping, abs(c))
    return stiffness, damping


@inner
def prepare(frame, model, held):
    """Fill what does not change with the phases; ``held`` is the pair of :func:`held_rates`."""
    for i in range(frame.shape[1]):
        floor = frame[FLOOR_MASS, i]
        brace = frame[BRACE_MASS, i]
        model[FLOOR_SHARE, i] = brace / (floor + brace)
        model[BRACE_SHARE, i] = floor / (floor + brace)
        model[MASS, i] = floor + brace
        model[BRACE, i] = brace
        model[COLUMNS, i] = frame[STOREY_STIFFNESS, i]
        model[COLUMN_DASHPOTS, i] = frame[STOREY_DAMPING, i]
        model[GROUND_SPRINGS, i] = frame[GROUND_STIFFNESS, i]
        model[GROUND_DASHPOTS, i] = frame[GROUND_DAMPING, i]
        model[SLIP_RATE, i] = 0.0
        if brace > 0.0:
            model[SLOWNESS, i] = math.sqrt(brace / frame[BRACE_STIFFNESS, i])
            k, c = slip_norms(frame, held, i)
            model[SLIP_RATE, i] = rate_of(k, c)


@inner
def slip_norms(frame, held, i):
    """Bounds as ``held``, those of :func:`held_rates`, with the brace of storey i in motion; it has mass."""
    brace = frame[BRACE_MASS, i]
    stiffness = frame[BRACE_STIFFNESS, i]
    damping = frame[BRACE_DAMPING, i]
    below = frame[FLOOR_MASS, i - 1] if i > 0 else math.inf
    share = math.sqrt(brace / below)
    k = max(stiffness / brace * (1.0 + share), held[0] + stiffness / brace * share)
    c = max(damping / brace * (1.0 + share), held[1] + damping / brace * share)
    return k, c


@inner
def rate_of(stiffness, damping):
    """Largest rate (1/s) of x'' + C x' + K x = 0 with these norms of K and C."""
    return 0.5 * (damping + math.sqrt(damping * damping + 4.0 * stiffness))


@inner
def fastest_rate(model, phase, held_rate):
    """Bound on the rate (1/s) of the frame in its present phases."""
    rate = held_rate
    for i in range(phase.size):
        if phase[i] != STICK and model[SLIP_RATE, i] > rate:
            rate = model[SLIP_RATE, i]
    return rate
