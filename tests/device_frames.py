"""Random buildings with devices, and random motions: seeded, from gentle to adversarial."""

from __future__ import annotations

from typing import Any

import numpy as np

import fdspec
from fdspec.model.link import Link, TensionBrace

GRAVITY = 9.80665


def random_motion(rng: np.random.Generator, seconds: float) -> fdspec.GroundMotion:
    """Sum of sines under an envelope, or white noise, at 0.1 to 1.2 g."""
    dt = float(rng.choice([0.005, 0.01, 0.02]))
    n = max(2, int(seconds / dt) + 1)
    t = np.arange(n) * dt
    if rng.random() < 0.2:
        x = rng.normal(size=n)
    else:
        x = np.zeros(n)
        for _ in range(8):
            x += rng.uniform(0.2, 1.0) * np.sin(
                2.0 * np.pi * rng.uniform(0.3, 9.0) * t + rng.uniform(0.0, 6.3)
            )
    x *= np.minimum(1.0, t / (0.2 * seconds))
    x *= rng.uniform(0.1, 1.2) * GRAVITY / np.abs(x).max()
    return fdspec.GroundMotion(x, dt, name="random")


def random_building(
    rng: np.random.Generator, most_storeys: int = 10, *, adversarial: bool = False, beside: bool = False
) -> fdspec.Building:
    """A frame of 1 to ``most_storeys`` storeys with a random mixture of devices.

    adversarial: forces that tie, slots of no length to speak of, kinetic friction of 0, light plates, many
    plates at one floor.  beside: every storey stands on any floor before it or on the ground.
    """
    size = int(rng.integers(1, most_storeys + 1))
    mass = rng.uniform(1e4, 5e4, size)
    period = rng.uniform(0.08, 0.25) * size + rng.uniform(0.0, 0.5)
    stiffness = np.full(size, mass.mean() * (2.0 * np.pi / period) ** 2 * (0.4 * size + 0.6) ** 2)
    stiffness *= rng.uniform(0.6, 1.4, size)
    weight = np.cumsum(mass[::-1])[::-1] * GRAVITY
    height = rng.uniform(2.8, 4.5, size)
    braced = rng.random(size) < 0.85
    with_mass = rng.random(size) < 0.7
    brace = stiffness * rng.choice([0.3, 2.0, 5.0, 10.0]) * braced
    plate = np.where(braced & with_mass, 10.0 ** rng.uniform(0.7 if adversarial else 1.3, 2.6, size), 0.0)
    share = 10.0 ** rng.uniform(-2.0 if adversarial else -1.3, -0.2, size)
    slip = np.where(braced, share * weight, 0.0)
    if adversarial and rng.random() < 0.3:
        slip[:] = np.where(braced, slip.max(), 0.0)
    if adversarial:
        slip[rng.random(size) < 0.1] = 0.0
    kinetic = slip * rng.choice([1.0, 1.0, 0.9, 0.5, 0.0 if adversarial else 0.7])
    dashpot = np.where(braced & (rng.random(size) < 0.15), 0.02 * brace / 20.0, 0.0)
    devices: dict[str, Any] = {"storey_height": height}
    if rng.random() < 0.7:
        strength = 10.0 ** rng.uniform(-1.3, -0.1, size) * weight
        strength[rng.random(size) < 0.2] = np.inf
        devices["yield_shear"] = strength
        devices["hardening_ratio"] = float(rng.choice([0.0, 0.02, 0.1, 0.5, -0.02, -0.1]))
    if rng.random() < 0.5:
        devices["gravity_load"] = np.minimum(weight * rng.uniform(0.1, 1.5), 0.6 * stiffness * height)
    if rng.random() < 0.5:
        length = 10.0 ** rng.uniform(-5.0 if adversarial else -2.7, -1.3, size)
        devices["slot_length"] = np.where(braced, length, np.inf)
        devices["slot_stiffness"] = brace * rng.choice([0.5, 2.0, 20.0])
    if rng.random() < 0.3:
        devices["recentring_stiffness"] = brace * rng.uniform(0.0, 0.3)
    links = [_random_link(rng, size, weight, stiffness, adversarial) for _ in range(int(rng.integers(0, 5)))]
    if beside:
        devices["stands_on"] = [int(rng.integers(0, floor + 1)) for floor in range(size)]
    return fdspec.Building(
        mass,
        stiffness,
        plate,
        brace,
        slip,
        kinetic,
        damping=fdspec.ModalDamping(float(rng.uniform(0.0, 0.06))),
        brace_damping=dashpot,
        links=links,
        **devices,
    )


def _random_link(
    rng: np.random.Generator,
    size: int,
    weight: np.ndarray[Any, Any],
    stiffness: np.ndarray[Any, Any],
    adversarial: bool,
) -> Link | TensionBrace:
    upper = int(rng.integers(1, size + 1))
    lower = int(rng.choice([i for i in range(size + 1) if i != upper]))
    force = float(10.0 ** rng.uniform(-1.7, -0.4) * weight[0])
    spring = float(stiffness[0] * 10.0 ** rng.uniform(-0.7, 0.8))
    if rng.random() < 0.3:
        return TensionBrace(
            upper,
            lower,
            spring,
            force if rng.random() < 0.7 else None,
            slack=float(rng.choice([0.0, 0.002, 0.02])),
            direction=int(rng.choice([-1, 1])),
        )
    options: dict[str, float] = {}
    if rng.random() < 0.3:
        options["kinetic_slip_force"] = force * float(rng.choice([0.9, 0.6, 0.0 if adversarial else 0.8]))
    if rng.random() < 0.3:
        options["slot_length"] = float(10.0 ** rng.uniform(-5.0 if adversarial else -2.7, -1.3))
        options["slot_stiffness"] = spring * float(rng.choice([0.5, 3.0]))
    if rng.random() < 0.5:
        options["mass"] = float(10.0 ** rng.uniform(0.7 if adversarial else 1.3, 2.8))
        if rng.random() < 0.3:
            options["recentring_stiffness"] = 0.1 * spring
    elif rng.random() < 0.6:
        options["recentring_stiffness"] = float(rng.uniform(0.01, 0.5)) * spring
        options["recentring_preload"] = force * float(rng.choice([0.0, 0.5, 1.3]))
        options["friction_stiffness"] = options["recentring_stiffness"] * float(rng.choice([0.0, 0.5, 1.0]))
    return Link(upper, lower, spring, force, **options)
