"""Histories by a general integrator: scipy's DOP853 with events, one call for each phase and sample.

Slow and plain; it shares nothing with the engines but the building's numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import noise, shaking, two_storeys
from fdspec.verification.row import Row, absolute, relative, same_count

WITHIN = 1e-7
RTOL = 1e-10
NEVER_ZERO = 1e-9
"""s after its start in which a slip is not asked whether it has stopped: it begins at zero."""


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    cases: dict[str, tuple[Building, GroundMotion]] = {
        "one storey": (storey(600.0, 45e3), shaking(5.0)),
        "one storey, kinetic friction 0.6 of static": (
            storey(600.0, 45e3, 27e3),
            noise(2.5, 0.02, seed=5),
        ),
        "one storey, damped brace": (
            storey(300.0, 45e3, brace_damping=4e3),
            noise(4.0, 0.02, seed=3),
        ),
        "two storeys": (two_storeys(), noise(2.5, 0.02, seed=7)),
    }
    if full:
        cases["two storeys, kinetic friction 0.8 of static"] = (
            two_storeys(kinetic=0.8),
            noise(2.5, 0.02, seed=9),
        )
        cases["one storey, 20 s"] = (storey(600.0, 45e3), shaking(20.0))
    for name, (building, motion) in cases.items():
        history = simulate(building, motion)
        found = General(building, motion).run()
        case = f"DOP853 with events, {name}"
        for i in range(building.n_storeys):
            quantity = "peak acceleration, m/s2" if building.n_storeys == 1 else f"peak, floor {i + 1}, m/s2"
            computed = float(history["peak_acceleration"][i])
            yield relative(case, quantity, float(found.peak[i]), computed, WITHIN)
        last = float(history["displacement"][-1, -1])
        scale = float(history["peak_displacement"][-1])
        yield absolute(case, "final over peak displacement", found.u[-1] / scale, last / scale, 10 * WITHIN)
        yield same_count(case, "changes of phase", found.changes, int(history["transitions"]))


def storey(
    brace_mass: float, slip_force: float, kinetic: float | None = None, brace_damping: float = 0.0
) -> Building:
    """Make the single-storey frame of these cases, 0.5 s, with a brace heavy enough for a general solver."""
    return Building(20e3, 3.2e6, brace_mass, 12.8e6, slip_force, kinetic, ModalDamping(0.05), brace_damping)


@dataclass
class General:
    """One history, phase by phase."""

    building: Building
    motion: GroundMotion
    changes: int = 0
    tops: list[tuple[float, int, Callable[[float], FloatArray], float, float, tuple[int, ...]]] = field(
        default_factory=list
    )

    def __post_init__(self) -> None:
        b = self.building
        n = b.n_storeys
        self.n = n
        self.peak = np.zeros(n)
        self.u = np.zeros(n)
        self.phase = np.zeros(n, np.int64)
        # Of a brace standing by itself: nothing moves faster.
        self.longest = 0.5 / float(np.max(np.sqrt(b.brace_stiffness / b.brace_mass)))

    def forces(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces (N,) of all springs and dashpots on floors and on braces; y = [u, d, v, e]."""
        b, n = self.building, self.n
        u, d, v, e = y[:n], y[n : 2 * n], y[2 * n : 3 * n], y[3 * n :]
        below, below_velocity = np.append(0.0, u[:-1]), np.append(0.0, v[:-1])
        spring = b.brace_stiffness * (d - below) + b.brace_damping * (e - below_velocity)
        floor = np.append(spring[1:], 0.0) - b.stiffness_matrix @ u - b.damping_matrix @ v
        return floor, -spring

    def reaction(self, y: FloatArray) -> FloatArray:
        """Forces (N,) that would keep floors and braces together."""
        n = self.n
        joint = y.copy()
        stuck = self.phase == 0
        joint[3 * n :] = np.where(stuck, y[2 * n : 3 * n], y[3 * n :])
        floor, brace = self.forces(joint)
        b = self.building
        return np.asarray((b.brace_mass * floor - b.floor_mass * brace) / (b.floor_mass + b.brace_mass))

    def absolute(self, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Absolute accelerations of floors and braces."""
        b = self.building
        floor, brace = self.forces(y)
        stuck = self.phase == 0
        friction = np.where(stuck, self.reaction(y), self.phase * b.kinetic_slip_force)
        a, c = (floor - friction) / b.floor_mass, (brace + friction) / b.brace_mass
        return a, np.where(stuck, a, c)

    def run(self) -> General:
        """Integrate from rest, sample by sample and phase by phase."""
        n, dt = self.n, self.motion.dt
        y, began = np.zeros(4 * n), np.full(n, -math.inf)
        for k in range(self.motion.n - 1):
            now, end = k * dt, (k + 1) * dt
            rate = (self.motion.acceleration[k + 1] - self.motion.acceleration[k]) / dt
            while now < end:
                now, y = self.advance(now, end, self.motion.acceleration[k], rate, k * dt, y, began)
        self.u = y[:n]
        self.refine()
        return self

    def advance(
        self, now: float, end: float, ground: float, rate: float, at: float, y: FloatArray, began: FloatArray
    ) -> tuple[float, FloatArray]:
        """Integrate to the end of the sample or to the next change of phase, whichever comes first."""
        from scipy.integrate import solve_ivp

        n, b = self.n, self.building

        def rates(t: float, y: FloatArray) -> FloatArray:
            a, c = self.absolute(y)
            pull = ground + rate * (t - at)
            return np.concatenate([y[2 * n :], a - pull, c - pull])

        def condition(i: int) -> Callable[[float, FloatArray], float]:
            def gives_way(t: float, y: FloatArray) -> float:  # noqa: ARG001
                return float(b.slip_force[i] - abs(self.reaction(y)[i]))

            def stops(t: float, y: FloatArray) -> float:
                free = b.slip_force[i] if t <= began[i] + NEVER_ZERO else 0.0
                return float(self.phase[i] * (y[2 * n + i] - y[3 * n + i]) + free)

            chosen: Any = stops if self.phase[i] else gives_way
            chosen.terminal, chosen.direction = True, -1.0
            return chosen  # type: ignore[no-any-return]

        solution = solve_ivp(
            rates,
            (now, end),
            y,
            method="DOP853",
            rtol=RTOL,
            atol=RTOL * 1e-4,
            max_step=self.longest if self.phase.any() else math.inf,
            events=[condition(i) for i in range(n)],
            dense_output=True,
        )
        self.note(solution)
        now, y = float(solution.t[-1]), solution.y[:, -1].copy()
        if solution.status != 1:
            return end, y
        before = self.phase.copy()
        held = self.reaction_if_stuck(y)
        for i in range(n):
            if not solution.t_events[i].size:
                continue
            if before[i] == 0:
                self.phase[i] = 1 if held[i] > 0.0 else -1
                began[i] = now
            else:
                y[3 * n + i] = y[2 * n + i]
                sticks = abs(held[i]) <= b.slip_force[i]
                self.phase[i] = 0 if sticks else (1 if held[i] > 0.0 else -1)
                began[i] = now
            self.changes += int(self.phase[i] != before[i])
        self.peak = np.maximum(self.peak, np.abs(self.absolute(y)[0]))
        return now, y

    def reaction_if_stuck(self, y: FloatArray) -> FloatArray:
        """Reactions (N,) with each storey's own brace at its floor's velocity, the others as they are."""
        held = np.empty(self.n)
        for i in range(self.n):
            joint = y.copy()
            joint[3 * self.n + i] = y[2 * self.n + i]
            floor, brace = self.forces(joint)
            b = self.building
            m_f, m_d = b.floor_mass[i], b.brace_mass[i]
            held[i] = (m_d * floor[i] - m_f * brace[i]) / (m_f + m_d)
        return held

    def note(self, solution: Any) -> None:
        """Keep where a peak may lie between the solver's own points."""
        values = np.abs(np.stack([self.absolute(y)[0] for y in solution.y.T]))
        self.peak = np.maximum(self.peak, values.max(axis=0))
        for i in range(self.n):
            k = int(np.argmax(values[:, i]))
            if values[k, i] > 0.9 * self.peak[i]:
                first, last = solution.t[max(k - 1, 0)], solution.t[min(k + 1, solution.t.size - 1)]
                phase = tuple(int(p) for p in self.phase)
                self.tops.append((float(values[k, i]), i, solution.sol, float(first), float(last), phase))

    def refine(self) -> None:
        """Look for the peaks between the points, on the solver's own interpolation."""
        from scipy.optimize import minimize_scalar

        for value, i, sol, first, last, phase in self.tops:
            if value < 0.98 * self.peak[i] or last <= first:
                continue
            self.phase = np.array(phase)

            def height(t: float, i: int = i, sol: Callable[[float], FloatArray] = sol) -> float:
                return -abs(float(self.absolute(sol(t))[0][i]))

            found = minimize_scalar(height, bounds=(first, last), method="bounded", options={"xatol": 1e-10})
            self.peak[i] = max(self.peak[i], -float(found.fun))
