"""Rigid-plastic dampers: braces that do not stretch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, IntArray, Span, Trajectory
from fdspec.methods.marching import Dampers, march
from fdspec.methods.matrices import System, braced, discretised, drifts, state_matrix
from fdspec.methods.method import Method, intervals, parts_of, positive
from fdspec.methods.samples import Samples, count_steps, stepwise, trajectory_of
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class RigidPlastic(Method):
    """Replace damper and brace by friction between a floor and the one below: nothing gives before it slips.

    The study's "rigid-perfectly plastic idealization", its references [3, 25 to 28].  With the storey's
    drift g::

        R = F sgn g'   while g' is not 0,   |R| <= F   while it is,

    a brace of infinite stiffness, whose mass goes with the floor it stands on.  Stepped like "state-space":
    R is first the force that would leave no drift velocity at the step's end, cut to friction.

    Parameters
    ----------
    dt : float, s
        Longest step; a whole number of steps fit between two samples.

    Notes
    -----
    It is the limit of the exact engine as the braces' stiffness grows.  A damper that never slips holds its
    storey rigid.  Of initial values those of the floors are used.  Dashpots of braces have no part in it.
    The forces of several storeys at once are found by iteration; with kinetic friction below static there
    may be no answer that a step can hold, and the status is ``iteration_not_converged``.
    """

    name: ClassVar[str] = "rigid-plastic"

    dt: float = 1e-4

    def __post_init__(self) -> None:
        positive(self, "dt", "s")

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        from fdspec.kernels.fixed_step.balanced import HELD

        ground, parts = intervals(motion, span), parts_of(motion, self.dt)
        count_steps(self, ground.shape[0], parts)
        h = motion.dt / parts
        size, storeys = building.n_storeys, braced(building)
        mass = building.floor_mass.copy()
        mass[:-1] += building.brace_mass[1:]
        D = drifts(size)[storeys]
        system = System(mass, building.damping_matrix, building.stiffness_matrix)
        friction = np.vstack([np.zeros((size, storeys.size)), -D.T / mass[:, np.newaxis]])
        shaking = np.concatenate([np.zeros(size), -np.ones(size)])[:, np.newaxis]
        step = discretised(state_matrix(system), np.hstack([shaking, friction]), h)
        held, trial = step.held[:, 1:], np.hstack([np.zeros_like(D), D])
        states, w, phases, status = march(
            step,
            (step.first[:, 0], step.last[:, 0]),
            Dampers(
                HELD,
                np.zeros_like(held),
                held,
                trial,
                -trial @ held,
                np.zeros(storeys.size),
                building.slip_force[storeys],
                building.kinetic_slip_force[storeys],
            ),
            ground,
            parts,
            np.concatenate([start[0, 0], start[1, 0]]),
            np.zeros(storeys.size),
            np.sign(D @ start[1, 0]).astype(np.int64),
        )
        u, v = states[:, :size], states[:, size:]
        pulls = stepwise(ground, parts)
        at = np.concatenate([pulls[:1, 0], pulls[:, 1]])
        force = np.zeros(u.shape)
        rest = -(u @ building.stiffness_matrix + v @ building.damping_matrix)
        kinetic = building.kinetic_slip_force[storeys]
        force[:, storeys] = _reactions(D, mass, rest, phases, kinetic, at, storeys)
        phase = np.zeros(u.shape, np.int64)
        phase[:, storeys] = phases
        absolute = (rest - force @ drifts(size)) / mass
        below = np.hstack([at[:, np.newaxis], absolute[:, :-1]])
        no_brace = np.setdiff1d(np.arange(size), storeys)
        d, e = u - u @ drifts(size).T, v - v @ drifts(size).T
        d[:, no_brace], e[:, no_brace] = u[:, no_brace], v[:, no_brace]
        over_steps = np.zeros((u.shape[0] - 1, size))
        over_steps[:, storeys] = w[1:]
        return trajectory_of(
            building,
            Samples(
                step=h,
                ground=pulls,
                displacement=u,
                velocity=v,
                acceleration=absolute,
                brace_displacement=d,
                brace_velocity=e,
                brace_acceleration=below,
                friction_force=force,
                phase=phase,
                held_force=over_steps,
                status=status,
            ),
            span,
        )


def _reactions(
    D: FloatArray,
    mass: FloatArray,
    rest: FloatArray,
    phases: IntArray,
    kinetic: FloatArray,
    ground: FloatArray,
    storeys: IntArray,
) -> FloatArray:
    """Return the force of each damper at each instant: friction where it slips, else what keeps the drift.

    Where dampers i in a set stick, D_i (M^-1 (rest - D^T R) - 1 a_g) = 0 together; one linear system for
    every set that occurs.
    """
    shape = (D / mass) @ D.T
    force = np.where(phases == 0, 0.0, phases * np.where(phases == 0, 0.0, kinetic))
    first = (storeys == 0).astype(float)
    wanted = (rest / mass) @ D.T - ground[:, np.newaxis] * first - force @ shape
    for stuck in np.unique(phases == 0, axis=0):
        rows = np.flatnonzero(((phases == 0) == stuck).all(axis=1))
        which = np.flatnonzero(stuck)
        if which.size:
            block = shape[np.ix_(which, which)]
            force[np.ix_(rows, which)] = np.linalg.solve(block, wanted[np.ix_(rows, which)].T).T
    return force
