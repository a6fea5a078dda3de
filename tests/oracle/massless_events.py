"""A slow integrator of frames with massless braces that imports nothing from fdspec.

A massless brace has no equation of motion. With drift g = u_i - u_(i-1), slip offset o and stretch e = g - o
its force is B = k e + c e', and the law is a first-order one:

    stick    o' = 0,                      while |k e + c g'| <= F_st
    slip     k e + c e' = s F_sl,         so o' = g' + (k e - s F_sl) / c, while s o' > 0
    slip     k e = s F_sl,                so o' = g' (no dashpot), while s g' > 0

State: z = [u (N), u' (N), o (N), a_g, a_g', 1]. Between two changes it is linear, and the matrix exponential
takes it over sub-steps that are short against its fastest rate; within one of them changes of sign are
refined by ``brentq``, and minima that might reach zero by ``minimize_scalar``. A condition that is zero
where its phase begins counts from where it has left zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray
from scipy.linalg import eigvals, expm
from scipy.optimize import brentq, minimize_scalar

Array = NDArray[np.float64]

RADIANS = 0.5
"""Sub-step times the fastest rate."""
PLACES = np.linspace(0.0, 1.0, 9)
"""Where in a sub-step a slope's sign is looked at: it may change twice between the ends."""
ORDER = 22
"""Terms of the exponential's series within such a sub-step: to rounding."""
MOST_CHANGES = 20_000
NOUGHT = 1e-9
"""Share of its terms that counts as zero where a phase begins."""
SETTLED = 60.0
"""Time constants after which a dashpot's decay is over: e^-60 is below rounding."""


@dataclass(frozen=True)
class Frame:
    """Floors (N,) kg, stiffness and damping of the bare frame (N, N), massless braces (N,) each."""

    mass: Array
    stiffness: Array
    damping: Array
    spring: Array
    dashpot: Array
    static: Array
    kinetic: Array


@dataclass
class Answer:
    """Peaks per floor, changes (time, storey from 0, phase), slip travel and final floors and offsets."""

    acceleration: Array
    displacement: Array
    travel: Array
    changes: list[tuple[float, int, int]] = field(default_factory=list)
    final: Array = field(default_factory=lambda: np.zeros(0))


class Pattern:
    """The linear system of one tuple of phases; ``loose``: slips that are quasi-static."""

    def __init__(self, frame: Frame, phases: tuple[int, ...], loose: tuple[bool, ...]) -> None:
        n = len(frame.mass)
        size = 3 * n + 3
        drift = np.eye(n) - np.eye(n, k=-1)
        g, rate, offset, force = (np.zeros((n, size)) for _ in range(4))
        g[:, :n] = drift
        rate[:, n : 2 * n] = drift
        offset[:, 2 * n : 3 * n] = np.eye(n)
        slide = np.zeros((n, size))
        for i in range(n):
            if phases[i] == 0:
                force[i] = frame.spring[i] * (g[i] - offset[i]) + frame.dashpot[i] * rate[i]
                continue
            force[i, -1] = phases[i] * frame.kinetic[i]
            slide[i] = rate[i]
            if not loose[i]:
                excess = frame.spring[i] * (g[i] - offset[i])
                excess[-1] -= force[i, -1]
                slide[i] += excess / frame.dashpot[i]
        total = -drift.T @ force
        total[:, :n] -= frame.stiffness
        total[:, n : 2 * n] -= frame.damping
        self.acceleration = total / frame.mass[:, None]
        self.matrix = np.zeros((size, size))
        self.matrix[:n, n : 2 * n] = np.eye(n)
        self.matrix[n : 2 * n] = self.acceleration
        self.matrix[n : 2 * n, -3] -= 1.0
        self.matrix[2 * n : 3 * n] = slide
        self.matrix[-3, -2] = 1.0
        self.slide = slide
        rates = np.abs(eigvals(self.matrix[: 3 * n, : 3 * n]))
        self.longest = RADIANS / max(1.0, float(rates.max()))
        self.rows: list[Array] = []
        self.owners: list[int] = []
        for i in range(n):
            if phases[i] != 0:
                if frame.static[i] > 0.0:
                    self.rows.append(phases[i] * slide[i])
                    self.owners.append(i)
            elif frame.spring[i] > 0.0 and math.isfinite(frame.static[i]):
                for sign in (1.0, -1.0):
                    row = -sign * force[i]
                    row[-1] += frame.static[i]
                    self.rows.append(row)
                    self.owners.append(i)
        self.conditions = np.array(self.rows).reshape(len(self.rows), size)
        self._steps: dict[float, Array] = {}

    def series(self, z: Array, h: float) -> Array:
        """Terms of exp(A h x) z over powers of x, (ORDER + 1, size)."""
        terms = [z]
        for k in range(1, ORDER + 1):
            terms.append(self.matrix @ terms[-1] * (h / k))
        return np.array(terms)

    def step(self, h: float) -> Array:
        if h not in self._steps:
            if len(self._steps) > 16:
                self._steps.clear()
            self._steps[h] = expm(self.matrix * h)
        return self._steps[h]


