"""The first event of a step, over all devices."""

from __future__ import annotations

import math

from fdspec.compiler.options import inner
from fdspec.kernels.devices.bilinear import bilinear_guard
from fdspec.kernels.devices.dashpot_brace import dashpot_guard
from fdspec.kernels.devices.guard import root_of
from fdspec.kernels.devices.layout import KIND, WITH_DASHPOT, WITH_MASS, WITHOUT_MASS, U
from fdspec.kernels.devices.one_sided import one_sided_guard
from fdspec.kernels.devices.plate import plate_guard
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT


@inner
def first_event(frame, law, state, series, n, instants, signs, events):
    """Fill instants[j], the fraction of the step at which link j changes its mode, signs[j] and events[j].

    Return the smallest instant, NO_ROOT where there is none.
    """
    first = NO_ROOT
    for j in range(frame.places.shape[1]):
        kind = frame.places[KIND, j]
        if kind == WITH_MASS:
            instants[j] = plate_guard(frame, law, state, series, j, n, signs, events)
        elif kind == WITHOUT_MASS:
            instants[j] = bilinear_guard(frame, law, state, series, j, n, signs, events)
        elif kind == WITH_DASHPOT:
            instants[j] = dashpot_guard(frame, law, state, series, j, n, signs, events)
        else:
            instants[j] = one_sided_guard(frame, state, series, j, n, events)
        first = min(first, instants[j])
    return first


@inner
def first_collapse(frame, series, n):
    """Fraction of the step at which a drift reaches its limit, NO_ROOT where none does, and the storey."""
    first = NO_ROOT
    where = -1
    c = series.c
    for i in range(frame.drift_limit.size):
        limit = frame.drift_limit[i]
        if limit == math.inf:
            continue
        for sign in (1.0, -1.0):
            for k in range(n + 1):
                c[k] = -sign * (series.floors[U, i + 1, k] - series.floors[U, frame.below[i], k])
            c[0] += limit
            x = root_of(c, n)
            if x < first:
                first = x
                where = i
    return first, where
