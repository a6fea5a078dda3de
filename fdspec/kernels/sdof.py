"""One single-storey history, event by event.

Between two changes of phase the storey is one linear oscillator (stick) or two uncoupled ones
(slip) under a ground acceleration that is linear in time, so its motion is known; what is left is
to find every instant at which the phase changes, and every peak.

A record step is walked in pieces, each at most about a radian long.  A whole piece is advanced by
its closed form and let go when bounds show that nothing happens on it: no root of the reaction's
distance to the slip force, or of the sliding velocity, and no new peak between its ends.  Any other
piece is expanded in its Taylor series and searched.  A brace that rings fast under a floor that
slides faster cannot catch up with it: its ringing amplitude says so for a whole record step at once.
"""

from __future__ import annotations

import math

from fdspec.jit import inlined, inner
from fdspec.kernels.bounds import forcing
from fdspec.kernels.energy import input_work, series_work, stored_energy
from fdspec.kernels.friction import GOES_ON, phase_after_stop, reaction, sliding_kick
from fdspec.kernels.oscillator import TERMS, advance, area, expand, square_integral
from fdspec.kernels.roots import value_slope
from fdspec.kernels.slip import base_shear, search_slip, slip_is_quiet, slip_peaks, stride_is_quiet
from fdspec.kernels.stick import held_force, search_stick, stick_is_quiet, stick_peaks
from fdspec.kernels.types import (
    BRACE,
    FLOOR,
    NON_FINITE_STATE,
    OK,
    STICK,
    TRANSITION_CAP,
    TRANSITION_CAP_REACHED,
    Energy,
    Motion,
    Peaks,
)

WORK_SHAPE = (3, TERMS)

RESULTS = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_base_shear",
    "residual_displacement",
    "slip_travel",
    "transitions",
    "dissipated_energy",
    "input_energy",
    "energy_error",
    "status",
)
"""What a history leaves behind, in the order of its result row."""

TRACES = (
    "displacement",
    "velocity",
    "acceleration",
    "brace_displacement",
    "brace_velocity",
    "friction_force",
    "phase",
    "slip_travel",
    "input_energy",
    "viscous_energy",
    "friction_energy",
)
"""What is written at each output instant, in the order of the columns."""

NO_KICK = -1.0
"""Sliding acceleration handed on where no slip begins with a piece."""


@inlined
def floor_acceleration(plan, phase, offset, motion):
    """Absolute acceleration of the floor, m/s2."""
    if phase == STICK:
        b = plan.stick
        return plan.lift * offset - b.g * motion.v - b.w2 * motion.u
    b = plan.floor
    push = phase * plan.storey.kinetic_slip_force / plan.storey.floor_mass
    return -push - b.g * motion.v - b.w2 * motion.u


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
def begin_slip(storey, sign, motion, held):
    """Motion and sliding acceleration just after the damper gives way in this direction.

    A massless brace follows at once: without damping it springs to where the kinetic slip force
    holds it, with damping its velocity does.
    """
    if storey.brace_mass > 0.0:
        return Motion(motion.u, motion.v, motion.d, motion.v), sliding_kick(storey, held)
    if storey.brace_damping > 0.0:
        lag = (abs(held) - storey.kinetic_slip_force) / storey.brace_damping
        return Motion(motion.u, motion.v, motion.d, motion.v - sign * lag), NO_KICK
    return Motion(motion.u, motion.v, sign * storey.kinetic_slip_force / storey.brace_stiffness, 0.0), NO_KICK


@inner
def shorten(c, n, x):
    """Rescale the series of a step to its first part x."""
    power = 1.0
    for k in range(1, n + 1):
        power *= x
        c[k] *= power


@inner
def end_of_series(c, n, h):
    """Displacement and velocity at a step's end."""
    x, rise = value_slope(c, 0, n, 1.0)
    return x, rise / h


@inner
def write_trace(plan, work, n, phase, offset, anchor, travel, so_far, acceleration, rate, h, x, row):
    """Fill one row (see TRACES) at the fraction x of an expanded piece of length h."""
    storey = plan.storey
    u, rise = value_slope(work[FLOOR], 0, n, x)
    v = rise / h if h > 0.0 else work[FLOOR, 1]
    done, lost = series_work(plan, phase, work, n, acceleration, rate, h, x, True)
    if phase == STICK:
        d = u - offset
        e = v
        friction = held_force(plan, u, v, offset)
    else:
        d, rise = value_slope(work[BRACE], 0, n, x)
        e = rise / h
        friction = phase * storey.kinetic_slip_force
        travel += phase * (u - d - anchor)
    row[0] = u
    row[1] = v
    row[2] = floor_acceleration(plan, phase, offset, Motion(u, v, d, e))
    row[3] = d
    row[4] = e
    row[5] = friction
    row[6] = phase
    row[7] = travel
    row[8] = so_far.input + done
    row[9] = so_far.viscous + lost
    row[10] = so_far.release + (storey.kinetic_slip_force * travel if travel > 0.0 else 0.0)


