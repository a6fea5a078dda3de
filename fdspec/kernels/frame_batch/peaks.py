"""Peaks of eight frames' continuous motion: bounds tell which may be new, and those are searched.

Between two instants a quantity leaves the larger of its two values by at most an eighth of its largest
second derivative; accelerations leave that at the start by at most their reach.
"""

from __future__ import annotations

from fdspec.jit import inner, wide
from fdspec.kernels.frame_batch.eight import WIDTH, above, abs8, fma8, load, max8, splat
from fdspec.kernels.frame_batch.layout import (
    END,
    FRACTION,
    GROUND,
    INERTIA,
    INERTIA_REACH,
    JERK_REACH,
    LENGTH,
    LOOSE_MASS,
    MASS,
    PEAK,
    REACH,
    RISE,
    SECOND,
    SECOND_REACH,
    SLIDES,
    START,
    row,
    term,
)
from fdspec.kernels.frame_batch.advance import ONCE, TWICE
from fdspec.kernels.frame_peaks import (
    PEAK_ACCELERATION,
    PEAK_BRACE_DISPLACEMENT,
    PEAK_DISPLACEMENT,
    PEAK_DRIFT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
)
from fdspec.kernels.roots import largest_magnitude
from fdspec.kernels.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY


@inner
def raise_peaks(p, at, size, lanes, orders, c):
    """Raise the peaks of these lanes to those of what is taken of their steps.

    orders (WIDTH,): terms of each lane's series; c: room for a series.
    """
    wide()
    h = load(p, LENGTH * WIDTH)
    rise = abs8(load(p, RISE * WIDTH))
    strongest = abs8(load(p, GROUND * WIDTH)) + rise
    eighth = splat(0.125) * h * h
    shear = splat(0.0)
    shear_reach = splat(0.0)
    for i in range(size - 1, -1, -1):
        inertia = load(p, term(at, INERTIA, i, 0))
        second = load(p, term(at, SECOND, i, 0)) * load(p, row(SLIDES, i))
        second_reach = load(p, row(REACH + SECOND_REACH, i)) * load(p, row(SLIDES, i))
        swing = load(p, row(REACH + INERTIA_REACH, i))
        jerk = load(p, row(REACH + JERK_REACH, i))
        u0 = load(p, row(START + DISPLACEMENT, i))
        u1 = load(p, row(END + DISPLACEMENT, i))
        v0 = load(p, row(START + VELOCITY, i))
        v1 = load(p, row(END + VELOCITY, i))
        b0 = u0 - load(p, row(START + OFFSET, i))
        b1 = u1 - load(p, row(END + OFFSET, i))
        pull = abs8(inertia) + swing
        velocity = fma8(splat(0.125) * h, jerk + rise, max8(abs8(v0), abs8(v1)))
        displacement = fma8(eighth, pull + strongest, max8(abs8(u0), abs8(u1)))
        below = strongest
        g0 = u0
        g1 = u1
        if i > 0:
            g0 = u0 - load(p, row(START + DISPLACEMENT, i - 1))
            g1 = u1 - load(p, row(END + DISPLACEMENT, i - 1))
            below = abs8(load(p, term(at, INERTIA, i - 1, 0))) + load(p, row(REACH + INERTIA_REACH, i - 1))
        drift = fma8(eighth, pull + below, max8(abs8(g0), abs8(g1)))
        brace = max8(abs8(b0), abs8(b1))
        brace = fma8(eighth, pull + strongest + second_reach + abs8(second), brace)
        # The storey shear carries the inertia of all masses above: that of floor and brace, less what
        # the brace's acceleration falls short of the floor's.
        mass = load(p, row(MASS, i))
        loose = load(p, row(LOOSE_MASS, i))
        shear = fma8(mass, inertia, shear) - loose * second
        shear_reach = fma8(mass, swing, shear_reach) + loose * second_reach
        of_acceleration = lanes & above(pull, load(p, row(PEAK + PEAK_ACCELERATION, i)))
        of_velocity = lanes & above(velocity, load(p, row(PEAK + PEAK_VELOCITY, i)))
        of_displacement = lanes & above(displacement, load(p, row(PEAK + PEAK_DISPLACEMENT, i)))
        of_drift = lanes & above(drift, load(p, row(PEAK + PEAK_DRIFT, i)))
        of_brace = lanes & above(brace, load(p, row(PEAK + PEAK_BRACE_DISPLACEMENT, i)))
        of_shear = lanes & above(abs8(shear) + shear_reach, load(p, row(PEAK + PEAK_SHEAR, i)))
        found = of_acceleration | of_velocity | of_displacement | of_drift | of_brace | of_shear
        lane = 0
        while found != 0:
            if found & 1:
                n = orders[lane]
                x = p[FRACTION * WIDTH + lane]
                if of_acceleration >> lane & 1:
                    take_acceleration(p, at, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_ACCELERATION, i) + lane, c, n - 1)
                if of_velocity >> lane & 1:
                    take_velocity(p, at, size, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_VELOCITY, i) + lane, c, n)
                if of_displacement >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, size, i, lane, n, x, 1.0, c)
                    raise_peak(p, row(PEAK + PEAK_DISPLACEMENT, i) + lane, c, n + 1)
                if of_drift >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, size, i, lane, n, x, 1.0, c)
                    if i > 0:
                        add_displacement(p, at, size, i - 1, lane, n, x, -1.0, c)
                    raise_peak(p, row(PEAK + PEAK_DRIFT, i) + lane, c, n + 1)
                if of_brace >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, size, i, lane, n, x, 1.0, c)
                    take_off_offset(p, at, size, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_BRACE_DISPLACEMENT, i) + lane, c, n + 1)
                if of_shear >> lane & 1:
                    take_shear(p, at, size, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_SHEAR, i) + lane, c, n - 1)
            lane += 1
            found >>= 1


