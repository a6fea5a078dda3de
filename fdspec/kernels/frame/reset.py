"""What a storey of a frame does at a change of phase."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import (
    BRACE_DAMPING,
    BRACE_STIFFNESS,
    KINETIC_SLIP_FORCE,
    MASSLESS,
    PLAIN,
    SLIP_FORCE,
)
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.friction import GOES_ON, phase_after_stop
from fdspec.kernels.types import STICK

ANCHOR = 0
"""Slip offset where the present slip began, m."""
TRAVEL = 1
"""Distance slipped in the phases that are over, m."""
RELEASE = 2
"""Energy that a massless brace lost to friction in snapping back, J."""
TALLY_ROWS = 3
"""Rows of the ``tally`` array (3, N)."""


@inner
def begin_slip(frame, kind, phase, fresh, state, tally, i, sign):
    """Start slip from stick in this direction.

    With equal static and kinetic friction the sliding acceleration begins at zero as well.  A massless
    brace follows at once: without a dashpot it springs back to where kinetic friction holds it, with
    one its velocity does.
    """
    static = frame[SLIP_FORCE, i]
    kinetic = frame[KINETIC_SLIP_FORCE, i]
    phase[i] = sign
    tally[ANCHOR, i] = state[OFFSET, i]
    state[SLIDING, i] = 0.0
    if kind[i] == PLAIN:
        fresh[i] = 2 if static == kinetic else 1
    elif frame[BRACE_DAMPING, i] > 0.0:
        fresh[i] = 1 if static == kinetic else 0
    else:
        fresh[i] = 0
        drift = state[DISPLACEMENT, i] - (state[DISPLACEMENT, i - 1] if i > 0 else 0.0)
        stiffness = frame[BRACE_STIFFNESS, i]
        before = drift - state[OFFSET, i]
        after = sign * kinetic / stiffness
        state[OFFSET, i] = drift - after
        tally[RELEASE, i] += 0.5 * stiffness * (before - after) * (before - after)


@inner
def returns_at_once(frame, kind, phase, state, i):
    """Whether a massless brace that has just sprung back is taken along by a storey that moves its way."""
    drift = state[VELOCITY, i] - (state[VELOCITY, i - 1] if i > 0 else 0.0)
    return kind[i] == MASSLESS and frame[BRACE_DAMPING, i] == 0.0 and phase[i] * drift < 0.0


@inner
def stay_sprung(frame, phase, fresh, touching, state, tally, i):
    """Make such a storey stick where its brace sprang to."""
    close_travel(state, tally, i, phase[i])
    if frame[SLIP_FORCE, i] == frame[KINETIC_SLIP_FORCE, i]:
        touching[i] = phase[i]
        fresh[i] = 1
    phase[i] = STICK


@inner
def end_slip(frame, kind, phase, fresh, touching, state, tally, i, held):
    """Decide, at zero sliding velocity, between stick, reversal and going on; ``held`` is the reaction
    that sticking would need.  Return whether the phase changed."""
    sign = phase[i]
    state[SLIDING, i] = 0.0
    if frame[SLIP_FORCE, i] == 0.0:  # free sliding has no phases; only its distance is counted by direction
        close_travel(state, tally, i, sign)
        phase[i] = -sign
        fresh[i] = 1
        return False
    if kind[i] == MASSLESS:
        held = sign * frame[KINETIC_SLIP_FORCE, i]
    after = phase_after_stop(sign, held, frame[SLIP_FORCE, i])
    if after == GOES_ON:
        fresh[i] = 1
        return False
    close_travel(state, tally, i, sign)
    phase[i] = after
    fresh[i] = 0
    if after != STICK:
        fresh[i] = 1
    elif abs(held) == frame[SLIP_FORCE, i]:
        touching[i] = sign
        fresh[i] = 1
        if kind[i] == MASSLESS and frame[BRACE_DAMPING, i] == 0.0:
            fresh[i] = 2
    return True


@inner
def close_travel(state, tally, i, sign):
    """Count the distance slipped since the slip began, and begin anew."""
    tally[TRAVEL, i] += sign * (state[OFFSET, i] - tally[ANCHOR, i])
    tally[ANCHOR, i] = state[OFFSET, i]


@inner
def travel_so_far(phase, offset, tally, i):
    """Distance (m) slipped up to an instant with this offset."""
    return tally[TRAVEL, i] + phase[i] * (offset - tally[ANCHOR, i])
