"""The oscillator of period zero: a block that rides with the ground until a_g overcomes its strength.

It slides with u'' = -(a + s f), a linear in time, so its velocity is a parabola on each record step, and
stops where that returns to zero.
"""

from __future__ import annotations

import math

from fdspec.compiler.options import inner


@inner
def stop_fraction(v, start, end, h):
    """First x in (0, 1] at which v + h (start x + (end - start) x^2 / 2) falls to zero; 2 where it does not.

    v: speed in the direction of sliding, 0 or more; start, end: its acceleration at both ends of the step.
    """
    square = 0.5 * h * (end - start)
    linear = h * start
    if v == 0.0 and (linear < 0.0 or (linear == 0.0 and square <= 0.0)):
        return 0.0
    first = 2.0
    if square == 0.0:
        if linear < 0.0:
            first = -v / linear
    else:
        below = linear * linear - 4.0 * square * v
        if below >= 0.0:
            q = -0.5 * (linear + math.copysign(math.sqrt(below), linear))
            for x in (q / square, v / q if q != 0.0 else 2.0):
                if 0.0 < x < first:
                    first = x
    return first if first <= 1.0 else 2.0


@inner
def slide(ground, dt, strength, out):
    """Slide one block; out as for the bilinear oscillator, see `fdspec.kernels.bilinear.history.RESULTS`."""
    u = 0.0
    v = 0.0
    sign = 0.0
    travel = 0.0
    displacement = 0.0
    acceleration = 0.0
    work = 0.0
    events = 0
    for step in range(ground.size):
        a0 = ground[step]
        a1 = ground[step + 1] if step + 1 < ground.size else 0.0
        last = step + 1 == ground.size
        length = dt
        if last:  # the ground has come to rest, and the block stops within this time
            a0 = 0.0
            length = abs(v) / strength * 2.0 if strength > 0.0 else 0.0
        x = 0.0
        while x < 1.0:
            now = a0 + (a1 - a0) * x
            if sign == 0.0:
                peak = min(max(abs(now), abs(a1)), strength)
                acceleration = max(acceleration, peak)
                if max(abs(now), abs(a1)) <= strength:
                    break
                # Each side of zero apart: the first instant at which |a| passes the strength.
                start = 2.0
                for side in (1.0, -1.0):
                    if side * now > strength or (side * now == strength and side * (a1 - now) > 0.0):
                        start = x
                        sign = -side
                    elif side * a1 > strength and start > 1.0:
                        start = x + (1.0 - x) * (side * strength - now) / (a1 - now)
                        sign = -side
                x = min(start, 1.0)
                events += 1
                continue
            h = (1.0 - x) * length
            begin = -sign * now - strength
            end = -sign * a1 - strength
            stop = stop_fraction(sign * v, begin, end, h) if h > 0.0 else 0.0
            done = min(stop, 1.0)
            t = done * h
            bend = (end - begin) / h if h > 0.0 else 0.0
            moved = t * (sign * v + t * (0.5 * begin + t * bend / 6.0))
            there = now + (a1 - now) * done
            area = t * (u + sign * t * (0.5 * sign * v + t * (begin / 6.0 + t * bend / 24.0)))
            u1 = u + sign * moved
            work += now * u - there * u1 + ((there - now) / t * area if t > 0.0 else 0.0)
            v = v + sign * t * (begin + 0.5 * t * bend)
            u = u1
            travel += moved
            displacement = max(displacement, abs(u))
            acceleration = max(acceleration, strength)
            x += done * (1.0 - x)
            if stop <= 1.0:
                v = 0.0
                sign = 0.0
                events += 1
                if length == 0.0 or done == 0.0:
                    x = max(x, 1.0) if abs(now) <= strength else x
    out[0] = displacement
    out[1] = acceleration
    out[2] = u
    out[3] = travel
    out[4] = strength * travel
    out[5] = work
    scale = max(abs(work), strength * travel)
    out[6] = abs(work - 0.5 * v * v - strength * travel) / scale if scale > 0.0 else 0.0
    out[7] = events
    out[8] = 0.0 if math.isfinite(u) else 3.0
