"""The first instant of each history at which a storey changes its phase.

What decides it is a polynomial for each storey that the bounds did not clear; these are searched eight at
a time, of whichever histories they are.
"""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.frame.guard import first_root_after
from fdspec.kernels.frame.model import SLIP_FORCE
from fdspec.kernels.frame.reset import LAST, patience
from fdspec.kernels.frame.taylor import SLIDING, TERMS
from fdspec.kernels.frame_batch.eight import ALL, WIDTH
from fdspec.kernels.frame_batch.first_roots import first_roots
from fdspec.kernels.frame_batch.layout import (
    LENGTH,
    RATE,
    REACH,
    SECOND,
    SECOND_REACH,
    START,
    TAU,
    row,
    term,
)
from fdspec.kernels.mathematics.oscillator import INVERSE
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, first_root
from fdspec.kernels.types import STICK


@inner
def gather(p, at, i, lane, slot, n, sign, limit, vanishing, slides, terms):
    """Put what decides about storey i of a lane into a slot; return its order, -1 where a root is at 0.

    It is limit - sign R, or sign times the sliding velocity, and begins above zero: leading terms that are
    zero by construction are stripped.  The order is 0 where no term is left.
    """
    q = term(at, SECOND, i, 0) + lane
    to = at.searched + slot
    h = p[LENGTH * WIDTH + lane]
    start = sign * p[row(START + SLIDING, i) + lane] if slides else limit - sign * p[q]
    if start < 0.0 and vanishing == 0:
        return -1
    if start > 0.0 and vanishing == 0:
        p[to] = start
        if slides:
            for k in range(n):
                p[to + (k + 1) * WIDTH] = p[q + 2 * k * WIDTH] * (sign * h * INVERSE[k + 1])
            return n
        for k in range(1, n):
            p[to + k * WIDTH] = -sign * p[q + 2 * k * WIDTH]
        return n - 1
    terms[0] = start
    if slides:
        for k in range(n):
            terms[k + 1] = p[q + 2 * k * WIDTH] * (sign * h * INVERSE[k + 1])
        n += 1
    else:
        for k in range(1, n):
            terms[k] = -sign * p[q + 2 * k * WIDTH]
    for k in range(vanishing):
        terms[k] = 0.0
    first = 0
    while first < n and terms[first] == 0.0:
        first += 1
    if first == n:
        return 0
    if terms[first] < 0.0:
        return -1
    for k in range(n - first):
        p[to + k * WIDTH] = terms[first + k]
    return n - first - 1


@inner
def patience_of(p, lane, dt, step, tally, i):
    """Fraction of the step for which a damper without friction is left in its phase."""
    radian = min(dt, 1.0 / p[RATE * WIDTH + lane])
    now = step * dt + p[TAU * WIDTH + lane]
    return max(0.0, tally[LAST, i] + patience(tally, i, radian) - now) / p[LENGTH * WIDTH + lane]


@inner
def root_after(p, at, i, lane, n, sign, waits, terms):
    """Where the sliding velocity of storey i comes to zero after the fraction ``waits`` of the step."""
    h = p[LENGTH * WIDTH + lane]
    terms[0] = p[row(START + SLIDING, i) + lane]
    for k in range(n):
        terms[k + 1] = p[term(at, SECOND, i, k) + lane] * (h * INVERSE[k + 1])
    return first_root_after(terms, n, sign, waits)


@inner
def search(
    p,
    at,
    size,
    dt,
    steps,
    lanes,
    alerts,
    frames,
    of_lane,
    phases,
    vanishings,
    touchings,
    tallies,
    orders,
    terms,
    instants,
    signs,
    slot_lane,
    slot_storey,
    slot_sign,
    slot_order,
    firsts,
):
    """Fill instants[lane, i], the fraction of the step at which storey i changes, and signs[lane, i].

    firsts[lane]: the smallest instant, NO_ROOT where there is none.  lanes: those with alerts.
    Of a storey that has just begun to slip, ``vanishing`` leading terms of the sliding velocity are zero; of
    one that has just stuck at its limit, in the direction touching, as many of the distance to the limit.
    """
    filled = 0
    most = 0
    for lane in range(WIDTH):
        firsts[lane] = NO_ROOT
        if lanes >> lane & 1 == 0:
            continue
        for i in range(size):
            instants[lane, i] = NO_ROOT
            if alerts[i] >> lane & 1 == 0:
                continue
            phase = phases[lane, i]
            vanishing = vanishings[lane, i]
            touching = touchings[lane, i]
            q = term(at, SECOND, i, 0) + lane
            limit = frames[of_lane[lane], SLIP_FORCE, i]
            room = limit - p[row(REACH + SECOND_REACH, i) + lane]
            if limit == 0.0:
                waits = patience_of(p, lane, dt, steps[lane], tallies[lane], i)
                if waits >= 1.0:
                    continue
                if waits > 0.0:
                    x = root_after(p, at, i, lane, orders[lane], float(phase), waits, terms)
                    instants[lane, i] = x
                    signs[lane, i] = phase
                    firsts[lane] = min(firsts[lane], x)
                    continue
            if vanishing > 1 and phase != STICK:
                p[q] = 0.0
            for sign in (1, -1):
                zeros = 0
                if phase != STICK:
                    if sign != phase:
                        continue
                elif touching == sign:
                    zeros = vanishing
                elif sign * p[q] < room:
                    continue
                n = gather(
                    p, at, i, lane, filled, orders[lane], float(sign), limit, zeros, phase != STICK, terms
                )
                if n < 0:
                    if instants[lane, i] > 0.0:
                        instants[lane, i] = 0.0
                        signs[lane, i] = sign
                    firsts[lane] = 0.0
                if n <= 0:
                    continue
                slot_lane[filled] = lane
                slot_storey[filled] = i
                slot_sign[filled] = sign
                slot_order[filled] = n
                most = max(most, n)
                filled += 1
                if filled == WIDTH:
                    settle(
                        p,
                        at,
                        filled,
                        most,
                        terms,
                        instants,
                        signs,
                        slot_lane,
                        slot_storey,
                        slot_sign,
                        slot_order,
                        firsts,
                    )
                    filled = 0
                    most = 0
    if filled > 0:
        settle(
            p, at, filled, most, terms, instants, signs, slot_lane, slot_storey, slot_sign, slot_order, firsts
        )


@inner
def settle(
    p, at, filled, most, terms, instants, signs, slot_lane, slot_storey, slot_sign, slot_order, firsts
):
    """Find the first roots of what is in the slots, and empty them."""
    most = max(most, 3)
    for slot in range(filled):
        for k in range(slot_order[slot] + 1, most + 1):
            p[at.searched + k * WIDTH + slot] = 0.0
    result = at.searched + (TERMS + 1) * WIDTH
    undecided = first_roots(p, at.searched, most, ALL >> (WIDTH - filled), result)
    for slot in range(filled):
        x = p[result + slot]
        if undecided >> slot & 1:
            n = slot_order[slot]
            for k in range(n + 1):
                terms[k] = p[at.searched + k * WIDTH + slot]
            x = first_root(terms, 0, n, 1.0)
        lane = slot_lane[slot]
        i = slot_storey[slot]
        if x < instants[lane, i]:
            instants[lane, i] = x
            signs[lane, i] = slot_sign[slot]
            firsts[lane] = min(firsts[lane], x)
