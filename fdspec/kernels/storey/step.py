"""One step of one history, segment by segment, from change of phase to change of phase.

A step is a record step or an equal part of one, at most a radian of the sticking storey.  A segment of
slip is at most a radian of the brace.  The motion at both ends of a segment mostly tells whether the
phase changes on it, and leads to the instant (`mathematics/zero_crossing.py`).  Where it leaves doubt,
and where a course in time is asked for, the segment is expanded in its Taylor series and searched; it ends
where the phase changes.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.friction import GOES_ON, onset_acceleration, phase_after_stop, reaction, sliding_force
from fdspec.kernels.mathematics.oscillator import expand
from fdspec.kernels.mathematics.polynomial_roots import value_slope
from fdspec.kernels.mathematics.zero_crossing import CROSSES, UNCLEAR
from fdspec.kernels.storey.bounds import forcing, ground_at
from fdspec.kernels.storey.demands import (
    brace_force,
    slip_brace_bound,
    slip_brace_peak,
    stick_brace_peak,
)
from fdspec.kernels.storey.energy import (
    input_work,
    series_work,
    stored_energy,
)
from fdspec.kernels.storey.output import floor_acceleration, write_trace
from fdspec.kernels.storey.rest import REST_STEPS, is_at_rest
from fdspec.kernels.storey.segment import at_once, part_loss, whole_loss
from fdspec.kernels.storey.slip import (
    base_shear,
    search_slip,
    slip_peaks,
)
from fdspec.kernels.storey.state import motion_of, peaks_of, put_motion, put_peaks
from fdspec.kernels.storey.stick import (
    search_stick,
    stick_peaks,
)
from fdspec.kernels.types import (
    NO_ONSET,
    NON_FINITE_STATE,
    OK,
    STATE,
    STICK,
    TRANSITION_CAP,
    TRANSITION_CAP_REACHED,
    Energy,
    Motion,
    Peaks,
)

UNRESOLVED = 2.0**-50
"""A sliding velocity below this share of those of floor and brace has not yet left the zero it began at."""

CHANGES_AT_ONE_INSTANT = 64
"""More changes of phase than this without any time between them are a loop: two or three are real."""


@inlined
def with_instant(plan, phase, offset, motion, peaks):
    """Peaks with those of one instant: the far side of each jump in acceleration."""
    return Peaks(
        max(peaks.acceleration, abs(floor_acceleration(plan, phase, offset, motion))),
        max(peaks.displacement, abs(motion.u)),
        max(peaks.velocity, abs(motion.v)),
        max(peaks.shear, abs(base_shear(plan.storey, motion))),
    )


@inner
def begin_peaks(plan, s, motion):
    """Set the peaks in the state ``s``, whose phase and offset are known, to those of this instant."""
    put_peaks(s, with_instant(plan, int(s[STATE.phase]), s[STATE.offset], motion, Peaks(0.0, 0.0, 0.0, 0.0)))
    s[STATE.peak_slip] = abs(motion.u - motion.d)
    s[STATE.peak_brace] = abs(brace_force(plan.storey, motion))


@inner
def begin_slip(storey, sign, motion, held):
    """Motion and sliding acceleration just after the damper gives way in this direction.

    A massless brace follows at once: without damping it springs to where the kinetic slip force
    holds it, with damping its velocity does.
    """
    if storey.brace_mass > 0.0:
        return Motion(motion.u, motion.v, motion.d, motion.v), onset_acceleration(storey, held)
    if storey.brace_damping > 0.0:
        lag = (abs(held) - storey.kinetic_slip_force) / storey.brace_damping
        return Motion(motion.u, motion.v, motion.d, motion.v - sign * lag), NO_ONSET
    stretch = sliding_force(sign, storey.kinetic_slip_force) / storey.brace_stiffness
    return Motion(motion.u, motion.v, stretch, 0.0), NO_ONSET


@inner
def spring_release(storey, before, after):
    """Energy (J) lost where a massless brace springs from one displacement to another."""
    return 0.5 * storey.brace_stiffness * (before - after) * (before - after)


@inner
def begin(plan, start, s):
    """Set the state ``s`` (N_STATE,) to the instant t = 0."""
    storey = plan.storey
    s[:] = 0.0
    motion = start
    onset = NO_ONSET
    phase = STICK
    held = reaction(storey, motion.u, motion.v, motion.d)
    s[STATE.stored] = stored_energy(storey, motion)
    s[STATE.offset] = motion.u - motion.d
    s[STATE.anchor] = motion.u - motion.d
    if storey.brace_mass == 0.0:
        motion = Motion(motion.u, motion.v, motion.d, motion.v)  # its velocity is none of the state
    if storey.slip_force == 0.0:
        if storey.brace_mass == 0.0:
            motion, _ = begin_slip(storey, 1 if held > 0.0 else -1, motion, held)
            s[STATE.release] = spring_release(storey, start.d, motion.d)
            s[STATE.travel] = abs(start.d - motion.d)
            s[STATE.anchor] = motion.u - motion.d
        slide = motion.v - motion.e
        phase = 1 if slide > 0.0 or (slide == 0.0 and held >= 0.0) else -1
    elif motion.v != motion.e and storey.brace_mass > 0.0:
        phase = 1 if motion.v > motion.e else -1
    elif abs(held) > storey.slip_force:
        phase = 1 if held > 0.0 else -1
        motion, onset = begin_slip(storey, phase, motion, held)
        s[STATE.release] = spring_release(storey, start.d, motion.d)
        s[STATE.transitions] = 1.0
        if storey.brace_mass == 0.0 and storey.brace_damping == 0.0 and phase * motion.v < 0.0:
            # The brace has sprung back to the floor's side, and the floor takes it along.
            s[STATE.travel] = abs(start.d - motion.d)
            s[STATE.offset] = motion.u - motion.d
            s[STATE.anchor] = motion.u - motion.d
            s[STATE.transitions] = 2.0
            s[STATE.touching] = phase
            motion = Motion(motion.u, motion.v, motion.d, motion.v)
            phase = STICK
    put_motion(s, motion)
    s[STATE.phase] = phase
    s[STATE.onset] = onset
    begin_peaks(plan, s, motion)


@inner
def resume(plan, s):
    """Go on from the state ``s`` in which another history has ended, with peaks and energies anew."""
    motion = motion_of(s)
    for k in (STATE.input, STATE.viscous, STATE.release, STATE.travel):
        s[k] = 0.0
    for k in (STATE.transitions, STATE.events, STATE.status):
        s[k] = 0.0
    s[STATE.anchor] = motion.u - motion.d
    s[STATE.stored] = stored_energy(plan.storey, motion)
    begin_peaks(plan, s, motion)


@inner
def take_step(
    plan,
    forms,
    s,
    at,
    a0,
    rate,
    certify,
    no_new_peak,
    no_new_brace_peak,
    floor,
    brace,
    search,
    times,
    phases,
    traces,
    dt_out,
    written,
    reach,
):
    """Take the state ``s`` over one step; return the number of output rows written so far.

    forms: the losses of the plan, (N_FORMS,), read where certify.  at: time of the step's start, s;
    a0, rate: ground acceleration there (m/s2) and its rate (m/s3).  certify: whether the work of the viscous
    dampers is kept.  no_new_peak: whether it is known that no peak of the floor or of base shear
    is passed before the phase changes; no_new_brace_peak: the same of the brace force.
    floor, brace, search: room for series, (TERMS,).  times, phases: changes of
    phase, as far as they have room.  traces (m, len(TRACES)): row k is
    written at k dt_out once that is not later than ``reach`` past the state; with m = 0
    nothing is written, else every segment is expanded.
    """
    storey = plan.storey
    limit = storey.slip_force
    free = limit == 0.0
    tracing = traces.shape[0] > 0
    spring_only = storey.brace_mass == 0.0 and storey.brace_damping == 0.0

    motion = motion_of(s)
    offset = s[STATE.offset]
    phase = int(s[STATE.phase])
    onset = s[STATE.onset]
    touching = int(s[STATE.touching])
    peaks = peaks_of(s)
    strongest = s[STATE.peak_brace]
    tau = 0.0
    part = 0  # index of the segment within the step, on the grid of the phase
    whole = True  # whether the segment begins on that grid
    at_one_instant = 0
    rings_below = False  # whether the brace force stays below its peak while this slip lasts
    while tau < plan.step:
        segments = 1 if phase == STICK else int(plan.slip_steps)
        order = int(plan.stick_order) if phase == STICK else int(plan.slip_order)
        target = plan.step if part + 1 == segments else (part + 1) * plan.slip_step
        h = target - tau
        acceleration = ground_at(a0, rate, tau)
        force = forcing(plan, phase, offset, acceleration, rate)

        found = UNCLEAR
        sign = phase
        share = 0.0
        length = h
        end = motion
        swept = swung = 0.0
        if not tracing and touching == STICK:
            found, sign, length, end, swept, swung = at_once(
                plan, phase, whole, motion, force, offset, onset, h
            )
        if found != UNCLEAR:
            happens = found == CROSSES
            h = length
            s[STATE.input] += input_work(plan, phase, motion, end, swept, swung, acceleration, rate, h)
            if certify and whole and not happens:
                s[STATE.viscous] += whole_loss(plan, forms, phase, motion, force)
            elif certify:
                s[STATE.viscous] += part_loss(plan, phase, floor, motion, force, h)
        else:
            if phase == STICK:
                b = plan.stick
                expand(floor, order, motion.u, motion.v, b.g, b.w2, force.p0, force.p1, h)
                x, sign = search_stick(plan, floor, search, order, h, offset, touching)
            else:
                b = plan.floor
                expand(floor, order, motion.u, motion.v, b.g, b.w2, force.p0, force.p1, h)
                b = plan.brace
                expand(brace, order, motion.d, motion.e, b.g, b.w2, force.b0, force.b1, h)
                x = search_slip(floor, brace, search, order, h, phase, onset)
                sign = phase
            happens = x <= 1.0
            share = min(x, 1.0)
            if tracing:
                so_far = Energy(s[STATE.input], s[STATE.viscous], s[STATE.release])
                until = (tau + share * h if happens else target) + reach
                while written < traces.shape[0] and written * dt_out - at <= until:
                    y = min(max((written * dt_out - at - tau) / h, 0.0), share)
                    write_trace(
                        plan,
                        floor,
                        brace,
                        order,
                        phase,
                        offset,
                        s[STATE.anchor],
                        s[STATE.travel],
                        so_far,
                        acceleration,
                        rate,
                        h,
                        y,
                        traces[written],
                    )
                    written += 1
            done, lost = series_work(plan, phase, floor, brace, order, acceleration, rate, h, share, certify)
            s[STATE.input] += done
            s[STATE.viscous] += lost
            u, rise = value_slope(floor, 0, order, share)
            v = rise / h
            d = u - offset
            e = v
            if phase != STICK:
                d, rise = value_slope(brace, 0, order, share)
                e = rise / h
            end = Motion(u, v, d, e)
            h *= share

        if h > 0.0:
            no_new_peak = no_new_peak and not happens
            no_new_brace_peak = no_new_brace_peak and not happens
            if phase == STICK and not (no_new_peak and no_new_brace_peak):
                # The brace's first: it leaves the series as it is.  What both bounds need is worked out once.
                strongest = stick_brace_peak(
                    plan, floor, search, order, share, motion, end, force, offset, h, strongest
                )
                peaks = stick_peaks(plan, floor, search, order, share, motion, end, force, offset, h, peaks)
            elif phase != STICK:
                if not (no_new_brace_peak or rings_below):
                    strongest = slip_brace_peak(
                        plan, brace, search, order, share, motion, end, force, h, strongest
                    )
                if not no_new_peak:
                    peaks = slip_peaks(
                        plan, floor, brace, search, order, share, motion, end, force, phase, h, peaks
                    )
            motion = end
        touching = STICK
        if happens or phase * (motion.v - motion.e) > UNRESOLVED * (abs(motion.v) + abs(motion.e)):
            onset = NO_ONSET
        if not happens:
            part += 1
            whole = True
            tau = target
            continue

        at_one_instant = at_one_instant + 1 if tau + h == tau else 0
        tau += h
        s[STATE.events] += 1.0
        if s[STATE.events] > TRANSITION_CAP or at_one_instant > CHANGES_AT_ONE_INSTANT:
            s[STATE.status] = TRANSITION_CAP_REACHED
            break
        changes = True
        if phase == STICK:
            s[STATE.anchor] = offset
            spring = motion.d
            motion, onset = begin_slip(storey, sign, motion, limit)
            s[STATE.release] += spring_release(storey, spring, motion.d)
            phase = sign
        else:
            v = 0.0 if spring_only else motion.v
            motion = Motion(motion.u, v, motion.d, v)
            slipped = sign * (motion.u - motion.d - s[STATE.anchor])
            held = reaction(storey, motion.u, motion.v, motion.d)
            if storey.brace_mass == 0.0:
                held = sliding_force(sign, storey.kinetic_slip_force)
            after = phase_after_stop(sign, held, limit)
            if free and after == STICK:
                after = -sign
            if after == GOES_ON:
                onset = onset_acceleration(storey, held)
                changes = False
            else:
                s[STATE.travel] += slipped
                s[STATE.anchor] = motion.u - motion.d
                phase = after
                changes = not free
                if phase == STICK:
                    offset = motion.u - motion.d
                    motion = Motion(motion.u, motion.v, motion.d, motion.v)
                    if storey.brace_mass == 0.0:
                        touching = sign
                elif storey.brace_mass > 0.0:
                    onset = onset_acceleration(storey, held)
        if changes:
            k = int(s[STATE.transitions])
            if k < times.size:
                times[k] = at + tau
                phases[k] = phase
            s[STATE.transitions] = k + 1.0
        peaks = with_instant(plan, phase, offset, motion, peaks)
        s[STATE.peak_slip] = max(s[STATE.peak_slip], abs(motion.u - motion.d))
        segments = 1 if phase == STICK else int(plan.slip_steps)
        part = 0 if phase == STICK else min(int(tau / plan.slip_step), segments - 1)
        if part + 1 < segments and (part + 1) * plan.slip_step <= tau:
            part += 1
        whole = False
        rings_below = False
        if phase != STICK:
            force = forcing(plan, phase, offset, ground_at(a0, rate, tau), rate)
            rings_below = slip_brace_bound(plan, motion, force.b0, force.b1, plan.step - tau) <= strongest
        no_new_brace_peak = False

    if no_new_peak:
        # Bounds on what lies inside a step leave out its end, which the next step's would tell of.
        peaks = with_instant(plan, phase, offset, motion, peaks)
    if no_new_brace_peak:
        strongest = max(strongest, abs(brace_force(storey, motion)))
    if not abs(motion.u) + abs(motion.v) + abs(motion.d) + abs(motion.e) < math.inf:
        s[STATE.status] = NON_FINITE_STATE
    put_motion(s, motion)
    s[STATE.offset] = offset
    s[STATE.phase] = phase
    s[STATE.onset] = onset
    s[STATE.touching] = touching
    put_peaks(s, peaks)
    s[STATE.peak_brace] = strongest
    return written


@inner
def come_to_rest(plan, forms, s, parts, certify, floor, brace, search, times, phases, traces):
    """Go on with the ground at rest until nothing can slip any more; return the record steps taken.

    parts: steps of the plan in each of them.  times, phases, traces: as for `take_step`, and without room.
    """
    taken = 0
    while s[STATE.status] == OK and not is_at_rest(plan, s):
        if taken == REST_STEPS:
            s[STATE.status] = TRANSITION_CAP_REACHED
            break
        for _ in range(parts):
            take_step(
                plan,
                forms,
                s,
                0.0,
                0.0,
                0.0,
                certify,
                False,
                False,
                floor,
                brace,
                search,
                times,
                phases,
                traces,
                0.0,
                0,
                0.0,
            )
            if s[STATE.status] != OK:
                break
        taken += 1
    return taken
