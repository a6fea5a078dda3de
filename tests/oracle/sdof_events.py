"""A slow single-storey stick-slip integrator that imports nothing from fdspec.

Everything is done the plain way, in extended precision (``numpy.longdouble``) so that what it disagrees with
is not its own rounding: the phase's linear system with its forcing is one matrix, advanced in sub-steps of a
fortieth of its shortest period by the matrix's own power series; every condition is looked at at the ends of
all sub-steps; where it changes sign, or has a minimum that might reach zero, the series of that one sub-step
is bisected.

State: z = [u_f, u_d, v_f, v_d, a_g, a_g', 1] (displacements relative to the ground, m).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tests.cells import FLOOR_MASS, Cell

Real = np.longdouble
Array = NDArray[np.longdouble]

POINTS_PER_PERIOD = 40
TERMS = 20
CHUNK = 64
MOST_TRANSITIONS = 200_000
STICK = 0

U_F, U_D, V_F, V_D, GROUND, GROUND_SLOPE, ONE = range(7)


@dataclass(frozen=True)
class Storey:
    """Masses kg, stiffnesses N/m, dampings N s/m, slip forces N; kinetic by default as static."""

    floor_mass: float
    floor_stiffness: float
    floor_damping: float
    brace_mass: float
    brace_stiffness: float
    brace_damping: float = 0.0
    static_force: float = math.inf
    kinetic_force: float | None = None

    @classmethod
    def from_period(
        cls,
        period: float,
        stiffness_ratio: float,
        slip_force: float,
        floor_mass: float = 20e3,
        brace_mass: float = 50.0,
        damping_ratio: float = 0.05,
        brace_damping_ratio: float = 0.0,
        kinetic_force: float | None = None,
    ) -> Storey:
        omega = 2.0 * math.pi / period
        stiffness = floor_mass * omega**2
        brace_stiffness = stiffness_ratio * stiffness
        return cls(
            floor_mass,
            stiffness,
            2.0 * damping_ratio * floor_mass * omega,
            brace_mass,
            brace_stiffness,
            2.0 * brace_damping_ratio * math.sqrt(brace_stiffness * brace_mass),
            slip_force,
            kinetic_force,
        )

    @property
    def sliding_force(self) -> float:
        return self.static_force if self.kinetic_force is None else self.kinetic_force


@dataclass
class History:
    """What one history came to; SI units.

    ``closest_call`` says how near, relatively, any decision (touch or not, stick or not) was to the other.
    """

    peak_acceleration: float = 0.0
    peak_displacement: float = 0.0
    peak_velocity: float = 0.0
    peak_base_shear: float = 0.0
    transitions: list[tuple[float, int]] = field(default_factory=list)
    final_displacement: tuple[float, float] = (0.0, 0.0)
    final_velocity: tuple[float, float] = (0.0, 0.0)
    slip_travel: float = 0.0
    input_energy: float = 0.0
    viscous_energy: float = 0.0
    friction_energy: float = 0.0
    initial_energy: float = 0.0
    final_energy: float = 0.0
    closest_call: float = math.inf

    @property
    def energy_error(self) -> float:
        """Input minus everything it went into, relative to input plus what was there at the start."""
        out = self.final_energy - self.initial_energy + self.viscous_energy + self.friction_energy
        return abs(self.input_energy - out) / max(abs(self.input_energy), self.initial_energy, 1e-300)


def dynamics(storey: Storey, phase: int) -> Array:
    """The matrix A of z' = A z in one phase."""
    m_f, k_f, c_f = Real(storey.floor_mass), Real(storey.floor_stiffness), Real(storey.floor_damping)
    m_d, k_d, c_d = Real(storey.brace_mass), Real(storey.brace_stiffness), Real(storey.brace_damping)
    a = np.zeros((7, 7), dtype=Real)
    a[U_F, V_F] = a[U_D, V_D] = a[GROUND, GROUND_SLOPE] = 1
    if phase == STICK:
        mass = m_f + m_d
        for row in (V_F, V_D):
            a[row, [U_F, U_D, V_F, V_D]] = -k_f / mass, -k_d / mass, -c_f / mass, -c_d / mass
            a[row, GROUND] = -1
        return a
    friction = phase * Real(storey.sliding_force)
    a[V_F, [U_F, V_F, GROUND, ONE]] = -k_f / m_f, -c_f / m_f, -1, -friction / m_f
    if m_d > 0:
        a[V_D, [U_D, V_D, GROUND, ONE]] = -k_d / m_d, -c_d / m_d, -1, friction / m_d
    elif c_d > 0:  # c_d u_d' + k_d u_d = s F
        a[V_D, V_D] = -k_d / c_d
    else:  # k_d u_d = s F: the brace stands still
        a[U_D, V_D] = 0
    return a


