"""No friction, and friction that is never overcome: linear frames, by one matrix exponential."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.methods.matrices import discretised, state_matrix, with_braces, with_elements
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.validation import four_storey
from fdspec.verification.problems import frame, shaking
from fdspec.verification.row import Row, relative

WITHIN = 1e-9


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    motion = shaking(20.0)
    for period in (0.05, 0.4, 3.0) if full else (0.05, 0.4):
        for force in (0.0, math.inf):
            yield from compared(f"one storey, {period:g} s", frame(period, 3.0, force), motion)
    for force in (0.0, math.inf):
        yield from compared("four storeys", four_storey.building(force), motion)


def compared(name: str, building: Building, motion: GroundMotion) -> Iterator[Row]:
    """Compare the samples of the top floor's motion, and the peak, which lies between them."""
    free = building.slip_force[0] == 0.0
    case = f"{name}, {'free' if free else 'stuck'}"
    exact, peak = exponential(building, motion, free)
    history = simulate(building, motion)
    samples = history["displacement"].values[:, -1]
    worst = int(np.argmax(np.abs(samples - exact)))
    top = int(np.argmax(np.abs(exact)))
    computed = exact[top] + samples[worst] - exact[worst]
    yield relative(case, "displacement, worst sample, m", exact[top], float(computed), WITHIN)
    found = float(history["peak_displacement"][-1])
    yield relative(case, "peak displacement, m", peak, found, WITHIN)


def exponential(building: Building, motion: GroundMotion, free: bool) -> tuple[FloatArray, float]:
    """Displacement of the top floor at the motion's samples, and its peak.

    The peak: of the cubics through displacements and velocities at 64 points a sample.
    """
    if free:
        system = with_braces(building)
    else:
        system = with_elements(building, building.brace_stiffness, building.brace_damping)
        system = system._replace(
            mass=building.floor_mass + building.brace_mass,
        )
    n, fine = system.mass.size, 64
    shaken = np.concatenate([np.zeros(n), -np.ones(n)])[:, np.newaxis]
    step = discretised(state_matrix(system), shaken, motion.dt / fine)
    first, last = step.first[:, 0], step.last[:, 0]
    z, top = np.zeros(2 * n), building.n_storeys - 1
    u, v = [0.0], [0.0]
    share = np.arange(fine + 1) / fine
    for i in range(motion.n - 1):
        a = motion.acceleration[i] + (motion.acceleration[i + 1] - motion.acceleration[i]) * share
        for k in range(fine):
            z = step.A @ z + first * a[k] + last * a[k + 1]
            u.append(float(z[top]))
            v.append(float(z[n + top]))
    displacement, velocity = np.array(u), np.array(v)
    return displacement[::fine], cubic_peak(displacement, velocity, motion.dt / fine)


def cubic_peak(u: FloatArray, v: FloatArray, h: float) -> float:
    """Largest magnitude of the piecewise cubic with these values and slopes, h apart."""
    best = float(np.max(np.abs(u)))
    turning = np.flatnonzero(v[:-1] * v[1:] < 0.0)
    for i in turning[np.maximum(np.abs(u[turning]), np.abs(u[turning + 1])) > 0.99 * best]:
        cubic = np.polynomial.Polynomial(
            [
                u[i],
                h * v[i],
                3.0 * (u[i + 1] - u[i]) - h * (2.0 * v[i] + v[i + 1]),
                2.0 * (u[i] - u[i + 1]) + h * (v[i] + v[i + 1]),
            ]
        )
        roots = np.asarray(cubic.deriv().roots(), dtype=np.complex128)
        inside = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0.0) & (roots.real <= 1.0)]
        best = max([best, *np.abs(cubic(inside)).tolist()])
    return best
