"""The study's own scheme: Newmark with a fixed step, three nested loops, phases checked at step ends.

Study, equations (30) to (38); gamma = 1/2.  The scheme is kept as published, its error included: a change of
phase inside a step is seen at the step's end, so that the error falls with the first power of the step.  One
thing is added: an iteration that does not settle ends the history with a status.  It settles while
beta (omega dt)^2 < 1 for the brace alone, and while braces are lighter than their floors.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from fdspec.compiler.options import entry, float1d, float2d, float3d, inlined, inner, int1d
from fdspec.compiler.positions import positions
from fdspec.kernels.friction import sliding_force
from fdspec.kernels.types import ITERATION_NOT_CONVERGED, NON_FINITE_STATE, OK, STICK

MOST_ITERATIONS = 1000
"""Of one loop of one step; where the scheme settles at all it takes two or three."""

FLOOR_MASS, BRACE_MASS, BRACE_STIFFNESS, BRACE_DAMPING, SLIP_FORCE, KINETIC_SLIP_FORCE = range(6)
"""Rows of ``storeys`` (6, N), SI units."""

STOREY_TRACES = (
    "displacement",
    "velocity",
    "acceleration",
    "brace_displacement",
    "brace_velocity",
    "friction_force",
    "phase",
    "slip_travel",
    "storey_friction_energy",
    "storey_shear",
)
TRACE = positions(STOREY_TRACES)
TOTAL_TRACES = ("input_energy", "viscous_energy")
ENERGY = positions(TOTAL_TRACES)
STOREY_RESULTS = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_drift",
    "peak_storey_shear",
    "residual_displacement",
    "peak_slip",
    "residual_slip",
    "peak_brace_force",
    "peak_column_shear",
)
RESULT = positions(STOREY_RESULTS)
TOTALS = ("transitions", "dissipated_energy", "energy_error", "status", "evaluations")
"""What a history of all storeys leaves behind; evaluations of (36), one a step if nothing had to iterate."""
TOTAL = positions(TOTALS)

U, V, A, D, E, B, R = range(7)
"""Rows of a state (7, N): floor displacement, velocity and acceleration, the same of the brace, friction."""
STATE_ROWS = 7


@inlined
def floor_rest(storeys, stiffness, damping, x, i):
    """Force (N) on floor i but for its own damper: of the frame and of the brace that stands on it."""
    force = 0.0
    for j in range(x.shape[1]):
        force -= stiffness[i, j] * x[U, j] + damping[i, j] * x[V, j]
    if i + 1 < x.shape[1]:
        force += brace_force(storeys, x, i + 1)
    return force


@inlined
def brace_force(storeys, x, i):
    """Force (N) in spring and dashpot of brace i, positive when its top is ahead of the floor below."""
    below, below_velocity = (x[U, i - 1], x[V, i - 1]) if i > 0 else (0.0, 0.0)
    return storeys[BRACE_STIFFNESS, i] * (x[D, i] - below) + storeys[BRACE_DAMPING, i] * (
        x[E, i] - below_velocity
    )


@inlined
def off(new, old, tolerance):
    """Whether two estimates differ by more than the tolerance, relative to the larger of 1 and themselves."""
    return not abs(new - old) <= tolerance * max(1.0, abs(new))


@inlined
def advance(storeys, stiffness, damping, phase, old, x, ground, h, beta, tolerance):
    """Fill x with the state a step later; return whether all three loops settled, and evaluations of (36)."""
    n = x.shape[1]
    early = (0.5 - beta) * h * h
    late = beta * h * h
    for i in range(n):
        x[A, i], x[B, i], x[R, i] = old[A, i], old[B, i], old[R, i]
    for outer in range(MOST_ITERATIONS):
        for i in range(n):
            x[V, i] = old[V, i] + 0.5 * h * (old[A, i] + x[A, i])  # (30)
            x[U, i] = old[U, i] + h * old[V, i] + early * old[A, i] + late * x[A, i]  # (31)
            if phase[i] == STICK:
                x[B, i] = x[A, i]  # (22)
                x[E, i] = x[V, i]  # (32)
                x[D, i] = old[D, i] + (x[U, i] - old[U, i])  # (34)
        settled = False
        for _ in range(MOST_ITERATIONS):
            for _ in range(MOST_ITERATIONS):
                settled = True
                for i in range(n):
                    if phase[i] == STICK:
                        continue
                    x[E, i] = old[E, i] + 0.5 * h * (old[B, i] + x[B, i])  # (33)
                    x[D, i] = old[D, i] + h * old[E, i] + early * old[B, i] + late * x[B, i]  # (35)
                    new = (x[R, i] - brace_force(storeys, x, i)) / storeys[BRACE_MASS, i] - ground  # (38)
                    settled = settled and not off(new, x[B, i], tolerance)
                    x[B, i] = new
                if settled:
                    break
            if not settled:
                return False, outer + 1
            for i in range(n):
                if phase[i] != STICK or storeys[BRACE_STIFFNESS, i] == 0.0:
                    continue
                new = storeys[BRACE_MASS, i] * (x[B, i] + ground) + brace_force(storeys, x, i)  # (37)
                settled = settled and not off(new, x[R, i], tolerance)
                x[R, i] = new
            if settled:
                break
        if not settled:
            return False, outer + 1
        for i in range(n):
            force = floor_rest(storeys, stiffness, damping, x, i) - x[R, i]
            new = force / storeys[FLOOR_MASS, i] - ground  # (36)
            settled = settled and not off(new, x[A, i], tolerance)
            x[A, i] = new
        if settled:
            return True, outer + 1
    return False, MOST_ITERATIONS


@inner
def reaction_to_stick(storeys, stiffness, damping, x, i):
    """Reaction (N) of storey i if it stuck from now on: (24) with the common acceleration eliminated."""
    floor, brace = storeys[FLOOR_MASS, i], storeys[BRACE_MASS, i]
    velocity = x[E, i]
    x[E, i] = x[V, i]
    held = brace_force(storeys, x, i)
    x[E, i] = velocity
    return (brace * floor_rest(storeys, stiffness, damping, x, i) + floor * held) / (floor + brace)


@inner
def next_phase(storeys, stiffness, damping, phase, x, i):
    """Phase of storey i after a step: (23) while it sticks, its sliding velocity while it slips."""
    limit = storeys[SLIP_FORCE, i]
    if limit == 0.0 or storeys[BRACE_STIFFNESS, i] == 0.0:
        return phase[i]
    if phase[i] == STICK:
        held = x[R, i]
    elif phase[i] * (x[V, i] - x[E, i]) > 0.0:
        return phase[i]
    else:
        held = reaction_to_stick(storeys, stiffness, damping, x, i)
    if abs(held) <= limit:
        return STICK
    return 1 if held > 0.0 else -1  # (25)


@inner
def balance(storeys, stiffness, damping, phase, x, ground):
    """Set forces and accelerations to the equilibrium of the present phases; each interval begins so."""
    for i in range(x.shape[1]):
        if phase[i] != STICK:
            x[R, i] = sliding_force(phase[i], storeys[KINETIC_SLIP_FORCE, i])
        else:
            x[E, i] = x[V, i]
            x[R, i] = 0.0
    for i in range(x.shape[1]):
        if phase[i] == STICK and storeys[BRACE_STIFFNESS, i] > 0.0:
            x[R, i] = reaction_to_stick(storeys, stiffness, damping, x, i)
    for i in range(x.shape[1]):
        force = floor_rest(storeys, stiffness, damping, x, i) - x[R, i]
        x[A, i] = force / storeys[FLOOR_MASS, i] - ground
        if phase[i] != STICK:
            x[B, i] = (x[R, i] - brace_force(storeys, x, i)) / storeys[BRACE_MASS, i] - ground
        else:
            x[B, i] = x[A, i]


@inner
def storey_shear(storeys, x, ground, i):
    """Shear (N) in frame and brace of storey i: the inertia of all masses from there up."""
    shear = 0.0
    for j in range(i, x.shape[1]):
        shear -= storeys[FLOOR_MASS, j] * (x[A, j] + ground) + storeys[BRACE_MASS, j] * (x[B, j] + ground)
    return shear


@inlined
def raise_peaks(storeys, stiffness, x, ground, results):
    """Raise the peaks to this state's."""
    shear = 0.0
    columns = 0.0
    for i in range(x.shape[1] - 1, -1, -1):
        for j in range(x.shape[1]):
            columns += stiffness[i, j] * x[U, j]
        absolute = x[A, i] + ground
        shear -= storeys[FLOOR_MASS, i] * absolute + storeys[BRACE_MASS, i] * (x[B, i] + ground)
        drift = x[U, i] - (x[U, i - 1] if i > 0 else 0.0)
        results[RESULT.peak_acceleration, i] = max(results[RESULT.peak_acceleration, i], abs(absolute))
        results[RESULT.peak_displacement, i] = max(results[RESULT.peak_displacement, i], abs(x[U, i]))
        results[RESULT.peak_velocity, i] = max(results[RESULT.peak_velocity, i], abs(x[V, i]))
        results[RESULT.peak_drift, i] = max(results[RESULT.peak_drift, i], abs(drift))
        results[RESULT.peak_storey_shear, i] = max(results[RESULT.peak_storey_shear, i], abs(shear))
        if storeys[BRACE_STIFFNESS, i] > 0.0:
            slip, force = x[U, i] - x[D, i], brace_force(storeys, x, i)
            results[RESULT.peak_slip, i] = max(results[RESULT.peak_slip, i], abs(slip))
            results[RESULT.peak_brace_force, i] = max(results[RESULT.peak_brace_force, i], abs(force))
        results[RESULT.peak_column_shear, i] = max(results[RESULT.peak_column_shear, i], abs(columns))


