"""The friction damper's rules: its reaction while it sticks, its force and work while it slides, and how
sliding stops.

Study, equations (3) to (7) and the paragraph on the transition phase.  Floor and brace:

    m_f (u_f'' + a_g) + c_f u_f' + k_f u_f = -R        m_d (u_d'' + a_g) + c_d u_d' + k_d u_d = +R

With one common velocity the reaction that keeps it common follows from the state alone.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.types import STICK

GOES_ON = 2
"""Outcome of a stop that is none: the sliding velocity touched zero and returns."""


@inner
def reaction(storey, u, v, d):
    """Force (N) by which the damper holds floor (u, v) and brace (d, v) together."""
    floor = storey.floor_stiffness * u + storey.floor_damping * v
    brace = storey.brace_stiffness * d + storey.brace_damping * v
    mass = storey.floor_mass + storey.brace_mass
    return (storey.floor_mass * brace - storey.brace_mass * floor) / mass


@inlined
def sliding_force(direction, level):
    """Force (N) of a damper that slides in this direction, +1 or -1; ``level``: its kinetic slip force.

    It acts backwards on the floor and forwards on the brace; divided by a mass, so is what it returns.
    """
    return direction * level


@inlined
def friction_work(level, travel):
    """Energy (J) that a kinetic slip force takes over a sliding distance (m, at least 0)."""
    return level * travel


@inner
def phase_after_stop(sign, held, slip_force):
    """Next phase where sliding in direction ``sign`` has come to zero.

    ``held`` is the reaction sticking would need: within the static slip force it sticks; beyond it,
    against the motion, it reverses; with the motion, it goes on.
    """
    beyond = -sign if held * sign < 0.0 else GOES_ON
    return STICK if abs(held) <= slip_force else beyond


@inner
def onset_acceleration(storey, held):
    """Sliding acceleration (m/s2, at least 0) just after the damper gives way at reaction ``held``."""
    if storey.brace_mass == 0.0:
        return 0.0
    excess = abs(held) - storey.kinetic_slip_force
    return math.fabs(excess) * (1.0 / storey.floor_mass + 1.0 / storey.brace_mass)
