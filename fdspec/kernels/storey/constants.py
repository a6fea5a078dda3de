"""What a single-storey history needs to know of its storey and time step, worked out once."""

from __future__ import annotations

import math
from typing import NamedTuple

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.mathematics.oscillator import StepMap, rate_bound, series_order, step_map
from fdspec.kernels.types import Storey

RADIANS = 1.0
"""Longest phase of a segment that is searched for roots; no result depends on it."""


SLOW = 0.05
"""Phase (rad) of the brace in a segment below which its motion is a series: 12 digits are left there."""


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
    hold_u: float
    hold_v: float
    hold_offset: float
    """Reaction while sticking = hold_u u + hold_v v - hold_offset (slip offset)."""
    lift: float
    """Force over mass per slip offset while sticking, 1/s2."""
    step: float
    """Length of a step, s: a whole segment of stick."""
    slip_steps: float
    """Segments of slip in a step, a whole number."""
    slip_step: float
    """Length of a segment of slip, s."""
    stick_order: float
    slip_order: float
    """Orders of the series on a segment, whole numbers."""
    floor_order: float
    """Order of the floor's series on a segment of slip: the floor moves far less than the brace."""
    stick_map: StepMap
    floor_map: StepMap
    brace_map: StepMap


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
def brace_branch(storey):
    """The brace alone."""
    if storey.brace_mass > 0.0:
        return branch(storey.brace_mass, storey.brace_damping, storey.brace_stiffness)
    return massless_branch(storey.brace_damping, storey.brace_stiffness)


@inner
def parts_of(rate, time, radians):
    """Number of equal parts of a time, each of at most ``radians``."""
    return max(1, int(math.ceil(rate * time / radians)))


@inner
def steps_per_sample(storey, dt, radians):
    """Steps in a record step of dt: each at most ``radians`` of the floor, with the brace or alone."""
    stick = branch(
        storey.floor_mass + storey.brace_mass,
        storey.floor_damping + storey.brace_damping,
        storey.floor_stiffness + storey.brace_stiffness,
    )
    floor = branch(storey.floor_mass, storey.floor_damping, storey.floor_stiffness)
    return parts_of(max(stick.rate, floor.rate), dt, radians)


@inlined
def has_closed_form(plan):
    """Whether the brace's motion is taken from its closed form: it has mass, no damping, and is not slow.

    The closed form of a brace that is slow against the step loses digits, see `is_slow`.
    """
    return plan.storey.brace_mass > 0.0 and plan.brace.g == 0.0 and not is_slow(plan)


@inlined
def is_slow(plan):
    """Whether the brace moves through so little of its period in a segment that its spring hardly matters.

    What is a difference of the forcing's share and of the swing about it then cancels: by 1 / phase^2 of a
    rounding.  A brace without spring is the limit.
    """
    return plan.brace.rate * plan.slip_step < SLOW


@inner
def plan(storey, step, radians):
    """Work out the constants; ``radians`` is the longest phase (rad) of a segment searched for roots."""
    m, c, k = storey.floor_mass, storey.floor_damping, storey.floor_stiffness
    md, cd, kd = storey.brace_mass, storey.brace_damping, storey.brace_stiffness
    mass = m + md
    stick = branch(mass, c + cd, k + kd)
    floor = branch(m, c, k)
    brace = brace_branch(storey)
    slip_steps = parts_of(max(floor.rate, brace.rate), step, radians)
    slip_step = step / slip_steps
    return Plan(
        storey,
        stick,
        floor,
        brace,
        mass,
        (kd * m - md * k) / mass,
        (cd * m - md * c) / mass,
        kd * m / mass,
        kd / mass,
        step,
        float(slip_steps),
        slip_step,
        float(series_order(stick.rate * step)),
        float(series_order(max(floor.rate, brace.rate) * slip_step)),
        float(series_order(floor.rate * slip_step)),
        step_map(stick.g, stick.w2, step),
        step_map(floor.g, floor.w2, slip_step),
        step_map(brace.g, brace.w2, slip_step),
    )
