"""Elasto-plastic dampers on massless braces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
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
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class Bilinear(Method):
    """Replace damper and brace by one elasto-plastic spring over the storey, as general programs model them.

    The study's second category, its references [3, 23, 25 to 28]: SAP2000's plastic link, DRAIN's bilinear
    spring.  With the storey's drift g, the spring's offset o and the brace's stiffness k_d::

        R = k_d (g - o),   |R| <= F,   o' (R - F sgn o') = 0 .

    The brace's mass is neglected, and with it its swinging.  Stepped by a state-space map that is exact
    while the spring is elastic, with the force brought back to friction at each step's end where it exceeds
    it (return mapping).

    Parameters
    ----------
    dt : float, s
        Longest step; a whole number of steps fit between two samples.

    Notes
    -----
    As dt falls this tends to the exact engine's massless brace.  Braces with a dashpot are refused.
    """

    name: ClassVar[str] = "bilinear"

    dt: float = 1e-4

    def __post_init__(self) -> None:
        positive(self, "dt", "s")

    def model(self, building: Building) -> Building:
        """Return the building with massless braces."""
        return without_brace_mass(building)

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        from fdspec.kernels.fixed_step.balanced import OFFSET

        no_brace_damping(self, building)
        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        h = motion.dt / parts
        size, storeys = building.n_storeys, braced(building)
        D = drifts(size)[storeys]
        spring = building.brace_stiffness[storeys]
        system = with_elements(building, building.brace_stiffness, np.zeros(size))
        push = np.vstack([np.zeros((size, storeys.size)), (D.T * spring) / system.mass[:, np.newaxis]])
        shaking = np.concatenate([np.zeros(size), -np.ones(size)])[:, np.newaxis]
        step = discretised(state_matrix(system), np.hstack([shaking, push]), h)
        trial = np.hstack([spring[:, np.newaxis] * D, np.zeros_like(D)])
        offset = (start[0, 0] - start[0, 1])[storeys]
        states, w, phases, status = march(
            step,
            (step.first[:, 0], step.last[:, 0]),
            Dampers(
                OFFSET,
                step.first[:, 1:],
                step.last[:, 1:],
                trial,
                np.diag(spring) - trial @ step.last[:, 1:],
                spring,
                building.slip_force[storeys],
                building.kinetic_slip_force[storeys],
            ),
            ground,
            parts,
            np.concatenate([start[0, 0], start[1, 0]]),
            offset,
            np.zeros(storeys.size, np.int64),
        )
        u, v = states[:, :size], states[:, size:]
        phase, force = np.zeros(u.shape, np.int64), np.zeros(u.shape)
        phase[:, storeys], force[:, storeys] = phases, spring * (u @ D.T - w)
        slip = np.zeros(u.shape)
        slip[:, storeys] = w
        below_velocity = v - v @ drifts(size).T
        brace_velocity = np.where(phase == 0, v, below_velocity)  # slipping, the spring keeps its length
        rest = u @ building.stiffness_matrix + v @ building.damping_matrix
        return trajectory_of(
            self.model(building),
            Samples(
                step=h,
                ground=stepwise(ground, parts),
                displacement=u,
                velocity=v,
                acceleration=-(rest + force @ drifts(size)) / building.floor_mass,
                brace_displacement=u - slip,
                brace_velocity=brace_velocity,
                brace_acceleration=np.zeros(u.shape),
                friction_force=force,
                phase=phase,
                status=status,
            ),
            span,
        )
