"""The study's fixed-step scheme, each step solved as one linear system; imports nothing from fdspec.

Newmark's relations (30) to (35) with gamma = 1/2 make (26) and (27) linear in the accelerations at the step's
end; the phase is looked at when the step is done. Where the package iterates, here numpy.linalg.solve works.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class Stepped:
    """m/s2, m; (time, storey, phase) of every change."""

    peak_acceleration: Array
    final_displacement: Array
    transitions: list[tuple[float, int, int]] = field(default_factory=list)


def integrate(
    floor_mass: Array,
    brace_mass: Array,
    stiffness: Array,
    damping: Array,
    brace_stiffness: Array,
    slip_force: Array,
    kinetic: Array,
    ground: Array,
    dt: float,
    divisions: int,
    beta: float,
) -> Stepped:
    """From rest; frame matrices (N, N), all else (N,)."""
    n, h = len(floor_mass), dt / divisions
    K = np.zeros((2 * n, 2 * n))
    C = np.zeros((2 * n, 2 * n))
    K[:n, :n], C[:n, :n] = stiffness, damping
    for i, k in enumerate(brace_stiffness):
        stretch = np.zeros(2 * n)
        stretch[n + i] = 1.0
        if i:
            stretch[i - 1] = -1.0
        K += k * np.outer(stretch, stretch)
    M = np.concatenate([floor_mass, brace_mass])
    x, v = np.zeros(2 * n), np.zeros(2 * n)
    phase = np.zeros(n, int)

    def accelerations(pull: float, state: Array, rate: Array, mass: Array) -> Array:
        """Solve for accelerations and reactions: sticking storeys add R_i and one equation each."""
        stuck = np.flatnonzero(phase == 0)
        size = 2 * n + len(stuck)
        A, b = np.zeros((size, size)), np.zeros(size)
        A[: 2 * n, : 2 * n] = mass
        friction = phase * kinetic
        b[: 2 * n] = -M * pull - C @ rate - K @ state - np.concatenate([friction, -friction])
        for row, i in enumerate(stuck, start=2 * n):
            A[i, row], A[n + i, row] = 1.0, -1.0
            A[row, i], A[row, n + i] = 1.0, -1.0
        return np.linalg.solve(A, b)

    def reactions(solution: Array) -> Array:
        found = phase * kinetic.astype(float)
        found[phase == 0] = solution[2 * n :]
        return found

    at_once = np.diag(M)
    in_step = at_once + 0.5 * h * C + beta * h * h * K
    a = accelerations(ground[0], x, v, at_once)[: 2 * n]
    result = Stepped(np.abs(a[:n] + ground[0]), x[:n])
    for k in range((len(ground) - 1) * divisions):
        i, j = divmod(k + 1, divisions)
        pull = ground[i] if j == 0 else ground[i] + (ground[i + 1] - ground[i]) * j / divisions
        x = x + h * v + (0.5 - beta) * h * h * a
        v = v + 0.5 * h * a
        solution = accelerations(pull, x, v, in_step)
        a = solution[: 2 * n]
        x, v = x + beta * h * h * a, v + 0.5 * h * a
        result.peak_acceleration = np.maximum(result.peak_acceleration, np.abs(a[:n] + pull))
        held = reactions(solution)
        after = phase.copy()
        for s in range(n):
            if phase[s] == 0 and abs(held[s]) > slip_force[s]:
                after[s] = np.sign(held[s])
            elif phase[s] * (v[s] - v[n + s]) < 0.0 or (phase[s] and v[s] == v[n + s]):
                rate = v.copy()
                rate[n + s] = v[s]
                p = -(C @ rate) - K @ x
                need = (brace_mass[s] * p[s] - floor_mass[s] * p[n + s]) / (floor_mass[s] + brace_mass[s])
                after[s] = 0 if abs(need) <= slip_force[s] else np.sign(need)
        if (after != phase).any():
            result.transitions += [((k + 1) * h, s, int(after[s])) for s in range(n) if after[s] != phase[s]]
            phase = after
            stuck = phase == 0
            v[n:][stuck] = v[:n][stuck]
            a = accelerations(pull, x, v, at_once)[: 2 * n]
            result.peak_acceleration = np.maximum(result.peak_acceleration, np.abs(a[:n] + pull))
    result.final_displacement = x[:n]
    return result
