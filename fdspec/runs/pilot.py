"""What a sweep costs on this machine, measured on small parts of it.

    core seconds = step * samples * steps + transition * transitions,

where `fdspec.runs.cost.steps_per_sample` gives the steps.  The two constants are fitted to the parts.  They
depend on the processor, on what runs beside, and on the study: histories that never slip share one, so that
strong dampers cost next to nothing.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.methods import Method
from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.columns import run_columns, timed, warm
from fdspec.runs.cost import middles, seconds_of_sweep, steps_per_sample
from fdspec.scheduling.task import cores

FloatArray = NDArray[np.float64]

RECORDS: Final = 3
"""Records that are tried, from the shortest to the longest."""

BANDS: Final = 6
"""Bands of period that are tried, each on its own."""

RATIOS: Final = 8
"""Stiffness ratios of one part at most; of all together one history is without brace."""

HISTORIES: Final = 400
"""Histories of one part, about: enough to fill the lanes in which the kernels work."""

FORCES: Final = 40
"""Pretensions of one part at most."""

REPEATS: Final = 2
"""Times that a part is run; the shorter time counts, the longer had a disturbance in it."""

WINDOW: Final = 512
"""Samples of the record for which a probe computes histories."""

PROBE: Final = 0.2
"""s of core time after which a probe has seen enough."""


LEAST: Final = 0.25
"""Part of the rough estimate below which no probe is believed: its clock is coarse."""


class Measured(NamedTuple):
    """A part of a study that was computed, and what it took."""

    seconds: float
    """Core time."""
    samples: float
    """Samples of all its histories."""
    steps: float
    """Steps of all its histories."""
    transitions: float


@dataclass(frozen=True)
class Cost:
    """Constants of the model, s, and how often phases change in the study."""

    step: float
    transition: float
    transitions_per_sample: float
    parts: tuple[Measured, ...] = ()

    def of_sweep(
        self, grid: Grid, motions: Sequence[GroundMotion], transitions: float | None = None
    ) -> float:
        """Core seconds of a sweep; transitions: of all histories, unless given as often as in the parts."""
        samples, steps = work_of(grid, motions)
        if transitions is None:
            transitions = self.transitions_per_sample * samples
        return self.step * steps + self.transition * transitions


def work_of(grid: Grid, motions: Sequence[GroundMotion]) -> tuple[float, float]:
    """Return samples and steps of all histories of a sweep."""
    n_f = grid.pretension.size * grid.intensities.size
    samples = float(sum(motion.n for motion in motions)) * grid.size
    steps = sum(n_f * motion.n * float(steps_per_sample(grid, motion.dt).sum()) for motion in motions)
    return samples, steps


def measured(grid: Grid, motions: Sequence[GroundMotion], certify: bool = True) -> Cost:
    """Compute small parts of a study here, on one core, and fit the model to what they take."""
    found = []
    for part, motion in parts_of(grid, motions):
        tries = [timed(part, motion, certify) for _ in range(REPEATS)]
        seconds = min(seconds for seconds, _ in tries)
        found.append(Measured(seconds, *work_of(part, [motion]), tries[0][1]))
    return fitted(found)


def fitted(parts: Sequence[Measured]) -> Cost:
    """Fit the constants, none negative, so that relative errors are smallest in the mean square."""
    from scipy.optimize import nnls

    rows = np.array([part[2:] for part in parts]) / np.array([[part.seconds] for part in parts])
    scale = rows.max(axis=0, initial=0.0)
    scale[scale == 0.0] = 1.0
    constants, _ = nnls(rows / scale, np.ones(len(parts)))
    step, transition = (constants / scale).tolist()
    samples = sum(part.samples for part in parts)
    per_sample = sum(part.transitions for part in parts) / samples
    return Cost(step, transition, per_sample, tuple(parts))


def parts_of(grid: Grid, motions: Sequence[GroundMotion]) -> Iterator[tuple[Grid, GroundMotion]]:
    """Give small grids from every band of period, under short and long records."""
    by_length = sorted(motions, key=lambda motion: motion.n)
    chosen = {by_length[k].name: by_length[k] for k in middles(len(by_length), RECORDS)}
    ratio = grid.stiffness_ratio[middles(grid.stiffness_ratio.size, RATIOS)]
    pretension = grid.pretension[middles(grid.pretension.size, FORCES)]
    periods = max(1, HISTORIES // (ratio.size * pretension.size))
    for motion in chosen.values():
        for band in np.array_split(grid.period, min(BANDS, grid.period.size)):
            period = band[middles(band.size, periods)]
            yield replace(grid, stiffness_ratio=ratio, pretension=pretension, period=period), motion


def wall_seconds(motions: Sequence[GroundMotion], grid: Grid, certify: bool = True) -> float:
    """Wall seconds that a sweep takes on this machine's cores, from some of its histories, computed here.

    They are taken around the strongest shaking, so that it is rather too much.
    """
    return sum(probed(motions, grid, certify, False, None)) / cores()


def probed(
    motions: Sequence[GroundMotion], grid: Grid, certify: bool, strain: bool, other: Method | None
) -> list[float]:
    """Core seconds of the histories of each motion: the rough estimate, scaled to what a few of them take.

    Those few run through the strongest shaking of the longest record, so that it is rather too much.
    """
    warm()
    longest = max(motions, key=lambda motion: motion.n)
    peak = int(np.argmax(np.abs(longest.acceleration)))
    first = max(0, min(peak - WINDOW // 4, longest.n - WINDOW))
    window = GroundMotion(longest.acceleration[first : first + WINDOW], longest.dt, name="window")
    nothing = GroundMotion(np.zeros(2), longest.dt, name="nothing")
    ratio = grid.stiffness_ratio[middles(grid.stiffness_ratio.size, 2)]
    pretension = grid.pretension[middles(grid.pretension.size, 8)]
    period = grid.period[middles(grid.period.size, 6)]
    part = replace(grid, stiffness_ratio=ratio, pretension=pretension, period=period)
    spent, expected = 0.0, 0.0
    for k in range(period.size):  # from the shortest, which costs most
        columns = np.arange(k, ratio.size * period.size, period.size)
        for motion, sign in ((nothing, -1), (window, 1)):  # what a call costs by itself is no history's
            started = time.thread_time()
            run_columns(part, certify, strain, other, columns, motion)
            spent += sign * (time.thread_time() - started)
        expected += sum(seconds_of_sweep(replace(part, period=period[k : k + 1]), [window], certify))
        if spent > PROBE:
            break
    scale = max(spent / expected, LEAST)
    return [scale * seconds for seconds in seconds_of_sweep(grid, motions, certify)]
