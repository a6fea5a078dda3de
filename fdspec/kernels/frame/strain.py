"""Strain energy of a frame of N storeys: its area under the history and its maximum.

The energy is that of Filiatrault and Cherry's index, elastic and in every member, frame and braces alike.
The frame is stepped as `history.py` does, without what that keeps beside the motion.  On a
step U is a polynomial: its integral is a Gauss quadrature, exact to rounding, and its maximum is looked for
only where the reach of all drifts and stretches leaves room for one.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, inner
from fdspec.kernels.frame.energy import strain_energy
from fdspec.kernels.frame.groups_of_four import LANES
from fdspec.kernels.frame.history import given1d, given2d, widen
from fdspec.kernels.frame.model import (
    BRACE_STIFFNESS,
    GROUND_STIFFNESS,
    MASSLESS,
    MODEL_ROWS,
    NO_BRACE,
    SLIP_FORCE,
    STOREY_STIFFNESS,
    fastest_rate,
    held_rates,
    is_damped,
    is_grounded,
    kind_of,
    prepare,
    rate_of,
    set_phase,
)
from fdspec.kernels.frame.reset import TALLY_ROWS, begin_slip
from fdspec.kernels.frame.results import NO_TIME
from fdspec.kernels.frame.step import change_phases, look_ahead
from fdspec.kernels.frame.taylor import (
    DISPLACEMENT,
    OFFSET,
    QUANTITIES,
    REACH_ROWS,
    TERMS,
    end_of_step,
    order_for,
    relax,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude
from fdspec.kernels.mathematics.quadrature import NODES, WEIGHTS
from fdspec.kernels.storey.strain import STRAIN
from fdspec.kernels.types import NON_FINITE_STATE, OK, TRANSITION_CAP, TRANSITION_CAP_REACHED


@inner
def stretch_term(series, i, k):
    """Coefficient k of the stretch of the brace of storey i, counted from 1."""
    return series[DISPLACEMENT, i, k] - series[DISPLACEMENT, i - 1, k] - series[OFFSET, i, k]


@inner
def bound_on_strain(frame, dense_stiffness, series, n, c):
    """A strain energy (J) that is not exceeded on the step; c is room for N numbers."""
    total = 0.0
    for i in range(1, frame.shape[1] + 1):
        floor = 0.0
        drift = 0.0
        stretch = 0.0
        for k in range(n + 1):
            floor += abs(series[DISPLACEMENT, i, k])
            drift += abs(series[DISPLACEMENT, i, k] - series[DISPLACEMENT, i - 1, k])
            stretch += abs(stretch_term(series, i, k))
        total += frame[GROUND_STIFFNESS, i - 1] * floor * floor
        total += frame[STOREY_STIFFNESS, i - 1] * drift * drift
        total += frame[BRACE_STIFFNESS, i - 1] * stretch * stretch
        if dense_stiffness.shape[0] > 0:
            c[i - 1] = floor
    for i in range(dense_stiffness.shape[0]):
        for j in range(dense_stiffness.shape[0]):
            total += abs(dense_stiffness[i, j]) * c[i] * c[j]
    return 0.5 * total


@inner
def strain_series(frame, dense_stiffness, series, n, out):
    """Make out, of the full order, the series of U from those of displacements and slip offsets."""
    for k in range(TERMS):
        total = 0.0
        for j in range(max(0, k - n), min(k, n) + 1):
            m = k - j
            for i in range(1, frame.shape[1] + 1):
                x, y = series[DISPLACEMENT, i, j], series[DISPLACEMENT, i, m]
                total += frame[GROUND_STIFFNESS, i - 1] * x * y
                x, y = x - series[DISPLACEMENT, i - 1, j], y - series[DISPLACEMENT, i - 1, m]
                total += frame[STOREY_STIFFNESS, i - 1] * x * y
                x, y = stretch_term(series, i, j), stretch_term(series, i, m)
                total += frame[BRACE_STIFFNESS, i - 1] * x * y
            for i in range(dense_stiffness.shape[0]):
                force = 0.0
                for q in range(dense_stiffness.shape[0]):
                    force += dense_stiffness[i, q] * series[DISPLACEMENT, q + 1, m]
                total += force * series[DISPLACEMENT, i + 1, j]
        out[k] = 0.5 * total


@inner
def strain_of_step(frame, dense_stiffness, series, n, h, x, motion, c, most):
    """The integral of U over the first part x of a step, and the greater of its maximum and ``most``."""
    total = 0.0
    for node in range(len(NODES)):
        end_of_step(series, n, x * NODES[node], motion)
        total += WEIGHTS[node] * strain_energy(frame, dense_stiffness, motion)
    if bound_on_strain(frame, dense_stiffness, series, n, c) > most:
        strain_series(frame, dense_stiffness, series, n, c)
        power = 1.0
        for k in range(TERMS):
            c[k] *= power
            power *= x
        most = largest_magnitude(c, TERMS - 1, most)
    return total * x * h, most


@inner
def strain_of_history(
    frame,
    dense_stiffness,
    stiffness_lanes,
    damping_lanes,
    held,
    ground,
    dt,
    radians,
    model,
    state,
    motion,
    tally,
    series,
    momentum,
    reach,
    c,
    spare,
    instants,
    signs,
    kind,
    phase,
    vanishing,
    touching,
    no_times,
    none,
    counts,
    result,
):
    """Integrate one history from rest: arguments as in :func:`integrate_frame_strain`, zeroed room."""
    size = frame.shape[1]
    damped = is_damped(frame)
    grounded = is_grounded(frame)
    held_rate = rate_of(held[0], held[1])
    prepare(frame, model, held)
    massless = False
    for i in range(size):
        kind[i] = kind_of(frame, i)
        massless = massless or kind[i] == MASSLESS
        if kind[i] != NO_BRACE and frame[SLIP_FORCE, i] == 0.0:
            begin_slip(frame, kind, phase, vanishing, state, tally, i, 1, False)
            vanishing[i] = 0
        set_phase(frame, model, phase, i)
    rate = fastest_rate(model, phase, held_rate)
    status = OK
    total = 0.0
    most = 0.0
    events = 0
    for step in range(ground.size - 1):
        slope = (ground[step + 1] - ground[step]) / dt
        tau = 0.0
        while True:
            if massless:
                relax(frame, model, kind, phase, vanishing, state)
                rate = fastest_rate(model, phase, held_rate)
            radian = min(dt, 1.0 / rate)
            parts = max(1, math.ceil((dt - tau) * rate / radians - 1e-9))
            h = (dt - tau) / parts
            n = order_for(rate * h, 0)
            acceleration = ground[step] + slope * tau
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
            if done > 0.0:
                swept, most = strain_of_step(frame, dense_stiffness, series, n, h, done, motion, spare, most)
                total += swept
                end_of_step(series, n, done, state)
                for i in range(size):
                    vanishing[i] = 0
                    touching[i] = 0
                tau += h * done
            if not happens:
                if parts == 1:
                    break
                continue
            events_now, _ = change_phases(
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
                no_times,
                none,
                none,
                0,
                counts,
            )
            events += events_now
            rate = fastest_rate(model, phase, held_rate)
            if events > TRANSITION_CAP:
                status = TRANSITION_CAP_REACHED
                break
            if dt - tau <= NO_TIME * dt:
                break
        if status == OK and not math.isfinite(total + most):
            status = NON_FINITE_STATE
        if status != OK:
            break
    result[STRAIN.strain_energy_area] = total
    result[STRAIN.peak_strain_energy] = most
    result[STRAIN.status] = status


@entry(types.void(given2d, given2d, given2d, given1d, types.float64, types.float64, float1d))
def integrate_frame_strain(frame, dense_stiffness, dense_damping, ground, dt, radians, result):
    """Integrate the strain energy of a frame of N storeys from rest.

    Arguments as in :func:`fdspec.kernels.frame.history.integrate`.  Filled: result (3,), as in
    :data:`fdspec.kernels.storey.strain.STRAIN_RESULTS`.
    """
    size = frame.shape[1]
    lanes = LANES * ((size + LANES - 1) // LANES)
    wide = lanes if dense_stiffness.shape[0] > 0 else 0
    stiffness_lanes = np.zeros((wide, wide))
    widen(dense_stiffness, stiffness_lanes)
    wide = lanes if dense_damping.shape[0] > 0 else 0
    damping_lanes = np.zeros((wide, wide))
    widen(dense_damping, damping_lanes)
    strain_of_history(
        frame,
        dense_stiffness,
        stiffness_lanes,
        damping_lanes,
        held_rates(frame, dense_stiffness, dense_damping),
        ground,
        dt,
        radians,
        np.zeros((MODEL_ROWS, lanes)),
        np.zeros((4, size)),
        np.zeros((4, size)),
        np.zeros((TALLY_ROWS, size)),
        np.zeros((QUANTITIES, lanes + 1, TERMS)),
        np.zeros(TERMS),
        np.zeros((REACH_ROWS, lanes)),
        np.zeros(TERMS),
        np.zeros(max(TERMS, size)),
        np.zeros(size),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.zeros(size, np.int64),
        np.empty(0),
        np.empty(0, np.int64),
        np.zeros(size),
        result,
    )