class Phase:
    """One phase's matrix, its rows of interest and its powers."""

    def __init__(self, storey: Storey, phase: int) -> None:
        self.phase = phase
        self.matrix = dynamics(storey, phase)
        m_f, k_f, c_f = Real(storey.floor_mass), Real(storey.floor_stiffness), Real(storey.floor_damping)
        m_d, k_d, c_d = Real(storey.brace_mass), Real(storey.brace_stiffness), Real(storey.brace_damping)
        rates = [Real(1)]
        masses = [m_f + m_d] if phase == STICK else [m_f, m_d]
        pairs = [(k_f + k_d, c_f + c_d)] if phase == STICK else [(k_f, c_f), (k_d, c_d)]
        for mass, (k, c) in zip(masses, pairs, strict=True):
            if mass > 0:
                rates.append(max(np.sqrt(k / mass), c / mass))
            elif c > 0:
                rates.append(k / c)
        self.longest_step = Real(2) * Real(np.pi) / (POINTS_PER_PERIOD * max(rates))

        acceleration = self.matrix[V_F].copy()
        acceleration[GROUND] += 1
        # What columns and inertia leave to the damper: R = -(m_f (u_f'' + a_g) + c_f v_f + k_f u_f).
        self.reaction = -m_f * acceleration
        self.reaction[U_F] -= k_f
        self.reaction[V_F] -= c_f
        shear = np.zeros(7, dtype=Real)
        shear[[U_F, U_D, V_F, V_D]] = k_f, k_d, c_f, c_d
        unit = np.eye(7, dtype=Real)
        self.peaks = np.stack([acceleration, unit[U_F], unit[V_F], shear])

        self.conditions: list[Array] = []
        if phase != STICK:
            self.conditions = [phase * (unit[V_F] - unit[V_D])]
        elif math.isfinite(storey.static_force):
            limit = Real(storey.static_force) * unit[ONE]
            self.conditions = [limit - self.reaction, limit + self.reaction]
        self._stacks: dict[tuple[float, int], Array] = {}

    def series(self, row: Array, z: Array) -> Array:
        """Coefficients c_k of row . z(tau) = sum c_k tau^k."""
        coefficients = np.empty(TERMS, dtype=Real)
        for k in range(TERMS):
            coefficients[k] = row @ z
            z = self.matrix @ z / (k + 1)
        return coefficients

    def advance(self, z: Array, tau: Real) -> Array:
        """z(tau) for tau within a sub-step."""
        total, term = z.copy(), z
        for k in range(1, TERMS):
            term = self.matrix @ term * (tau / k)
            total = total + term
        return total

    def stack(self, h: Real, count: int) -> Array:
        """exp(A h j), j = 1 .. count."""
        key = (float(h), count)
        if key not in self._stacks:
            one, term = np.eye(7, dtype=Real), np.eye(7, dtype=Real)
            for k in range(1, TERMS):
                term = term @ self.matrix * (h / k)
                one = one + term
            powers = [one]
            for _ in range(count - 1):
                powers.append(powers[-1] @ one)
            if len(self._stacks) > 16:
                self._stacks.clear()
            self._stacks[key] = np.stack(powers)
        return self._stacks[key]


def _value(c: Array, tau: Real) -> Real:
    total = Real(0)
    for coefficient in c[::-1]:
        total = total * tau + coefficient
    return total


def _slope(c: Array) -> Array:
    return c[1:] * np.arange(1, len(c))


def _bisect(c: Array, low: Real, high: Real) -> Real:
    """The point of [low, high] where a polynomial changes sign, taking for granted that it does."""
    above = _value(c, high) > 0
    while True:
        middle = (low + high) / 2
        if middle <= low or middle >= high:
            return high
        if (_value(c, middle) > 0) == above:
            high = middle
        else:
            low = middle


