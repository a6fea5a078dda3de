"""One storey with devices by matrix exponentials and bracketed roots; imports nothing from fdspec.

Floor (u, v) and brace (d, e), a friction damper between them, columns that yield, a slot that ends, a
re-centring spring across the slider, gravity.  The state (u, v, d, e, a, slope, 1, p) of every combination of
modes obeys y' = A y.  A record step is sampled many times a radian of the brace; a guard that changes its
sign between two samples is located by Brent's method on the exponential itself.  Slow and plain.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

U, V, D, E, A, SLOPE, ONE, P = range(8)

PER_RADIAN = 16
"""Samples in a radian of the fastest vibration."""

TIGHT = 1e-9
"""Share of a limit within which a guard that has just changed counts as zero."""


class Mode(NamedTuple):
    """Damper: 0 stick, or the direction of slip; columns: 0 elastic, or that of yielding; slot: 0 free."""

    damper: int
    column: int
    slot: int


@dataclass
class Storey:
    """SI units; infinite limits are never reached."""

    floor_mass: float
    stiffness: float
    damping: float
    brace_mass: float
    brace_stiffness: float
    slip_force: float
    kinetic_slip_force: float
    brace_damping: float = 0.0
    yield_shear: float = np.inf
    hardening_ratio: float = 0.0
    gravity: float = 0.0
    """P/h, N/m."""
    slot_length: float = np.inf
    slot_stiffness: float = 0.0
    recentring: float = 0.0
    cache: dict = field(default_factory=dict, repr=False)

    @property
    def yield_drift(self):
        return self.yield_shear / self.stiffness

    def rows(self, mode):
        """Rows over the state: floor's and brace's relative acceleration, and the friction force."""
        if mode in self.cache:
            return self.cache[mode]
        eye = np.eye(8)
        soft = self.hardening_ratio * self.stiffness
        hard = self.stiffness - soft
        shear = soft * eye[U] - self.gravity * eye[U] + self.damping * eye[V]
        if mode.column == 0:
            shear += hard * (eye[U] - eye[P])
        else:
            shear += mode.column * hard * self.yield_drift * eye[ONE]
        brace = self.brace_stiffness * eye[D] + self.brace_damping * eye[E]
        beside = self.recentring * (eye[U] - eye[D])
        if mode.slot:
            beside += self.slot_stiffness * (eye[U] - eye[D] - mode.slot * self.slot_length * eye[ONE])
        if mode.damper == 0:
            both = -(shear + brace) / (self.floor_mass + self.brace_mass) - eye[A]
            rows = both, both, self.brace_mass * (both + eye[A]) + brace - beside
        else:
            friction = mode.damper * self.kinetic_slip_force * eye[ONE]
            rows = (
                -(shear + friction + beside) / self.floor_mass - eye[A],
                (friction + beside - brace) / self.brace_mass - eye[A],
                friction,
            )
        self.cache[mode] = rows
        return rows

    def matrix(self, mode):
        floor, brace, _ = self.rows(mode)
        a = np.zeros((8, 8))
        a[U, V] = a[D, E] = a[A, SLOPE] = 1.0
        a[V], a[E] = floor, brace
        if mode.column:
            a[P, V] = 1.0
        return a

    def after(self, mode, y, time, *, keep=False):
        key = (mode, time)
        if key in self.cache:
            return self.cache[key] @ y
        flow = expm(self.matrix(mode) * time)
        if keep:
            self.cache[key] = flow
        return flow @ y

    def fastest(self):
        extra = self.brace_stiffness + self.slot_stiffness + self.recentring
        return np.sqrt(extra / self.brace_mass + (self.stiffness + extra) / self.floor_mass)


def _guards(storey, mode, y):
    """Name -> value over its limit; a mode lasts while all of its guards are positive."""
    found = {}
    if mode.damper == 0:
        if np.isfinite(storey.slip_force):
            reaction = storey.rows(mode)[2] @ y
            for sign in (1, -1):
                found["slips", sign] = (storey.slip_force - sign * reaction) / storey.slip_force
    else:
        found["stops", mode.damper] = mode.damper * (y[V] - y[E])
        if mode.slot:
            found["leaves", mode.slot] = (mode.slot * (y[U] - y[D]) - storey.slot_length) / storey.slot_length
        elif np.isfinite(storey.slot_length):
            for sign in (1, -1):
                found["meets", sign] = (storey.slot_length - sign * (y[U] - y[D])) / storey.slot_length
    if mode.column:
        found["unloads", mode.column] = mode.column * y[V]
    elif np.isfinite(storey.yield_shear):
        for sign in (1, -1):
            found["yields", sign] = (storey.yield_drift - sign * (y[U] - y[P])) / storey.yield_drift
    return found


def _change(storey, mode, y, name):
    """The mode after an event, and the event's kind in the counts, or None where it is a momentary halt."""
    what, sign = name
    if what == "slips":
        return mode._replace(damper=sign), "damper"
    if what == "stops":
        y[E] = y[V]
        held = storey.rows(mode._replace(damper=0))[2] @ y
        after = 0 if abs(held) <= storey.slip_force else int(np.sign(held))
        return mode._replace(damper=after), None if after == mode.damper else "damper"
    if what == "meets":
        return mode._replace(slot=sign), "slot"
    if what == "leaves":
        return mode._replace(slot=0), "slot"
    if what == "yields":
        return mode._replace(column=sign), "column"
    y[V] = 0.0
    return mode._replace(column=0), "column"