def first_zero(c: Array, fresh: bool) -> float | None:
    """First x in (0, 1] where the polynomial falls to zero; ``fresh``: it may be zero at x = 0."""

    def value(x: float) -> float:
        return float(polyval(x, c))

    start = 0.0
    if fresh and abs(c[0]) <= NOUGHT * np.abs(c).sum():
        start = next((x for x in np.logspace(-6, -0.01, 40) if value(x) > 0.0), 1.0)
        if start == 1.0:
            return 0.0
    elif c[0] <= 0.0:
        return 0.0
    stop = 1.0
    if value(1.0) > 0.0:
        lowest = minimize_scalar(value, bounds=(start, 1.0), method="bounded", options={"xatol": 1e-10})
        if lowest.fun > 0.0:
            return None
        stop = float(lowest.x)
    return float(brentq(value, start, stop, xtol=1e-16, rtol=1e-15))


class Integrator:
    """One history; `run` returns its answer."""

    def __init__(self, frame: Frame) -> None:
        self.frame = frame
        self.n = len(frame.mass)
        self.patterns: dict[tuple[tuple[int, ...], tuple[bool, ...]], Pattern] = {}
        self.answer = Answer(*(np.zeros(self.n) for _ in range(3)))
        self.phases = [0] * self.n
        self.since = np.zeros(self.n)

    def pattern(self, now: float) -> Pattern:
        frame = self.frame
        loose = tuple(
            self.phases[i] != 0
            and (
                frame.dashpot[i] == 0.0
                or (now - self.since[i]) * frame.spring[i] > SETTLED * frame.dashpot[i]
            )
            for i in range(self.n)
        )
        key = (tuple(self.phases), loose)
        if key not in self.patterns:
            self.patterns[key] = Pattern(frame, *key)
        return self.patterns[key]

    def drift(self, z: Array, i: int) -> tuple[float, float]:
        n = self.n
        below = (z[i - 1], z[n + i - 1]) if i > 0 else (0.0, 0.0)
        return float(z[i] - below[0]), float(z[n + i] - below[1])

    def release(self, z: Array, i: int, sign: int) -> None:
        """Slip begins; without a dashpot the brace springs to where kinetic friction holds it."""
        self.phases[i] = sign
        if self.frame.dashpot[i] == 0.0:
            offset = self.drift(z, i)[0] - sign * self.frame.kinetic[i] / self.frame.spring[i]
            self.answer.travel[i] += abs(offset - z[2 * self.n + i])
            z[2 * self.n + i] = offset

    def run(self, ground: Array, dt: float, displacement: Array, velocity: Array, offset: Array) -> Answer:
        frame, n, answer = self.frame, self.n, self.answer
        z = np.concatenate([displacement, velocity, offset, [ground[0], 0.0, 1.0]])
        fresh: set[int] = set()
        for i in range(n):
            if frame.spring[i] == 0.0:
                continue
            g, rate = self.drift(z, i)
            reaction = frame.spring[i] * (g - z[2 * n + i]) + frame.dashpot[i] * rate
            sign = 1 if reaction > 0.0 else -1
            if frame.static[i] == 0.0:
                self.release(z, i, sign)
            elif abs(reaction) > frame.static[i]:
                self.release(z, i, sign)
                answer.changes.append((0.0, i, sign))
                fresh.add(i)
                if frame.dashpot[i] == 0.0 and sign * rate < 0.0:
                    self.phases[i] = 0
                    answer.changes.append((0.0, i, 0))
        for step in range(len(ground) - 1):
            z[-3], z[-2] = ground[step], (ground[step + 1] - ground[step]) / dt
            tau = 0.0
            while tau < dt:
                pattern = self.pattern(step * dt + tau)
                h = min(pattern.longest, dt - tau)
                if dt - tau - h < 1e-3 * h:
                    h = dt - tau
                after = pattern.step(h) @ z
                found = self.first_change(pattern, z, after, h, fresh)
                if found is not None:
                    h = found[0]
                    after = pattern.series(z, h).sum(axis=0)
                self.observe(pattern, z, after, h)
                z = after
                tau = dt if found is None and h == dt - tau else tau + h
                fresh = set()
                if found is not None:
                    fresh = self.change(z, found[1], step * dt + tau)
        answer.final = z[: 3 * n].copy()
        return answer

    def first_change(
        self, pattern: Pattern, z: Array, after: Array, h: float, fresh: set[int]
    ) -> tuple[float, list[int]] | None:
        if not pattern.rows:
            return None
        values, ends = pattern.conditions @ z, pattern.conditions @ after
        slopes = pattern.conditions @ (pattern.matrix @ z)
        slopes_end = pattern.conditions @ (pattern.matrix @ after)
        dips = (slopes < 0.0) & (slopes_end > 0.0)
        dips &= np.minimum(values, ends) < h * np.maximum(-slopes, slopes_end)
        suspects = np.nonzero((ends <= 0.0) | dips | (values <= 0.0))[0]
        if suspects.size == 0:
            return None
        terms = pattern.series(z, h)
        roots = []
        for k in suspects:
            root = first_zero(terms @ pattern.conditions[k], pattern.owners[k] in fresh)
            if root is not None:
                roots.append((root * h, pattern.owners[k]))
        if not roots:
            return None
        first = min(roots)[0]
        return first, [owner for root, owner in roots if root - first <= 1e-13 * h]

    def change(self, z: Array, storeys: list[int], now: float) -> set[int]:
        for i in set(storeys):
            if self.phases[i] == 0:
                g, rate = self.drift(z, i)
                reaction = self.frame.spring[i] * (g - z[2 * self.n + i]) + self.frame.dashpot[i] * rate
                self.release(z, i, 1 if reaction > 0.0 else -1)
                self.since[i] = now
            else:
                self.phases[i] = 0
            self.answer.changes.append((now, i, self.phases[i]))
        if len(self.answer.changes) > MOST_CHANGES:
            raise RuntimeError(f"more than {MOST_CHANGES} changes of phase")
        return set(storeys)

    def observe(self, pattern: Pattern, z: Array, after: Array, h: float) -> None:
        n, answer = self.n, self.answer
        for i in range(n):
            # Where there is friction the sliding velocity keeps its sign.
            answer.travel[i] += abs(after[2 * n + i] - z[2 * n + i])
        still = np.hstack([np.eye(n), np.zeros((n, 2 * n + 3))])
        for rows, peaks in ((pattern.acceleration, answer.acceleration), (still, answer.displacement)):
            a, b = rows @ z, rows @ after
            np.maximum(peaks, np.maximum(np.abs(a), np.abs(b)), out=peaks)
            c = pattern.series(z, h)
            slope = c @ (rows @ pattern.matrix).T
            signs = np.sign(polyval(PLACES, slope))
            for i, k in zip(*np.nonzero(signs[:, 1:] * signs[:, :-1] < 0.0), strict=True):
                x = float(brentq(polyval, PLACES[k], PLACES[k + 1], args=(slope[:, i],), xtol=1e-15))
                peaks[i] = max(peaks[i], abs(polyval(x, c @ rows[i])))
