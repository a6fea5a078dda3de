"""Hands the kernel of balanced steps its arrays and takes them back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdspec.engines.trajectory import FloatArray, IntArray
from fdspec.methods.matrices import Step


@dataclass(frozen=True)
class Dampers:
    """How dampers enter a step: see `fdspec.kernels.fixed_step.balanced`."""

    kind: int
    first: FloatArray
    """(n, m): of w at the step's start"""
    last: FloatArray
    """(n, m): of w at its end"""
    trial: FloatArray
    """Y (m, n)"""
    relief: FloatArray
    """S (m, m)"""
    spring: FloatArray
    static: FloatArray
    kinetic: FloatArray


def march(
    step: Step,
    pull: tuple[FloatArray, FloatArray],
    dampers: Dampers,
    ground: FloatArray,
    parts: int,
    state: FloatArray,
    offset: FloatArray,
    phase: IntArray,
) -> tuple[FloatArray, FloatArray, IntArray, int]:
    """Return states (k, n), w (k, m) and phases (k, m) at the ends of all steps, and a status.

    pull: what the ground acceleration at start and end of a step adds; ground (j, 2): at both ends of each
    interval of ``parts`` steps.
    """
    from fdspec.kernels.fixed_step.balanced import march as kernel

    steps = ground.shape[0] * parts
    states = np.full((steps + 1, state.size), np.nan)
    w = np.full((steps + 1, offset.size), np.nan)
    phases = np.zeros((steps + 1, offset.size), np.int64)
    states[0], w[0], phases[0] = state, offset, phase
    status = kernel(
        np.ascontiguousarray(step.A),
        np.ascontiguousarray(np.stack(pull)),
        np.ascontiguousarray(dampers.first),
        np.ascontiguousarray(dampers.last),
        np.ascontiguousarray(dampers.trial),
        np.ascontiguousarray(dampers.relief),
        dampers.spring.copy(),
        dampers.static.copy(),
        dampers.kinetic.copy(),
        ground,
        parts,
        dampers.kind,
        states,
        w,
        phases,
    )
    return states, w, phases, int(status)