@inner
def history(
    plan, losses, ground, dt, free_steps, certify, start, work, times, phases, dt_out, traces, result
):
    """Integrate one history and fill ``result`` (see RESULTS).

    ground: acceleration at the samples, m/s2, (n,); free_steps: steps of dt with the ground at rest
    that follow.  start: Motion at t = 0, the brace locked where it stands, unless its velocity
    differs.  times, phases: changes of phase as far as they have room.  traces (m, len(TRACES)):
    filled at k dt_out for k < m; pieces are then all searched, none strode over.
    """
    storey = plan.storey
    limit = storey.slip_force
    free = limit == 0.0
    tracing = traces.shape[0] > 0
    floor = work[FLOOR]
    brace = work[BRACE]
    may_stride = plan.stride and not tracing and not (certify and storey.brace_damping > 0.0)
    loose = storey.brace_mass == 0.0 and storey.brace_damping == 0.0

    motion = start
    offset = motion.u - motion.d
    anchor = offset
    peaks = Peaks(0.0, 0.0, 0.0, 0.0)
    work_in = 0.0
    viscous = 0.0
    release = 0.0
    travel = 0.0
    transitions = 0
    events = 0
    status = OK
    stored = stored_energy(storey, motion)
    touching = STICK
    kick = NO_KICK
    phase = STICK
    written = 0

    held = reaction(storey, motion.u, motion.v, motion.d)
    if free:
        phase = 1
    elif motion.v != motion.e and storey.brace_mass > 0.0:
        phase = 1 if motion.v > motion.e else -1
    elif abs(held) > limit:
        phase = 1 if held > 0.0 else -1
        before = motion.d
        motion, kick = begin_slip(storey, phase, motion, held)
        release += 0.5 * storey.brace_stiffness * (before - motion.d) * (before - motion.d)
        if times.size > 0:
            times[0] = 0.0
            phases[0] = phase
        transitions = 1
    peaks = with_instant(plan, phase, offset, motion, peaks)

    steps = ground.size - 1
    for i in range(steps + free_steps):
        a0 = 0.0
        rate = 0.0
        if i < steps:
            a0 = ground[i]
            rate = (ground[i + 1] - a0) / dt
        tau = 0.0
        part = 0  # index of the piece within the record step, in the grid of the phase
        whole = True  # whether it begins on that grid
        while True:
            acceleration = a0 + rate * tau
            force = forcing(plan, phase, offset, acceleration, rate)
            fresh = touching != STICK or kick >= 0.0

            if phase != STICK and part == 0 and whole and may_stride and not fresh:
                u, v = advance(plan.stride_floor, motion.u, motion.v, force.p0, force.p1)
                d, e = advance(plan.stride_brace, motion.d, motion.e, force.b0, force.b1)
                end = Motion(u, v, d, e)
                far = with_instant(plan, phase, offset, end, peaks)
                strongest = max(abs(a0), abs(a0 + rate * dt))
                if stride_is_quiet(plan, motion, end, force, phase, dt, strongest, far):
                    floor_area = area(plan.stride_floor, motion.u, motion.v, force.p0, force.p1)
                    brace_area = area(plan.stride_brace, motion.d, motion.e, force.b0, force.b1)
                    work_in += input_work(plan, phase, motion, end, floor_area, brace_area, a0, rate, dt)
                    if certify:
                        viscous += storey.floor_damping * square_integral(
                            losses.stride, motion.u, motion.v, force.p0, force.p1
                        )
                    motion = end
                    peaks = far
                    break

            pieces = plan.stick_steps if phase == STICK else plan.slip_steps
            length = plan.stick_step if phase == STICK else plan.slip_step
            order = plan.stick_order if phase == STICK else plan.slip_order
            target = dt if part + 1 == pieces else (part + 1) * length
            h = length if whole else target - tau

            if whole and not fresh and not tracing:
                if phase == STICK:
                    u, v = advance(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
                    end = Motion(u, v, u - offset, v)
                    quiet = stick_is_quiet(plan, motion, end, force, offset, h)
                else:
                    u, v = advance(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
                    d, e = advance(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
                    end = Motion(u, v, d, e)
                    quiet = slip_is_quiet(plan, motion, end, force, phase, h)
                if quiet:
                    brace_area = 0.0
                    if phase == STICK:
                        floor_area = area(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
                        peaks = stick_peaks(plan, work, order, False, motion, end, force, offset, h, peaks)
                    else:
                        floor_area = area(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
                        brace_area = area(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
                        peaks = slip_peaks(plan, work, order, False, motion, end, force, phase, h, peaks)
                    work_in += input_work(
                        plan, phase, motion, end, floor_area, brace_area, acceleration, rate, h
                    )
                    if certify:
                        if phase == STICK:
                            viscous += (storey.floor_damping + storey.brace_damping) * square_integral(
                                losses.stick, motion.u, motion.v, force.p0, force.p1
                            )
                        else:
                            viscous += storey.floor_damping * square_integral(
                                losses.floor, motion.u, motion.v, force.p0, force.p1
                            )
                            if storey.brace_damping > 0.0:
                                viscous += storey.brace_damping * square_integral(
                                    losses.brace, motion.d, motion.e, force.b0, force.b1
                                )
                    motion = end
                    part += 1
                    tau = target
                    if part == pieces:
                        break
                    continue

            b = plan.stick if phase == STICK else plan.floor
            expand(floor, order, motion.u, motion.v, b.g, b.w2, force.p0, force.p1, h)
            if phase == STICK:
                x, sign = search_stick(plan, work, order, h, offset, touching)
            else:
                b = plan.brace
                expand(brace, order, motion.d, motion.e, b.g, b.w2, force.b0, force.b1, h)
                x = search_slip(plan, work, order, h, phase, kick)
                sign = phase
            happens = x <= 1.0
            x = min(x, 1.0)
            if tracing:
                reached = tau + x * h if happens else target
                final = i == steps + free_steps - 1 and not happens and part + 1 == pieces
                while written < traces.shape[0]:
                    at = written * dt_out - i * dt
                    if at > reached and not (final and at <= reached + 1e-6 * dt):
                        break
                    y = min(max((at - tau) / h, 0.0), x) if h > 0.0 else 0.0
                    so_far = Energy(work_in, viscous, release)
                    write_trace(
                        plan,
                        work,
                        order,
                        phase,
                        offset,
                        anchor,
                        travel,
                        so_far,
                        acceleration,
                        rate,
                        h,
                        y,
                        traces[written],
                    )
                    written += 1
            done, lost = series_work(plan, phase, work, order, acceleration, rate, h, x, certify or tracing)
            work_in += done
            viscous += lost
            if happens:
                shorten(floor, order, x)
                if phase != STICK:
                    shorten(brace, order, x)
                h *= x
            if h > 0.0:
                u, v = end_of_series(floor, order, h)
                d = u - offset
                e = v
                if phase != STICK:
                    d, e = end_of_series(brace, order, h)
                end = Motion(u, v, d, e)
                if phase == STICK:
                    peaks = stick_peaks(plan, work, order, True, motion, end, force, offset, h, peaks)
                else:
                    peaks = slip_peaks(plan, work, order, True, motion, end, force, phase, h, peaks)
                motion = end
            touching = STICK
            kick = NO_KICK
            if not happens:
                part += 1
                whole = True
                tau = target
                if part == pieces:
                    break
                continue

            tau += h
            events += 1
            if events > TRANSITION_CAP:
                status = TRANSITION_CAP_REACHED
                break
            before = phase
            if phase == STICK:
                phase = sign
                anchor = motion.u - motion.d
                spring = motion.d
                motion, kick = begin_slip(storey, sign, motion, limit)
                release += 0.5 * storey.brace_stiffness * (spring - motion.d) * (spring - motion.d)
            elif free:
                motion = Motion(motion.u, motion.v, motion.d, motion.v)
                travel += phase * (motion.u - motion.d - anchor)
                anchor = motion.u - motion.d
                phase = -phase
                before = phase
            else:
                v = 0.0 if loose else motion.v
                motion = Motion(motion.u, v, motion.d, v)
                held = reaction(storey, motion.u, motion.v, motion.d)
                if storey.brace_mass == 0.0:
                    held = sign * storey.kinetic_slip_force
                after = phase_after_stop(sign, held, limit)
                if after == STICK:
                    travel += sign * (motion.u - motion.d - anchor)
                    offset = motion.u - motion.d
                    phase = STICK
                    if abs(held) == limit:
                        touching = sign
                elif after == GOES_ON:
                    kick = sliding_kick(storey, held)
                else:
                    travel += sign * (motion.u - motion.d - anchor)
                    anchor = motion.u - motion.d
                    phase = after
                    kick = sliding_kick(storey, held)
            if phase != before:
                if transitions < times.size:
                    times[transitions] = i * dt + tau
                    phases[transitions] = phase
                transitions += 1
            peaks = with_instant(plan, phase, offset, motion, peaks)
            pieces = plan.stick_steps if phase == STICK else plan.slip_steps
            length = plan.stick_step if phase == STICK else plan.slip_step
            part = min(int(tau / length), pieces - 1)
            whole = False
        if status != OK:
            break
        if not abs(motion.u) + abs(motion.v) + abs(motion.d) + abs(motion.e) < math.inf:
            status = NON_FINITE_STATE
            break

    if phase != STICK:
        travel += phase * (motion.u - motion.d - anchor)
    friction = storey.kinetic_slip_force * travel if travel > 0.0 else 0.0
    friction += release
    error = 0.0
    if certify:
        missing = work_in + stored - stored_energy(storey, motion) - viscous - friction
        scale = abs(work_in) + stored
        error = missing / scale if scale > 0.0 else 0.0
    result[0] = peaks.acceleration
    result[1] = peaks.displacement
    result[2] = peaks.velocity
    result[3] = peaks.shear
    result[4] = motion.u
    result[5] = travel
    result[6] = transitions
    result[7] = friction
    result[8] = work_in
    result[9] = error
    result[10] = status
