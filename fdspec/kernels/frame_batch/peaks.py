"""Peaks of eight frames' continuous motion: bounds tell which may be new, and those are searched.

Between two instants a quantity leaves the larger of its two values by at most an eighth of its largest
second derivative; accelerations leave that at the start by at most their reach.
"""

from __future__ import annotations

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.frame.peaks import (
    PEAK_ACCELERATION,
    PEAK_BRACE_DISPLACEMENT,
    PEAK_DISPLACEMENT,
    PEAK_DRIFT,
    PEAK_SHEAR,
    PEAK_VELOCITY,
)
from fdspec.kernels.frame.taylor import DISPLACEMENT, OFFSET, SLIDING, VELOCITY
from fdspec.kernels.frame_batch.advance import ONCE, TWICE
from fdspec.kernels.frame_batch.eight import (
    ALL,
    WIDTH,
    above,
    abs8,
    fma8,
    less8,
    load,
    max8,
    min8,
    splat,
    store,
)
from fdspec.kernels.frame_batch.layout import (
    BEND_REACH,
    DASHPOT,
    END,
    FRACTION,
    GROUND,
    INERTIA,
    INERTIA_REACH,
    JERK_REACH,
    LAST,
    LAST_SECOND,
    LENGTH,
    MASS,
    OMEGA,
    OVER_BRACE,
    PEAK,
    REACH,
    RING,
    RISE,
    SECOND,
    SECOND_REACH,
    SLIDES,
    SLIDING_MASS,
    START,
    row,
    term,
)
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude


@inner
def raise_peaks(p, at, size, lanes, orders, c):
    """Raise the peaks of these lanes to those of what is taken of their steps.

    orders (WIDTH,): terms of each lane's series; c: room for a series.
    """
    wide()
    h = load(p, LENGTH * WIDTH)
    rise = abs8(load(p, RISE * WIDTH))
    ground = load(p, GROUND * WIDTH)
    strongest = abs8(ground) + rise
    eighth = splat(0.125) * h
    shear = splat(0.0)
    last_shear = splat(0.0)
    bends = splat(0.0)
    rings = splat(0.0)
    steepens = splat(0.0)
    for i in range(size - 1, -1, -1):
        inertia = load(p, term(at, INERTIA, i, 0))
        last = load(p, row(LAST, i))
        slides = load(p, row(SLIDES, i))
        second = load(p, term(at, SECOND, i, 0)) * slides
        second_reach = load(p, row(REACH + SECOND_REACH, i)) * slides
        swing = load(p, row(REACH + INERTIA_REACH, i))
        jerk = load(p, row(REACH + JERK_REACH, i))
        pull = abs8(inertia) + swing
        u0 = load(p, row(START + DISPLACEMENT, i))
        u1 = load(p, row(END + DISPLACEMENT, i))
        v0 = load(p, row(START + VELOCITY, i))
        v1 = load(p, row(END + VELOCITY, i))
        x0 = splat(0.0)
        x1 = splat(0.0)
        y0 = splat(0.0)
        y1 = splat(0.0)
        below = strongest
        below_jerk = rise
        if i > 0:
            x0 = load(p, row(START + DISPLACEMENT, i - 1))
            x1 = load(p, row(END + DISPLACEMENT, i - 1))
            y0 = load(p, row(START + VELOCITY, i - 1))
            y1 = load(p, row(END + VELOCITY, i - 1))
            below = abs8(load(p, term(at, INERTIA, i - 1, 0))) + load(p, row(REACH + INERTIA_REACH, i - 1))
            below_jerk = load(p, row(REACH + JERK_REACH, i - 1))
        ring = load(p, row(RING, i)) * slides
        omega = load(p, row(OMEGA, i))

        top = raised(p, PEAK_ACCELERATION, i, inertia, last)
        bend = load(p, row(REACH + BEND_REACH, i))
        most = min8(pull, fma8(splat(0.125), bend, max8(abs8(inertia), abs8(last))))
        turns = ALL & ~above(abs8(last - inertia), splat(0.5) * bend)
        of_acceleration = lanes & turns & above(most, top)

        sway = eighth * (jerk + rise)
        top = raised(p, PEAK_VELOCITY, i, v0, v1)
        turns = ALL & ~above(abs8(inertia - ground), swing + rise)
        of_velocity = lanes & turns & above(max8(abs8(v0), abs8(v1)) + sway, top)

        top = raised(p, PEAK_DISPLACEMENT, i, u0, u1)
        most = fma8(eighth * h, pull + strongest, max8(abs8(u0), abs8(u1)))
        of_displacement = lanes & may_turn(v0, v1, sway) & above(most, top)

        top = raised(p, PEAK_DRIFT, i, u0 - x0, u1 - x1)
        most = fma8(eighth * h, pull + below, max8(abs8(u0 - x0), abs8(u1 - x1)))
        of_drift = lanes & may_turn(v0 - y0, v1 - y1, eighth * (jerk + below_jerk)) & above(most, top)

        # A slipping brace swings about the floor below.
        b0 = u0 - load(p, row(START + OFFSET, i))
        b1 = u1 - load(p, row(END + OFFSET, i))
        top = raised(p, PEAK_BRACE_DISPLACEMENT, i, b0, b1)
        most = min8(pull + second_reach + abs8(second), fma8(ring, omega, below))
        most = fma8(eighth * h, most + strongest, max8(abs8(b0), abs8(b1)))
        sticks = above(splat(0.5), slides)
        turns = sticks & may_turn(v0, v1, sway)
        if i > 0:
            turns |= ~sticks & may_turn(y0, y1, fma8(eighth, below_jerk + rise, ring))
        else:
            turns |= ~sticks
        of_brace = lanes & turns & above(most, top)

        # The storey shear carries the inertia of all masses above; a slipping brace's is that of the floor
        # below it and of its swing about that, which does not go beyond its bound.
        mass = load(p, row(MASS, i))
        sliding_mass = load(p, row(SLIDING_MASS, i))
        shear = less8(fma8(mass, inertia, shear), sliding_mass, second)
        last_shear = less8(fma8(mass, last, last_shear), sliding_mass, load(p, row(LAST_SECOND, i)))
        bends = fma8(mass - sliding_mass, bend, bends)
        if i > 0:
            bends = fma8(sliding_mass, load(p, row(REACH + BEND_REACH, i - 1)), bends)
        of_ring = splat(2.0) * sliding_mass * ring * omega
        rings = rings + of_ring
        rate = fma8(load(p, row(DASHPOT, i)), load(p, row(OVER_BRACE, i)), omega)
        steepens = fma8(of_ring, rate * h, fma8(splat(2.0) * sliding_mass, below_jerk, steepens))
        top = raised(p, PEAK_SHEAR, i, shear, last_shear)
        most = fma8(splat(0.125), bends, max8(abs8(shear), abs8(last_shear)) + rings)
        turns = ALL & ~above(abs8(last_shear - shear), fma8(splat(0.5), bends, steepens))
        of_shear = lanes & turns & above(most, top)
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
                    take_velocity(p, at, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_VELOCITY, i) + lane, c, n)
                if of_displacement >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, i, lane, n, x, 1.0, c)
                    raise_peak(p, row(PEAK + PEAK_DISPLACEMENT, i) + lane, c, n + 1)
                if of_drift >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, i, lane, n, x, 1.0, c)
                    if i > 0:
                        add_displacement(p, at, i - 1, lane, n, x, -1.0, c)
                    raise_peak(p, row(PEAK + PEAK_DRIFT, i) + lane, c, n + 1)
                if of_brace >> lane & 1:
                    clear(c, n + 1)
                    add_displacement(p, at, i, lane, n, x, 1.0, c)
                    take_off_offset(p, at, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_BRACE_DISPLACEMENT, i) + lane, c, n + 1)
                if of_shear >> lane & 1:
                    take_shear(p, at, size, i, lane, n, x, c)
                    raise_peak(p, row(PEAK + PEAK_SHEAR, i) + lane, c, n - 1)
            lane += 1
            found >>= 1


