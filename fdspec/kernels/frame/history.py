"""One history of a frame of N storeys, event by event.

Between two changes of phase the frame is linear and its forcing linear in time.  Its motion over a
step of a few radians of its fastest part is a Taylor series complete to rounding, in which every
storey's reaction and sliding velocity is a polynomial: the first root of any of them ends the step,
that storey changes its phase, and the next step starts there.  Only storeys that slip have their
brace in the motion, so a frame that sticks is stepped as slowly as its record.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.frame.arrays import Balance
from fdspec.kernels.frame.demands import (
    has_only_columns,
    raise_column_shears,
    raise_demands,
)
from fdspec.kernels.frame.energy import (
    input_work,
    stored_energy,
    viscous_work,
)
from fdspec.kernels.frame.finish import finish
from fdspec.kernels.frame.model import (
    fastest_rate,
    held_rates,
    is_damped,
    is_grounded,
    prepare,
    rate_of,
    set_phase,
)
from fdspec.kernels.frame.output import ENERGY, write_traces
from fdspec.kernels.frame.peaks import raise_peaks
from fdspec.kernels.frame.results import END_ROWS, NO_TIME
from fdspec.kernels.frame.start import begin, go_on, set_state
from fdspec.kernels.frame.step import change_phases, look_ahead
from fdspec.kernels.frame.strain import strain_of_step
from fdspec.kernels.frame.taylor import (
    DISPLACEMENT,
    VELOCITY,
    end_of_step,
    order_for,
    relax,
)
from fdspec.kernels.storey.strain import STRAIN
from fdspec.kernels.types import (
    NON_FINITE_STATE,
    OK,
    TRANSITION_CAP,
    TRANSITION_CAP_REACHED,
)


@inner
def history(
    frame,
    matrices,
    ground,
    dt,
    free_steps,
    certify,
    start,
    radians,
    extra,
    room,
    log,
    dt_out,
    over_time,
    results,
    strain,
):
    """Integrate one history: arguments as in :mod:`fdspec.kernels.frame.entry`, in the bundles of `arrays`.

    strain: None, or a `Strain` where that is wanted in place of all else: numba leaves out what is not.
    """
    dense_stiffness, dense_damping, stiffness_lanes, damping_lanes = matrices
    model, state, motion, tally, series, momentum, reach, speeds, c = room[:9]
    instants, signs, kind, phase, vanishing, touching = room[9:]
    times, storeys, phases = log
    traces, energies = over_time
    peaks, counts, demands = results.peaks, results.counts, results.demands
    size = frame.shape[1]
    damped = is_damped(frame)
    grounded = is_grounded(frame)
    only_columns = has_only_columns(frame, dense_stiffness)
    held = held_rates(frame, dense_stiffness, dense_damping)
    held_rate = rate_of(held[0], held[1])
    prepare(frame, model, held)
    massless = set_state(frame, model, kind, phase, state, tally, start)
    resumes = start.shape[0] == END_ROWS
    if resumes:
        go_on(phase, vanishing, touching, state, tally, start)
    stored = stored_energy(frame, dense_stiffness, state)
    transitions = 0
    if not resumes:
        transitions = begin(
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
        )
    for i in range(size):
        set_phase(frame, model, phase, i)
    rate = fastest_rate(model, phase, held_rate)

    tracing = traces.shape[0] > 0
    status = OK
    work_in = 0.0
    most_in = 0.0
    viscous = 0.0
    area = 0.0
    most_strain = 0.0
    written = 0
    events = 0
    steps = ground.size - 1
    for step in range(steps + free_steps):
        a0 = 0.0
        slope = 0.0
        if step < steps:
            a0 = ground[step]
            slope = (ground[step + 1] - a0) / dt
        tau = 0.0
        while True:
            if massless:
                relax(frame, model, kind, phase, vanishing, state)
                rate = fastest_rate(model, phase, held_rate)
            radian = min(dt, 1.0 / rate)
            parts = max(1, math.ceil((dt - tau) * rate / radians - 1e-9))
            h = (dt - tau) / parts
            n = order_for(rate * h, extra)
            acceleration = a0 + slope * tau
            rise = slope * h
            x = look_ahead(
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
                step * dt + tau,
                radian,
                acceleration,
                rise,
                c,
                instants,
                signs,
            )
            happens = x <= 1.0
            done = x if happens else 1.0
            if strain is None and tracing:
                reached = tau + h * done
                final = step == steps + free_steps - 1 and not happens and parts == 1
                while written < traces.shape[0]:
                    at = written * dt_out - step * dt
                    if at > reached and not (final and at <= reached + 1e-6 * dt):
                        break
                    y = min(max((at - tau) / h, 0.0), done)
                    energies[written, ENERGY.input_energy] = work_in + input_work(
                        momentum, n, h, acceleration, rise, y
                    )
                    energies[written, ENERGY.viscous_energy] = viscous + viscous_work(
                        frame, dense_damping, damped, series, n, h, y, speeds
                    )
                    write_traces(
                        frame,
                        dense_stiffness,
                        phase,
                        series,
                        n,
                        h,
                        y,
                        tally,
                        motion,
                        c,
                        traces,
                        energies,
                        written,
                    )
                    written += 1
            if strain is not None and done > 0.0:
                swept, most_strain = strain_of_step(
                    frame,
                    dense_stiffness,
                    series,
                    n,
                    h,
                    done,
                    motion,
                    strain.room,
                    most_strain,
                )
                area += swept
                end_of_step(series, n, done, state)
            elif done > 0.0:
                work_in += input_work(momentum, n, h, acceleration, rise, done)
                most_in = max(most_in, abs(work_in))
                if certify or tracing:
                    viscous += viscous_work(frame, dense_damping, damped, series, n, h, done, speeds)
                end_of_step(series, n, done, state)
                raise_peaks(frame, model, series, reach, state, n, h, done, acceleration, rise, c, peaks)
                raise_demands(model, series, reach, state, n, h, done, acceleration, rise, c, demands)
                if not only_columns:
                    raise_column_shears(dense_stiffness, model, series, n, done, c, demands)
            if done > 0.0:
                for i in range(size):
                    vanishing[i] = 0
                    touching[i] = 0
                tau += h * done
            if not happens:
                if parts == 1:
                    break
                continue
            events_now, transitions = change_phases(
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
                step * dt + tau,
                radian,
                times,
                storeys,
                phases,
                transitions,
                counts,
            )
            events += events_now
            rate = fastest_rate(model, phase, held_rate)
            if events > TRANSITION_CAP:
                status = TRANSITION_CAP_REACHED
                break
            if dt - tau <= NO_TIME * dt:
                break
        if not math.isfinite(area + most_strain):
            status = NON_FINITE_STATE
        for i in range(size):
            if not math.isfinite(state[DISPLACEMENT, i] + state[VELOCITY, i]):
                status = NON_FINITE_STATE
        if status != OK:
            break

    if strain is not None:
        strain.result[STRAIN.strain_energy_area] = area
        strain.result[STRAIN.peak_strain_energy] = most_strain
        strain.result[STRAIN.status] = status
    else:
        finish(
            frame,
            dense_stiffness,
            only_columns,
            certify,
            phase,
            vanishing,
            touching,
            state,
            tally,
            Balance(work_in, most_in, viscous, stored),
            transitions,
            status,
            results,
        )