def _first_zero(c: Array, h: Real) -> tuple[Real | None, Real]:
    """First zero of a polynomial on [0, h], and its size at an interior minimum (inf when there is none).

    A polynomial that is not positive at 0 has its zero there.
    """
    nothing = Real(np.inf)
    if c[0] <= 0:
        return Real(0), abs(c[0])
    slope = _slope(c)
    if _value(slope, Real(0)) < 0 < _value(slope, h):
        bottom = _bisect(slope, Real(0), h)
        least = _value(c, bottom)
        if least <= 0:
            return _bisect(c, Real(0), bottom), abs(least)
        return None, least
    if _value(c, h) <= 0:
        return _bisect(c, Real(0), h), nothing
    return None, nothing


GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)


class Integrator:
    def __init__(self, storey: Storey, energies: bool) -> None:
        self.storey = storey
        self.energies = energies
        self.phases: dict[int, Phase] = {}
        self.result = History()
        self.peaks = np.zeros(4, dtype=Real)
        self.speed = Real(0)
        # [input, viscous, friction work]
        self.work = np.zeros(3, dtype=Real)
        self.travel = Real(0)
        self.closest = Real(np.inf)

    def phase(self, number: int) -> Phase:
        if number not in self.phases:
            self.phases[number] = Phase(self.storey, number)
        return self.phases[number]

    # What happens between changes of phase.

    def march(
        self, phase: Phase, z: Array, length: Real, vanishing: tuple[int, int]
    ) -> tuple[Array, Real, bool]:
        """Advance by ``length`` or to the first condition that fails: state, time used, whether one failed.

        By the mechanics ``vanishing[i]`` leading coefficients of condition i are zero at the phase's start.
        """
        count = max(1, math.ceil(length / phase.longest_step))
        h = length / count
        done = 0
        while done < count:
            size = min(CHUNK, count - done)
            states = np.concatenate([z[None], phase.stack(h, CHUNK)[:size] @ z])
            event = self.first_event(phase, states, h, vanishing)
            if event is not None:
                index, tau = event
                end = phase.advance(states[index], tau)
                self.observe(phase, states[: index + 1], h)
                self.observe(phase, np.stack([states[index], end]), tau)
                return end, (done + index) * h + tau, True
            self.observe(phase, states, h)
            z = states[-1]
            done += size
            vanishing = (0, 0)
        return z, length, False

    def first_event(
        self, phase: Phase, states: Array, h: Real, vanishing: tuple[int, int]
    ) -> tuple[int, Real] | None:
        first: tuple[int, Real] | None = None
        for row, zeros in zip(phase.conditions, vanishing, strict=False):
            value = states @ row
            slope = states @ (row @ phase.matrix)
            margin = 2 * h * (np.abs(slope[:-1]) + np.abs(slope[1:]))
            dips = (slope[:-1] < 0) & (slope[1:] > 0) & (np.minimum(value[:-1], value[1:]) < margin)
            suspects = np.nonzero((value[1:] <= 0) | dips)[0].tolist()
            if zeros and 0 not in suspects:
                suspects.insert(0, 0)
            for index in suspects:
                if first is not None and index > first[0]:
                    break
                c = phase.series(row, states[index])
                c = c[zeros:] if index == 0 and zeros else c
                root, least = _first_zero(c, h)
                scale = Real(self.storey.static_force) if phase.phase == STICK else self.slip_scale()
                self.closest = min(self.closest, least / scale)
                if root is not None and (first is None or (index, root) < first):
                    first = (index, root)
                if root is not None:
                    break
        return first

    def slip_scale(self) -> Real:
        """A velocity to measure a sliding velocity by."""
        force = Real(self.storey.sliding_force)
        if self.storey.brace_mass > 0:
            brace = np.sqrt(Real(self.storey.brace_mass) * Real(self.storey.brace_stiffness))
            return max(self.speed, force / brace)
        return max(self.speed, Real(1e-300))

    def observe(self, phase: Phase, states: Array, h: Real) -> None:
        """Peaks and energies over consecutive states h apart."""
        rows = phase.peaks
        values = states @ rows.T
        slopes = states @ (rows @ phase.matrix).T
        self.speed = max(self.speed, np.max(np.abs(states[:, [V_F, V_D]])))
        self.peaks = np.maximum(self.peaks, np.max(np.abs(values), axis=0))
        if len(states) < 2:
            return
        ends = np.maximum(np.abs(values[:-1]), np.abs(values[1:]))
        reach = ends + h * np.maximum(np.abs(slopes[:-1]), np.abs(slopes[1:]))
        turns = (slopes[:-1] * slopes[1:] < 0) & (reach > self.peaks)
        for index, column in np.argwhere(turns):
            if reach[index, column] <= self.peaks[column]:
                continue
            c = phase.series(rows[column], states[index])
            extremum = abs(_value(c, _bisect(_slope(c), Real(0), h)))
            self.peaks[column] = max(self.peaks[column], extremum)
        if phase.phase != STICK:
            offset = states[:, U_F] - states[:, U_D]
            self.travel += abs(offset[-1] - offset[0])
        if self.energies:
            self.integrate(phase, states[:-1], h)

    def integrate(self, phase: Phase, states: Array, h: Real) -> None:
        """Gauss quadrature of the three powers over the sub-steps that start at ``states``."""
        s = self.storey
        for point, weight in zip(GAUSS_POINTS, GAUSS_WEIGHTS, strict=True):
            tau = h * (1 + Real(point)) / 2
            step = np.eye(7, dtype=Real)
            term = step
            for k in range(1, TERMS):
                term = term @ phase.matrix * (tau / k)
                step = step + term
            inside = states @ step.T
            v_f, v_d = inside[:, V_F], inside[:, V_D]
            power_in = -(s.floor_mass * v_f + s.brace_mass * v_d) * inside[:, GROUND]
            viscous = s.floor_damping * v_f**2 + s.brace_damping * v_d**2
            # Zero while sticking, where the phase is 0 and the force may be infinite.
            force = phase.phase * Real(s.sliding_force) if phase.phase != STICK else Real(0)
            friction = force * (v_f - v_d)
            for i, power in enumerate((power_in, viscous, friction)):
                self.work[i] += Real(weight) * h / 2 * np.sum(power)

    # What happens at a change of phase.

    def start_slip(self, z: Array, direction: int) -> tuple[Array, tuple[int, int]]:
        """From stick at the limit."""
        s = self.storey
        equal = s.static_force == s.sliding_force
        if s.brace_mass > 0:
            return z, (2 if equal else 1, 0)
        before = z[U_D]
        z = z.copy()
        force = direction * Real(s.sliding_force)
        if s.brace_damping > 0:
            z[V_D] = (force - Real(s.brace_stiffness) * z[U_D]) / Real(s.brace_damping)
            return z, (1 if equal else 0, 0)
        z[U_D], z[V_D] = force / Real(s.brace_stiffness), 0
        jump = before - z[U_D]
        self.travel += abs(jump)
        # The brace snaps back through (F_st - F_sl)/k_d, and friction takes all that it had stored.
        self.work[2] += Real(s.brace_stiffness) * (before**2 - z[U_D] ** 2) / 2
        return z, (0, 0)

    def halt(self, z: Array, direction: int) -> tuple[Array, int, tuple[int, int]]:
        """At zero sliding velocity: state, next phase (its own for a momentary halt), vanishing orders."""
        s = self.storey
        z = z.copy()
        z[V_D] = z[V_F]
        limit = Real(s.static_force)
        if s.brace_mass == 0:  # the reaction is s F_sl on both sides of the halt
            order = 0
            if s.static_force == s.sliding_force:
                order = 1  # R' = k_d v_f + c_d v_f'
                if s.brace_damping == 0:
                    order = 2
                    z[[V_F, V_D]] = 0
            return z, STICK, (order, 0) if direction > 0 else (0, order)
        reaction = self.phase(STICK).reaction @ z
        if limit > 0:
            self.closest = min(self.closest, abs(abs(reaction) - limit) / limit)
        if abs(reaction) <= limit:
            return z, STICK, (0, 0)
        return z, 1 if reaction > 0 else -1, (1, 0)

    def energy(self, z: Array) -> Real:
        s = self.storey
        moving = s.floor_mass * z[V_F] ** 2 + s.brace_mass * z[V_D] ** 2
        return (moving + s.floor_stiffness * z[U_F] ** 2 + s.brace_stiffness * z[U_D] ** 2) / 2

    def run(
        self,
        segments: list[tuple[Real, Real, Real]],
        displacement: tuple[float, float],
        velocity: tuple[float, float],
    ) -> History:
        """``segments``: (length s, ground acceleration at its start m/s2, its slope m/s3)."""
        s = self.storey
        result = self.result
        z = np.zeros(7, dtype=Real)
        z[[U_F, U_D]], z[[V_F, V_D]], z[ONE] = displacement, velocity, 1
        z[GROUND], z[GROUND_SLOPE] = segments[0][1], segments[0][2]
        result.initial_energy = float(self.energy(z))
        free = s.static_force == 0
        vanishing = (0, 0)
        if s.brace_mass == 0:  # a massless brace has no velocity of its own
            z[V_D] = z[V_F]
        sliding = z[V_F] - z[V_D]
        reaction = self.phase(STICK).reaction @ z
        if free:
            number = 1
        elif sliding != 0:
            number = 1 if sliding > 0 else -1
        elif abs(reaction) <= Real(s.static_force):
            number = STICK
        else:
            number = 1 if reaction > 0 else -1
            result.transitions.append((0.0, number))
            z, vanishing = self.start_slip(z, number)
            vanishing = (1, 0) if s.brace_mass > 0 else vanishing
        start = Real(0)
        for length, ground, slope in segments:
            z[GROUND], z[GROUND_SLOPE] = ground, slope
            left = length
            while left > 0:
                phase = self.phase(number)
                if free:
                    z, used = self.march_free(phase, z, left)
                    break
                z, used, failed = self.march(phase, z, left, vanishing)
                left = left - used
                vanishing = vanishing if used == 0 and not failed else (0, 0)
                if not failed:
                    break
                if number == STICK:
                    following = 1 if phase.reaction @ z > 0 else -1
                    z, vanishing = self.start_slip(z, following)
                else:
                    z, following, vanishing = self.halt(z, number)
                if len(result.transitions) > MOST_TRANSITIONS:
                    raise RuntimeError(f"more than {MOST_TRANSITIONS} transitions")
                if following != number:
                    result.transitions.append((float(start + length - left), following))
                number = following
            start = start + length
        # A change at the very last instant still shows its other side.
        self.observe(self.phase(number), z[None], Real(0))
        result.peak_acceleration, result.peak_displacement = float(self.peaks[0]), float(self.peaks[1])
        result.peak_velocity, result.peak_base_shear = float(self.peaks[2]), float(self.peaks[3])
        result.final_displacement = float(z[U_F]), float(z[U_D])
        result.final_velocity = float(z[V_F]), float(z[V_D])
        result.slip_travel = float(self.travel)
        result.input_energy, result.viscous_energy, result.friction_energy = (float(w) for w in self.work)
        result.final_energy = float(self.energy(z))
        result.closest_call = float(self.closest)
        return result

    def march_free(self, phase: Phase, z: Array, length: Real) -> tuple[Array, Real]:
        """A frame and a brace that do not touch."""
        count = max(1, math.ceil(length / phase.longest_step))
        h = length / count
        done = 0
        while done < count:
            size = min(CHUNK, count - done)
            states = np.concatenate([z[None], phase.stack(h, CHUNK)[:size] @ z])
            self.observe(phase, states, h)
            z = states[-1]
            done += size
        return z, length


