"""The study's scheme: Newmark's average acceleration, the phase looked at when a step has ended.

Study, equations (30) to (38) with gamma = 1/2, beta = 1/4. Its inner iterations solve a linear system; here
that is solved at once, and for one storey floor and brace are uncoupled while slipping, so a step costs a few
nanoseconds. Ground acceleration is linear between samples.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from benchmarks.problem import Problem


@numba.njit(error_model="numpy")
def integrate(
    m_f: float,
    c_f: float,
    k_f: float,
    m_d: float,
    c_d: float,
    k_d: float,
    force: float,
    ground: NDArray[np.float64],
    dt: float,
    divisions: int,
) -> tuple[float, float, int]:
    """Peak absolute acceleration, peak displacement and changes of phase, ``divisions`` steps a sample."""
    h = dt / divisions
    mass, damping, stiffness = m_f + m_d, c_f + c_d, k_f + k_d
    quarter, half = 0.25 * h * h, 0.5 * h
    # Effective masses: acceleration at the end of a step from equilibrium there.
    stuck = 1.0 / (mass + half * damping + quarter * stiffness)
    floor = 1.0 / (m_f + half * c_f + quarter * k_f)
    brace = 1.0 / (m_d + half * c_d + quarter * k_d)
    u = v = d = e = 0.0
    a, b = -ground[0], -ground[0]
    phase = 0
    peak_a = peak_u = 0.0
    transitions = 0
    for i in range(ground.size - 1):
        slope = (ground[i + 1] - ground[i]) / divisions
        for j in range(1, divisions + 1):
            pull = ground[i] + slope * j
            u0 = u + h * v + quarter * a
            v0 = v + half * a
            if phase == 0:
                a = stuck * (-mass * pull - damping * v0 - k_f * u0 - k_d * (d + u0 - u))
                d += u0 - u + quarter * a
                u = u0 + quarter * a
                v = v0 + half * a
                b, e = a, v
                held = m_d * (b + pull) + c_d * e + k_d * d
                if abs(held) > force:
                    phase = 1 if held > 0.0 else -1
                    transitions += 1
                    a = -(c_f * v + k_f * u + phase * force) / m_f - pull
                    b = -(c_d * e + k_d * d - phase * force) / m_d - pull
            else:
                d0 = d + h * e + quarter * b
                e0 = e + half * b
                a = floor * (-m_f * pull - c_f * v0 - k_f * u0 - phase * force)
                b = brace * (-m_d * pull - c_d * e0 - k_d * d0 + phase * force)
                u, v = u0 + quarter * a, v0 + half * a
                d, e = d0 + quarter * b, e0 + half * b
                if phase * (v - e) <= 0.0:
                    e = v
                    both = -(damping * v + k_f * u + k_d * d) / mass - pull
                    held = m_d * (both + pull) + c_d * v + k_d * d
                    before = phase
                    phase = 0 if abs(held) <= force else (1 if held > 0.0 else -1)
                    if phase == 0:
                        a = b = both
                    else:
                        a = -(c_f * v + k_f * u + phase * force) / m_f - pull
                        b = -(c_d * e + k_d * d - phase * force) / m_d - pull
                    if phase != before:
                        transitions += 1
            peak_a = max(peak_a, abs(a + pull))
            peak_u = max(peak_u, abs(u))
    return peak_a, peak_u, transitions


def run(problem: Problem, step: float) -> tuple[float, float, int]:
    """One history at about this step (s)."""
    ground, dt = problem.motion
    s = problem.storey
    return integrate(
        s.floor_mass,
        s.floor_damping,
        s.floor_stiffness,
        s.brace_mass,
        s.brace_damping,
        s.brace_stiffness,
        s.static_force,
        ground,
        dt,
        max(1, round(dt / step)),
    )
