"""Histories on which several families of cases stand."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.records import load_record

FRAMES: Final = tuple(
    (period, ratio, force)
    for period in (0.2, 0.3, 0.5, 0.8, 1.2, 1.6)
    for ratio, force in ((1.0, 15e3), (4.0, 50e3), (8.0, 30e3), (10.0, 60e3))
)
"""Period (s), stiffness ratio and slip force (N) of single-storey frames over the study's ranges."""


def frame(period: float, stiffness_ratio: float, slip_force: float, kinetic: float = 1.0) -> Building:
    """Make the study's example frame."""
    return Building.single_storey(
        period=period,
        stiffness_ratio=stiffness_ratio,
        slip_force=slip_force,
        kinetic_slip_force=kinetic * slip_force,
    )


def shaking(seconds: float) -> GroundMotion:
    """Some seconds of FSR1, from the catalogue, from three before its peak on."""
    record = load_record("FSR1")
    start = int(np.argmax(np.abs(record.acceleration))) - round(3.0 / record.dt)
    samples = record.acceleration[start : start + round(seconds / record.dt) + 1]
    return GroundMotion(samples, record.dt, name="FSR1, part")


def noise(seconds: float, dt: float, seed: int, pga: float = 4.0) -> GroundMotion:
    """White noise under a bell, from a fixed seed, m/s2."""
    n = round(seconds / dt) + 1
    x = np.random.default_rng(seed).standard_normal(n) * np.sin(np.linspace(0.0, math.pi, n)) ** 2
    return GroundMotion(pga * x / np.max(np.abs(x)), dt, name=f"noise {seed}")


def still(seconds: float, dt: float) -> GroundMotion:
    """No motion."""
    return GroundMotion(np.zeros(round(seconds / dt) + 1), dt, name="still")


def two_storeys(slip_force: tuple[float, float] = (60e3, 35e3), kinetic: float = 1.0) -> Building:
    """Make a frame of two storeys whose braces are heavy enough for a general solver."""
    return Building(
        floor_mass=[20e3, 18e3],
        storey_stiffness=[9e6, 7e6],
        brace_mass=[500.0, 400.0],
        brace_stiffness=[25e6, 20e6],
        slip_force=slip_force,
        kinetic_slip_force=[kinetic * force for force in slip_force],
        damping=ModalDamping(0.03),
    )


def rubbing(
    mass: float,
    stiffness: float,
    damping_ratio: float,
    force: float,
    brace_omega: float,
    heavier: float,
    brace_damping_ratio: float,
) -> Building:
    """Make a floor that rubs on the ground: a brace ``heavier`` times its mass, at ``brace_omega`` rad/s.

    A brace so heavy and stiff moves with the ground; where the ground moves it needs a critical dashpot, for
    the first sample's jump would make it ring for ever.
    """
    brace = heavier * mass
    return Building(
        mass,
        stiffness,
        brace,
        brace * brace_omega**2,
        force,
        damping=ModalDamping(damping_ratio),
        brace_damping=2.0 * brace_damping_ratio * brace * brace_omega,
    )
