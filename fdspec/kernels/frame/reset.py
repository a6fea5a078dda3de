"""What a storey of a frame does at a change of phase.

A massless brace has no equation of motion: the damper's force is the brace's at all times, s F_sl = k_d e
+ c_d e' while it slips, with e its stretch.  With a dashpot that is a first-order system.  Its sliding
velocity, with g the storey's drift,

    o' = g' - e' = (R* - s F_sl) / c_d,      R* = k_d e + c_d g',

and the reaction R* that sticking would need are continuous, for e, g and the floors' velocities are.  So it
slips where |R*| > F_st, at once with (|R*| - F_sl) / c_d, and it comes to rest where s R* has fallen to
F_sl, which is never more than F_st: a massless brace always sticks when it stops.  Without a dashpot the
brace springs to e = s F_sl / k_d as it gives way, which loses (F_st - F_sl)^2 / (2 k_d); its offset then
follows the drift, and it sticks where the drift turns.

The force in a massless brace jumps where it gives way with kinetic below static friction, and nowhere else.
That jump reaches the floor below, and so the reaction of a damper there whose brace has mass.  It reaches
no massless brace, whose reaction has no part of its neighbours' forces, and it is passed on no further,
since springs and dashpots of a brace with mass follow displacements and velocities, which do not jump.  So
what happens at one instant is settled by two rounds, in whatever order the storeys are taken: massless
braces first, by the state alone, then those with mass, by what the first left.
"""

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
from fdspec.kernels.friction import GOES_ON, phase_after_stop, sliding_force
from fdspec.kernels.types import STICK

ANCHOR = 0
"""Slip offset where the present slip began, m."""
TRAVEL = 1
"""Distance slipped in the phases that are over, m."""
RELEASE = 2
"""Energy that a massless brace lost to friction in snapping back, J."""
LAST = 3
"""Time of the latest change of a massless brace, or of one without friction, s."""
SINCE = 4
TURNS = 5
"""Start (s) of a radian or record step, whichever is shorter, and the changes counted in it."""
TALLY_ROWS = 6
"""Rows of the ``tally`` array (6, N)."""

FREE_TURNS = 8.0
MOST_TURNS = 28.0
"""Changes within a radian that no law makes, and those after which the next has to wait the longest."""

JUMPED = -1
"""``vanishing`` of a storey that sticks, whose reaction has just jumped with the force in the brace above."""


@inner
def begin_slip(frame, kind, phase, vanishing, state, tally, i, sign, stood):
    """Start slip from stick in this direction; ``stood``: whether it has stood at the limit since it stuck.

    With equal static and kinetic friction the sliding acceleration begins at zero as well, unless the
    reaction has jumped past the limit.  A massless brace follows at once: without a dashpot it springs back
    to where kinetic friction holds it, with one its velocity does.
    """
    static = frame[SLIP_FORCE, i]
    kinetic = frame[KINETIC_SLIP_FORCE, i]
    phase[i] = sign
    tally[ANCHOR, i] = state[OFFSET, i]
    state[SLIDING, i] = 0.0
    if kind[i] == PLAIN:
        vanishing[i] = 2 if static == kinetic and vanishing[i] != JUMPED else 1
    elif frame[BRACE_DAMPING, i] > 0.0:
        vanishing[i] = 1
    else:
        drift_rate = state[VELOCITY, i] - (state[VELOCITY, i - 1] if i > 0 else 0.0)
        vanishing[i] = 1 if stood and static == kinetic and sign * drift_rate <= 0.0 else 0
        spring_back(frame, state, tally, i, sliding_force(sign, kinetic) / frame[BRACE_STIFFNESS, i])


@inner
def spring_back(frame, state, tally, i, after):
    """Let a massless brace without a dashpot snap to the stretch ``after`` (m), and count what that loses."""
    drift = state[DISPLACEMENT, i] - (state[DISPLACEMENT, i - 1] if i > 0 else 0.0)
    before = drift - state[OFFSET, i]
    state[OFFSET, i] = drift - after
    tally[RELEASE, i] += 0.5 * frame[BRACE_STIFFNESS, i] * (before - after) * (before - after)


