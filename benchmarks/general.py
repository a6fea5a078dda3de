"""scipy's solve_ivp with events, as a careful user would write it: one call a phase."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.problem import Problem


def run(problem: Problem, rtol: float = 1e-8) -> tuple[float, int]:
    """Peak absolute acceleration (of the solver's own points) and changes of phase."""
    ground, dt = problem.motion
    s = problem.storey
    force = s.static_force
    time = dt * np.arange(len(ground))
    brace_omega = np.sqrt(s.brace_stiffness / s.brace_mass)
    phase = 0

    def pull(t: float) -> float:
        return float(np.interp(t, time, ground))

    def stuck(y: NDArray[np.float64]) -> float:
        """Absolute acceleration of floor and brace as one."""
        spring = s.floor_stiffness * y[0] + s.brace_stiffness * y[1] + s.floor_damping * y[2]
        return -spring / (s.floor_mass + s.brace_mass)

    def held(y: NDArray[np.float64]) -> float:
        return s.brace_mass * stuck(y) + s.brace_stiffness * y[1]

    def floor(y: NDArray[np.float64]) -> float:
        if phase == 0:
            return stuck(y)
        return -(s.floor_stiffness * y[0] + s.floor_damping * y[2] + phase * force) / s.floor_mass

    def rates(t: float, y: NDArray[np.float64]) -> list[float]:
        a = pull(t)
        if phase == 0:
            both = stuck(y) - a
            return [y[2], y[3], both, both]
        return [y[2], y[3], floor(y) - a, (phase * force - s.brace_stiffness * y[1]) / s.brace_mass - a]

    def gives_way(_: float, y: NDArray[np.float64]) -> float:
        return force - abs(held(y))

    def stops(t: float, y: NDArray[np.float64]) -> float:
        # Free of the zero it starts from.
        return phase * (y[2] - y[3]) + (1.0 if t <= started + 1e-9 else 0.0)

    gives_way.terminal = stops.terminal = True  # type: ignore[attr-defined]
    gives_way.direction = stops.direction = -1.0  # type: ignore[attr-defined]
    y, now, started, peak, changes = np.zeros(4), 0.0, -1.0, 0.0, 0
    while now < time[-1]:
        solution = solve_ivp(
            rates,
            (now, time[-1]),
            y,
            method="DOP853",
            rtol=rtol,
            atol=rtol * 1e-4,
            max_step=min(dt, 1.0 / brace_omega) if phase else dt,
            events=stops if phase else gives_way,
        )
        peak = max(peak, *(abs(floor(state)) for state in solution.y.T))
        now, y = float(solution.t[-1]), solution.y[:, -1]
        if solution.status != 1:
            break
        before, started = phase, now
        if phase == 0:
            phase = 1 if held(y) > 0.0 else -1
        else:
            y[3] = y[2]
            phase = 0 if abs(held(y)) <= force else (1 if held(y) > 0.0 else -1)
        changes += phase != before
        peak = max(peak, abs(floor(y)))
    return peak, changes
