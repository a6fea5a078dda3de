"""The study's scheme beside the exact engine: agreement, order, and the claim of the README about both."""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter
from typing import Final

import numpy as np

from fdspec.methods import Newmark, StateSpace
from fdspec.records import load_record
from fdspec.runs.simulate import simulate
from fdspec.runs.sweep import sweep
from fdspec.validation import four_storey, kalamata, single_storey_k_braced
from fdspec.verification.problems import FRAMES, frame, shaking
from fdspec.verification.row import Row, absolute, at_least, at_most, relative

STUDY_STEP: Final = 1e-6
"""s"""

WITHIN: Final = 1e-5
"""Error in peak acceleration that the study's step leaves on its validation problems."""

TIMES_FASTER: Final = 1000.0
"""What README claims at least: "thousands of times"."""

CLAIM: Final = {
    "period": [0.4, 0.5, 0.6],
    "stiffness_ratio": [4.0, 8.0],
    "pretension": 20e3 + 30e3 * np.arange(6),
}
"""A piece of the study's grid, in which most histories slip."""


def rows(full: bool) -> Iterator[Row]:
    """Yield the rows of this family."""
    yield from agreement(full)
    yield from order(full)
    yield from claim()


def agreement(full: bool) -> Iterator[Row]:
    """Both validation problems with the study's step."""
    motion = kalamata.stand_in()
    problems = {
        "K-braced storey": single_storey_k_braced.building(),
        "four-storey frame": four_storey.building(),
    }
    for name, building in problems.items():
        exact = simulate(building, motion)["peak_acceleration"].values
        for beta, label in ((1 / 4, "1/4"), (1 / 6, "1/6"))[: 2 if full else 1]:
            stepped = simulate(building, motion, method=Newmark(dt=STUDY_STEP, beta=beta))
            found = stepped["peak_acceleration"].values
            worst = int(np.argmax(np.abs(found / exact - 1.0)))
            yield relative(
                f"study's scheme, 1e-6 s, beta {label}, {name}",
                f"peak acceleration of floor {worst + 1}, m/s2",
                float(exact[worst]),
                float(found[worst]),
                WITHIN,
            )


def order(full: bool) -> Iterator[Row]:
    """Order at which the error in peak acceleration falls with the step: a line through its logarithms.

    A change of phase falls anywhere in its step, so that the error of one history jumps about; what is told
    is the geometric mean over many.
    """
    motion = shaking(8.0)
    newmark = (1e-4, 3e-5, 1e-5, 3e-6, 1e-6)[: 5 if full else 3]
    schemes: list[tuple[type[Newmark | StateSpace], tuple[float, ...]]] = [(Newmark, newmark)]
    if full:
        schemes.append((StateSpace, (3e-4, 1e-4, 3e-5)))
    exact = [float(simulate(frame(*numbers), motion)["peak_acceleration"][0]) for numbers in FRAMES]
    for maker, steps in schemes:
        errors = np.empty((len(steps), len(FRAMES)))
        for row, step in enumerate(steps):
            for column, numbers in enumerate(FRAMES):
                stepped = simulate(frame(*numbers), motion, method=maker(dt=step))
                errors[row, column] = abs(float(stepped["peak_acceleration"][0]) / exact[column] - 1.0)
        typical = np.log(np.maximum(errors, np.finfo(float).eps)).mean(axis=1)
        slope = float(np.polyfit(np.log(steps), typical, 1)[0])
        case, quantity = f"{maker.name}, {len(FRAMES)} histories", "order of the error in dt"
        if maker is Newmark:
            yield absolute(case, quantity, 1.0, slope, 0.2)
        else:
            yield at_least(case, quantity, 1.0, slope)


def claim() -> Iterator[Row]:
    """README: thousands of times faster than the study's scheme, and exact: both in this run, on one core.

    Exact histories come from a sweep of a piece of the study's grid, the study's scheme does one of them, so
    that its time is of the same history as its error.
    """
    motion = load_record("FSR1")
    sweep(motion, **CLAIM, workers=1)  # type: ignore[arg-type]
    began = perf_counter()
    cube = sweep(motion, **CLAIM, workers=1)  # type: ignore[arg-type]
    each = (perf_counter() - began) / cube["peak_acceleration"].size
    building = frame(0.5, 4.0, 40e3)
    began = perf_counter()
    stepped = simulate(building, motion, method=Newmark(dt=STUDY_STEP))
    theirs = perf_counter() - began
    exact = simulate(building, motion)
    peaks = float(exact["peak_acceleration"][0]), float(stepped["peak_acceleration"][0])
    case = "README: exact engine beside the study's scheme"
    yield at_least(case, "time of a history, theirs over ours", TIMES_FASTER, theirs / each)
    yield at_most(case, "our error of energy over input", float(exact["energy_error"]), 1e-9)
    yield relative(case, "peak acceleration, theirs, m/s2", *peaks, WITHIN)
