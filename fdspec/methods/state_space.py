"""The discrete-time state-space solution with shear balance at each step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.methods.marching import Dampers, march
from fdspec.methods.matrices import braced, discretised, drifts, state_matrix, with_braces
from fdspec.methods.method import Method, intervals, parts_of, positive
from fdspec.methods.samples import Samples, count_steps, stepwise, trajectory_of
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class StateSpace(Method):
    """Step by an exact state-space map, with friction chosen so that shear balances at each step's end.

    L. Y. Lu and others, the study's reference [24].  With z = [u, u'] of floors and braces the study's (19)
    is z' = A z + E a_g + B R, and over a step::

        z+ = A_d z + E_0 a_g + E_1 a_g+ + B_d R+ .

    R+ is first the force that would leave no sliding velocity D z+ at the step's end,
    R+ = -(D B_d)^-1 D (A_d z + E_0 a_g + E_1 a_g+); where it exceeds friction the damper slips, with R+ the
    friction force, and the others are balanced again.  No phase is searched for and nothing is iterated but
    that.

    Parameters
    ----------
    dt : float, s
        Longest step; a whole number of steps fit between two samples.

    Notes
    -----
    The study cites the method without printing it, so its equations have no numbers here.  Friction is held
    over a step and the ground is linear in it.  A damper may start or stop within a step, on the average of
    it: the error falls nearly with the square of the step.  The step must be shorter than half
    a period of the fastest brace.  A massless brace has no sliding velocity of its own: "bilinear" is this
    scheme for it.
    """

    name: ClassVar[str] = "state-space"

    dt: float = 1e-4

    def __post_init__(self) -> None:
        positive(self, "dt", "s")

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        from fdspec.kernels.fixed_step.balanced import HELD

        storeys = braced(building)
        if (building.brace_mass[storeys] == 0.0).any():
            raise InvalidInput(
                f"brace_mass must be positive for method {self.name!r}; for massless braces use 'bilinear'"
            )
        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        h = motion.dt / parts
        system = with_braces(building)
        size, n = building.n_storeys, system.mass.size
        slide = np.zeros((storeys.size, n))  # sliding velocity, from velocities
        slide[np.arange(storeys.size), storeys] = 1.0
        slide[np.arange(storeys.size), size + np.arange(storeys.size)] = -1.0
        friction = np.vstack([np.zeros((n, storeys.size)), -slide.T / system.mass[:, np.newaxis]])
        shaking = np.concatenate([np.zeros(n), -np.ones(n)])[:, np.newaxis]
        step = discretised(state_matrix(system), np.hstack([shaking, friction]), h)
        held, trial = step.held[:, 1:], np.hstack([np.zeros_like(slide), slide])
        relief = -trial @ held
        if storeys.size and not (np.linalg.eigvalsh(0.5 * (relief + relief.T)) > 0.0).all():
            raise InvalidInput(
                f"dt of method {self.name!r} must be shorter than half a period of the braces, "
                f"got {self.dt:g} s"
            )
        started = np.sign(start[1, 0] - start[1, 1])[storeys].astype(np.int64)
        states, w, phases, status = march(
            step,
            (step.first[:, 0], step.last[:, 0]),
            Dampers(
                HELD,
                np.zeros_like(held),
                held,
                trial,
                relief,
                np.zeros(storeys.size),
                building.slip_force[storeys],
                building.kinetic_slip_force[storeys],
            ),
            ground,
            parts,
            np.concatenate([start[0, 0], start[0, 1, storeys], start[1, 0], start[1, 1, storeys]]),
            np.zeros(storeys.size),
            started,
        )
        return trajectory_of(
            building, self._samples(building, states, w, phases, stepwise(ground, parts), h, status), span
        )

    @staticmethod
    def _samples(
        building: Building,
        states: FloatArray,
        w: FloatArray,
        phases: np.ndarray[tuple[int, int], np.dtype[np.int64]],
        ground: FloatArray,
        h: float,
        status: int,
    ) -> Samples:
        """Put braces where their storeys are, and say what force each damper carries at the instants."""
        storeys, size, D = braced(building), building.n_storeys, drifts(building.n_storeys)
        n = size + storeys.size
        u, v = states[:, :size], states[:, n : n + size]
        d, e = u.copy(), v.copy()
        d[:, storeys], e[:, storeys] = states[:, size:n], states[:, n + size :]
        below, below_velocity = u - u @ D.T, v - v @ D.T
        spring = building.brace_stiffness * (d - below) + building.brace_damping * (e - below_velocity)
        rest = np.roll(spring, -1, axis=1)  # of the brace above
        rest[:, -1] = 0.0
        rest -= u @ building.stiffness_matrix + v @ building.damping_matrix
        phase = np.zeros(u.shape, np.int64)
        phase[:, storeys] = phases
        m_f, m_d = building.floor_mass, building.brace_mass
        held = (m_d * rest + m_f * spring) / (m_f + m_d)
        force = np.where(phase == 0, held, phase * np.where(phase == 0, 0.0, building.kinetic_slip_force))
        force[:, building.brace_stiffness == 0.0] = 0.0
        over_steps = np.zeros((u.shape[0] - 1, size))
        over_steps[:, storeys] = w[1:]
        brace = np.divide(force - spring, m_d, out=np.zeros_like(force), where=m_d > 0.0)
        return Samples(
            step=h,
            ground=ground,
            displacement=u,
            velocity=v,
            acceleration=(rest - force) / m_f,
            brace_displacement=d,
            brace_velocity=e,
            brace_acceleration=brace,
            friction_force=force,
            phase=phase,
            held_force=over_steps,
            status=status,
        )