@inner
def begin_free(frame, phase, vanishing, state, tally, i):
    """Begin the motion of a massless brace without friction: which way it slides, for its distance alone.

    Without a dashpot it springs to where it carries nothing, whichever way that is.
    """
    drift_rate = state[VELOCITY, i] - (state[VELOCITY, i - 1] if i > 0 else 0.0)
    speed = drift_rate
    before = state[DISPLACEMENT, i] - (state[DISPLACEMENT, i - 1] if i > 0 else 0.0) - state[OFFSET, i]
    if frame[BRACE_DAMPING, i] > 0.0:
        speed += frame[BRACE_STIFFNESS, i] / frame[BRACE_DAMPING, i] * before
    else:
        spring_back(frame, state, tally, i, 0.0)
        tally[TRAVEL, i] += abs(before)
    tally[ANCHOR, i] = state[OFFSET, i]
    state[SLIDING, i] = speed
    phase[i] = 1 if speed >= 0.0 else -1
    vanishing[i] = 0


@inner
def unsettle_below(kind, phase, vanishing, touching, i):
    """Tell the storey below that the force in the massless brace i has jumped.

    What was known of the reaction there, that it stood at its limit, is known no more.
    """
    below = i - 1
    if below < 0 or kind[below] != PLAIN:
        return
    if phase[below] == STICK:
        touching[below] = 0
        vanishing[below] = JUMPED
    elif vanishing[below] > 1:
        vanishing[below] = 1


@inner
def returns_at_once(frame, kind, phase, state, i):
    """Whether a massless brace that has just sprung back is taken along by a storey that moves its way."""
    drift = state[VELOCITY, i] - (state[VELOCITY, i - 1] if i > 0 else 0.0)
    return kind[i] == MASSLESS and frame[BRACE_DAMPING, i] == 0.0 and phase[i] * drift < 0.0


@inner
def stay_sprung(phase, vanishing, touching, state, tally, i):
    """Let such a storey stick at the offset to which its brace has sprung back."""
    close_travel(state, tally, i, phase[i])
    touching[i] = phase[i]
    vanishing[i] = 1
    phase[i] = STICK


@inner
def end_slip(frame, kind, phase, vanishing, touching, state, tally, i, held):
    """Decide, at zero sliding velocity, between stick, reversal and going on; ``held`` is the reaction
    that sticking would need.  Return whether the phase changed."""
    sign = phase[i]
    state[SLIDING, i] = 0.0
    if frame[SLIP_FORCE, i] == 0.0:  # free sliding has no phases; only its distance is counted by direction
        close_travel(state, tally, i, sign)
        phase[i] = -sign
        vanishing[i] = 1
        return False
    if kind[i] == MASSLESS:
        held = sliding_force(sign, frame[KINETIC_SLIP_FORCE, i])
    after = phase_after_stop(sign, held, frame[SLIP_FORCE, i])
    if after == GOES_ON:
        vanishing[i] = 1
        return False
    close_travel(state, tally, i, sign)
    phase[i] = after
    vanishing[i] = 0
    if after != STICK:
        vanishing[i] = 1
    elif kind[i] == MASSLESS:  # the reaction is exactly that of kinetic friction, its rate nought as well
        touching[i] = sign
        vanishing[i] = 1 if frame[BRACE_DAMPING, i] > 0.0 else 2
    elif abs(held) == frame[SLIP_FORCE, i]:
        touching[i] = sign
        vanishing[i] = 1
    return True


@inner
def count_turn(tally, i, at, radian):
    """Count a change of storey i at the time ``at`` among those of this radian (s)."""
    if at - tally[SINCE, i] > radian or at < tally[SINCE, i]:
        tally[SINCE, i] = at
        tally[TURNS, i] *= 0.25
    else:
        tally[TURNS, i] += 1.0
    tally[LAST, i] = at


@inner
def patience(tally, i, radian):
    """How long (s) after its latest change a storey is left in its phase.

    No time, but where more changes follow each other within a radian (s) of the fastest motion than it can
    make.  There two phases differ by what rounding leaves of a force or velocity that is zero, and either is
    right: at one instant, in motion that has died out, or in upper floors that have hardly begun to move.
    Each further change then multiplies the time to the next, so that the motion gets away.
    """
    turns = tally[TURNS, i]
    if turns <= FREE_TURNS:
        return 0.0
    return radian * 4.0 ** (min(turns, MOST_TURNS) - MOST_TURNS)


@inner
def close_travel(state, tally, i, sign):
    """Count the distance slipped since the slip began, and begin anew."""
    tally[TRAVEL, i] += sign * (state[OFFSET, i] - tally[ANCHOR, i])
    tally[ANCHOR, i] = state[OFFSET, i]


@inner
def travel_so_far(phase, offset, tally, i):
    """Distance (m) slipped up to an instant with this offset."""
    return tally[TRAVEL, i] + phase[i] * (offset - tally[ANCHOR, i])