class Answer(NamedTuple):
    """Peaks of |u|, |u'' + a|, |slip|, |friction|; the final state; counts by kind."""

    displacement: float
    acceleration: float
    slip: float
    final: np.ndarray
    counts: dict


def integrate(storey, ground, dt):
    """Integrate one storey from rest under a ground acceleration (n,), linear between samples dt apart."""
    fine = max(4, int(np.ceil(PER_RADIAN * dt * storey.fastest())))
    span = dt / fine
    mode = Mode(0, 0, 0)
    y = np.zeros(8)
    y[ONE] = 1.0
    counts = {"damper": 0, "column": 0, "slot": 0}
    peaks = np.zeros(3)
    touching = set()
    for n in range(ground.size - 1):
        y[A], y[SLOPE] = ground[n], (ground[n + 1] - ground[n]) / dt
        for _ in range(fine):
            left = span
            while left > 0.0:
                last = storey.after(mode, y, left, keep=left == span)
                here, there = _guards(storey, mode, y), _guards(storey, mode, last)
                hits = []
                for name, value in there.items():
                    if value >= 0.0:
                        continue
                    if name in touching or here[name] <= 0.0:
                        # begins at its limit: what counts is which way it goes
                        hits.append((0.0, name))
                        continue

                    def guard(time, name=name, y=y, mode=mode):
                        return _guards(storey, mode, storey.after(mode, y, time))[name]

                    hits.append((brentq(guard, 0.0, left, xtol=1e-16, rtol=8.9e-16), name))
                done, name = min(hits, default=(left, None))
                if name is not None and done > 0.0:
                    last = storey.after(mode, y, done)
                if done > 0.0:
                    _raise(storey, mode, y, last, done, peaks)
                    touching = {known for known in touching if known in there and there[known] <= TIGHT}
                y = last if done > 0.0 else y.copy()
                left -= done
                if name is None:
                    break
                mode, kind = _change(storey, mode, y, name)
                if kind is not None:
                    counts[kind] += 1
                touching = {known for known, value in _guards(storey, mode, y).items() if abs(value) <= TIGHT}
                _raise(storey, mode, y, y, 0.0, peaks)
                if left <= 1e-13 * span:
                    break
    return Answer(peaks[0], peaks[1], peaks[2], y, counts)


def _raise(storey, mode, y, last, time, peaks):
    """Peaks of the two ends and of an extremum in between, where a derivative changes its sign."""
    eye = np.eye(8)
    flow = storey.matrix(mode)
    for k, row in enumerate((eye[U], storey.rows(mode)[0] + eye[A], eye[U] - eye[D])):
        peaks[k] = max(peaks[k], abs(row @ y), abs(row @ last))
        rate = row @ flow
        if time > 0.0 and (rate @ y) * (rate @ last) < 0.0:
            turn = brentq(
                lambda t, rate=rate: rate @ storey.after(mode, y, t), 0.0, time, xtol=1e-16, rtol=8.9e-16
            )
            peaks[k] = max(peaks[k], abs(row @ storey.after(mode, y, turn)))
