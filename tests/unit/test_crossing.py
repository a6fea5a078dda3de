"""The verdict on a quantity from both ends of a segment, against the quantity itself."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

from fdspec.kernels.mathematics.oscillator import advance, area, step_map
from fdspec.kernels.mathematics.zero_crossing import (
    CLEAR,
    CROSSES,
    NEAR,
    UNCLEAR,
    Course,
    dip_verdict,
    fall_of,
    guess,
    judged,
    leaves_zero,
    nearby,
    rates_of,
    step_to_zero,
    verdict,
)

AT = np.linspace(0.0, 1.0, 4001)

phases = st.floats(0.01, 3.0)
angles = st.floats(0.0, 2.0 * math.pi)
levels = st.floats(-2.0, 2.0)


def course(phase: float, angle: float, level: float, slope: float) -> Course:
    """The quantity level + slope x + cos(angle + phase x)."""
    far = angle + phase
    return Course(
        level + math.cos(angle),
        slope - phase * math.sin(angle),
        -phase * phase * math.cos(angle),
        level + slope + math.cos(far),
        slope - phase * math.sin(far),
        -phase * phase * math.cos(far),
        phase**4,
        phase**5,
    )


@settings(max_examples=600, derandomize=True)
@given(phases, angles, levels, st.floats(-3.0, 3.0))
@example(1.0, math.pi - 0.5, 1.0 - 1e-9, 0.0)  # dips below zero between ends above it
@example(1.0, math.pi - 0.5, 1.0 + 1e-9, 0.0)  # and stays above
def test_verdict(phase: float, angle: float, level: float, slope: float) -> None:
    found = verdict(course(phase, angle, level, slope))
    values = level + slope * AT + np.cos(angle + phase * AT)
    if found == CLEAR:
        assert values.min() > -1e-15
    if found == CROSSES:
        below = values <= 0.0
        first = int(np.argmax(below))
        assert below[-1]
        assert not below[0]
        assert np.all(values[first:] <= 1e-12)


dips = given(phases, st.floats(0.5 * math.pi, 1.5 * math.pi), st.floats(0.95, 1.1), st.floats(-0.3, 0.3))
some_are_sure = settings(derandomize=True, suppress_health_check=[HealthCheck.filter_too_much])


@settings(some_are_sure, max_examples=200)
@dips
@example(1.0, math.pi - 0.5, 1.0 - 1e-5, 0.0)  # dips below zero between ends above it
@example(1.0, math.pi - 0.5, 1.0 - 1e-3, 0.0)
@example(1.0, math.pi - 0.5, 1.0 + 1e-3, 0.0)  # and stays above
@example(1.0, math.pi - 0.5, 1.0 + 1e-5, 0.0)
def test_dips(phase: float, angle: float, level: float, slope: float) -> None:
    judge_dip(phase, angle, level, slope)


@pytest.mark.slow
@settings(some_are_sure, max_examples=2000)
@dips
def test_many_dips(phase: float, angle: float, level: float, slope: float) -> None:
    judge_dip(phase, angle, level, slope)


def judge_dip(phase: float, angle: float, level: float, slope: float) -> None:
    found, fall = dip_verdict(course(phase, angle, level, slope))
    assume(found != UNCLEAR)
    at = np.linspace(0.0, fall.share, 4001) if found == CROSSES else AT
    values = level + slope * at + np.cos(angle + phase * at)
    if found == CLEAR:
        assert values.min() > 0.0
    else:
        first = int(np.argmax(values <= 0.0))
        assert first > 0
        assert np.all(values[first:] <= 1e-12)
        assert phase > 1.0 or guess(fall) == pytest.approx(at[first], abs=0.05)


def test_a_dip_of_any_depth_is_found_or_left_to_the_search() -> None:
    """Doubt remains only next to a touch."""
    for depth in np.geomspace(1e-9, 1e-2, 50):
        below, _ = dip_verdict(course(1.0, math.pi - 0.5, 1.0 - depth, 0.0))
        above, _ = dip_verdict(course(1.0, math.pi - 0.5, 1.0 + depth, 0.0))
        assert below in ((CROSSES,) if depth > 5e-3 else (CROSSES, UNCLEAR))
        assert above in ((CLEAR,) if depth > 5e-3 else (CLEAR, UNCLEAR))


def test_few_quantities_leave_doubt() -> None:
    """On segments of a radian: the verdict is worth its while only where it is one."""
    rng = np.random.default_rng(5)
    found = [
        judged(course(phase, angle, level, slope))[0]
        for phase, angle, level, slope in rng.uniform((0.3, 0, -2, -3), (1, 2 * math.pi, 2, 3), (2000, 4))
        if level + math.cos(angle) > 0.0
    ]
    shares = [found.count(each) / len(found) for each in (CLEAR, CROSSES)]
    assert min(shares) > 0.1
    assert sum(shares) > 0.99


@settings(max_examples=100, derandomize=True, suppress_health_check=[HealthCheck.filter_too_much])
@given(st.floats(0.01, 1.0), angles, levels, st.floats(-3.0, 3.0))
def test_a_crossing_is_guessed_well(phase: float, angle: float, level: float, slope: float) -> None:
    line = course(phase, angle, level, slope)
    assume(verdict(line) == CROSSES and abs(line.end_rise) > 0.1 and abs(line.start_rise) > 0.1)
    x = guess(fall_of(line))
    values = level + slope * AT + np.cos(angle + phase * AT)
    assert x == pytest.approx(AT[int(np.argmax(values <= 0.0))], abs=0.05)


@settings(max_examples=300, derandomize=True)
@given(
    st.sampled_from([0.0, 1e-9, 0.3, 1.0]),
    st.floats(-3.0, 3.0),
    st.floats(-3.0, 3.0),
    st.floats(0.0, 5.0),
)
def test_leaving_zero(rise: float, bend: float, twist: float, fourth: float) -> None:
    assume(leaves_zero(rise, bend, twist, fourth, 1e-9))
    x = AT[1:]
    lowest = rise * x + bend * x**2 / 2.0 + twist * x**3 / 6.0 - fourth * x**4 / 24.0
    assert lowest.min() > 0.0


def test_a_start_at_zero_that_turns_back_is_not_cleared() -> None:
    assert not leaves_zero(0.0, -1.0, 5.0, 0.0, 0.0)
    assert not leaves_zero(0.0, 0.0, 0.0, 0.0, 0.0)
    assert not leaves_zero(0.1, -1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("g", "w2"), [(0.0, 2.5e5), (1.2, 158.0), (0.0, 0.0)])
def test_nearby_motion_is_the_step_map(g: float, w2: float) -> None:
    t = NEAR / max(math.sqrt(w2), 1.0)
    x, v, p0, p1 = 0.02, -0.3, 1.7, -40.0
    rates = rates_of(x, v, g, w2, p0, p1)
    found = nearby(rates, t)
    step = step_map(g, w2, t)
    assert found[:2] == pytest.approx(advance(step, x, v, p0, p1), rel=1e-15)
    assert found[2] == pytest.approx(area(step, x, v, p0, p1), rel=1e-15)


def test_a_zero_near_by_is_stepped_to() -> None:
    t, last = step_to_zero(1e-4, -1.0, 0.5, -2.0, 3.0)
    assert last < 1e-9
    assert 1e-4 - t + 0.25 * t**2 - t**3 / 3.0 + t**4 / 8.0 == pytest.approx(0.0, abs=1e-18)
