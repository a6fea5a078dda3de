"""Strain energy of single-storey histories: its area under the history and its maximum.

The energy is that of Filiatrault and Cherry's index, elastic and in every member, columns and brace alike:
U = k_f u^2 / 2 + k_d d^2 / 2.  Each step is taken as ever; between the changes of phase found on it the
motion is then gone through once more.  Over a whole segment the integral of U is a quadratic form of the
state at its start, worked out once; over any other segment U is a polynomial, integrated term by term.  A
maximum is looked for only where bounds on both displacements leave room for one.
"""

from __future__ import annotations

from typing import Final

from fdspec.compiler.options import inner
from fdspec.compiler.positions import positions
from fdspec.kernels.mathematics.oscillator import TERMS, advance, area, expand, square_integral
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude, value_slope
from fdspec.kernels.mathematics.quadrature import series_area, square_form
from fdspec.kernels.storey.bounds import floor_fourths, forcing, magnitude_bound, relative_acceleration
from fdspec.kernels.storey.constants import plan, steps_per_sample
from fdspec.kernels.storey.energy import loss_at
from fdspec.kernels.storey.slip import brace_fourths
from fdspec.kernels.storey.state import motion_of
from fdspec.kernels.storey.step import begin, begin_slip, take_step
from fdspec.kernels.types import N_STATE, OK, STATE, STICK, Motion

STRAIN_RESULTS: Final = ("strain_energy_area", "peak_strain_energy", "status")
"""What a history leaves behind, in the order of its result row: J s, J, a status code."""
STRAIN = positions(STRAIN_RESULTS)

ORDER: Final = TERMS - 2
"""Order of the series of U: its phase is twice that of the motion, 2 rad at most."""

N_SQUARES: Final = 30
"""Room for the quadratic forms of the integral of a displacement squared: of a whole segment of stick, then
of the floor and of the brace over one of slip."""


@inner
def put_squares(scheme, squares):
    """Work out the three forms of a plan."""
    stick, floor, brace = scheme.stick, scheme.floor, scheme.brace
    forms = (
        square_form(stick.g, stick.w2, scheme.step, False),
        square_form(floor.g, floor.w2, scheme.slip_step, False),
        square_form(brace.g, brace.w2, scheme.slip_step, False),
    )
    for j in range(3):
        for k in range(10):
            squares[10 * j + k] = forms[j][k]


@inner
def strain(storey, u, d):
    """Elastic energy (J) of columns and brace."""
    return 0.5 * (storey.floor_stiffness * u * u + storey.brace_stiffness * d * d)


@inner
def expand_both(scheme, phase, offset, motion, force, h, floor, brace):
    """Make floor and brace the series of both displacements on a segment of length h."""
    b = scheme.stick if phase == STICK else scheme.floor
    expand(floor, ORDER, motion.u, motion.v, b.g, b.w2, force.p0, force.p1, h)
    if phase == STICK:
        for k in range(ORDER + 1):
            brace[k] = floor[k]
        brace[0] = motion.u - offset
    else:
        b = scheme.brace
        expand(brace, ORDER, motion.d, motion.e, b.g, b.w2, force.b0, force.b1, h)


@inner
def strain_series(storey, floor, brace, out):
    """Make out the series of U from those of both displacements."""
    for k in range(ORDER + 1):
        columns = 0.0
        braces = 0.0
        for j in range(k + 1):
            columns += floor[j] * floor[k - j]
            braces += brace[j] * brace[k - j]
        out[k] = 0.5 * (storey.floor_stiffness * columns + storey.brace_stiffness * braces)


@inner
def whole_segment(scheme, squares, phase, offset, motion, force, floor, brace, out, most):
    """Take a whole segment; return its end, the integral of U and the greater of its maximum and ``most``."""
    storey = scheme.storey
    kf, kd = storey.floor_stiffness, storey.brace_stiffness
    if phase == STICK:
        h = scheme.step
        b = scheme.stick
        u, v = advance(scheme.stick_map, motion.u, motion.v, force.p0, force.p1)
        end = Motion(u, v, u - offset, v)
        square = square_integral(loss_at(squares, 0), motion.u, motion.v, force.p0, force.p1)
        swept = area(scheme.stick_map, motion.u, motion.v, force.p0, force.p1)
        total = 0.5 * (kf + kd) * square - kd * offset * swept + 0.5 * kd * offset * offset * h
        a0 = relative_acceleration(b, motion.u, motion.v, force.p0)
        fourth_u, _ = floor_fourths(b, motion.v, a0, force.p1, h)
        fourth_d = fourth_u
    else:
        h = scheme.slip_step
        b = scheme.floor
        u, v = advance(scheme.floor_map, motion.u, motion.v, force.p0, force.p1)
        d, e = advance(scheme.brace_map, motion.d, motion.e, force.b0, force.b1)
        end = Motion(u, v, d, e)
        columns = square_integral(loss_at(squares, 10), motion.u, motion.v, force.p0, force.p1)
        braces = square_integral(loss_at(squares, 20), motion.d, motion.e, force.b0, force.b1)
        total = 0.5 * (kf * columns + kd * braces)
        a0 = relative_acceleration(b, motion.u, motion.v, force.p0)
        fourth_u, _ = floor_fourths(b, motion.v, a0, force.p1, h)
        b0 = relative_acceleration(scheme.brace, motion.d, motion.e, force.b0)
        fourth_d, _ = brace_fourths(scheme, motion, b0, force, h)
    most = max(most, strain(storey, end.u, end.d))
    reach_u = magnitude_bound(motion.u, h * motion.v, end.u, h * end.v, fourth_u)
    reach_d = magnitude_bound(motion.d, h * motion.e, end.d, h * end.e, fourth_d)
    if strain(storey, reach_u, reach_d) > most:
        expand_both(scheme, phase, offset, motion, force, h, floor, brace)
        strain_series(storey, floor, brace, out)
        most = largest_magnitude(out, ORDER, most)
    return end, total, most


