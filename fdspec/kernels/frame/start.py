"""The start of a history of N storeys: its state, and the phases that this state asks for."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.model import MASSLESS, NO_BRACE, PLAIN, SLIP_FORCE, kind_of, set_phase
from fdspec.kernels.frame.reset import ANCHOR, begin_free, begin_slip, returns_at_once, stay_sprung
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY, reaction_now


@inner
def set_state(frame, model, kind, phase, state, tally, start):
    """Set the state to the start (4, N), with every damper stuck; return whether any brace is massless."""
    size = frame.shape[1]
    massless = False
    for i in range(size):
        kind[i] = kind_of(frame, i)
        massless = massless or kind[i] == MASSLESS
        state[DISPLACEMENT, i] = start[0, i]
        state[VELOCITY, i] = start[1, i]
        state[OFFSET, i] = start[0, i] - start[2, i]
        state[SLIDING, i] = start[1, i] - start[3, i] if kind[i] == PLAIN else 0.0
        if kind[i] == NO_BRACE:
            state[OFFSET, i] = 0.0
        tally[ANCHOR, i] = state[OFFSET, i]
        set_phase(frame, model, phase, i)
    return massless


@inner
def go_on(phase, vanishing, touching, state, tally, end):
    """Set state and phases to those in which another history ended, (END_ROWS, N): see `results`."""
    for i in range(phase.size):
        for k in range(4):
            state[k, i] = end[k, i]
        tally[ANCHOR, i] = state[OFFSET, i]
        phase[i] = int(end[4, i])
        vanishing[i] = int(end[5, i])
        touching[i] = int(end[6, i])


@inner
def begin(
    frame,
    model,
    stiffness_lanes,
    damping_lanes,
    kind,
    phase,
    vanishing,
    touching,
    state,
    tally,
    times,
    storeys,
    phases,
    counts,
):
    """Make the changes of phase that the state asks for at t = 0; return how many these are."""
    size = frame.shape[1]
    transitions = 0
    # Massless braces first: what they do at once is felt in the storeys below, and not the other way.
    for turn in range(2):
        for i in range(size):
            if kind[i] == NO_BRACE or (kind[i] == MASSLESS) != (turn == 0):
                continue
            reaction = reaction_now(frame, model, stiffness_lanes, damping_lanes, state, i)
            changes = 0
            if frame[SLIP_FORCE, i] == 0.0:
                if kind[i] == MASSLESS:
                    begin_free(frame, phase, vanishing, state, tally, i)
                else:
                    speed = state[SLIDING, i]
                    begin_slip(
                        frame, kind, phase, vanishing, state, tally, i, 1 if speed >= 0.0 else -1, False
                    )
                    state[SLIDING, i] = speed
                    vanishing[i] = 0
            elif state[SLIDING, i] != 0.0:
                phase[i] = 1 if state[SLIDING, i] > 0.0 else -1
            elif abs(reaction) > frame[SLIP_FORCE, i]:
                begin_slip(frame, kind, phase, vanishing, state, tally, i, 1 if reaction > 0.0 else -1, False)
                # The reaction is beyond the limit, not at it: sliding accelerates, or a dashpot lets it begin
                # with (|R| - F) / c_d.
                vanishing[i] = 1 if kind[i] == PLAIN else 0
                changes = 2 if returns_at_once(frame, kind, phase, state, i) else 1
            for change in range(changes):
                if change > 0:
                    stay_sprung(phase, vanishing, touching, state, tally, i)
                if transitions < times.size:
                    times[transitions] = 0.0
                    storeys[transitions] = i
                    phases[transitions] = phase[i]
                transitions += 1
                counts[i] += 1.0
            if turn == 0:
                set_phase(frame, model, phase, i)
    return transitions
