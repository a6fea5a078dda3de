"""Smooth hysteresis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.methods.matrices import braced, drifts
from fdspec.methods.method import (
    Method,
    intervals,
    no_brace_damping,
    parts_of,
    positive,
    without_brace_mass,
)
from fdspec.methods.samples import Samples, count_steps, stepwise, trajectory_of
from fdspec.methods.smooth import integrate_smooth
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class BoucWen(Method):
    """Replace damper and brace by one hysteretic spring over the storey that yields smoothly.

    Bouc (1967) and Wen (1976), the study's references [18] and [35].  With the storey's drift g, the brace's
    stiffness k_d and friction F, z = R / F and gamma = 1 - beta::

        R' = k_d g' (1 - |z|^n (beta sgn(g' z) + gamma)) .

    It is Wen's ``z' = A g' - beta |g'| |z|^(n-1) z - gamma g' |z|^n``, scaled so that the first stiffness is
    the brace's (A = 1) and the last force is friction (beta + gamma = 1).

    Parameters
    ----------
    exponent : float
        n, the sharpness of the yielding, at least 1; the elasto-plastic spring is the limit of large ones.
        Beyond about 100 the integrator may fail, with the status ``non_finite_state``.
    beta : float
        Share of the term that makes loops, above 0 and at most 1; 0.5 unloads with the first stiffness.
    rtol : float
        Relative tolerance of the integrator, LSODA.
    dt : float, s
        Longest time between the instants at which peaks are read.

    Notes
    -----
    The brace's mass is neglected.  The law passes smoothly from one phase to the other: none is told.
    Kinetic friction is used.  Braces with a dashpot are refused.
    """

    name: ClassVar[str] = "bouc-wen"

    exponent: float = 2.0
    beta: float = 0.5
    rtol: float = 1e-6
    dt: float = 1e-3

    def __post_init__(self) -> None:
        for name, unit in (("exponent", ""), ("beta", ""), ("rtol", ""), ("dt", "s")):
            positive(self, name, unit)
        if self.exponent < 1.0:
            raise InvalidInput(f"exponent of method {self.name!r} must be at least 1, got {self.exponent!r}")
        if self.beta > 1.0:
            raise InvalidInput(f"beta of method {self.name!r} must be at most 1, got {self.beta!r}")

    def model(self, building: Building) -> Building:
        """Return the building with massless braces."""
        return without_brace_mass(building)

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        no_brace_damping(self, building)
        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        size, storeys = building.n_storeys, braced(building)
        D, K, C = drifts(size), building.stiffness_matrix, building.damping_matrix
        mass, k_d, F = building.floor_mass, building.brace_stiffness, building.kinetic_slip_force
        yields = np.isfinite(building.slip_force)
        reciprocal = np.divide(1.0, F, out=np.zeros(size), where=yields & (F > 0.0))
        stiffness = np.where(yields & (F == 0.0), 0.0, k_d)
        n, beta, gamma = self.exponent, self.beta, 1.0 - self.beta

        def force_rate(drift_rate: FloatArray, R: FloatArray) -> FloatArray:
            z = R * reciprocal
            bend = np.abs(z) ** n * (gamma + beta * np.sign(drift_rate * z))
            return np.asarray(stiffness * drift_rate * (1.0 - bend))

        # y = [u, v, R]; all but R' is linear.
        L = np.zeros((3 * size, 3 * size))
        L[:size, size : 2 * size] = np.eye(size)
        L[size : 2 * size] = -np.hstack([K, C, D.T]) / mass[:, np.newaxis]
        L[2 * size :, size : 2 * size] = D
        shaken = np.repeat([0.0, -1.0, 0.0], size)

        def rates(y: FloatArray, ground: float, out: FloatArray) -> None:
            np.dot(L, y, out=out)
            out += shaken * ground
            out[2 * size :] = force_rate(out[2 * size :], y[2 * size :])

        below = start[0, 0] - D @ start[0, 0]
        pulled = np.where(stiffness > 0.0, k_d * (start[0, 1] - below), 0.0)
        speed = max(motion.pga * float(building.bare_periods[0]), float(np.max(np.abs(start[1]))), 1e-9)
        length = max(speed * float(building.bare_periods[0]), float(np.max(np.abs(start[0]))))
        scale = np.repeat([length, speed, length * float(np.max(k_d, initial=1.0))], size)
        begin = np.concatenate([start[0, 0], start[1, 0], pulled])
        atol = self.rtol * 1e-2 * scale
        states, status = integrate_smooth(rates, begin, ground, motion, parts, self.rtol, atol)
        u, v, R = states[:, :size], states[:, size : 2 * size], states[:, 2 * size :]
        d, e, rate = u.copy(), v.copy(), force_rate(v @ D.T, R)
        for i in storeys:  # the spring of the brace carries R
            d[:, i] = (u[:, i - 1] if i > 0 else 0.0) + R[:, i] / k_d[i]
            e[:, i] = (v[:, i - 1] if i > 0 else 0.0) + rate[:, i] / k_d[i]
        return trajectory_of(
            self.model(building),
            Samples(
                step=motion.dt / parts,
                ground=stepwise(ground, parts),
                displacement=u,
                velocity=v,
                acceleration=-(u @ K + v @ C + R @ D) / mass,
                brace_displacement=d,
                brace_velocity=e,
                brace_acceleration=np.zeros(u.shape),
                friction_force=R,
                phase=np.zeros(u.shape, np.int64),
                status=status,
            ),
            span,
        )
