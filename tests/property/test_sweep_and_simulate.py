"""A sweep judges steps by their ends and defers what it can; a history is searched throughout: same numbers.

The cells are made to be hard for the shorter way: records so short that hardly a step has another behind it,
records cut where something is largest, and slip forces read off a history, so that the reaction comes to the
slip force exactly at a sample, or at its very maximum, or misses it by rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from numba import config
from numpy.typing import NDArray

import fdspec
from fdspec.engines.batch import integrate_columns
from fdspec.engines.single_storey import integrate_single_storey
from fdspec.engines.trajectory import Span, Trajectory
from fdspec.kernels.storey.history import RESULTS

FloatArray = NDArray[np.float64]

WITHIN = 1e-9
"""Of the largest of each kind in a history."""

TIES = (1.0, 1.0 - 1e-15, 1.0 + 1e-15)


@dataclass(frozen=True)
class Hard:
    """A frame's row of `integrate_columns`, a motion and a slip force."""

    number: int
    frame: tuple[float, ...]
    motion: fdspec.GroundMotion
    slip_force: float
    kinetic_slip_force: float


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def frame_of(rng: np.random.Generator) -> tuple[float, ...]:
    """Floor mass, damping, stiffness, brace mass, damping, stiffness; the brace often massless or damped."""
    mass = 20e3
    stiffness = mass * (2.0 * math.pi / log_uniform(rng, 0.05, 4.0)) ** 2
    damping = 2.0 * math.sqrt(stiffness * mass) * float(rng.choice([0.0, 0.02, 0.05, rng.uniform(0.0, 0.3)]))
    brace = stiffness * log_uniform(rng, 0.1, 40.0)
    brace_mass = 0.0 if rng.integers(3) == 0 else log_uniform(rng, 5.0, 3000.0)
    brace_damping = 0.0
    if rng.integers(2) == 0:
        reference = brace_mass if brace_mass > 0.0 else 200.0
        brace_damping = 2.0 * float(rng.uniform(0.01, 0.3)) * math.sqrt(brace * reference)
    return mass, damping, stiffness, brace_mass, brace_damping, brace


def ground_of(rng: np.random.Generator, samples: int, dt: float) -> FloatArray:
    """A constant, a sine with samples at its turns, steps, or noise."""
    k = np.arange(samples)
    kind = rng.integers(4)
    size = log_uniform(rng, 0.2, 10.0)
    if kind == 0:
        return size * np.ones(samples)
    if kind == 1:
        return size * np.sin(math.pi * k / int(rng.choice([4, 5, 10, 20])))
    if kind == 2:
        return size * np.sign(np.sin(math.pi * (k + 0.5) / int(rng.choice([5, 12]))))
    return size * np.cumsum(rng.standard_normal(samples)) / math.sqrt(samples)


def history_of(
    frame: tuple[float, ...], slip_force: float, kinetic: float, motion: fdspec.GroundMotion
) -> Trajectory:
    mass, damping, stiffness, brace_mass, brace_damping, brace = frame
    building = fdspec.Building(
        [mass],
        [stiffness],
        [brace_mass],
        [brace],
        [slip_force],
        kinetic_slip_force=[kinetic],
        damping=fdspec.DampingMatrix([[damping]]),
        brace_damping=[brace_damping],
    )
    return integrate_single_storey(building, motion, Span(0, motion.dt, motion.n), np.zeros((2, 2, 1)))


def draw(number: int) -> Hard:
    """The cell of this number, which depends on the number alone."""
    rng = np.random.default_rng([number, 7])
    frame = frame_of(rng)
    dt = float(rng.choice([0.002, 0.005, 0.01, 0.02]))
    motion = fdspec.GroundMotion(ground_of(rng, int(rng.integers(3, 80)), dt), dt, name=str(number))
    stuck = history_of(frame, math.inf, 0.0, motion)
    reached = np.abs(stuck.friction_force[:, 0])
    kind = rng.integers(4)
    if kind == 0:  # the reaction at some sample
        force = float(rng.choice(reached[1:])) * float(rng.choice(TIES))
    elif kind == 1:  # its largest
        force = float(reached.max()) * float(rng.choice(TIES))
    else:
        force = float(reached.max()) * log_uniform(rng, 0.02, 0.98)
    force = max(force, 1e-6)
    # With less kinetic friction a tie is a fork: slip or not, by the last bit.
    below = kind > 1 and rng.integers(3) == 0
    ratio = float(rng.choice([0.999999, rng.uniform(0.3, 0.999)])) if below else 1.0
    if kind > 1 or rng.integers(3) == 0:  # cut where something has just passed an earlier swing
        whole = history_of(frame, force, ratio * force, motion)
        quantities = (whole.displacement, whole.velocity, whole.acceleration, whole.storey_shear)
        size = np.abs(quantities[rng.integers(4)][:, 0])
        so_far = np.maximum.accumulate(size)
        new = np.flatnonzero((size[2:] > so_far[1:-1]) & (size[1:-1] < so_far[1:-1])) + 2
        last = int(rng.choice(new)) if new.size else int(np.argmax(size[1:])) + 1
        motion = fdspec.GroundMotion(motion.acceleration[: last + 1], dt, name=str(number))
    return Hard(number, frame, motion, force, ratio * force)


def differences(cell: Hard) -> list[str]:
    """What a sweep of the cell, with and without the certificate, has otherwise than its history."""
    told = history_of(cell.frame, cell.slip_force, cell.kinetic_slip_force, cell.motion)
    pga = float(np.abs(cell.motion.acceleration).max())
    wanted = {
        "peak_acceleration": (told.peak_acceleration[0], max(told.peak_acceleration[0], pga)),
        "peak_displacement": (told.peak_displacement[0], told.peak_displacement[0]),
        "peak_velocity": (told.peak_velocity[0], told.peak_velocity[0]),
        "peak_base_shear": (told.peak_base_shear, told.peak_base_shear),
        "residual_displacement": (told.residual_displacement[0], told.peak_displacement[0]),
        "slip_travel": (told.slip_travel[-1, 0], told.peak_displacement[0]),
        "dissipated_energy": (told.dissipated_energy, cell.slip_force * told.peak_displacement[0]),
        "status": (told.status, 1.0),
    }
    found = []
    for certify in (True, False):
        _, results = integrate_columns(
            np.array([cell.frame]),
            np.array([cell.slip_force]),
            np.array([cell.kinetic_slip_force]),
            cell.motion,
            certify=certify,
        )
        of_sweep = dict(zip(RESULTS, results[0, 0], strict=True))
        for name, (value, scale) in wanted.items():
            off = abs(of_sweep[name] - value)
            if not off <= WITHIN * scale:
                found.append(f"{name} {of_sweep[name]!r} for {value!r} (certify={certify})")
        if certify and not max(of_sweep["energy_error"], told.energy_error) <= WITHIN:
            found.append(f"energy errors {of_sweep['energy_error']:.1e} and {told.energy_error:.1e}")
    return found


def check(first: int, last: int) -> None:
    wrong = {number: found for number in range(first, last) if (found := differences(draw(number)))}
    assert not wrong, f"{len(wrong)} of {last - first}: {dict(list(wrong.items())[:5])}"


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="an hour without the JIT")
def test_a_thousand_hard_cells() -> None:
    check(0, 1_000)


@pytest.mark.slow
def test_twenty_thousand_hard_cells() -> None:
    check(1_000, 21_000)
