"""One step of a frame: looking ahead to the next change of phase, and making the changes at its instant."""

from __future__ import annotations

from fdspec.compiler.options import inlined
from fdspec.kernels.frame.guard import SAME_INSTANT, search
from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE, MASSLESS, SLIP_FORCE, set_phase
from fdspec.kernels.frame.reset import begin_slip, count_turn, end_slip, unsettle_below
from fdspec.kernels.frame.taylor import expand, follow_drift, reaction_now
from fdspec.kernels.types import STICK


@inlined
def look_ahead(
    frame,
    model,
    stiffness_lanes,
    damping_lanes,
    damped,
    grounded,
    massless,
    kind,
    phase,
    vanishing,
    touching,
    state,
    tally,
    series,
    momentum,
    reach,
    n,
    h,
    at,
    radian,
    acceleration,
    rise,
    c,
    instants,
    signs,
):
    """Expand the motion over a step; return the fraction of it at which the first storey changes its phase.

    massless: whether any brace is.  The other arguments are those of `expand` and `search`, one by one: in
    bundles they cost 8 to 20 % at one to four storeys.
    """
    expand(
        model,
        stiffness_lanes,
        damping_lanes,
        damped,
        grounded,
        n,
        h,
        acceleration,
        rise,
        state,
        series,
        momentum,
        reach,
    )
    if massless:
        for i in range(frame.shape[1]):
            if kind[i] == MASSLESS and phase[i] != STICK:
                follow_drift(frame, model, state, vanishing, phase, n, h, series, i)
    return search(
        frame,
        model,
        kind,
        phase,
        vanishing,
        touching,
        tally,
        series,
        reach,
        state,
        n,
        h,
        at,
        radian,
        acceleration,
        rise,
        c,
        instants,
        signs,
    )


@inlined
def change_phases(
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
    instants,
    signs,
    x,
    at,
    radian,
    times,
    storeys,
    phases,
    transitions,
    counts,
):
    """Make the changes of all storeys whose instant is the fraction x of the step.

    Massless braces change first: what they do follows from the state alone, and the storeys below them need
    to know it.  at: time then, s; radian as in `search`.  times, storeys, phases: changes of phase, as far as
    they have room; counts (N,): changes of each storey.  Returns how many storeys were looked at, and
    transitions with those made added.
    """
    events = 0
    for turn in range(2):
        for i in range(frame.shape[1]):
            if instants[i] > x + SAME_INSTANT or (kind[i] == MASSLESS) != (turn == 0):
                continue
            events += 1
            changed = True
            if phase[i] == STICK:
                stood = touching[i] == signs[i]
                touching[i] = 0
                begin_slip(frame, kind, phase, vanishing, state, tally, i, signs[i], stood)
                if turn == 0 and frame[KINETIC_SLIP_FORCE, i] < frame[SLIP_FORCE, i]:
                    unsettle_below(kind, phase, vanishing, touching, i)
            else:
                held = reaction_now(frame, model, stiffness_lanes, damping_lanes, state, i)
                changed = end_slip(frame, kind, phase, vanishing, touching, state, tally, i, held)
            if turn == 0 or frame[SLIP_FORCE, i] == 0.0:
                count_turn(tally, i, at, radian)
            if turn == 0:
                set_phase(frame, model, phase, i)
            if changed:
                if transitions < times.size:
                    times[transitions] = at
                    storeys[transitions] = i
                    phases[transitions] = phase[i]
                transitions += 1
                counts[i] += 1.0
    for i in range(frame.shape[1]):
        if instants[i] <= x + SAME_INSTANT:
            set_phase(frame, model, phase, i)
    return events, transitions
