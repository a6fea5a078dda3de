"""Each method in its own limits: no friction, friction never overcome, massless or rigid braces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.methods import (
    EXACT,
    Bilinear,
    BoucWen,
    Dimova,
    EquivalentLinear,
    Method,
    Newmark,
    RigidPlastic,
    StateSpace,
)
from fdspec.model.building import Building, ModalDamping
from fdspec.model.motion import GroundMotion
from fdspec.runs.simulate import simulate
from fdspec.verification.problems import noise
from fdspec.verification.row import Row, at_most, relative
from fdspec.verification.steady_states import den_hartog_amplitude, steady_amplitude

WITH_MASS: Final[tuple[Method, ...]] = (Newmark(dt=1e-5), Dimova(dt=1e-3), StateSpace())
WITHOUT_MASS: Final[tuple[Method, ...]] = (Bilinear(dt=1e-3), BoucWen(), EquivalentLinear())
SAMPLED: Final = 1e-3
"""What reading a peak off samples leaves: (omega dt)^2 / 8 with 32 rad/s and 1e-3 s is 1e-4."""


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    motion = noise(6.0, 0.01, seed=31)
    yield from linear(motion)
    yield from massless(motion, full)
    yield from rigid(motion, full)


def storey(
    slip_force: float, brace_mass: float, brace_stiffness: float = 12.8e6, damping: float = 0.05
) -> Building:
    """Make the frame of these cases, 0.5 s."""
    return Building(20e3, 3.2e6, brace_mass, brace_stiffness, slip_force, damping=ModalDamping(damping))


def peak(building: Building, motion: GroundMotion, method: Method | None = None) -> float:
    """Peak acceleration by a method, the exact one unless given, m/s2."""
    history = simulate(building, motion) if method is None else simulate(building, motion, method=method)
    return float(history["peak_acceleration"][0])


def displacement(building: Building, motion: GroundMotion, method: str | Method) -> FloatArray:
    """Displacement of the floor at the motion's samples by a method, m."""
    return np.asarray(simulate(building, motion, method=method)["displacement"].values[:, 0])


def linear(motion: GroundMotion) -> Iterator[Row]:
    """No friction, and friction that is never overcome, against the exact engine's linear frames."""
    for force, label in ((0.0, "no friction"), (math.inf, "never slips")):
        for methods, brace_mass in ((WITH_MASS, 500.0), (WITHOUT_MASS, 0.0)):
            building = storey(force, brace_mass)
            exact = peak(building, motion)
            for method in methods:
                case = f"{method.name}, {label}"
                yield relative(
                    case, "peak acceleration, m/s2", exact, peak(building, motion, method), SAMPLED
                )


def massless(motion: GroundMotion, full: bool) -> Iterator[Row]:
    """Methods without brace mass against the exact engine's massless brace."""
    building = storey(45e3, 0.0)
    exact = peak(building, motion)
    sharp = BoucWen(exponent=60.0)
    narrow = Dimova(velocity_band=1e-5, dt=1e-3)
    for method, within in ((Bilinear(dt=1e-4), 1e-4), (sharp, 1e-2), (narrow, 1e-2)):
        case = f"{method.name}, massless brace"
        yield relative(case, "peak acceleration, m/s2", exact, peak(building, motion, method), within)
    laws: dict[str, Callable[[float], Method]] = {
        "bouc-wen, exponent 4 to 64": lambda k: BoucWen(exponent=4.0 * k),
        "dimova, band 0.016 to 0.001 m/s": lambda k: Dimova(velocity_band=0.016 / k, dt=1e-3),
    }
    reference = displacement(building, motion, EXACT)
    for name, law in laws.items() if full else ():
        # Of the whole motion: the error of one peak may pass through zero on the way.
        first, last = (
            float(np.max(np.abs(displacement(building, motion, law(k)) - reference))) for k in (1.0, 16.0)
        )
        yield at_most(f"{name}, massless brace", "last error of displacement over first", last / first, 0.25)


def rigid(motion: GroundMotion, full: bool) -> Iterator[Row]:
    """The rigid-plastic method: Den Hartog without a detour, and the limits of braces that grow stiff."""
    omega_n, mass = 2.0 * math.pi, 1000.0
    for r, beta, zeta in ((0.8, 0.5, 0.05), (1.5, 0.4, 0.05))[: 2 if full else 1]:
        frame = Building(mass, mass * omega_n**2, 1.0, 1e6, beta * mass, damping=ModalDamping(zeta))
        expected = den_hartog_amplitude(r, beta, zeta)
        positive, negative, _ = steady_amplitude(frame, r * omega_n, 1.0, 500, 25, method=RigidPlastic())
        computed = 0.5 * (positive + negative) * omega_n**2
        case = f"rigid-plastic, Den Hartog r {r:g}, F/P {beta:g}, zeta {zeta:g}"
        yield relative(case, "amplitude x0 k / P", expected, computed, 1e-3)
    method = RigidPlastic(dt=1e-4)
    free, locked = storey(0.0, 0.0), storey(math.inf, 0.0)
    yield relative(
        "rigid-plastic, no friction",
        "peak acceleration, m/s2",
        peak(free, motion),
        peak(free, motion, method),
        SAMPLED,
    )
    yield relative(
        "rigid-plastic, never slips",
        "peak acceleration, m/s2",
        motion.pga,
        peak(locked, motion, method),
        1e-9,
    )
    # Stopping, the frame's last speed swings on in the brace: the way there falls with its stiffness^(-1/2).
    soft, stiff = (
        float(simulate(storey(20e3, 0.0, brace_stiffness=3.2e6 * ratio), motion)["peak_displacement"][0])
        for ratio in (1e5, 1e7)
    )
    found = simulate(storey(20e3, 0.0), motion, method=RigidPlastic(dt=1e-5))
    yield relative(
        "rigid-plastic, braces of the exact engine that stiffen",
        "peak displacement, m",
        stiff + (stiff - soft) / 9.0,
        float(found["peak_displacement"][0]),
        2e-3,
    )
