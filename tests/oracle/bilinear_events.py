"""A bilinear oscillator by matrix exponentials and bracketed roots; imports nothing from fdspec.

The state (u, v, a, slope, push) of each branch obeys y' = A y: u'' = -a - c u' - k u + push.  A record step
is sampled at FINE instants by the exponential of A; a change of sign of a guard between two of them is
bracketed and located by Brent's method on the exponential itself.  Slow and plain.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

FINE = 12
"""Samples of a record step, at least; more where a radian asks for them."""

U, V, A, PUSH = 0, 1, 2, 4


class Spring(NamedTuple):
    """Damping c, stiffness k, hardening stiffness, plastic force and yield displacement, per unit mass."""

    c: float
    k: float
    hard: float
    force: float
    limit: float


@lru_cache(maxsize=256)
def _exponential(c, k, time):
    a = np.zeros((5, 5))
    a[U, V] = 1.0
    a[V] = [-k, -c, -1.0, 0.0, 1.0]
    a[A, 3] = 1.0
    return expm(a * time)


def _ahead(spring, branch, y, time):
    return _exponential(spring.c, spring.k if branch == 0 else spring.hard, time) @ y


def _flow(spring, branch, y, time):
    """The same for an instant that will not come again."""
    return _exponential.__wrapped__(spring.c, spring.k if branch == 0 else spring.hard, time) @ y


def _total(spring, branch, y):
    """u'' + a."""
    return -spring.c * y[V] - (spring.k if branch == 0 else spring.hard) * y[U] + y[PUSH]


def _total_rate(spring, branch, y):
    relative = _total(spring, branch, y) - y[A]
    return -spring.c * relative - (spring.k if branch == 0 else spring.hard) * y[V]


def _root(spring, branch, y, end, quantity):
    """The instant in [0, end] at which a quantity of the state changes its sign."""
    return brentq(
        lambda t: quantity(_flow(spring, branch, y, t)), 0.0, end, xtol=1e-15, rtol=8.9e-16, maxiter=200
    )


def _yields(spring, y, last, span, p, touching):
    """Instant and direction of the next yield while elastic, if there is one in this span."""
    hits = []
    for sign in (1, -1):

        def room(state, sign=sign):
            return spring.limit - sign * (state[U] - p)

        if sign == touching or room(y) <= 0.0:
            at_rest = y[V] == 0.0 and sign * (_total(spring, 0, y) - y[A]) > 0.0
            if sign * y[V] > 0.0 or at_rest:
                hits.append((0.0, sign))
        elif room(last) < 0.0:
            hits.append((_root(spring, 0, y, span, room), sign))
        elif sign * y[V] > 0.0 > sign * last[V]:  # a turn inside, which may pass the limit
            top = _root(spring, 0, y, span, lambda state: state[V])
            if room(_flow(spring, 0, y, top)) < 0.0:
                hits.append((_root(spring, 0, y, top, room), sign))
    return min(hits, default=None)


def _unloads(spring, branch, y, last, span):
    """Instant at which the velocity returns to zero while yielding, if there is one in this span."""
    if branch * last[V] <= 0.0 < branch * y[V]:
        return _root(spring, branch, y, span, lambda state: state[V]), 0
    relative = [branch * (_total(spring, branch, state) - state[A]) for state in (y, last)]
    if branch * min(y[V] * branch, last[V] * branch) >= 0.0 and relative[0] < 0.0 < relative[1]:
        bottom = _root(spring, branch, y, span, lambda state: _total(spring, branch, state) - state[A])
        if branch * _flow(spring, branch, y, bottom)[V] < 0.0:  # a dip of the velocity inside
            return _root(spring, branch, y, bottom, lambda state: state[V]), 0
    return None


def bilinear(ground, dt, *, period, damping_ratio, hardening_ratio, strength, free=0.0):
    """Return peaks of |u| and |u'' + a|, plastic offset, plastic travel and number of yields and unloadings.

    free: s of rest of the ground after the record.
    """
    omega = 2.0 * np.pi / period
    k, alpha = omega**2, hardening_ratio
    spring = Spring(2.0 * damping_ratio * omega, k, alpha * k, (1.0 - alpha) * strength, strength / k)
    fine = max(FINE, int(np.ceil(FINE * dt * omega)))
    u = v = p = travel = peak_u = peak_a = 0.0
    branch = events = touching = 0
    steps = ground.size - 1
    for n in range(steps + round(free / dt)):
        if n > steps and branch == 0:  # no energy left to yield with, nor for a larger displacement
            swing = np.hypot(u - (1.0 - alpha) * p, v / omega)
            if abs(alpha * p) + swing < 0.999 * spring.limit and (1.0 - alpha) * abs(p) + swing < peak_u:
                break
        start, end = (ground[n], ground[n + 1]) if n < steps else (0.0, 0.0)
        slope = (end - start) / dt
        time = 0.0
        y = np.array([u, v, start, slope, 0.0])
        while dt - time > 1e-14 * dt:
            y[PUSH] = (1.0 - alpha) * k * p if branch == 0 else -branch * spring.force
            span = dt / fine if dt - time > dt / fine * (1.0 + 1e-9) else dt - time
            last = _ahead(spring, branch, y, span)
            if branch == 0:
                hit = _yields(spring, y, last, span, p, touching)
            else:
                hit = _unloads(spring, branch, y, last, span)
            done = span
            if hit is not None:
                done = hit[0]
                last = _flow(spring, branch, y, done)
            if done > 0.0 and y[V] * last[V] < 0.0:
                turn = _root(spring, branch, y, done, lambda state: state[V])
                peak_u = max(peak_u, abs(_flow(spring, branch, y, turn)[U]))
            rates = [_total_rate(spring, branch, state) for state in (y, last)]
            if done > 0.0 and rates[0] * rates[1] < 0.0:
                turn = _root(spring, branch, y, done, lambda state, b=branch: _total_rate(spring, b, state))
                peak_a = max(peak_a, abs(_total(spring, branch, _flow(spring, branch, y, turn))))
            peak_u = max(peak_u, abs(last[U]))
            peak_a = max(peak_a, *(abs(_total(spring, branch, state)) for state in (y, last)))
            if branch != 0:
                travel += branch * (last[U] - y[U])
                p = last[U] - branch * spring.limit
            time += done
            y = last.copy()
            touching = 0
            if hit is not None:
                events += 1
                touching = branch
                if branch != 0:
                    y[V] = 0.0
                branch = hit[1]
        u, v = y[U], y[V]
    return peak_u, peak_a, p, travel, events
