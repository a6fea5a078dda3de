"""Equivalent viscous damping from the energy per cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.methods.marching import Dampers, march
from fdspec.methods.matrices import braced, discretised, drifts, state_matrix, with_elements
from fdspec.methods.method import (
    Method,
    intervals,
    no_brace_damping,
    parts_of,
    positive,
    without_brace_mass,
)
from fdspec.methods.samples import Samples, count_steps, stepwise, trajectory_of
from fdspec.model.building import Building
from fdspec.model.damping import natural_modes
from fdspec.model.motion import GroundMotion

MOST_ROUNDS = 500


@dataclass(frozen=True, kw_only=True)
class EquivalentLinear(Method):
    """Replace each damper on its brace by a spring and a dashpot that are iterated on the drift's amplitude.

    Jacobsen's equivalent viscous damping (1930), the study's reference [17].  A loop of amplitude X of an
    elasto-plastic spring (k_d, F) has the secant stiffness F / X and dissipates 4 F (X - F / k_d); a dashpot
    dissipates pi c w X^2 in the same cycle.  So::

        k_eq = F / X,   c_eq = 4 F (X - F / k_d) / (pi w X^2)   for X > F / k_d,   else k_d and 0,

    with w the first natural frequency of the linear frame that results.  X is ``share`` times the peak drift
    of that frame's response to the whole record, for each storey its own.

    Parameters
    ----------
    share : float
        Of the peak drift that counts as the amplitude; 1 is the peak itself, 0.65 a usual choice where the
        peak comes once.
    tolerance : float
        Largest change of an amplitude, relative, at which the iteration ends.
    dt : float, s
        Longest time between the instants at which peaks are read; the linear response is exact at them.

    Notes
    -----
    A linear frame has no phases: none is told.  The brace's mass is neglected.  Kinetic friction is used.
    Where the amplitudes do not settle the status is ``iteration_not_converged``.
    """

    name: ClassVar[str] = "equivalent-linear"

    share: float = 1.0
    tolerance: float = 1e-6
    dt: float = 1e-3

    def __post_init__(self) -> None:
        for name, unit in (("share", ""), ("tolerance", ""), ("dt", "s")):
            positive(self, name, unit)
        if self.share > 1.0:
            raise InvalidInput(f"share of method {self.name!r} must be at most 1, got {self.share!r}")

    def model(self, building: Building) -> Building:
        """Return the building with massless braces."""
        return without_brace_mass(building)

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        from fdspec.kernels.types import ITERATION_NOT_CONVERGED

        no_brace_damping(self, building)
        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        size = building.n_storeys
        D = drifts(size)
        state = np.concatenate([start[0, 0], start[1, 0]])
        k_eq, c_eq = building.brace_stiffness.copy(), np.zeros(size)
        amplitude = np.zeros(size)
        status = ITERATION_NOT_CONVERGED
        states = np.empty((0, 0))
        for _ in range(MOST_ROUNDS):
            states = _linear(building, k_eq, c_eq, ground, parts, motion.dt, state)
            reached = self.share * np.max(np.abs(states[:, :size] @ D.T), axis=0)
            if np.all(np.abs(reached - amplitude) <= self.tolerance * reached):
                status = 0
                break
            # Half way: what is stiffer moves less, and a whole step may swing about the answer for ever.
            amplitude = reached if not amplitude.any() else 0.5 * (amplitude + reached)
            k_eq, c_eq = _equivalent(building, k_eq, amplitude)
        return trajectory_of(
            self.model(building),
            self._samples(building, states, k_eq, c_eq, stepwise(ground, parts), motion.dt / parts, status),
            span,
        )

    @staticmethod
    def _samples(
        building: Building,
        states: FloatArray,
        k_eq: FloatArray,
        c_eq: FloatArray,
        ground: FloatArray,
        h: float,
        status: int,
    ) -> Samples:
        size = building.n_storeys
        D = drifts(size)
        u, v = states[:, :size], states[:, size:]
        force = (u @ D.T) * k_eq + (v @ D.T) * c_eq
        rest = u @ building.stiffness_matrix + v @ building.damping_matrix
        acceleration = -(rest + force @ D) / building.floor_mass
        at = np.concatenate([ground[:1, 0], ground[:, 1]])
        relative = acceleration - at[:, np.newaxis]
        rate = (v @ D.T) * k_eq + (relative @ D.T) * c_eq
        d, e = u.copy(), v.copy()
        for i in braced(building):  # the brace's spring carries the same force
            stiffness = building.brace_stiffness[i]
            d[:, i] = (u[:, i - 1] if i > 0 else 0.0) + force[:, i] / stiffness
            e[:, i] = (v[:, i - 1] if i > 0 else 0.0) + rate[:, i] / stiffness
        return Samples(
            step=h,
            ground=ground,
            displacement=u,
            velocity=v,
            acceleration=acceleration,
            brace_displacement=d,
            brace_velocity=e,
            brace_acceleration=np.zeros(u.shape),
            friction_force=force,
            phase=np.zeros(u.shape, np.int64),
            status=status,
        )


def _equivalent(
    building: Building, before: FloatArray, amplitude: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Spring and dashpot (N,) of each storey at these amplitudes."""
    stiffness = building.brace_stiffness
    friction = np.where(np.isinf(building.slip_force), np.inf, building.kinetic_slip_force)
    slips = stiffness * amplitude > friction
    safe = np.where(slips, amplitude, 1.0)
    finite = np.where(slips, friction, 0.0)
    k_eq = np.where(slips, finite / safe, stiffness)
    system = with_elements(building, k_eq, np.zeros_like(before))
    omega = natural_modes(system.mass, system.stiffness)[0][0]
    yielded = np.divide(finite, stiffness, out=np.zeros_like(finite), where=stiffness > 0.0)
    c_eq = np.where(slips, 4.0 * finite * (safe - yielded) / (np.pi * omega * safe**2), 0.0)
    return k_eq, c_eq


def _linear(
    building: Building,
    k_eq: FloatArray,
    c_eq: FloatArray,
    ground: FloatArray,
    parts: int,
    dt: float,
    state: FloatArray,
) -> FloatArray:
    """States (k, 2N) of the linear frame at the ends of all steps."""
    size = building.n_storeys
    shaking = np.concatenate([np.zeros(size), -np.ones(size)])[:, np.newaxis]
    step = discretised(state_matrix(with_elements(building, k_eq, c_eq)), shaking, dt / parts)
    none, nothing = np.zeros((2 * size, 0)), np.zeros(0)
    dampers = Dampers(0, none, none, none.T, np.zeros((0, 0)), nothing, nothing, nothing)
    pull = (step.first[:, 0], step.last[:, 0])
    return march(step, pull, dampers, ground, parts, state, nothing, np.zeros(0, np.int64))[0]
