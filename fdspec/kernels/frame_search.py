"""The first change of phase on a step of a frame, storey by storey."""

from __future__ import annotations

from fdspec.jit import inner
from fdspec.kernels.frame import NO_BRACE, SLIP_FORCE
from fdspec.kernels.roots import NO_ROOT, first_root
from fdspec.kernels.taylor import OFFSET, REACTION
from fdspec.kernels.types import STICK

SAME_INSTANT = 1e-12
"""Fraction of a step (of at most a few radians) that counts as no time: far below what rounding leaves
of a root's place, so storeys that change within it change together."""


@inner
def search(frame, kind, phase, fresh, touching, series, n, c, instants, signs):
    """Fill instants[i], the fraction of the step at which storey i changes, and signs[i], its direction.

    Return the smallest instant (NO_ROOT where there is none).  touching[i] is the direction in which
    a storey that has just stuck stands at its limit: its distance to the limit begins with
    fresh[i] vanishing terms.
    """
    first = NO_ROOT
    for i in range(phase.size):
        instants[i] = NO_ROOT
        if kind[i] == NO_BRACE:
            continue
        if phase[i] == STICK:
            x = search_stick(
                series[REACTION], i + 1, n - 2, frame[SLIP_FORCE, i], touching[i], fresh[i], c, signs, i
            )
        else:
            signs[i] = phase[i]
            x = search_slip(series[OFFSET], i + 1, n - 1, float(phase[i]), c)
        instants[i] = x
        first = min(first, x)
    return first


@inner
def search_stick(reaction, column, n, limit, touching, vanishing, c, signs, i):
    """Where |reaction| reaches the limit; its direction goes to signs[i]."""
    reach = abs(reaction[0, column])
    for k in range(1, n + 1):
        reach += abs(reaction[k, column])
    if reach < limit:
        return NO_ROOT
    first = NO_ROOT
    for sign in (1, -1):
        if reach - abs(reaction[0, column]) + sign * reaction[0, column] < limit and touching != sign:
            continue
        for k in range(n + 1):
            c[k] = -sign * reaction[k, column]
        c[0] += limit
        if touching == sign:
            for k in range(vanishing):
                c[k] = 0.0
        x = first_root(c, 0, n, 1.0)
        if x < first:
            first = x
            signs[i] = sign
    return first


@inner
def search_slip(offset, column, n, sign, c):
    """Where the sliding velocity comes to zero."""
    room = sign * offset[1, column]
    for k in range(1, n + 1):
        room -= (k + 1) * abs(offset[k + 1, column])
    if room > 0.0:
        return NO_ROOT
    for k in range(n + 1):
        c[k] = (k + 1) * offset[k + 1, column]
    return first_root(c, 0, n, sign)
