"""Energy of a single-storey history: each term by its own formula, none as what the others leave."""

from __future__ import annotations

from typing import Final

from fdspec.compiler.options import fma, inlined, inner
from fdspec.kernels.mathematics.oscillator import SquareForm
from fdspec.kernels.mathematics.polynomial_roots import value_slope
from fdspec.kernels.mathematics.quadrature import series_area, series_square, square_form
from fdspec.kernels.types import STICK

STICK_FORM: Final = 0
FLOOR_FORM: Final = 10
BRACE_FORM: Final = 20
STRIDE_FORM: Final = 30
N_FORMS: Final = 40
"""Places of the quadratic forms of the viscous work: over a whole segment of stick; over one of slip, of
floor and brace; of the floor over a whole step of slip."""


@inlined
def loss_at(forms, at):
    """Take a quadratic form from its place."""
    return SquareForm(
        forms[at],
        forms[at + 1],
        forms[at + 2],
        forms[at + 3],
        forms[at + 4],
        forms[at + 5],
        forms[at + 6],
        forms[at + 7],
        forms[at + 8],
        forms[at + 9],
    )


@inner
def put_losses(plan, forms):
    """Work out the viscous forms of a plan."""
    stick, floor, brace = plan.stick, plan.floor, plan.brace
    at = (STICK_FORM, FLOOR_FORM, BRACE_FORM, STRIDE_FORM)
    loss = (
        square_form(stick.g, stick.w2, plan.step, True),
        square_form(floor.g, floor.w2, plan.slip_step, True),
        square_form(brace.g, brace.w2, plan.slip_step, True),
        square_form(floor.g, floor.w2, plan.step, True),
    )
    for j in range(4):
        for k in range(10):
            forms[at[j] + k] = loss[j][k]


@inlined
def input_work(plan, phase, start, end, floor_area, brace_area, acceleration, rate, h):
    """Work of the ground on a segment: minus the integral of (m_f u' + m_d d') a_g, by parts."""
    floor = fma(acceleration, end.u - start.u, rate * fma(h, end.u, -floor_area))
    if phase == STICK:
        return -plan.mass * floor
    brace = fma(acceleration, end.d - start.d, rate * fma(h, end.d, -brace_area))
    return fma(-plan.storey.floor_mass, floor, -plan.storey.brace_mass * brace)


@inner
def series_work(plan, phase, floor, brace, n, acceleration, rate, h, x, viscous):
    """Input and viscous work over the first part x of an expanded segment."""
    storey = plan.storey
    start = floor[0]
    end, _ = value_slope(floor, 0, n, x)
    part = x * h
    moved = acceleration * (end - start) + rate * (part * end - series_area(floor, n, h, x))
    if phase == STICK:
        damping = storey.floor_damping + storey.brace_damping
        return -plan.mass * moved, damping * series_square(floor, n, h, x) if viscous else 0.0
    end, _ = value_slope(brace, 0, n, x)
    swung = acceleration * (end - brace[0]) + rate * (part * end - series_area(brace, n, h, x))
    lost = 0.0
    if viscous:
        lost = storey.floor_damping * series_square(floor, n, h, x)
        if storey.brace_damping > 0.0:
            lost += storey.brace_damping * series_square(brace, n, h, x)
    return -storey.floor_mass * moved - storey.brace_mass * swung, lost


@inner
def stored_energy(storey, motion):
    """Kinetic and strain energy, J."""
    return 0.5 * (
        storey.floor_mass * motion.v * motion.v
        + storey.brace_mass * motion.e * motion.e
        + storey.floor_stiffness * motion.u * motion.u
        + storey.brace_stiffness * motion.d * motion.d
    )