@inlined
def powers(storeys, damping, x, ground):
    """Power (W) of the ground and of the dashpots."""
    given, lost = 0.0, 0.0
    for i in range(x.shape[1]):
        given -= (storeys[FLOOR_MASS, i] * x[V, i] + storeys[BRACE_MASS, i] * x[E, i]) * ground
        for j in range(x.shape[1]):
            lost += x[V, i] * damping[i, j] * x[V, j]
        rate = x[E, i] - (x[V, i - 1] if i > 0 else 0.0)
        lost += storeys[BRACE_DAMPING, i] * rate * rate
    return given, lost


@inner
def stored(storeys, stiffness, x):
    """Kinetic and elastic energy (J)."""
    energy = 0.0
    for i in range(x.shape[1]):
        for j in range(x.shape[1]):
            energy += 0.5 * x[U, i] * stiffness[i, j] * x[U, j]
        stretch = x[D, i] - (x[U, i - 1] if i > 0 else 0.0)
        energy += 0.5 * storeys[BRACE_STIFFNESS, i] * stretch * stretch
        energy += 0.5 * (storeys[FLOOR_MASS, i] * x[V, i] ** 2 + storeys[BRACE_MASS, i] * x[E, i] ** 2)
    return energy


@inner
def tell(storeys, phase, x, ground, slipped, weight, row):
    """Add ``weight`` times this state to a row (len(STOREY_TRACES), N) of the trajectory."""
    for i in range(x.shape[1]):
        row[TRACE.displacement, i] += weight * x[U, i]
        row[TRACE.velocity, i] += weight * x[V, i]
        row[TRACE.acceleration, i] += weight * (x[A, i] + ground)
        row[TRACE.brace_displacement, i] += weight * x[D, i]
        row[TRACE.brace_velocity, i] += weight * x[E, i]
        row[TRACE.friction_force, i] += weight * x[R, i]
        row[TRACE.phase, i] = phase[i]
        row[TRACE.slip_travel, i] += weight * slipped[0, i]
        row[TRACE.storey_friction_energy, i] += weight * slipped[1, i]
        row[TRACE.storey_shear, i] += weight * storey_shear(storeys, x, ground, i)


