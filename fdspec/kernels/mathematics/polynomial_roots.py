"""First root and largest value of a polynomial on [0, 1]: complete, and located to rounding.

A quantity of the motion on a step of at most about one radian is, to rounding, a polynomial
p(x) = sum c[k] x^k of the fraction x of the step.  Signs at the two ends say little about it: the
sliding velocity of a light brace returns close to zero once in every brace period and often
touches it between two ends.  So every interval is cleared by a bound or taken apart:

- the cubic through values and slopes at both ends of [x, x + w] lies within its four Bezier
  ordinates, and its error falls to zero at both ends as fast as the weights of the inner two:
  where the ends are positive and the inner ordinates at least max|p''''| w^4 / 288, p is positive;
- where the curvature provably keeps one sign, the extremum in between is found by Newton's method
  and its sign is looked at;
- otherwise the interval is halved.

``lo`` strips leading coefficients that are zero by construction (a phase that begins with a zero
sliding velocity): p(x) = x^lo q(x), and q is searched instead.
"""

from __future__ import annotations

from fdspec.compiler.options import fma, inlined, inner, seldom

NO_ROOT = 2.0
"""Returned where there is no root in [0, 1]."""

THIRD = 1.0 / 3.0

TAIL = 1.0 / 288.0
"""Weight of a bound on the fourth derivative against the inner Bezier ordinates."""

SMALLEST_INTERVAL = 2.0**-40
"""Where an interval this short is still undecided, values at its ends decide: p is then zero to rounding."""

ROUNDING = 2.0**-53
"""What a sum is off by at least, relative to the sum of its terms' magnitudes."""

NEWTON_STEPS = 60
"""Newton needs 3 to 6; a step that leaves the bracket halves it, so this many always suffice."""

CLOSE = 1e-9
"""A Newton step this short is followed by one more and then by none: the error left is its square."""


@inner
def value_slope(c, lo, n, x):
    """Value and slope at x of q(x) = sum over k = lo..n of c[k] x^(k - lo).

    Even and odd powers apart, q = E(x^2) + x O(x^2): two short chains of arithmetic in place of a long one.
    """
    square = x * x
    k = n
    odd = 0.0
    if (n - lo) & 1:
        odd = c[n]
        k = n - 1
    even = c[k]
    even_slope = 0.0
    odd_slope = 0.0
    k -= 2
    while k >= lo:
        odd_slope = fma(odd_slope, square, odd)
        even_slope = fma(even_slope, square, even)
        odd = fma(odd, square, c[k + 1])
        even = fma(even, square, c[k])
        k -= 2
    return fma(x, odd, even), fma(2.0 * x, fma(x, odd_slope, even_slope), odd)


@inner
def value(c, n, x):
    """Value of the polynomial of degree n at x."""
    result = c[n]
    for k in range(n - 1, -1, -1):
        result = fma(result, x, c[k])
    return result


@inner
def curvature(c, lo, n, x):
    """Second derivative of q at x."""
    result = 0.0
    for k in range(n - lo, 1, -1):
        result = fma(result, x, k * (k - 1) * c[k + lo])
    return result


@inlined
def clears(start, start_rise, end, end_rise, fourth):
    """Whether a quantity surely stays positive on a step.

    Values at both ends, slopes times the step, and a bound on the fourth derivative times step^4.
    """
    inside = min(fma(start_rise, THIRD, start), fma(-end_rise, THIRD, end))
    return (start > 0.0) & (end > 0.0) & (inside >= fourth * TAIL)


@inner
def fourth_bound(c, lo, n):
    """Upper bound on |q''''| over [0, 1]."""
    bound = 0.0
    for k in range(4, n - lo + 1):
        bound = fma(float(k * (k - 1) * (k - 2) * (k - 3)), abs(c[k + lo]), bound)
    return bound


@inner
def locate_turn(c, lo, n, sign, a, b, slope_a, slope_b):
    """The zero of q' in [a, b] where sign q'(a) < 0 < sign q'(b) and q'' keeps one sign."""
    x = a + (b - a) * slope_a / (slope_a - slope_b)
    close = False
    for _ in range(NEWTON_STEPS):
        slope = sign * value_slope(c, lo, n, x)[1]
        if slope < 0.0:
            a = x
        elif slope > 0.0:
            b = x
        else:
            break
        bend = sign * curvature(c, lo, n, x)
        step = x - slope / bend if bend != 0.0 else a
        if not a <= step <= b:
            step = 0.5 * (a + b)
        moved = abs(step - x)
        x = step
        if close or moved == 0.0:
            break
        close = moved <= CLOSE
    return x


