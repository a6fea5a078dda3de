"""One lane of the eight: a history is put into it, changes its phase, and is taken out."""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.frame import model as rows
from fdspec.kernels.frame.energy import stored_energy
from fdspec.kernels.frame.finish import fill_storeys, fill_totals
from fdspec.kernels.frame.model import (
    NO_BRACE,
    fastest_rate,
    held_rates,
    kind_of,
    prepare,
    rate_of,
    set_phase,
)
from fdspec.kernels.frame.reset import TALLY_ROWS, begin_slip
from fdspec.kernels.frame.taylor import DISPLACEMENT, VELOCITY
from fdspec.kernels.frame_batch.eight import WIDTH
from fdspec.kernels.frame_batch.layout import (
    COLUMN_DASHPOTS,
    COLUMNS,
    COMPLIANCE,
    DASHPOT,
    END,
    FRICTION,
    GROUND_DASHPOTS,
    GROUND_SPRINGS,
    INPUT,
    LIMIT,
    MASS,
    MOST_INPUT,
    OF_BRACE,
    OF_FLOOR,
    OMEGA,
    OVER_BRACE,
    PEAK,
    PEAKS,
    RATE,
    SIGN,
    SLIDES,
    SLIDING_MASS,
    SLOWNESS,
    SPECIAL,
    SPRING,
    START,
    STUCK,
    TAU,
    VISCOUS,
    row,
)
from fdspec.kernels.types import ENERGY_NOT_CLOSED, ENERGY_TOLERANCE, NON_FINITE_STATE, OK, STICK


@inner
def put_phase(p, lane, frame, model, phase, i):
    """Bring the lane's numbers of storey i in line with its phase."""
    set_phase(frame, model, phase, i)
    sticks = phase[i] == STICK
    floor = frame[rows.FLOOR_MASS, i]
    brace = frame[rows.BRACE_MASS, i]
    p[row(COMPLIANCE, i) + lane] = model[rows.COMPLIANCE, i]
    p[row(STUCK, i) + lane] = model[rows.STUCK, i]
    p[row(FRICTION, i) + lane] = model[rows.FRICTION, i]
    p[row(OF_FLOOR, i) + lane] = model[rows.FLOOR_SHARE, i] if sticks else 1.0 / floor
    p[row(OF_BRACE, i) + lane] = model[rows.BRACE_SHARE, i] if sticks else 1.0 / brace
    p[row(SLIDES, i) + lane] = 0.0 if sticks else 1.0
    p[row(SIGN, i) + lane] = phase[i]
    p[row(SLIDING_MASS, i) + lane] = 0.0 if sticks else brace


@inner
def put_history(
    p, at, size, lane, frame, stiffness, damping, model, kind, phase, vanishing, touching, state, tally
):
    """Set a lane to a history at rest at t = 0; a damper without friction slides from the start.

    Return the rate (1/s) with every damper stuck.
    """
    held = held_rates(frame, stiffness, damping)
    prepare(frame, model, held)
    for r in range(4):
        for i in range(size):
            state[r, i] = 0.0
            p[row(START + r, i) + lane] = 0.0
    for r in range(PEAKS):
        for i in range(size):
            p[row(PEAK + r, i) + lane] = 0.0
    for r in range(TALLY_ROWS):
        for i in range(size):
            tally[r, i] = 0.0
    for i in range(size):
        kind[i] = kind_of(frame, i)
        phase[i] = STICK
        vanishing[i] = 0
        touching[i] = 0
        if kind[i] != NO_BRACE and frame[rows.SLIP_FORCE, i] == 0.0:
            begin_slip(frame, kind, phase, vanishing, state, tally, i, 1, False)
            vanishing[i] = 0
        brace = frame[rows.BRACE_MASS, i]
        p[row(SPRING, i) + lane] = frame[rows.BRACE_STIFFNESS, i]
        p[row(DASHPOT, i) + lane] = frame[rows.BRACE_DAMPING, i]
        p[row(COLUMNS, i) + lane] = frame[rows.STOREY_STIFFNESS, i]
        p[row(COLUMN_DASHPOTS, i) + lane] = frame[rows.STOREY_DAMPING, i]
        p[row(GROUND_SPRINGS, i) + lane] = frame[rows.GROUND_STIFFNESS, i]
        p[row(GROUND_DASHPOTS, i) + lane] = frame[rows.GROUND_DAMPING, i]
        p[row(MASS, i) + lane] = frame[rows.FLOOR_MASS, i] + brace
        p[row(LIMIT, i) + lane] = math.inf if kind[i] == NO_BRACE else frame[rows.SLIP_FORCE, i]
        p[row(SPECIAL, i) + lane] = 0.0
        p[row(OVER_BRACE, i) + lane] = 1.0 / brace if brace > 0.0 else 0.0
        p[row(SLOWNESS, i) + lane] = model[rows.SLOWNESS, i] if brace > 0.0 else 0.0
        slowness = p[row(SLOWNESS, i) + lane]
        p[row(OMEGA, i) + lane] = 1.0 / slowness if slowness > 0.0 else 0.0
        put_phase(p, lane, frame, model, phase, i)
    for i in range(stiffness.shape[0]):
        for j in range(size):
            p[at.stiffness + (i * size + j) * WIDTH + lane] = stiffness[i, j]
    for i in range(damping.shape[0]):
        for j in range(size):
            p[at.damping + (i * size + j) * WIDTH + lane] = damping[i, j]
    held_rate = rate_of(held[0], held[1])
    p[TAU * WIDTH + lane] = 0.0
    p[INPUT * WIDTH + lane] = 0.0
    p[MOST_INPUT * WIDTH + lane] = 0.0
    p[VISCOUS * WIDTH + lane] = 0.0
    p[RATE * WIDTH + lane] = fastest_rate(model, phase, held_rate)
    return held_rate


@inner
def take_state(p, block, size, lane, state):
    """Take a lane's state from the rows of that state into (4, N)."""
    for r in range(4):
        for i in range(size):
            state[r, i] = p[row(block + r, i) + lane]


@inner
def put_state(p, block, size, lane, state):
    """Put a state (4, N) into a lane's rows of that state."""
    for r in range(4):
        for i in range(size):
            p[row(block + r, i) + lane] = state[r, i]


@inner
def is_finite(p, block, size, lane):
    """Whether a lane's displacements and velocities are numbers."""
    for i in range(size):
        if not math.isfinite(p[row(block + DISPLACEMENT, i) + lane] + p[row(block + VELOCITY, i) + lane]):
            return False
    return True


@inner
def finish(
    p, size, lane, frame, stiffness, phase, state, tally, transitions, status, certify, by_storey, totals
):
    """Fill a history's results, as `fdspec.kernels.frame.entry.integrate` does, from the rows END."""
    take_state(p, END, size, lane, state)
    for r in range(PEAKS):
        for i in range(size):
            by_storey[r, i] = p[row(PEAK + r, i) + lane]
    friction = fill_storeys(frame, phase, state, tally, by_storey)
    work_in = p[INPUT * WIDTH + lane]
    viscous = p[VISCOUS * WIDTH + lane]
    error = 0.0
    if certify:
        scale = max(p[MOST_INPUT * WIDTH + lane], viscous + friction)
        if scale > 0.0:
            now = stored_energy(frame, stiffness, state)
            error = abs(work_in - now - viscous - friction) / scale
    if status == OK:
        if not math.isfinite(friction + viscous + work_in + error):
            status = NON_FINITE_STATE
        elif error > ENERGY_TOLERANCE:
            status = ENERGY_NOT_CLOSED
    fill_totals(transitions, friction, viscous, work_in, error, status, totals)
