"""One history of the bilinear oscillator, event by event.

Per unit mass, with p the plastic offset and alpha the hardening ratio:

    u'' + c u' + alpha k u + q = -a        q = (1 - alpha) k (u - p),   |u - p| <= u_y = f_y / k

Guards: |u - p| reaches u_y while elastic; the velocity returns to zero while yielding.  Resets: none of
the state; yielding drags p along, p = u - s u_y.  A step on which bounds on its ends show that nothing
happens is one product with constants; any other is expanded, searched and ended at its first event.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.bilinear.mode import (
    INTEGRAL_ROW,
    U_ROW,
    V_ROW,
    expand,
    reach,
    row_times,
    slope_at,
    squared_velocity,
    sum_at,
)
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, first_root, largest_magnitude
from fdspec.kernels.mathematics.quadrature import series_area, series_square
from fdspec.kernels.storey.bounds import magnitude_bound

RESULTS = (
    "peak_displacement",
    "peak_acceleration",
    "residual_displacement",
    "plastic_travel",
    "hysteretic_energy",
    "input_energy",
    "energy_error",
    "transitions",
    "status",
)
"""Columns of ``out``: m, m/s2, m, m, J/kg, J/kg, 1, 1, 1."""

OK = 0
COLLAPSED = 1
STILL_MOVING = 2
NON_FINITE = 3
STATUSES = ("ok", "collapsed", "still_moving", "non_finite_state")
"""Name of each status, in the order of the codes."""

FREE_PERIODS = 1000.0
"""Periods after the record's end in which the oscillator must have stopped yielding."""

SAME_PLACE = 1e-12
"""Share of the yield displacement that no yielding is worth waiting for."""

EVENTS_AT_ONE_INSTANT = 4
"""Changes without progress after which an event of rounding is passed over."""

ELASTIC = 0
"""Mode; +1 and -1 is yielding in that direction."""


@inner
def guard_root(mode, alike, series, n, p, limit, touching, c):
    """Fraction of the expanded step at which the mode ends, and the mode that follows.

    touching: the direction in which the spring stands at its limit, whose distance then begins at zero;
    alike: changes made at this instant; c (TERMS,): room.
    """
    if mode != ELASTIC:
        for j in range(n - 1):
            c[j] = (j + 1) * series[j + 1]
        if alike > EVENTS_AT_ONE_INSTANT:
            c[0] = 0.0
            c[1] = 0.0
        return first_root(c, 0, n - 2, float(mode)), ELASTIC
    first = NO_ROOT
    toward = ELASTIC
    for sign in (1, -1):
        room = limit - sign * (series[0] - p)
        for j in range(1, n):
            c[j] = -sign * series[j]
        c[0] = 0.0 if sign == touching or room < 0.0 else room
        if alike > EVENTS_AT_ONE_INSTANT and sign == touching:
            c[1] = 0.0
            c[2] = 0.0
        x = first_root(c, 0, n - 1, 1.0)
        if x < first:
            first = x
            toward = sign
    return first, toward


@inner
def raise_peaks(c, k, b, h, series, n, done, coefficients, displacement, acceleration):
    """Peaks of |u| and |u'' + a| over the first ``done`` of an expanded step; coefficients: room."""
    power = 1.0
    for j in range(n):
        coefficients[j] = series[j] * power
        power *= done
    displacement = largest_magnitude(coefficients, n - 1, displacement)
    power = 1.0
    for j in range(n):
        rise = (j + 1) * series[j + 1] / h if j + 1 < n else 0.0
        coefficients[j] = -(c * rise + k * series[j]) * power
        power *= done
    coefficients[0] += b
    acceleration = largest_magnitude(coefficients, n - 2, acceleration)
    return displacement, acceleration


@inner
def may_turn(c, k, h, u, v, w, y, u1, v1, w1, y1, third, fourth, displacement, acceleration):
    """Whether |u| or |u'' + a| = |y| may pass its peak between the ends of a step.

    v, w: u' and u''; third, fourth: bounds on the derivatives of u.
    """
    power = h * h * h * h
    if magnitude_bound(u, h * v, u1, h * v1, power * fourth) > displacement:
        return True
    fifth = c * fourth + abs(k) * third
    rise, rise1 = -h * (c * w + k * v), -h * (c * w1 + k * v1)
    return magnitude_bound(y, rise, y1, rise1, power * (c * fifth + abs(k) * fourth)) > acceleration


