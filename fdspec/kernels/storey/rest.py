"""When a storey has come to rest for good, and where it then stands.

Once the ground rests, a storey that sticks swings about the position in which its springs balance, with an
amplitude that its energy bounds and that never grows.  The reaction swings about the one there.  Where even
the bound stays below the slip force, nothing slips any more.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.types import STATE, STICK

REST_STEPS = 2_000_000
"""Record steps after which a storey that still slips is given up."""


@inner
def rest_displacement(storey, offset):
    """Displacement (m) at which frame and brace balance with this slip offset; 0 where nothing pulls."""
    stiffness = storey.floor_stiffness + storey.brace_stiffness
    if storey.slip_force == 0.0 or stiffness == 0.0:
        return 0.0
    return storey.brace_stiffness * offset / stiffness


@inner
def is_at_rest(plan, s):
    """Whether nothing can slip any more while the ground rests; a damper without friction has no rest."""
    storey = plan.storey
    if storey.slip_force == 0.0 or storey.slip_force == math.inf:
        return True
    if s[STATE.phase] != STICK or s[STATE.touching] != 0.0:
        return False
    stiffness = storey.floor_stiffness + storey.brace_stiffness
    rest = rest_displacement(storey, s[STATE.offset])
    omega = math.sqrt(stiffness / plan.mass)
    away = s[STATE.u] - rest
    pace = s[STATE.v] / omega
    amplitude = math.sqrt(away * away + pace * pace)
    tilt = plan.hold_v * omega
    swing = amplitude * math.sqrt(plan.hold_u * plan.hold_u + tilt * tilt)
    return abs(plan.hold_u * rest - plan.hold_offset * s[STATE.offset]) + swing < storey.slip_force
