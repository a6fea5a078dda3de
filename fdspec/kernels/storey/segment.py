"""A segment of motion judged by its ends, without a series, and the viscous work on it."""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner
from fdspec.kernels.mathematics.oscillator import advance, area, expand, square_integral
from fdspec.kernels.mathematics.quadrature import SHORT, series_square, short_square
from fdspec.kernels.mathematics.zero_crossing import CROSSES, UNCLEAR
from fdspec.kernels.storey.constants import has_closed_form
from fdspec.kernels.storey.energy import BRACE_FORM, FLOOR_FORM, STICK_FORM, loss_at
from fdspec.kernels.storey.slip import locate_stop, slip_ahead, slip_verdict
from fdspec.kernels.storey.stick import locate_slip, stick_ahead, stick_verdict
from fdspec.kernels.types import STICK, Motion


@inner
def whole_loss(plan, forms, phase, motion, force):
    """Viscous work (J) on a whole segment."""
    storey = plan.storey
    if phase == STICK:
        return (storey.floor_damping + storey.brace_damping) * square_integral(
            loss_at(forms, STICK_FORM), motion.u, motion.v, force.p0, force.p1
        )
    lost = storey.floor_damping * square_integral(
        loss_at(forms, FLOOR_FORM), motion.u, motion.v, force.p0, force.p1
    )
    if storey.brace_damping > 0.0:
        lost += storey.brace_damping * square_integral(
            loss_at(forms, BRACE_FORM), motion.d, motion.e, force.b0, force.b1
        )
    return lost


@inner
def part_loss(plan, phase, floor, motion, force, h):
    """Viscous work (J) on a part of a segment; while slipping the brace has no damping, see `at_once`."""
    b = plan.stick
    order = int(plan.stick_order)
    damping = plan.storey.floor_damping + plan.storey.brace_damping
    if phase != STICK:
        b = plan.floor
        order = int(plan.floor_order)
        damping = plan.storey.floor_damping
    if h == 0.0:
        return 0.0
    expand(floor, order, motion.u, motion.v, b.g, b.w2, force.p0, force.p1, h)
    if b.rate * h <= SHORT:
        return damping * short_square(floor, order, h)
    return damping * series_square(floor, order, h, 1.0)


@inlined
def at_once(plan, phase, whole, motion, force, offset, onset, h):
    """What the ends of a segment of length h tell of it.

    Returns the verdict (see `mathematics/zero_crossing.py`); the phase that follows where it crosses; how
    far the segment then reaches, s; the motion there; the integrals of both displacements until there.
    """
    swung = 0.0
    if phase == STICK:
        if whole:
            u, v = advance(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
            end = Motion(u, v, u - offset, v)
            swept = area(plan.stick_map, motion.u, motion.v, force.p0, force.p1)
        else:
            end, swept = stick_ahead(plan, motion, force, offset, h)
        found, side, near, until = stick_verdict(plan, motion, end, force, offset, h)
        if found == CROSSES:
            h, end, swept = locate_slip(plan, motion, force, offset, side, near, until)
        return found if h >= 0.0 else UNCLEAR, side, h, end, swept, swung
    closed = has_closed_form(plan)
    if whole:
        u, v = advance(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
        d, e = advance(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
        end = Motion(u, v, d, e)
        swept = area(plan.floor_map, motion.u, motion.v, force.p0, force.p1)
        swung = area(plan.brace_map, motion.d, motion.e, force.b0, force.b1)
    elif closed:
        end, swept, swung = slip_ahead(plan, motion, force, h)
    else:
        return UNCLEAR, phase, h, motion, 0.0, 0.0
    found, near, until = slip_verdict(plan, motion, end, force, phase, onset, h)
    if found == CROSSES:
        if not closed:
            return UNCLEAR, phase, h, end, swept, swung
        h, end, swept, swung = locate_stop(plan, motion, force, phase, near, until)
    return found if h >= 0.0 else UNCLEAR, phase, h, end, swept, swung