@inner
def locate_root(c, lo, n, sign, a, b, height_a, height_b):
    """The root of sign q in [a, b] where sign q(a) > 0 >= sign q(b) and it is the only one."""
    x = a + (b - a) * height_a / (height_a - height_b)
    close = False
    for _ in range(NEWTON_STEPS):
        height, slope = value_slope(c, lo, n, x)
        height *= sign
        slope *= sign
        if height > 0.0:
            a = x
        elif height < 0.0:
            b = x
        else:
            break
        step = x - height / slope if slope != 0.0 else a
        if not a <= step <= b:
            step = 0.5 * (a + b)
        moved = abs(step - x)
        x = step
        if close or moved == 0.0:
            break
        close = moved <= CLOSE
    return x


@inner
def first_root(c, lo, n, sign):
    """Smallest x in [0, 1] where sign q(x) falls to zero or below; NO_ROOT where it stays positive.

    Zero leading coefficients are stripped: the polynomial that begins at zero is judged by where
    it goes.  A polynomial that begins below zero has its root at 0.
    """
    seldom()
    while lo < n and c[lo] == 0.0:
        lo += 1
    if lo == n and c[n] == 0.0:
        return NO_ROOT
    x = 0.0
    height = sign * c[lo]
    if height <= 0.0:
        return 0.0
    slope = sign * c[lo + 1] if lo < n else 0.0
    fourth = fourth_bound(c, lo, n)
    w = 1.0
    while x < 1.0:
        if w >= 1.0 - x:
            w = 1.0 - x
            y = 1.0
        else:
            y = x + w
        height_y, slope_y = value_slope(c, lo, n, y)
        height_y *= sign
        slope_y *= sign
        inside = min(height + w * slope / 3.0, height_y - w * slope_y / 3.0)
        if height_y <= 0.0 or inside < fourth * w**4 * TAIL:
            bend = sign * curvature(c, lo, n, x)
            bend_y = sign * curvature(c, lo, n, y)
            margin = fourth * w * w / 8.0
            if max(bend, bend_y) + margin < 0.0:
                if height_y <= 0.0:
                    return locate_root(c, lo, n, sign, x, y, height, height_y)
            elif min(bend, bend_y) - margin > 0.0:
                if slope < 0.0:
                    bottom = y
                    height_bottom = height_y
                    if slope_y > 0.0:
                        bottom = locate_turn(c, lo, n, sign, x, y, slope, slope_y)
                        height_bottom = sign * value_slope(c, lo, n, bottom)[0]
                    if height_bottom <= 0.0:
                        return locate_root(c, lo, n, sign, x, bottom, height, height_bottom)
            elif w <= SMALLEST_INTERVAL:
                if height_y <= 0.0:
                    return y
            else:
                w *= 0.5
                continue
        x = y
        height = height_y
        slope = slope_y
        w *= 2.0
    return NO_ROOT


@inner
def largest(c, n, sign, end, end_slope, fourth, rounding, best):
    """The greater of ``best`` and the maximum of sign p(x) over [0, 1].

    end, end_slope: value and slope of p at 1; fourth: a bound on |p''''|; rounding: what p is off by
    anyway.  A maximum no further above ``best`` is not looked for: next to a zero of high order no bound
    is ever below zero.
    """
    x = 0.0
    height = sign * c[0]
    slope = sign * c[1]
    best = max(best, max(height, sign * end))
    w = 1.0
    while x < 1.0:
        if w >= 1.0 - x:
            w = 1.0 - x
            y = 1.0
            height_y = end
            slope_y = end_slope
        else:
            y = x + w
            height_y, slope_y = value_slope(c, 0, n, y)
        height_y *= sign
        slope_y *= sign
        best = max(best, height_y)
        inside = max(height + w * slope / 3.0, height_y - w * slope_y / 3.0)
        if inside + fourth * w**4 * TAIL > best + rounding:
            bend = sign * curvature(c, 0, n, x)
            bend_y = sign * curvature(c, 0, n, y)
            margin = fourth * w * w / 8.0
            if max(bend, bend_y) + margin < 0.0:
                if slope > 0.0 > slope_y:
                    top = locate_turn(c, 0, n, -sign, x, y, -slope, -slope_y)
                    best = max(best, sign * value_slope(c, 0, n, top)[0])
            elif min(bend, bend_y) - margin <= 0.0 and w > SMALLEST_INTERVAL:
                w *= 0.5
                continue
        x = y
        height = height_y
        slope = slope_y
        w *= 2.0
    return best


@inner
def largest_magnitude(c, n, best):
    """The greater of ``best`` and the maximum of |p(x)| over [0, 1]."""
    seldom()
    fourth = fourth_bound(c, 0, n)
    end, end_slope = value_slope(c, 0, n, 1.0)
    rounding = 0.0
    for k in range(n + 1):
        rounding += abs(c[k])
    rounding *= ROUNDING
    best = largest(c, n, 1.0, end, end_slope, fourth, rounding, best)
    return largest(c, n, -1.0, end, end_slope, fourth, rounding, best)
