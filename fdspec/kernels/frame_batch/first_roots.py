"""First roots of eight polynomials at once, by the bounds of :mod:`fdspec.kernels.mathematics.polynomial_roots`.

Each begins above zero and is looked at on the four quarters of [0, 1], one after another: its Bezier
ordinates clear a quarter, or its slope or its curvature, which provably keep one sign there, leave room for
one crossing at most, and Newton's method goes there.  What none of these decides is left to the scalar search.
"""

from __future__ import annotations

from typing import Final

from fdspec.compiler.options import inner, wide
from fdspec.kernels.frame_batch.eight import (
    ALL,
    WIDTH,
    above,
    abs8,
    fma8,
    load,
    max8,
    splat,
    store,
    where_above,
    where_in,
)
from fdspec.kernels.mathematics.polynomial_roots import CLOSE, NEWTON_STEPS, NO_ROOT, TAIL

QUARTER: Final = 0.25


@inner
def at_quarters(p, block, n, x):
    """Value, slope and curvature at x of the polynomials of order n in a block."""
    wide()
    value = load(p, block + n * WIDTH)
    slope = splat(0.0)
    bend = splat(0.0)
    for k in range(n - 1, -1, -1):
        bend = fma8(bend, x, slope)
        slope = fma8(slope, x, value)
        value = fma8(value, x, load(p, block + k * WIDTH))
    return value, slope, bend + bend


@inner
def first_roots(p, block, n, lanes, result):
    """Put the first root in [0, 1] of each of these lanes' polynomials into ``result``, or NO_ROOT.

    block: place of their coefficients of the powers 0 to n.  Return the lanes that are left undecided.
    """
    wide()
    third = splat(0.0)
    fourth = splat(0.0)
    for k in range(3, n + 1):
        size = abs8(load(p, block + k * WIDTH)) * splat(float(k * (k - 1) * (k - 2)))
        third = third + size
        fourth = fma8(size, splat(float(k - 3)), fourth)
    third = third * splat(0.125 * QUARTER * QUARTER)
    margin = fourth * splat(0.125 * QUARTER * QUARTER)
    inner_least = fourth * splat(TAIL * QUARTER * QUARTER * QUARTER * QUARTER)
    step = splat(QUARTER / 3.0)
    nothing = splat(0.0)
    start = load(p, block)
    slope = load(p, block + WIDTH)
    bend = splat(2.0) * load(p, block + 2 * WIDTH)
    opened = lanes
    crossed = 0
    undecided = 0
    left = nothing
    above_left = splat(1.0)
    below_right = splat(-1.0)
    for quarter in range(4):
        x = splat(QUARTER * (quarter + 1))
        end, end_slope, end_bend = at_quarters(p, block, n, x)
        positive = above(end, nothing)
        first = fma8(slope, step, start)
        last = fma8(end_slope, nothing - step, end)
        clear = ~above(inner_least, first) & ~above(inner_least, last)
        falls = above(nothing, max8(slope, end_slope) + third)
        concave = above(nothing, max8(bend, end_bend) + margin)
        convex = above(nothing, max8(nothing - bend, nothing - end_bend) + margin)
        rises = convex & ~above(nothing, slope)
        convex_falls = convex & above(nothing, slope) & ~above(end_slope, nothing)
        known = falls | concave | convex_falls | rises
        # What is no number is neither positive nor known, and is left to the scalar search.
        passes = positive & (clear | known)
        crosses = opened & ~positive & (falls | concave | convex_falls) & above(splat(1e300), abs8(end))
        left = where_in(crosses, splat(QUARTER * quarter), left)
        above_left = where_in(crosses, start, above_left)
        below_right = where_in(crosses, end, below_right)
        crossed |= crosses
        undecided |= opened & ~passes & ~crosses
        opened &= passes
        if opened == 0:
            break
        start = end
        slope = end_slope
        bend = end_bend
    store(p, result, splat(NO_ROOT))
    if crossed != 0:
        root = locate(p, block, n, crossed, left, left + splat(QUARTER), above_left, below_right)
        store(p, result, where_in(crossed, root, splat(NO_ROOT)))
    return undecided


@inner
def locate(p, block, n, lanes, a, b, height_a, height_b):
    """The only root between a and b of each of these lanes' polynomials, which falls there through zero."""
    wide()
    nothing = splat(0.0)
    x = fma8((b - a) * height_a, splat(1.0) / (height_a - height_b), a)
    close = 0
    for _ in range(NEWTON_STEPS):
        square = x * x
        k = n
        odd = nothing
        if n & 1:
            odd = load(p, block + n * WIDTH)
            k = n - 1
        even = load(p, block + k * WIDTH)
        even_slope = nothing
        odd_slope = nothing
        k -= 2
        while k >= 0:
            odd_slope = fma8(odd_slope, square, odd)
            even_slope = fma8(even_slope, square, even)
            odd = fma8(odd, square, load(p, block + (k + 1) * WIDTH))
            even = fma8(even, square, load(p, block + k * WIDTH))
            k -= 2
        height = fma8(x, odd, even)
        slope = fma8(x + x, fma8(x, odd_slope, even_slope), odd)
        a = where_above(height, nothing, x, a)
        b = where_above(height, nothing, b, x)
        step = x - height / slope
        inside = ~above(a, step) & ~above(step, b) & (above(slope, nothing) | above(nothing, slope))
        step = where_in(inside, step, splat(0.5) * (a + b))
        moved = abs8(step - x)
        moves = above(abs8(height), nothing)
        x = where_in(lanes & moves, step, x)
        lanes &= moves & ~close & above(moved, nothing)
        close |= ALL & ~above(moved, splat(CLOSE))
        if lanes == 0:
            break
    return x