@inner
def history(
    ground,
    dt,
    parts,
    c,
    k,
    alpha,
    strength,
    collapse,
    certify,
    rest,
    elastic,
    hardening,
    n,
    series,
    room,
    out,
):
    """Integrate one history; strength: f_y per unit mass, m/s2; collapse: |u| at which it is called, m.

    elastic, hardening: constants of whole steps, dt/parts long; n: coefficients of their series.  rest: go on
    after the record until nothing can yield and no larger displacement can come.  series, room: (TERMS,).
    """
    h = dt / parts
    share = 1.0 / parts
    pace = 1.0 / h
    limit = strength / k
    force = (1.0 - alpha) * strength
    soft = alpha * k
    u = 0.0
    v = 0.0
    p = 0.0
    mode = ELASTIC
    touching = ELASTIC
    displacement = 0.0
    acceleration = 0.0
    travel = 0.0
    work = 0.0
    viscous = 0.0
    scale = 0.0
    events = 0
    status = OK
    eighth = h * h / 8.0
    steps = (ground.size - 1) * parts
    most = steps + (int(math.ceil(FREE_PERIODS * 2.0 * math.pi / (math.sqrt(k) * h))) if rest else 0)
    resting = 0
    sample = 0
    part = 0
    step = 0
    while step < most:
        if step < steps:
            rise = (ground[sample + 1] - ground[sample]) * share
            a0 = ground[sample] + rise * part
            part += 1
            if part == parts:
                sample += 1
                part = 0
        else:
            a0 = 0.0
            rise = 0.0
            if mode == ELASTIC:
                home = (1.0 - alpha) * p
                swing = math.sqrt((u - home) * (u - home) + v * v / k)
                if abs(home - p) + swing <= limit * (1.0 + SAME_PLACE):
                    resting += 1
                    if abs(home) + swing <= displacement or resting * h > 2.0 * math.pi / math.sqrt(k) + h:
                        break
                else:
                    resting = 0
        step += 1
        stiff = k if mode == ELASTIC else soft
        b = (1.0 - alpha) * k * p if mode == ELASTIC else -mode * force
        constants = elastic if mode == ELASTIC else hardening
        e0 = a0 - b
        e1 = e0 + rise
        u1 = row_times(constants, U_ROW, u, v, e0, e1)
        v1 = row_times(constants, V_ROW, u, v, e0, e1)
        w0 = -e0 - c * v - stiff * u
        w1 = -e1 - c * v1 - stiff * u1
        second, third = reach(c, stiff, constants, v, w0, v1, w1, rise * pace)
        bow = eighth * second
        if mode == ELASTIC:
            clear = max(abs(u - p), abs(u1 - p)) + bow < limit
        else:
            clear = min(mode * v, mode * v1) - eighth * third > 0.0
        if clear:
            y0 = w0 + a0
            y1 = w1 + a0 + rise
            displacement = max(displacement, abs(u1))
            acceleration = max(acceleration, abs(y1))
            fourth = c * third + abs(stiff) * second
            near = max(abs(u), abs(u1)) + bow > displacement
            near = near or max(abs(y0), abs(y1)) + eighth * fourth > acceleration
            if near and may_turn(
                c, stiff, h, u, v, w0, y0, u1, v1, w1, y1, third, fourth, displacement, acceleration
            ):
                expand(c, stiff, h, u, v, e0, rise, series, n)
                displacement, acceleration = raise_peaks(
                    c, stiff, b, h, series, n, 1.0, room, displacement, acceleration
                )
            if certify:
                area = row_times(constants, INTEGRAL_ROW, u, v, e0, e1)
                work += a0 * u - (a0 + rise) * u1 + rise * pace * area
                viscous += c * squared_velocity(constants, u, v, e0, e1)
            if mode != ELASTIC:
                travel += mode * (u1 - u)
                p = u1 - mode * limit
            u = u1
            v = v1
        else:
            x = 0.0
            alike = 0
            while x < 1.0:
                left = 1.0 - x
                stiff = k if mode == ELASTIC else soft
                b = (1.0 - alpha) * k * p if mode == ELASTIC else -mode * force
                start = a0 + rise * x
                expand(c, stiff, h * left, u, v, start - b, rise * left, series, n)
                root, after = guard_root(mode, alike, series, n, p, limit, touching, room)
                done = min(root, 1.0)
                u1 = sum_at(series, n, done)
                v1 = slope_at(series, n, done) / (h * left)
                span = h * left * done
                w0 = b - start - c * v - stiff * u
                w1 = b - start - rise * left * done - c * v1 - stiff * u1
                y0 = w0 + start
                y1 = w1 + start + rise * left * done
                displacement = max(displacement, abs(u1))
                acceleration = max(acceleration, abs(y1))
                constants = elastic if mode == ELASTIC else hardening
                second, third = reach(c, stiff, constants, v, w0, v1, w1, rise * pace)
                fourth = c * third + abs(stiff) * second
                if may_turn(
                    c, stiff, span, u, v, w0, y0, u1, v1, w1, y1, third, fourth, displacement, acceleration
                ):
                    displacement, acceleration = raise_peaks(
                        c, stiff, b, h * left, series, n, done, room, displacement, acceleration
                    )
                if certify and done > 0.0:
                    area = series_area(series, n - 1, h * left, done)
                    work += start * u - (start + rise * left * done) * u1 + rise * pace * area
                    viscous += c * series_square(series, n - 1, h * left, done)
                if mode != ELASTIC:
                    travel += mode * (u1 - u)
                    p = u1 - mode * limit
                u = u1
                v = v1
                alike = 0 if done > 0.0 else alike + 1
                touching = ELASTIC
                if root > 1.0:
                    break
                events += 1
                if mode != ELASTIC:
                    touching = mode
                    v = 0.0
                mode = after
                x += done * left
                if 1.0 - x < SAME_PLACE:
                    break
        if certify:
            stored = 0.5 * (v * v + alpha * k * u * u + (1.0 - alpha) * k * (u - p) * (u - p))
            scale = max(scale, abs(work), stored)
        if abs(u) >= collapse:
            status = COLLAPSED
            break
    if step == most and rest:
        status = STILL_MOVING
    hysteretic = force * travel
    if not math.isfinite(u + v + travel):
        status = NON_FINITE
    error = 0.0
    if certify and scale > 0.0:
        stored = 0.5 * (v * v + alpha * k * u * u + (1.0 - alpha) * k * (u - p) * (u - p))
        error = abs(work - stored - viscous - hysteretic) / max(scale, viscous + hysteretic)
    out[0] = displacement
    out[1] = acceleration
    out[2] = (1.0 - alpha) * p if rest else u
    out[3] = travel
    out[4] = hysteretic
    out[5] = work
    out[6] = error
    out[7] = events
    out[8] = status
