"""The position in which a building of several storeys comes to rest.

Once the ground rests and every damper sticks, the frame swings about the position in which its springs
balance.  Its energy about that position never grows, and bounds how far each reaction swings about its
value there: a reaction r.x + q.v is at most sqrt(2 E (r K^-1 r + q M^-1 q)).  Where every bound stays below
the slip force, nothing slips any more.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.trajectory import FloatArray, Rest, Span
from fdspec.errors import InvalidInput
from fdspec.kernels.frame.results import END_ROWS
from fdspec.kernels.storey.rest import REST_STEPS
from fdspec.kernels.types import OK, TRANSITION_CAP_REACHED
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.model.springs import shear_matrix

EVERY = 50
"""Record steps between two looks at whether the building can slip any more."""


def rest_position(building: Building, slip: FloatArray) -> FloatArray:
    """Return the displacements (N,) at which frame and braces balance with these slip offsets (N,), m."""
    pull = building.brace_stiffness * slip
    force = pull - np.append(pull[1:], 0.0)
    return np.linalg.solve(building.stiffness_matrix + shear_matrix(building.brace_stiffness), force)


def can_slip(building: Building, end: FloatArray) -> bool:
    """Whether some damper may still slip; end: the engine's state, (7 N,), with the ground at rest."""
    u, v, slip, _, phase = end.reshape(END_ROWS, -1)[:5]
    if phase.any():
        return True
    size = building.n_storeys
    drift = np.eye(size) - np.eye(size, k=-1)
    above = np.eye(size, k=1)
    brace = building.brace_stiffness[:, np.newaxis] * drift
    dashpot = building.brace_damping[:, np.newaxis] * drift
    mass = building.floor_mass + building.brace_mass
    of_floor, of_brace = building.brace_mass / mass, building.floor_mass / mass

    def reaction(of_frame: FloatArray, of_braces: FloatArray) -> FloatArray:
        return (of_floor * (above @ of_braces - of_frame).T + of_brace * of_braces.T).T

    rest = rest_position(building, slip)
    force = brace @ rest - building.brace_stiffness * slip
    held = reaction(building.stiffness_matrix @ rest, force)
    stiffness = building.stiffness_matrix + shear_matrix(building.brace_stiffness)
    away = u - rest
    energy = away @ stiffness @ away + mass @ v**2  # twice
    r = reaction(building.stiffness_matrix, brace)
    q = reaction(building.damping_matrix, dashpot)
    reach = np.einsum("ij,ji->i", r, np.linalg.solve(stiffness, r.T)) + (q**2 / mass).sum(axis=1)
    swing = np.sqrt(np.maximum(reach, 0.0) * max(energy, 0.0))
    return bool((np.abs(held) + swing >= building.slip_force)[building.brace_stiffness > 0.0].any())


def rest_of_building(
    building: Building, motion: GroundMotion, span: Span, start: FloatArray, resume: FloatArray | None = None
) -> Rest:
    """Go on after the span until no damper can slip any more."""
    if (free := (building.brace_stiffness > 0.0) & (building.slip_force == 0.0)).any():
        raise InvalidInput(
            f"at_rest needs friction in every damper, got slip_force 0 in storey {int(np.argmax(free)) + 1}"
        )
    trajectory = integrate_many_storeys(building, motion, replace(span, outputs=1), start, resume)
    still = GroundMotion(np.zeros(2), motion.dt, name="at rest")
    going = Span(EVERY - 1, motion.dt, 1)
    steps, status = 0, trajectory.status
    while status == OK and trajectory.end is not None and can_slip(building, trajectory.end):
        if steps >= REST_STEPS:
            status = TRANSITION_CAP_REACHED
            break
        trajectory = integrate_many_storeys(building, still, going, start, trajectory.end)
        steps, status = steps + EVERY, trajectory.status
    if trajectory.end is None or not math.isfinite(trajectory.end.sum()):
        return Rest(steps, trajectory.residual_displacement, trajectory.residual_slip, status)
    slip = trajectory.end.reshape(END_ROWS, -1)[2].copy()
    return Rest(steps, rest_position(building, slip), slip, status)
