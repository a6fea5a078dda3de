"""What a sweep costs: core time of a history as a function of period, stiffness ratio, dt and transitions.

    core seconds = step * samples * steps + transition * transitions,

where each sample takes steps = ceil(omega dt), omega = 2 pi / period sqrt((1 + SR) / (1 + m_d / m_f)) being
the frequency, rad/s, of floor and brace moving as one.  The two constants are measured on this machine on
small parts of the study.  They depend on the processor, on what runs beside, and on the study: histories that
never slip share one, so that strong dampers cost next to nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.sweep import timed

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


def steps_per_sample(grid: Grid, dt: float) -> FloatArray:
    """Steps that a history takes in each sample, (stiffness ratio, period)."""
    held = (1.0 + grid.stiffness_ratio) / (1.0 + grid.brace_mass / grid.floor_mass)
    omega = 2.0 * np.pi * np.sqrt(held)[:, np.newaxis] / grid.period
    steps: FloatArray = np.maximum(1.0, np.ceil(omega * dt))
    return steps


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
    chosen = {by_length[k].name: by_length[k] for k in _spread(len(by_length), RECORDS)}
    ratio = grid.stiffness_ratio[_spread(grid.stiffness_ratio.size, RATIOS)]
    pretension = grid.pretension[_spread(grid.pretension.size, FORCES)]
    periods = max(1, HISTORIES // (ratio.size * pretension.size))
    for motion in chosen.values():
        for band in np.array_split(grid.period, min(BANDS, grid.period.size)):
            period = band[_spread(band.size, periods)]
            yield replace(grid, stiffness_ratio=ratio, pretension=pretension, period=period), motion


def _spread(size: int, count: int) -> NDArray[np.int64]:
    """Positions of at most `count` things of so many: in the middle of as many equal shares."""
    count = min(size, count)
    return ((np.arange(count) + 0.5) * size / count).astype(np.int64)
