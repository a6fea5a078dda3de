"""Random frames with devices: nothing depends on the step, energy closes, nothing ends badly.

The default runs look at a few dozen frames, the slow ones at thousands; FDSPEC_RANDOM_FRAMES sets another
number for a campaign.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence

import numpy as np
import pytest

import fdspec
from fdspec.engines.devices import Outcome, run
from fdspec.engines.trajectory import Span
from fdspec.kernels.devices import layout as row
from fdspec.kernels.types import COLLAPSED, OK
from tests.device_frames import random_building, random_motion

COUNTS = [row.EVENTS, row.CONTACTS]


def frames(usual: int) -> int:
    return int(os.environ.get("FDSPEC_RANDOM_FRAMES", usual))


def outcome(
    building: fdspec.Building, motion: fdspec.GroundMotion, factor: float = 1.0, **options: float
) -> Outcome:
    shaken = motion if factor == 1.0 else motion.scaled(factor)
    start = np.zeros((2, 2, building.n_storeys))
    return run(building.device_frame, shaken, Span(0, motion.dt, 1), start, None, **options)  # type: ignore[arg-type]


def difference(one: Outcome, other: Outcome) -> float:
    return float((np.abs(one.peaks - other.peaks) / np.maximum(np.abs(one.peaks), 1e-12)).max())


def check_subdivision(seeds: Sequence[int], seconds: float, *, beside: bool = False) -> None:
    """Another step and another order give the same peaks and counts.

    A frame that makes 1e-15 of its ground motion felt (chaos: rounding itself is felt as much) is held to
    what it makes of that, and to nothing else.
    """
    compared = 0
    for seed in seeds:
        rng = np.random.default_rng(seed)
        building, motion = random_building(rng, beside=beside), random_motion(rng, seconds)
        one = outcome(building, motion)
        assert one.totals["status"] in (OK, COLLAPSED), seed
        other = outcome(building, motion, radians=1.1, extra_terms=2)
        apart = difference(one, other)
        same = np.array_equal(one.tally[COUNTS], other.tally[COUNTS])
        if apart > 1e-10 or not same:
            felt = [outcome(building, motion, 1.0 + k * 2e-15) for k in (1, 2, 3, 4)]
            assert apart <= 30.0 * max(difference(one, each) for each in felt), seed
            assert same or any(not np.array_equal(one.tally[COUNTS], each.tally[COUNTS]) for each in felt), (
                seed
            )
        else:
            compared += 1
    assert compared >= 0.9 * len(seeds)


def check_nothing_ends_badly(seeds: Iterable[int], seconds: float, *, beside: bool = False) -> None:
    """No status but a true collapse, a balance that closes."""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        building, motion = random_building(rng, adversarial=True, beside=beside), random_motion(rng, seconds)
        one = outcome(building, motion)
        assert one.totals["status"] in (OK, COLLAPSED), seed
        assert one.totals["energy_error"] <= 1e-9, seed
        if one.totals["status"] == COLLAPSED:
            storey = int(one.totals["collapse_storey"])
            assert (building.gravity_load > 0.0).any() or (building.hardening_ratio < 0.0).any(), seed
            assert one.peaks[3, storey] == pytest.approx(0.1 * building.storey_height[storey]), seed


def test_nothing_depends_on_the_step() -> None:
    check_subdivision(range(1000, 1020), 3.0)


def test_a_brace_that_stops_a_moment_before_its_neighbour() -> None:
    """It stands at its limit to rounding when the next event comes, which must not let it slip again."""
    check_subdivision([10_237], 2.0)


def test_nothing_depends_on_the_step_in_frames_beside_each_other() -> None:
    check_subdivision(range(2000, 2010), 3.0, beside=True)


def test_adversarial_frames_beside_each_other_end_well() -> None:
    check_nothing_ends_badly(range(300, 310), 2.0, beside=True)


def test_adversarial_frames_end_well() -> None:
    check_nothing_ends_badly(range(20), 2.0)


@pytest.mark.slow
@pytest.mark.parametrize("part", range(2))
def test_nothing_depends_on_the_step_in_two_thousand_frames(part: int) -> None:
    count = frames(2000) // 2
    check_subdivision(range(10_000 + part * count, 10_000 + (part + 1) * count), 2.0)


@pytest.mark.slow
def test_adversarial_frames_end_well_by_the_hundred() -> None:
    check_nothing_ends_badly(range(100_000, 100_000 + frames(500)), 2.0)


@pytest.mark.slow
def test_frames_beside_each_other_by_the_hundred() -> None:
    count = frames(200)
    check_nothing_ends_badly(range(300_000, 300_000 + count), 2.0, beside=True)
    check_subdivision(range(400_000, 400_000 + count), 2.0, beside=True)