@inner
def part_of_segment(scheme, phase, offset, motion, force, h, floor, brace, out, most):
    """Take a segment of any length h up to a whole one; return what :func:`whole_segment` does."""
    expand_both(scheme, phase, offset, motion, force, h, floor, brace)
    strain_series(scheme.storey, floor, brace, out)
    u, rise = value_slope(floor, 0, ORDER, 1.0)
    d, swing = value_slope(brace, 0, ORDER, 1.0)
    end = Motion(u, rise / h, d, swing / h)
    return end, series_area(out, ORDER, h, 1.0), largest_magnitude(out, ORDER, most)


@inner
def strain_of_phase(
    scheme, squares, phase, offset, motion, a0, rate, start, until, floor, brace, out, total, most
):
    """Go through the motion from ``start`` to ``until``, times within a step, in one phase.

    Returns the motion there, the integral of U so far and its maximum so far.
    """
    whole = scheme.step if phase == STICK else scheme.slip_step
    tau = start
    while tau < until:
        force = forcing(scheme, phase, offset, a0 + rate * tau, rate)
        h = until - tau
        if h >= whole:
            motion, done, most = whole_segment(
                scheme, squares, phase, offset, motion, force, floor, brace, out, most
            )
            tau += whole
        else:
            motion, done, most = part_of_segment(
                scheme, phase, offset, motion, force, h, floor, brace, out, most
            )
            tau = until
        total += done
    return motion, total, most


@inner
def strain_of_history(
    storey,
    ground,
    dt,
    radians,
    times,
    phases,
    no_traces,
    no_forms,
    squares,
    start,
    s,
    floor,
    brace,
    out,
    result,
):
    """Integrate one history from rest and fill ``result`` (see STRAIN_RESULTS).

    times, phases: room for the changes of phase on one step.  start, s: room for the state (N_STATE,)
    before and after a step; floor, brace, out: room for series, (TERMS,).  Returns how many changes the
    busiest step has; where that is more than there is room for, the result does not count.
    """
    parts = steps_per_sample(storey, dt, radians)
    scheme = plan(storey, dt / parts, radians)
    put_squares(scheme, squares)
    spring_only = storey.brace_mass == 0.0 and storey.brace_damping == 0.0
    begin(scheme, Motion(0.0, 0.0, 0.0, 0.0), s)
    total = 0.0
    most = 0.0
    busiest = 0
    for i in range(ground.size - 1):
        rate = (ground[i + 1] - ground[i]) / dt
        for j in range(parts):
            a0 = ground[i] + rate * (j * scheme.step)
            for k in range(N_STATE):
                start[k] = s[k]
            s[STATE.transitions] = 0.0
            take_step(
                scheme,
                no_forms,
                s,
                0.0,
                a0,
                rate,
                False,
                True,
                True,
                floor,
                brace,
                out,
                times,
                phases,
                no_traces,
                0.0,
                0,
                0.0,
            )
            changes = int(s[STATE.transitions])
            busiest = max(busiest, changes)
            if changes > times.size:
                return busiest
            motion = motion_of(start)
            phase = int(start[STATE.phase])
            offset = start[STATE.offset]
            tau = 0.0
            for k in range(changes + 1):
                until = times[k] if k < changes else scheme.step
                motion, total, most = strain_of_phase(
                    scheme,
                    squares,
                    phase,
                    offset,
                    motion,
                    a0,
                    rate,
                    tau,
                    until,
                    floor,
                    brace,
                    out,
                    total,
                    most,
                )
                tau = until
                if k == changes:
                    break
                if phase == STICK:
                    motion, _ = begin_slip(storey, phases[k], motion, storey.slip_force)
                    most = max(most, strain(storey, motion.u, motion.d))
                else:
                    v = 0.0 if spring_only else motion.v
                    motion = Motion(motion.u, v, motion.d, v)
                    offset = motion.u - motion.d
                phase = int(phases[k])
            if s[STATE.status] != OK:
                break
        if s[STATE.status] != OK:
            break
    result[STRAIN.strain_energy_area] = total
    result[STRAIN.peak_strain_energy] = most
    result[STRAIN.status] = s[STATE.status]
    return busiest
