"""From a motion that is known at the ends of equal steps to a `Trajectory`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdspec.engines.trajectory import FloatArray, IntArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.methods.matrices import drifts
from fdspec.methods.method import Method
from fdspec.model.building import Building

MOST_STEPS = 10_000_000
"""Steps of a history that is kept whole."""


@dataclass(frozen=True)
class Samples:
    """A history at k * step, k = 0 .. m; arrays (m + 1, N), SI units."""

    step: float
    ground: FloatArray
    """(m, 2): acceleration at both ends of each step"""
    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    """absolute"""
    brace_displacement: FloatArray
    brace_velocity: FloatArray
    brace_acceleration: FloatArray
    """absolute; whatever it is where the brace has no mass"""
    friction_force: FloatArray
    phase: IntArray
    held_force: FloatArray | None = None
    """(m, N): friction over each step where the method holds it, else it is linear"""
    status: int = 0


def count_steps(method: Method, intervals: int, parts: int) -> int:
    """Steps of a history, or InvalidInput where they are too many to keep."""
    steps = intervals * parts
    if steps > MOST_STEPS:
        raise InvalidInput(
            f"dt of method {method.name!r} gives {steps} steps; at most {MOST_STEPS} are kept, "
            "so it must be longer"
        )
    return steps


def stepwise(intervals: FloatArray, parts: int) -> FloatArray:
    """Ground acceleration at both ends of each step (m * parts, 2), from that of intervals (m, 2)."""
    share = np.arange(parts + 1) / parts
    points = intervals[:, :1] + (intervals[:, 1:] - intervals[:, :1]) * share
    return np.stack([points[:, :-1].ravel(), points[:, 1:].ravel()], axis=1)


def running_sum(pieces: FloatArray) -> FloatArray:
    """Integral up to each instant from those over the steps."""
    return np.concatenate([np.zeros((1, *pieces.shape[1:])), np.cumsum(pieces, axis=0)])


def mean_of_ends(values: FloatArray) -> FloatArray:
    """Return the mean over each step of what is linear in it."""
    return np.asarray(0.5 * (values[1:] + values[:-1]))


def trajectory_of(building: Building, samples: Samples, span: Span) -> Trajectory:
    """Work out shears, energies, peaks and changes of phase, and with the trajectory at the output instants.

    Peaks are those of the samples, energies integrals by the trapezoidal rule.
    """
    s, D, h = samples, drifts(building.n_storeys), samples.step
    drift = s.displacement @ D.T
    below = s.displacement - drift
    stretch_rate = s.brace_velocity - (s.velocity - s.velocity @ D.T)
    inertia = building.floor_mass * s.acceleration + building.brace_mass * s.brace_acceleration
    shear = -np.cumsum(inertia[:, ::-1], axis=1)[:, ::-1]
    momentum = s.velocity @ building.floor_mass + s.brace_velocity @ building.brace_mass
    given = -0.5 * h * (momentum[:-1] * s.ground[:, 0] + momentum[1:] * s.ground[:, 1])
    lost = np.einsum("ti,ij,tj->t", s.velocity, building.damping_matrix, s.velocity)
    lost += stretch_rate**2 @ building.brace_damping
    offset = s.displacement - s.brace_displacement
    slip = np.diff(offset, axis=0)
    force = mean_of_ends(s.friction_force) if s.held_force is None else s.held_force
    travel, friction = running_sum(np.abs(slip)), running_sum(force * slip)
    input_energy, viscous = running_sum(given), running_sum(h * mean_of_ends(lost))
    energy = _stored(building, s)
    missing = input_energy[-1] + energy[0] - energy[-1] - viscous[-1] - friction[-1].sum()
    scale = abs(input_energy[-1]) + energy[0]
    counted = np.where(building.slip_force > 0.0, s.phase, 0)
    at, storey = np.nonzero(np.diff(counted, axis=0, prepend=0))
    read = _Reader(span, h, s.displacement.shape[0])
    brace_force = building.brace_stiffness * (s.brace_displacement - below)
    brace_force += building.brace_damping * stretch_rate
    columns = np.cumsum((s.displacement @ building.stiffness_matrix)[:, ::-1], axis=1)[:, ::-1]
    offset = np.where(building.brace_stiffness > 0.0, offset, 0.0)
    peak_shear = np.max(np.abs(shear), axis=0)
    return Trajectory(
        displacement=read(s.displacement),
        velocity=read(s.velocity),
        acceleration=read(s.acceleration),
        brace_displacement=read(s.brace_displacement),
        brace_velocity=read(s.brace_velocity),
        friction_force=read(s.friction_force),
        phase=s.phase[read.index],
        slip_travel=read(travel),
        storey_friction_energy=read(friction),
        storey_shear=read(shear),
        input_energy=read(input_energy),
        viscous_energy=read(viscous),
        transition_time=np.asarray(at * h, dtype=np.float64),
        transition_storey=storey,
        transition_phase=counted[at, storey],
        peak_acceleration=np.max(np.abs(s.acceleration), axis=0),
        peak_displacement=np.max(np.abs(s.displacement), axis=0),
        peak_velocity=np.max(np.abs(s.velocity), axis=0),
        peak_drift=np.max(np.abs(drift), axis=0),
        peak_storey_shear=peak_shear,
        peak_base_shear=float(peak_shear[0]),
        residual_displacement=s.displacement[-1].copy(),
        peak_slip=np.max(np.abs(offset), axis=0),
        residual_slip=offset[-1].copy(),
        peak_brace_force=np.max(np.abs(brace_force), axis=0),
        peak_column_shear=np.max(np.abs(columns), axis=0),
        dissipated_energy=float(friction[-1].sum()),
        energy_error=float(abs(missing) / scale) if scale > 0.0 else 0.0,
        status=s.status,
    )


def _stored(building: Building, s: Samples) -> FloatArray:
    """Kinetic and elastic energy (2,) at start and end."""
    ends = [0, -1]
    u, v, d, e = (x[ends] for x in (s.displacement, s.velocity, s.brace_displacement, s.brace_velocity))
    below = u - u @ drifts(building.n_storeys).T
    return np.asarray(
        0.5
        * (
            v**2 @ building.floor_mass
            + e**2 @ building.brace_mass
            + np.einsum("ti,ij,tj->t", u, building.stiffness_matrix, u)
            + (d - below) ** 2 @ building.brace_stiffness
        )
    )


class _Reader:
    """Reads samples off at the output instants, linear between them."""

    def __init__(self, span: Span, h: float, samples: int) -> None:
        place = np.minimum(np.arange(span.outputs) * span.dt_out / h, samples - 1)
        self.index = np.minimum((place + 1e-6).astype(np.int64), samples - 1)
        self.next = np.minimum(self.index + 1, samples - 1)
        self.share = np.clip(place - self.index, 0.0, 1.0)

    def __call__(self, values: FloatArray) -> FloatArray:
        share = self.share.reshape(-1, *(1,) * (values.ndim - 1))
        return np.asarray((1.0 - share) * values[self.index] + share * values[self.next])