@entry(
    types.void(
        float2d,
        float2d,
        float2d,
        float2d,
        types.float64,
        types.int64,
        types.float64,
        types.float64,
        float2d,
        float1d,
        int1d,
        int1d,
        types.float64,
        float3d,
        float2d,
        float2d,
        float1d,
    )
)
def integrate(
    storeys,
    stiffness,
    damping,
    ground,
    dt,
    parts,
    beta,
    tolerance,
    start,
    times,
    changed,
    phases,
    dt_out,
    traces,
    energies,
    results,
    totals,
):
    """Integrate one history of a frame of N storeys.

    storeys (6, N); stiffness and damping (N, N) of the bare frame; ground (m, 2): acceleration at both ends
    of each of m intervals of dt, in each of which ``parts`` steps are taken; start (4, N): displacement and
    velocity of floors, then of braces.
    Filled: times, changed, phases: changes of phase as far as they have room; traces
    (k, len(STOREY_TRACES), N) and energies (k, len(TOTAL_TRACES)) at multiples of dt_out, linear between
    step ends; results (len(STOREY_RESULTS), N); totals (len(TOTALS)).
    """
    n = storeys.shape[1]
    h = dt / parts
    x, new = np.zeros((STATE_ROWS, n)), np.zeros((STATE_ROWS, n))
    slipped, before = np.zeros((2, n)), np.zeros((2, n))
    phase = np.zeros(n, np.int64)
    work = np.zeros(2)
    results[:] = 0.0
    for i in range(n):
        x[U, i], x[V, i], x[D, i], x[E, i] = start[0, i], start[1, i], start[2, i], start[3, i]
        if storeys[BRACE_STIFFNESS, i] == 0.0:
            x[D, i], x[E, i] = x[U, i], x[V, i]
        elif storeys[SLIP_FORCE, i] == 0.0:
            phase[i] = 1  # free sliding: no friction, and no phases to tell
        elif x[V, i] != x[E, i]:
            phase[i] = 1 if x[V, i] > x[E, i] else -1
    changes = 0
    for i in range(n):
        if phase[i] != STICK and storeys[SLIP_FORCE, i] > 0.0:
            if changes < times.size:
                times[changes], changed[changes], phases[changes] = 0.0, i, phase[i]
            changes += 1
    balance(storeys, stiffness, damping, phase, x, ground[0, 0])
    raise_peaks(storeys, stiffness, x, ground[0, 0], results)
    given, lost = powers(storeys, damping, x, ground[0, 0])
    at_start = stored(storeys, stiffness, x)
    told = 0
    if traces.shape[0] > 0:
        traces[0] = 0.0
        tell(storeys, phase, x, ground[0, 0], slipped, 1.0, traces[0])
        energies[0] = 0.0
        told = 1
    status = OK
    evaluations = 0
    for interval in range(ground.shape[0]):
        first, last = ground[interval, 0], ground[interval, 1]
        if interval > 0 and first != ground[interval - 1, 1]:
            balance(storeys, stiffness, damping, phase, x, first)
            raise_peaks(storeys, stiffness, x, first, results)
            given, lost = powers(storeys, damping, x, first)
        for part in range(parts):
            begin = first + (last - first) * (part / parts)
            end = first + (last - first) * ((part + 1) / parts)
            settled, used = advance(storeys, stiffness, damping, phase, x, new, end, h, beta, tolerance)
            evaluations += used
            if not settled:
                status = ITERATION_NOT_CONVERGED
            elif not math.isfinite(new[U, n - 1]):
                status = NON_FINITE_STATE
            if status != OK:
                break
            given_now, lost_now = powers(storeys, damping, new, end)
            given_before, lost_before = work[0], work[1]
            work[0] += 0.5 * h * (given + given_now)
            work[1] += 0.5 * h * (lost + lost_now)
            given, lost = given_now, lost_now
            for i in range(n):
                before[0, i], before[1, i] = slipped[0, i], slipped[1, i]
                if phase[i] != STICK:
                    # Of the step's own displacements: a sum of differences that telescopes.
                    slip = (new[U, i] - x[U, i]) - (new[D, i] - x[D, i])
                    slipped[0, i] += abs(slip)
                    slipped[1, i] += new[R, i] * slip
            now = (interval * parts + part + 1) * h
            while told < traces.shape[0] and told * dt_out <= now + 1e-6 * h:
                share = min(1.0, max(0.0, 1.0 - (now - told * dt_out) / h))
                traces[told] = 0.0
                tell(storeys, phase, x, begin, before, 1.0 - share, traces[told])
                tell(storeys, phase, new, end, slipped, share, traces[told])
                energies[told, ENERGY.input_energy] = given_before + share * (work[0] - given_before)
                energies[told, ENERGY.viscous_energy] = lost_before + share * (work[1] - lost_before)
                told += 1
            x, new = new, x
            raise_peaks(storeys, stiffness, x, end, results)
            differs = False
            for i in range(n):
                after = next_phase(storeys, stiffness, damping, phase, x, i)
                if after == phase[i]:
                    new[R, i] = phase[i]
                    continue
                differs = True
                new[R, i] = after
                if changes < times.size:
                    times[changes], changed[changes], phases[changes] = now, i, after
                changes += 1
            if differs:  # all storeys were judged in the same phases; now they change
                for i in range(n):
                    phase[i] = int(new[R, i])
                balance(storeys, stiffness, damping, phase, x, end)
                raise_peaks(storeys, stiffness, x, end, results)
                given, lost = powers(storeys, damping, x, end)
        if status != OK:
            break
    friction = 0.0
    for i in range(n):
        results[RESULT.residual_displacement, i] = x[U, i]
        results[RESULT.residual_slip, i] = x[U, i] - x[D, i] if storeys[BRACE_STIFFNESS, i] > 0.0 else 0.0
        friction += slipped[1, i]
    missing = work[0] + at_start - stored(storeys, stiffness, x) - work[1] - friction
    scale = abs(work[0]) + at_start
    totals[TOTAL.transitions] = changes
    totals[TOTAL.dissipated_energy] = friction
    totals[TOTAL.energy_error] = abs(missing) / scale if scale > 0.0 else 0.0
    totals[TOTAL.status] = status
    totals[TOTAL.evaluations] = evaluations