def of_cell(cell: Cell, slip_force: float | None = None) -> Storey:
    """The storey of a random cell, with its own slip force or this one."""
    return Storey.from_period(
        cell.period,
        cell.stiffness_ratio,
        cell.slip_force if slip_force is None else slip_force,
        FLOOR_MASS,
        cell.brace_mass,
        cell.damping_ratio,
        cell.brace_damping_ratio,
        cell.kinetic_slip_force,
    )


def integrate(
    storey: Storey,
    acceleration: ArrayLike,
    dt: float,
    *,
    displacement: tuple[float, float] = (0.0, 0.0),
    velocity: tuple[float, float] = (0.0, 0.0),
    free_vibration: float = 0.0,
    energies: bool = False,
) -> History:
    """Integrate one storey under samples (m/s2) ``dt`` apart, linear in between.

    ``free_vibration`` seconds without ground motion follow. ``displacement`` and ``velocity`` are those of
    floor and brace at the start.
    """
    samples = np.asarray(acceleration, dtype=Real)
    step = Real(dt)
    segments = [(step, samples[i], (samples[i + 1] - samples[i]) / step) for i in range(len(samples) - 1)]
    if free_vibration > 0:
        segments.append((Real(free_vibration), Real(0), Real(0)))
    return Integrator(storey, energies).run(segments, displacement, velocity)