@inner
def raise_peak(p, place, c, n):
    """Raise one peak to the largest magnitude of a series of order n."""
    p[place] = largest_magnitude(c, n, p[place])


@inner
def clear(c, n):
    """Set a series of order n to zero."""
    for k in range(n + 1):
        c[k] = 0.0


@inner
def take_acceleration(p, at, i, lane, n, x, c):
    """Absolute acceleration of floor i, as a series of the first part x of the step."""
    power = 1.0
    for k in range(n):
        c[k] = p[term(at, INERTIA, i, k) + lane] * power
        power *= x


@inner
def relative(p, at, i, lane, k):
    """Coefficient k of the floor's acceleration relative to the ground."""
    rate = p[term(at, INERTIA, i, k) + lane]
    if k == 0:
        rate -= p[GROUND * WIDTH + lane]
    elif k == 1:
        rate -= p[RISE * WIDTH + lane]
    return rate


@inner
def take_velocity(p, at, size, i, lane, n, x, c):
    """Velocity of floor i, as above."""
    power = p[LENGTH * WIDTH + lane] * x
    c[0] = p[row(START + VELOCITY, i) + lane]
    for k in range(n):
        c[k + 1] = relative(p, at, i, lane, k) * (power * ONCE[k])
        power *= x


@inner
def add_displacement(p, at, size, i, lane, n, x, sign, c):
    """Add the displacement of floor i, times sign, to a series as above."""
    step = p[LENGTH * WIDTH + lane] * x
    c[0] += sign * p[row(START + DISPLACEMENT, i) + lane]
    c[1] += sign * p[row(START + VELOCITY, i) + lane] * step
    power = sign * step * step
    for k in range(n):
        c[k + 2] += relative(p, at, i, lane, k) * (power * TWICE[k])
        power *= x


@inner
def take_off_offset(p, at, size, i, lane, n, x, c):
    """Take the slip offset of storey i off a series as above."""
    step = p[LENGTH * WIDTH + lane] * x
    c[0] -= p[row(START + OFFSET, i) + lane]
    if p[row(SLIDES, i) + lane] == 0.0:
        return
    c[1] -= p[row(START + SLIDING, i) + lane] * step
    power = step * step
    for k in range(n):
        c[k + 2] -= p[term(at, SECOND, i, k) + lane] * (power * TWICE[k])
        power *= x


@inner
def take_shear(p, at, size, storey, lane, n, x, c):
    """Shear in frame and brace of a storey, N, as above."""
    clear(c, n - 1)
    for i in range(size - 1, storey - 1, -1):
        mass = p[row(MASS, i) + lane]
        loose = p[row(LOOSE_MASS, i) + lane]
        power = 1.0
        for k in range(n):
            thrust = mass * p[term(at, INERTIA, i, k) + lane] - loose * p[term(at, SECOND, i, k) + lane]
            c[k] -= thrust * power
            power *= x
