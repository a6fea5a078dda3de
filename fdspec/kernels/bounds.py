"""Forces on a piece of motion, and bounds on what it does between its ends."""

from __future__ import annotations

from fdspec.jit import inlined, inner
from fdspec.kernels.types import STICK, Force


@inlined
def forcing(plan, phase, offset, acceleration, rate):
    """Force over mass on a piece that begins at this ground acceleration (m/s2) and rate (m/s3)."""
    if phase == STICK:
        return Force(plan.lift * offset - acceleration, -rate, 0.0, 0.0)
    storey = plan.storey
    push = phase * storey.kinetic_slip_force
    floor = -acceleration - push / storey.floor_mass
    if storey.brace_mass > 0.0:
        return Force(floor, -rate, push / storey.brace_mass - acceleration, -rate)
    return Force(floor, -rate, 0.0, 0.0)


@inlined
def relative_acceleration(branch, x, v, force):
    """x'' of an oscillator under this force over mass."""
    return force - branch.g * v - branch.w2 * x


@inlined
def swing(branch, v, a, force_rate):
    """Amplitude (m/s) that bounds free motion: |d^k v/dt^k| <= rate^k swing for k >= 1."""
    return abs(v) + abs(force_rate) * branch.drift + abs(a) * branch.slowness


@inlined
def crest(start, start_rise, end, end_rise, fourth):
    """Bound on a magnitude over a step, from values and rises (slope times step) at both ends."""
    inside = max(abs(start + start_rise / 3.0), abs(end - end_rise / 3.0))
    return max(max(abs(start), abs(end)), inside + fourth / 288.0)


@inner
def velocity_series(c, n, h, out):
    """Series of velocity from the series c of displacement."""
    for k in range(n):
        out[k] = (k + 1) * c[k + 1] / h
    out[n] = 0.0
