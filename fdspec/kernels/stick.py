"""The stick phase: floor and brace as one oscillator, until the reaction reaches the slip force.

Study, equations (2) to (4).
"""

from __future__ import annotations

from fdspec.jit import inlined, inner
from fdspec.kernels.bounds import floor_fourths, floor_peaks, relative_acceleration
from fdspec.kernels.roots import NO_ROOT, clears, first_root
from fdspec.kernels.types import STICK


@inlined
def held_force(plan, u, v, offset):
    """Reaction (N) of the sticking damper."""
    return plan.hold_u * u + plan.hold_v * v - plan.hold_offset * offset


@inlined
def stick_is_quiet(plan, start, end, force, offset, h):
    """Whether the reaction surely stays within the slip force on the piece."""
    limit = plan.storey.slip_force
    r0 = held_force(plan, start.u, start.v, offset)
    r1 = held_force(plan, end.u, end.v, offset)
    a0 = relative_acceleration(plan.stick, start.u, start.v, force.p0)
    a1 = relative_acceleration(plan.stick, end.u, end.v, force.p0 + force.p1 * h)
    rise0 = h * (plan.hold_u * start.v + plan.hold_v * a0)
    rise1 = h * (plan.hold_u * end.v + plan.hold_v * a1)
    fourth_u, fourth_v = floor_fourths(plan.stick, start.v, a0, force.p1, h)
    fourth = abs(plan.hold_u) * fourth_u + abs(plan.hold_v) * fourth_v
    return clears(limit - r0, -rise0, limit - r1, -rise1, fourth) and clears(
        limit + r0, rise0, limit + r1, rise1, fourth
    )


@inner
def search_stick(plan, floor, gap, n, h, offset, touching):
    """Fraction of the expanded piece at which the reaction reaches the slip force, and its sign.

    ``touching`` is the sign of a reaction that stands at the slip force when the piece begins (a
    massless brace that has just stopped), else 0.
    """
    limit = plan.storey.slip_force
    best = NO_ROOT
    sign = STICK
    pace = 1.0 / h
    for side in (1, -1):
        for k in range(n):
            gap[k] = -side * (plan.hold_u * floor[k] + plan.hold_v * (k + 1) * floor[k + 1] * pace)
        gap[n] = 0.0
        gap[0] = 0.0 if side == touching else gap[0] + limit + side * plan.hold_offset * offset
        x = first_root(gap, 0, n, 1.0)
        if x < best:
            best = x
            sign = side
    return best, sign


@inlined
def stick_peaks(plan, floor, search, n, share, start, end, force, offset, h, peaks):
    """Peaks over a stick piece; base shear is the inertia of floor and brace as one."""
    return floor_peaks(
        plan.stick, plan.lift * offset, plan.mass, floor, search, n, share, start, end, force, h, peaks
    )
