"""The two exact engines on the same histories: closed-form oscillators, and Taylor series for N storeys."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.single_storey import integrate_single_storey
from fdspec.engines.trajectory import Span
from fdspec.model.building import Building, ModalDamping
from fdspec.runs.sweep import sweep
from fdspec.verification.problems import FRAMES, frame, noise, shaking
from fdspec.verification.row import Row, relative, same_count

WITHIN = 1e-10


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    motion = shaking(20.0)
    span = Span(0, motion.dt, motion.n)
    named = {
        f"T {period:g} s, SR {ratio:g}, F {force / 1e3:g} kN": frame(period, ratio, force)
        for period, ratio, force in FRAMES[:: 1 if full else 5]
    }
    named["massless brace"] = Building(20e3, 3e6, 0.0, 12e6, 50e3, damping=ModalDamping(0.05))
    for name, building in named.items():
        start = np.zeros((2, 2, 1))
        one = integrate_single_storey(building, motion, span, start)
        other = integrate_many_storeys(building, motion, span, start)
        case = f"two engines, {name}"
        yield relative(
            case,
            "peak acceleration, m/s2",
            float(one.peak_acceleration[0]),
            float(other.peak_acceleration[0]),
            WITHIN,
        )
        yield same_count(case, "changes of phase", one.transition_time.size, other.transition_time.size)
    # Kinetic friction below static, where small differences grow: a short history.
    short = noise(3.0, 0.01, seed=11)
    building = frame(0.4, 4.0, 40e3, kinetic=0.7)
    start = np.zeros((2, 2, 1))
    span = Span(0, short.dt, short.n)
    one = integrate_single_storey(building, short, span, start)
    other = integrate_many_storeys(building, short, span, start)
    case = "two engines, kinetic friction 0.7 of static"
    peaks = float(one.peak_acceleration[0]), float(other.peak_acceleration[0])
    yield relative(case, "peak acceleration, m/s2", *peaks, 1e-8)
    yield same_count(case, "changes of phase", one.transition_time.size, other.transition_time.size)
    yield from swept()


def swept() -> Iterator[Row]:
    """A sweep, which runs many histories side by side, beside each of them by itself."""
    motion = shaking(10.0)
    cube = sweep(motion, period=[0.3, 0.6], stiffness_ratio=[1.0, 6.0], pretension=[40e3, 120e3])
    worst, counted, expected = (1.0, 1.0, 0.0), 0, 0
    for cell in cube["peak_acceleration"].stack(cell=[...]):
        one = integrate_single_storey(
            frame(float(cell["period"]), float(cell["stiffness_ratio"]), 0.5 * float(cell["pretension"])),
            motion,
            Span(0, motion.dt, 1),
            np.zeros((2, 2, 1)),
        )
        reference, computed = float(one.peak_acceleration[0]), float(cell)
        error = abs(computed / reference - 1.0)
        worst = max(worst, (reference, computed, error), key=lambda found: found[2])
        expected += one.transition_time.size
    counted = int(cube["transitions"].sum())
    yield relative("sweep of 8 beside each alone", "worst peak acceleration, m/s2", *worst[:2], WITHIN)
    yield same_count("sweep of 8 beside each alone", "changes of phase in all", expected, counted)
