"""First roots of eight polynomials at once.

Each begins above zero and is looked at on the four quarters of [0, 1]: its Bezier ordinates clear a quarter,
or its slope or its curvature, which provably keep one sign there, leave room for one crossing at most, and
Newton's method goes there.  The bounds are those of :mod:`fdspec.kernels.mathematics.polynomial_roots`; what
they leave undecided is for its scalar search.
"""

from __future__ import annotations

from typing import Final

from fdspec.compiler.options import inlined, inner, wide
from fdspec.kernels.frame_batch.eight import (
    ALL,
    WIDTH,
    above,
    abs8,
    fma8,
    load,
    max8,
    min8,
    splat,
    store,
    where_above,
    where_in,
)
from fdspec.kernels.mathematics.polynomial_roots import CLOSE, NEWTON_STEPS, NO_ROOT, TAIL

QUARTER: Final = 0.25
HUGE: Final = 1e300


@inlined
def one_more(p, place, x, value, slope, bend):
    """One step of Horner's rule for a polynomial, its slope and half its curvature at x."""
    bend = fma8(bend, x, slope)
    slope = fma8(slope, x, value)
    return fma8(value, x, load(p, place)), slope, bend


@inlined
def judge(start, slope, bend, end, end_slope, end_bend, step, third, margin, inner_least):
    """The lanes that pass a quarter without a root, and those that cross zero there just once.

    start, end: values at both ends, with slopes and halves of curvatures.
    """
    nothing = splat(0.0)
    positive = above(end, nothing)
    first = fma8(slope, step, start)
    last = fma8(end_slope, nothing - step, end)
    clear = ~above(inner_least, first) & ~above(inner_least, last)
    falls = above(nothing, max8(slope, end_slope) + third)
    concave = above(nothing, max8(bend, end_bend) + margin)
    convex = above(min8(bend, end_bend), margin)
    rises = convex & ~above(nothing, slope)
    convex_falls = convex & above(nothing, slope) & ~above(end_slope, nothing)
    once = falls | concave | convex_falls
    # What is no number is neither positive nor below zero.
    return positive & (clear | once | rises), once & ~above(end, nothing) & above(splat(HUGE), abs8(end))


@inner
def first_roots(p, block, n, lanes, result):
    """Put the first root in [0, 1] of each of these lanes' polynomials into ``result``, or NO_ROOT.

    block: place of their coefficients of the powers 0 to n.  Return the lanes that are left undecided.
    """
    wide()
    nothing = splat(0.0)
    third = nothing
    fourth = nothing
    x_1 = splat(0.25)
    x_2 = splat(0.5)
    x_3 = splat(0.75)
    x_4 = splat(1.0)
    v_1 = load(p, block + n * WIDTH)
    v_2 = v_1
    v_3 = v_1
    v_4 = v_1
    s_1 = nothing
    s_2 = nothing
    s_3 = nothing
    s_4 = nothing
    b_1 = nothing
    b_2 = nothing
    b_3 = nothing
    b_4 = nothing
    for k in range(n, -1, -1):
        place = block + k * WIDTH
        size = abs8(load(p, place)) * splat(float(k * (k - 1) * (k - 2)))
        third = third + size
        fourth = fma8(size, splat(float(k - 3)), fourth)
        if k < n:
            v_1, s_1, b_1 = one_more(p, place, x_1, v_1, s_1, b_1)
            v_2, s_2, b_2 = one_more(p, place, x_2, v_2, s_2, b_2)
            v_3, s_3, b_3 = one_more(p, place, x_3, v_3, s_3, b_3)
            v_4, s_4, b_4 = one_more(p, place, x_4, v_4, s_4, b_4)
    third = third * splat(0.125 * QUARTER * QUARTER)
    margin = fourth * splat(0.0625 * QUARTER * QUARTER)
    least = fourth * splat(TAIL * QUARTER * QUARTER * QUARTER * QUARTER)
    step = splat(QUARTER / 3.0)
    v_0 = load(p, block)
    s_0 = load(p, block + WIDTH)
    b_0 = load(p, block + 2 * WIDTH)
    pass_1, cross_1 = judge(v_0, s_0, b_0, v_1, s_1, b_1, step, third, margin, least)
    pass_2, cross_2 = judge(v_1, s_1, b_1, v_2, s_2, b_2, step, third, margin, least)
    pass_3, cross_3 = judge(v_2, s_2, b_2, v_3, s_3, b_3, step, third, margin, least)
    pass_4, cross_4 = judge(v_3, s_3, b_3, v_4, s_4, b_4, step, third, margin, least)
    # Each lane is decided by the first quarter that it does not pass.
    cross_1 &= lanes
    lanes_2 = lanes & pass_1
    cross_2 &= lanes_2
    lanes_3 = lanes_2 & pass_2
    cross_3 &= lanes_3
    lanes_4 = lanes_3 & pass_3
    cross_4 &= lanes_4
    crossed = cross_1 | cross_2 | cross_3 | cross_4
    root = splat(NO_ROOT)
    if crossed != 0:
        left = where_in(cross_2, x_1, where_in(cross_3, x_2, where_in(cross_4, x_3, nothing)))
        # Lanes without a crossing divide by something too.
        start = where_in(cross_1, v_0, where_in(cross_4, v_3, splat(1.0)))
        start = where_in(cross_2, v_1, where_in(cross_3, v_2, start))
        end = where_in(cross_1, v_1, where_in(cross_4, v_4, splat(-1.0)))
        end = where_in(cross_2, v_2, where_in(cross_3, v_3, end))
        found = locate(p, block, n, crossed, left, left + splat(QUARTER), start, end)
        root = where_in(crossed, found, root)
    store(p, result, root)
    return lanes & ~crossed & ~(lanes_4 & pass_4)


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
        steep = above(abs8(slope), nothing)
        step = x - height / where_in(steep, slope, splat(1.0))
        inside = steep & ~above(a, step) & ~above(step, b) & above(splat(HUGE), abs8(step))
        step = where_in(inside, step, splat(0.5) * (a + b))
        moved = abs8(step - x)
        moves = above(abs8(height), nothing)
        x = where_in(lanes & moves, step, x)
        lanes &= moves & ~close & above(moved, nothing)
        close |= ALL & ~above(moved, splat(CLOSE))
        if lanes == 0:
            break
    return x
