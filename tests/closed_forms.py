"""Answers on paper: histories whose peaks have a formula. Nothing here imports fdspec."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm

Array = NDArray[np.float64]


def friction_decay_extrema(stiffness: float, slip_force: float, displacement: float) -> Array:
    """Extrema of a mass with rigid friction, let go at rest; it sticks in the last.

    They lie pi / omega apart. Each half cycle swings about the point where spring and friction balance,
    x -> -(x - 2 F/k).
    """
    balance = slip_force / stiffness
    extrema = [displacement]
    while abs(extrema[-1]) > balance:
        last = extrema[-1]
        extrema.append(-last + math.copysign(2.0 * balance, last))
    return np.array(extrema[1:])


def den_hartog_amplitude(frequency_ratio: float, friction_ratio: float, damping_ratio: float) -> float:
    """x0 k / P of the steady state without stops: force P cos(wt) on a damped mass with rigid friction F.

    ``frequency_ratio`` r = w / w_n, ``friction_ratio`` beta = F / P (Den Hartog 1931, as reference/README.md
    writes it).
    """
    r, beta, zeta = frequency_ratio, friction_ratio, damping_ratio
    q = math.sqrt(1.0 - zeta**2)
    a, b = zeta * math.pi / r, q * math.pi / r
    d = math.cosh(a) + math.cos(b)
    g = (math.sinh(a) - (zeta / q) * math.sin(b)) / d
    h = math.sin(b) / (q * r * d)
    return -g * beta + math.sqrt(1.0 / ((1.0 - r**2) ** 2 + (2.0 * zeta * r) ** 2) - (h * beta) ** 2)


def shaken_block_amplitude(
    base_acceleration: float, omega: float, friction_coefficient: float, gravity: float
) -> float:
    """Half the peak-to-peak slip of a block on a base shaken at a0 cos(wt), steady, without stops."""
    beta = friction_coefficient * gravity / base_acceleration
    if beta > 1.0 / math.sqrt(1.0 + math.pi**2 / 4.0):
        raise ValueError(f"the block stops when mu g / a0 = {beta:.6f} is above 0.537029")
    return base_acceleration / omega**2 * math.sqrt(1.0 - (math.pi * beta / 2.0) ** 2)


def bilinear_free_extrema(
    mass: float, stiffness: float, brace_stiffness: float, slip_force: float, velocity: float, count: int
) -> Array:
    """First extrema of the displacement of an undamped mass on a frame spring and a massless slipping brace.

    It starts at u = 0, brace unloaded, at ``velocity``. Each half cycle is an arc about the balance of
    k_f + k_d, then, from the brace force +-F on, one about that of k_f. Amplitudes come from energy.
    """
    extrema: list[float] = []
    u, speed_squared, force, direction = 0.0, velocity**2, 0.0, math.copysign(1.0, velocity)
    for _ in range(count):
        # Elastic arc: m v^2/2 + k_f u^2/2 + q^2/(2 k_d) is constant, q = q0 + k_d (u - u0).
        offset = u - force / brace_stiffness
        elastic = 0.5 * mass * speed_squared + 0.5 * stiffness * u**2 + 0.5 * force**2 / brace_stiffness
        yields = offset + direction * slip_force / brace_stiffness
        spring = 0.5 * stiffness * yields**2
        left = elastic - spring - 0.5 * slip_force**2 / brace_stiffness
        if left <= 0.0:  # it turns before the brace yields: x with k_f x^2/2 + k_d (x - offset)^2/2 = elastic
            a, b = stiffness + brace_stiffness, brace_stiffness * offset
            u = (b + direction * math.sqrt(b * b - a * (brace_stiffness * offset**2 - 2.0 * elastic))) / a
            force = brace_stiffness * (u - offset)
        else:  # then m v^2/2 + k_f u^2/2 + s F u is constant
            total = left + spring + direction * slip_force * yields
            balance = direction * slip_force / stiffness
            u = -balance + direction * math.sqrt(balance**2 + 2.0 * total / stiffness)
            force = direction * slip_force
        extrema.append(u)
        speed_squared, direction = 0.0, -direction
    return np.array(extrema)


def linear_states(
    mass: ArrayLike,
    damping: ArrayLike,
    stiffness: ArrayLike,
    acceleration: ArrayLike,
    dt: float,
    *,
    subdivisions: int = 1,
    force: ArrayLike | None = None,
) -> tuple[Array, Array]:
    """u and u' (times, n) of M u'' + C u' + K u = -M 1 a_g + f from rest, a_g linear between samples.

    ``mass`` (n,) is the diagonal of M, ``force`` (n,) a constant. One matrix exponential, exact at every one
    of the ``subdivisions`` states a step.
    """
    m = np.atleast_1d(np.asarray(mass, dtype=float))
    c = np.atleast_2d(np.asarray(damping, dtype=float))
    k = np.atleast_2d(np.asarray(stiffness, dtype=float))
    f = np.zeros(len(m)) if force is None else np.asarray(force, dtype=float)
    a = np.asarray(acceleration, dtype=float)
    n = len(m)
    matrix = np.zeros((2 * n + 3, 2 * n + 3))
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n] = -k / m[:, None]
    matrix[n : 2 * n, n : 2 * n] = -c / m[:, None]
    matrix[n : 2 * n, -3] = -1.0
    matrix[n : 2 * n, -1] = f / m
    matrix[-3, -2] = 1.0
    step = expm(matrix * (dt / subdivisions))
    z = np.zeros(2 * n + 3)
    z[-1] = 1.0
    states = [z[: 2 * n]]
    for i in range(len(a) - 1):
        z[-3], z[-2] = a[i], (a[i + 1] - a[i]) / dt
        for _ in range(subdivisions):
            z = step @ z
            states.append(z[: 2 * n])
    result = np.array(states)
    return result[:, :n], result[:, n:]
