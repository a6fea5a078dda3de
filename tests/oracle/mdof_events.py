"""A slow N-storey stick-slip integrator that imports nothing from fdspec.

Double precision, scipy's matrix exponential, one constrained system a phase pattern: with T the matrix of the
motions that the sticking storeys leave, u' = T q', the system T'MT q'' + T'CT q' + T'K u = -T'M1 a_g - T'f
advances exactly, and the reaction of a sticking storey is what its floor's own equation lacks. Sub-steps of
1/POINTS_PER_PERIOD of the shortest period; sign changes by ``brentq``; minima that might reach zero by
``minimize_scalar``.

State: z = [u (2N), u' (2N), a_g, a_g', 1], floors first, then braces, relative to the ground.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh, eigvals, expm
from scipy.optimize import brentq, minimize_scalar

Array = NDArray[np.float64]

POINTS_PER_PERIOD = 40
CHUNK = 32
MOST_TRANSITIONS = 100_000


@dataclass(frozen=True)
class Frame:
    """M (2N,), K and C (2N, 2N), slip forces (N,)."""

    mass: Array
    stiffness: Array
    damping: Array
    static_force: Array
    kinetic_force: Array

    @property
    def storeys(self) -> int:
        return len(self.static_force)


def modal_damping(mass: Array, stiffness: Array, ratio: float) -> Array:
    """Damping matrix of the bare frame with one ratio in every mode."""
    squares, modes = eigh(stiffness, np.diag(mass))
    weighted = mass[:, None] * modes
    return weighted @ np.diag(2.0 * ratio * np.sqrt(squares)) @ weighted.T


def chain(coefficients: ArrayLike) -> Array:
    """Matrix of springs (or dashpots) that join each floor to the one below."""
    k = np.asarray(coefficients, dtype=float)
    n = len(k)
    matrix = np.zeros((n, n))
    for i in range(n):
        matrix[i, i] += k[i]
        if i > 0:
            matrix[i - 1, i - 1] += k[i]
            matrix[i, i - 1] -= k[i]
            matrix[i - 1, i] -= k[i]
    return matrix


def frame(
    floor_mass: ArrayLike,
    storey_stiffness: ArrayLike,
    brace_mass: ArrayLike,
    brace_stiffness: ArrayLike,
    slip_force: ArrayLike,
    *,
    damping_ratio: float = 0.0,
    frame_damping: Array | None = None,
    brace_damping: ArrayLike | None = None,
    kinetic_slip_force: ArrayLike | None = None,
) -> Frame:
    m_f, m_d = np.asarray(floor_mass, dtype=float), np.asarray(brace_mass, dtype=float)
    k_d = np.asarray(brace_stiffness, dtype=float)
    n = len(m_f)
    c_d = np.zeros(n) if brace_damping is None else np.asarray(brace_damping, dtype=float)
    k_frame = chain(storey_stiffness)
    c_frame = modal_damping(m_f, k_frame, damping_ratio) if frame_damping is None else frame_damping
    stiffness, damping = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    stiffness[:n, :n], damping[:n, :n] = k_frame, c_frame
    for matrix, coefficients in ((stiffness, k_d), (damping, c_d)):
        for i in range(n):
            brace = n + i
            matrix[brace, brace] += coefficients[i]
            if i > 0:
                floor = i - 1
                matrix[floor, floor] += coefficients[i]
                matrix[floor, brace] -= coefficients[i]
                matrix[brace, floor] -= coefficients[i]
    static = np.asarray(slip_force, dtype=float)
    kinetic = static if kinetic_slip_force is None else np.asarray(kinetic_slip_force, dtype=float)
    return Frame(np.concatenate([m_f, m_d]), stiffness, damping, static, kinetic)


@dataclass
class History:
    """Peaks per floor; transitions (time s, storey from 0, new phase); final state (2N,); SI units."""

    peak_acceleration: Array
    peak_displacement: Array
    transitions: list[tuple[float, int, int]] = field(default_factory=list)
    final_displacement: Array = field(default_factory=lambda: np.zeros(0))
    final_velocity: Array = field(default_factory=lambda: np.zeros(0))


class Pattern:
    """The linear system of one tuple of phases."""

    def __init__(self, frame: Frame, phases: tuple[int, ...]) -> None:
        n = frame.storeys
        size = 2 * n
        self.phases = phases
        stuck = [i for i in range(n) if phases[i] == 0]
        keep = [*range(n), *(n + i for i in range(n) if phases[i] != 0)]
        motions = np.zeros((size, len(keep)))
        for column, index in enumerate(keep):
            motions[index, column] = 1.0
        for i in stuck:
            motions[n + i, i] = 1.0
        friction = np.zeros(size)
        for i in range(n):
            if phases[i] != 0:
                friction[i] = phases[i] * frame.kinetic_force[i]
                friction[n + i] = -friction[i]
        mass = np.diag(frame.mass)
        reduced = np.linalg.inv(motions.T @ mass @ motions)
        self.matrix = np.zeros((2 * size + 3, 2 * size + 3))
        u, v, ground, slope, one = slice(0, size), slice(size, 2 * size), 2 * size, 2 * size + 1, 2 * size + 2
        # u'' = T (T'MT)^-1 T' (-M 1 a_g - C u' - K u - f)
        project = motions @ reduced @ motions.T
        self.matrix[u, v] = np.eye(size)
        self.matrix[v, u] = -project @ frame.stiffness
        self.matrix[v, v] = -project @ frame.damping
        self.matrix[v, ground] = -(project @ frame.mass)
        self.matrix[v, one] = -project @ friction
        self.matrix[ground, slope] = 1.0

        rates = eigvals(self.matrix[: 2 * size, : 2 * size])
        self.longest_step = 2.0 * math.pi / (POINTS_PER_PERIOD * max(1.0, float(np.max(np.abs(rates)))))

        # R = -(M (u'' + 1 a_g) + C u' + K u), the floors' rows.
        absolute = self.matrix[v].copy()
        absolute[:, ground] += 1.0
        lack = -(mass @ absolute)
        lack[:, u] -= frame.stiffness
        lack[:, v] -= frame.damping
        self.reaction = lack[:n]
        self.acceleration = absolute[:n]
        rows, owners = [], []
        for i in range(n):
            if frame.static_force[i] == 0.0 or (phases[i] == 0 and math.isinf(frame.static_force[i])):
                continue
            if phases[i] == 0:
                for sign in (-1.0, 1.0):
                    row = sign * self.reaction[i]
                    row[one] += frame.static_force[i]
                    rows.append(row)
                    owners.append(i)
            else:
                row = np.zeros(2 * size + 3)
                row[size + i], row[size + n + i] = phases[i], -phases[i]
                rows.append(row)
                owners.append(i)
        self.conditions = np.array(rows).reshape(len(rows), 2 * size + 3)
        self.owners = owners
        self._steps: dict[float, Array] = {}

    def stack(self, h: float) -> Array:
        if h not in self._steps:
            if len(self._steps) > 8:
                self._steps.clear()
            self._steps[h] = expm(self.matrix * (h * np.arange(1, CHUNK + 1))[:, None, None])
        return self._steps[h]

    def advance(self, z: Array, tau: float) -> Array:
        return np.asarray(expm(self.matrix * tau) @ z)


class Integrator:
    def __init__(self, frame: Frame) -> None:
        self.frame = frame
        self.patterns: dict[tuple[int, ...], Pattern] = {}
        n = frame.storeys
        self.result = History(np.zeros(n), np.zeros(n))

    def pattern(self, phases: tuple[int, ...]) -> Pattern:
        if phases not in self.patterns:
            self.patterns[phases] = Pattern(self.frame, phases)
        return self.patterns[phases]

    def first_event(
        self, pattern: Pattern, states: Array, h: float, fresh: dict[int, int]
    ) -> tuple[int, float, list[int]] | None:
        """Sub-step, time in it and the storeys whose condition fails first.

        ``fresh``: storey -> how many leading Taylor coefficients of its condition vanish.
        """
        if len(pattern.conditions) == 0:
            return None
        values = states @ pattern.conditions.T
        slopes = states @ (pattern.conditions @ pattern.matrix).T
        reach = 2 * h * (np.abs(slopes[:-1]) + np.abs(slopes[1:]))
        dips = (slopes[:-1] < 0) & (slopes[1:] > 0) & (np.minimum(values[:-1], values[1:]) < reach)
        suspects = (values[1:] <= 0) | dips
        for row, owner in enumerate(pattern.owners):
            suspects[0, row] |= owner in fresh
        for index in np.nonzero(suspects.any(axis=1))[0]:
            roots: list[tuple[float, int]] = []
            for row in np.nonzero(suspects[index])[0]:
                order = fresh.get(pattern.owners[row], 0) if index == 0 else 0
                root = self.first_zero(pattern, pattern.conditions[row], states[index], h, order)
                if root is not None:
                    roots.append((root, pattern.owners[row]))
            if roots:
                first = min(roots)[0]
                return int(index), first, [owner for root, owner in roots if root - first <= 1e-15]
        return None

    @staticmethod
    def first_zero(pattern: Pattern, row: Array, z: Array, h: float, order: int) -> float | None:
        """First zero of row . z(tau) on (0, h]; ``order`` leading Taylor coefficients are zero."""

        def series(tau: float) -> float:
            # Taylor terms from ``order`` on, divided by tau**order: no cancellation next to a known zero.
            total, term = 0.0, z
            for k in range(1, order + 1):
                term = pattern.matrix @ term / k
            for k in range(order, order + 20):
                total += float(row @ term) * tau ** (k - order)
                term = pattern.matrix @ term / (k + 1)
            return total

        def value(tau: float) -> float:
            return series(tau) if order else float(row @ pattern.advance(z, tau))

        left, right = value(0.0), value(h)
        if left <= 0.0:
            return 0.0
        if right <= 0.0:
            return float(brentq(value, 0.0, h, xtol=1e-18, rtol=1e-15))
        found = minimize_scalar(value, bounds=(0.0, h), method="bounded", options={"xatol": 1e-9 * h})
        if found.fun <= 0.0:
            return float(brentq(value, 0.0, found.x, xtol=1e-18, rtol=1e-15))
        return None

    def observe(self, pattern: Pattern, states: Array, h: float) -> None:
        n = self.frame.storeys
        displacement = np.zeros((n, states.shape[1]))
        displacement[:, :n] = np.eye(n)
        for rows, peaks in (
            (pattern.acceleration, self.result.peak_acceleration),
            (displacement, self.result.peak_displacement),
        ):
            values, slopes = states @ rows.T, states @ (rows @ pattern.matrix).T
            np.maximum(peaks, np.max(np.abs(values), axis=0), out=peaks)
            if len(states) < 2:
                continue
            reach = np.maximum(np.abs(values[:-1]), np.abs(values[1:]))
            reach = reach + h * np.maximum(np.abs(slopes[:-1]), np.abs(slopes[1:]))
            for index, column in np.argwhere((slopes[:-1] * slopes[1:] < 0) & (reach > peaks)):
                z, slope = states[index], rows[column] @ pattern.matrix
                ends = slope @ z, slope @ pattern.advance(z, h)
                if ends[0] * ends[1] >= 0:
                    continue
                tau = brentq(lambda t, z=z, s=slope: s @ pattern.advance(z, t), 0.0, h, xtol=1e-18)
                peaks[column] = max(peaks[column], abs(rows[column] @ pattern.advance(z, tau)))

    def run(self, samples: Array, dt: float, displacement: Array | None, velocity: Array | None) -> History:
        frame, result = self.frame, self.result
        n = frame.storeys
        z = np.zeros(4 * n + 3)
        z[-1] = 1.0
        z[-3], z[-2] = samples[0], (samples[1] - samples[0]) / dt
        if displacement is not None:
            z[: 2 * n] = displacement
        if velocity is not None:
            z[2 * n : 4 * n] = velocity
        phases = [0] * n
        for i in range(n):
            sliding = z[2 * n + i] - z[3 * n + i]
            phases[i] = int(np.sign(sliding)) if frame.static_force[i] > 0 else 1
        fresh: dict[int, int] = {}
        for step in range(len(samples) - 1):
            z[-3], z[-2] = samples[step], (samples[step + 1] - samples[step]) / dt
            left = dt
            while left > 0.0:
                pattern = self.pattern(tuple(phases))
                count = max(1, math.ceil(left / pattern.longest_step))
                h = left / count
                done, storeys = 0, []
                while done < count and not storeys:
                    size = min(CHUNK, count - done)
                    states = np.concatenate([z[None], pattern.stack(h)[:size] @ z])
                    event = self.first_event(pattern, states, h, fresh)
                    if event is None:
                        self.observe(pattern, states, h)
                        z, done, fresh = states[-1], done + size, {}
                        continue
                    index, tau, storeys = event
                    self.observe(pattern, states[: index + 1], h)
                    z = pattern.advance(states[index], tau)
                    self.observe(pattern, np.stack([states[index], z]), tau)
                    left -= (done + index) * h + tau
                if not storeys:
                    break
                fresh = self.change(pattern, phases, z, storeys, (step + 1) * dt - left)
        self.observe(self.pattern(tuple(phases)), z[None], 0.0)
        result.final_displacement, result.final_velocity = z[: 2 * n].copy(), z[2 * n : 4 * n].copy()
        return result

    def change(
        self, pattern: Pattern, phases: list[int], z: Array, storeys: list[int], time: float
    ) -> dict[int, int]:
        """New phases of the storeys whose condition failed; returns the vanishing order of each."""
        frame = self.frame
        n = frame.storeys
        fresh: dict[int, int] = {}
        for i in storeys:
            if phases[i] == 0:
                reaction = pattern.reaction[i] @ z
                following = 1 if reaction > 0 else -1
                fresh[i] = 2 if frame.static_force[i] == frame.kinetic_force[i] else 1
            else:
                z[3 * n + i] = z[2 * n + i]
                tried = [*phases]
                tried[i] = 0
                reaction = self.pattern(tuple(tried)).reaction[i] @ z
                if abs(reaction) <= frame.static_force[i]:
                    following = 0
                else:
                    following = 1 if reaction > 0 else -1
                    fresh[i] = 1
            if following != phases[i]:
                self.result.transitions.append((time, i, following))
            if len(self.result.transitions) > MOST_TRANSITIONS:
                raise RuntimeError(f"more than {MOST_TRANSITIONS} transitions")
            phases[i] = following
        return fresh


def integrate(
    frame: Frame,
    acceleration: ArrayLike,
    dt: float,
    *,
    displacement: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
) -> History:
    """Integrate N storeys under samples (m/s2) ``dt`` apart, linear in between.

    It starts at rest, or at ``displacement`` and ``velocity`` (2N,).
    """
    initial = [None if x is None else np.asarray(x, dtype=float) for x in (displacement, velocity)]
    return Integrator(frame).run(np.asarray(acceleration, dtype=float), dt, *initial)