@inlined
def raised(p, which, i, start, end):
    """Raise a peak of all lanes to its values at both ends, and give it."""
    top = max8(load(p, row(PEAK + which, i)), max8(abs8(start), abs8(end)))
    store(p, row(PEAK + which, i), top)
    return top


@inlined
def may_turn(start, end, sway):
    """The lanes in which a rate, at most ``sway`` off these values at both ends, may be zero in between."""
    ahead = above(min8(start, end), sway)
    back = above(splat(0.0) - max8(start, end), sway)
    return ALL & ~(ahead | back)


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
def take_velocity(p, at, i, lane, n, x, c):
    """Velocity of floor i, as above."""
    power = p[LENGTH * WIDTH + lane] * x
    c[0] = p[row(START + VELOCITY, i) + lane]
    for k in range(n):
        c[k + 1] = relative(p, at, i, lane, k) * (power * ONCE[k])
        power *= x


@inner
def add_displacement(p, at, i, lane, n, x, sign, c):
    """Add the displacement of floor i, times sign, to a series as above."""
    step = p[LENGTH * WIDTH + lane] * x
    c[0] += sign * p[row(START + DISPLACEMENT, i) + lane]
    c[1] += sign * p[row(START + VELOCITY, i) + lane] * step
    power = sign * step * step
    for k in range(n):
        c[k + 2] += relative(p, at, i, lane, k) * (power * TWICE[k])
        power *= x


@inner
def take_off_offset(p, at, i, lane, n, x, c):
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
        sliding_mass = p[row(SLIDING_MASS, i) + lane]
        power = 1.0
        for k in range(n):
            thrust = (
                mass * p[term(at, INERTIA, i, k) + lane] - sliding_mass * p[term(at, SECOND, i, k) + lane]
            )
            c[k] -= thrust * power
            power *= x
