"""What a single-storey history needs to know of its storey and time step, worked out once."""

from __future__ import annotations

import math
from typing import NamedTuple

from fdspec.jit import inner
from fdspec.kernels.oscillator import StepMap, rate_bound, series_order, step_map
from fdspec.kernels.types import Storey


class Branch(NamedTuple):
    """One linear oscillator of the storey: floor and brace as one, the floor alone, the brace alone."""

    g: float
    w2: float
    rate: float
    """Bound on the growth of derivatives, 1/s."""
    slowness: float
    """1/omega, s (0 where there is no spring): weighs acceleration against velocity in bounds."""
    drift: float
    """1/omega^2, s2: velocity per rate of the forcing about which free motion swings."""


class Plan(NamedTuple):
    """Constants of one storey under one time step."""

    storey: Storey
    stick: Branch
    floor: Branch
    brace: Branch
    mass: float
    """Floor and brace, kg."""
    inverse_mass: float
    """1/m_f + 1/m_d, 1/kg; 0 for a massless brace."""
    hold_u: float
    hold_v: float
    hold_offset: float
    """Reaction while sticking = hold_u u + hold_v v - hold_offset (slip offset)."""
    lift: float
    """Force over mass per slip offset while sticking, 1/s2."""
    stick_steps: int
    slip_steps: int
    stick_step: float
    slip_step: float
    stick_order: int
    slip_order: int
    stick_map: StepMap
    floor_map: StepMap
    brace_map: StepMap
    stride_floor: StepMap
    stride_brace: StepMap
    stride: bool
    """Whether a whole record step may be taken at once while slipping."""


@inner
def branch(mass, damping, stiffness):
    """The oscillator of one mass, damper and spring."""
    g = damping / mass
    w2 = stiffness / mass
    if w2 > 0.0:
        return Branch(g, w2, rate_bound(g, w2), 1.0 / math.sqrt(w2), 1.0 / w2)
    if g > 0.0:
        return Branch(g, 0.0, g, 1.0 / g, 1.0 / (g * g))
    return Branch(0.0, 0.0, 0.0, 0.0, 0.0)


@inner
def massless_branch(damping, stiffness):
    """A brace without mass: it relaxes at stiffness / damping, at once where there is no damping."""
    rate = stiffness / damping if damping > 0.0 else 0.0
    return Branch(rate, 0.0, rate, 0.0, 0.0)


@inner
def steps_of(rate, dt, radians):
    """Number of equal parts of dt, each at most ``radians`` long."""
    return max(1, int(math.ceil(rate * dt / radians)))


@inner
def plan(storey, dt, radians):
    """Work out the constants; ``radians`` is the longest phase (rad) of a step searched for roots."""
    m, c, k = storey.floor_mass, storey.floor_damping, storey.floor_stiffness
    md, cd, kd = storey.brace_mass, storey.brace_damping, storey.brace_stiffness
    mass = m + md
    stick = branch(mass, c + cd, k + kd)
    floor = branch(m, c, k)
    if md > 0.0:
        brace = branch(md, cd, kd)
        inverse_mass = 1.0 / m + 1.0 / md
    else:
        brace = massless_branch(cd, kd)
        inverse_mass = 0.0
    stick_steps = steps_of(stick.rate, dt, radians)
    slip_steps = steps_of(max(floor.rate, brace.rate), dt, radians)
    stick_step = dt / stick_steps
    slip_step = dt / slip_steps
    stride = md > 0.0 and kd > 0.0 and slip_steps > 1 and floor.rate * dt <= 2.0 * radians
    brace_map = step_map(brace.g, brace.w2, slip_step)
    stride_floor = step_map(floor.g, floor.w2, dt)
    stride_brace = step_map(brace.g, brace.w2, dt) if stride else brace_map
    return Plan(
        storey,
        stick,
        floor,
        brace,
        mass,
        inverse_mass,
        (kd * m - md * k) / mass,
        (cd * m - md * c) / mass,
        kd * m / mass,
        kd / mass,
        stick_steps,
        slip_steps,
        stick_step,
        slip_step,
        series_order(stick.rate * stick_step),
        series_order(max(floor.rate, brace.rate) * slip_step),
        step_map(stick.g, stick.w2, stick_step),
        step_map(floor.g, floor.w2, slip_step),
        brace_map,
        stride_floor,
        stride_brace,
        stride,
    )
