"""Roots and extrema of polynomials on [0, 1], against dense sampling and numpy's eigenvalues."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from fdspec.kernels.mathematics.polynomial_roots import (
    NO_ROOT,
    clears,
    first_root,
    largest_magnitude,
    value,
    value_slope,
)

SAMPLES = np.linspace(0.0, 1.0, 4001)


def series(seed: int, degree: int, theta: float) -> NDArray[np.float64]:
    """Coefficients that decay as those of motion over a phase of theta (rad)."""
    rng = np.random.default_rng([seed, degree])
    decay = np.array([theta**k / math.factorial(k) for k in range(degree + 1)])
    return rng.standard_normal(degree + 1) * decay


@given(st.integers(0, 10**6), st.integers(1, 24), st.integers(0, 2), st.floats(0.0, 1.0))
def test_value_and_slope(seed: int, degree: int, lo: int, x: float) -> None:
    c = series(seed, degree + lo, 1.0)
    plain = np.polynomial.Polynomial(c[lo:])
    height, slope = value_slope(c, lo, degree + lo, x)
    assert height == pytest.approx(plain(x), abs=1e-13)
    assert slope == pytest.approx(plain.deriv()(x), abs=1e-12)
    assert value(c[lo:], degree, x) == pytest.approx(plain(x), abs=1e-13)


@given(st.integers(0, 10**6), st.integers(2, 22), st.floats(0.1, 3.0), st.floats(-1.5, 1.5))
def test_first_root(seed: int, degree: int, theta: float, shift: float) -> None:
    c = series(seed, degree, theta)
    c[0] += shift
    sign = 1.0 if c[0] > 0.0 else -1.0
    heights = sign * np.polynomial.polynomial.polyval(SAMPLES, c)
    x = first_root(c, 0, degree, sign)
    if x == NO_ROOT:
        assert heights.min() > 0.0
    else:
        below = np.flatnonzero(heights <= 0.0)
        assert below.size == 0 or x <= SAMPLES[below[0]]
        assert (heights[x > SAMPLES] > 0.0).all()
        assert abs(np.polynomial.polynomial.polyval(x, c)) <= 1e-14 * np.abs(c).sum()


@given(st.floats(0.05, 0.95), st.floats(1e-13, 1e-3), st.booleans())
def test_pairs_that_graze(at: float, depth: float, reaches: bool) -> None:
    """(x - at)^2 -+ depth^2: a pair of roots 2 depth apart, or none by as little."""
    offset = -(depth**2) if reaches else depth**2
    c = np.array([at**2 + offset, -2.0 * at, 1.0])
    x = first_root(c, 0, 2, 1.0)
    exact = c[1] ** 2 - 4.0 * c[0] * c[2]  # the discriminant that the rounded coefficients really have
    if abs(exact) > 1e-15:
        assert (x < NO_ROOT) == (exact > 0.0)
    if x < NO_ROOT:
        assert x == pytest.approx(at, abs=1.1 * depth + 1e-7)


@pytest.mark.parametrize("lift", [1e-9, -1e-9])
def test_grazing_at_the_end_of_a_long_series(lift: float) -> None:
    """1 - cos(theta x) + lift x^2 returns close to zero at the end of its period, as a brace does."""
    theta = 2.0 * math.pi / 0.75
    c = np.zeros(61)
    for k in range(2, 61, 2):
        c[k] = -((-1.0) ** (k // 2)) * theta**k / math.factorial(k)
    c[2] += lift
    x = first_root(c, 0, 60, 1.0)
    if lift > 0.0:
        assert x == NO_ROOT
    else:
        assert x == pytest.approx(0.75, abs=1e-5)
        assert x < 0.75


def test_leading_zeros_are_stripped() -> None:
    c = np.array([0.0, 0.0, 0.25, -1.0, 0.0])
    assert first_root(c, 0, 4, 1.0) == pytest.approx(0.25, abs=1e-16)
    assert first_root(c, 0, 4, -1.0) == 0.0
    assert first_root(np.zeros(5), 0, 4, 1.0) == NO_ROOT


@given(st.integers(0, 10**6), st.integers(1, 22), st.floats(0.1, 3.0))
def test_largest_magnitude(seed: int, degree: int, theta: float) -> None:
    c = np.append(series(seed, degree, theta), 0.0)
    sampled = np.abs(np.polynomial.polynomial.polyval(SAMPLES, c)).max()
    bend = np.abs(c * np.arange(c.size) * (np.arange(c.size) - 1.0)).sum()
    found = largest_magnitude(c, degree, 0.0)
    assert found >= sampled - 1e-15 * np.abs(c).sum()
    assert found <= sampled + bend / (8.0 * 4000.0**2) + 1e-14 * np.abs(c).sum()
    assert largest_magnitude(c, degree, 10.0 * found) == 10.0 * found


@given(
    st.floats(0.0, 1.0, allow_subnormal=False),  # products of those below vanish in the test itself
    st.floats(-3.0, 3.0),
    st.floats(0.0, 1.0, allow_subnormal=False),
    st.floats(-3.0, 3.0),
    st.floats(-20.0, 20.0),
)
def test_what_clears_is_positive(
    start: float, start_rise: float, end: float, end_rise: float, fourth: float
) -> None:
    """The worst quartic with these ends: its cubic part plus fourth/24 x^2 (1 - x)^2."""
    if clears(start, start_rise, end, end_rise, abs(fourth)):
        x = SAMPLES
        cubic = (
            (1 + 2 * x) * (1 - x) ** 2 * start
            + x * (1 - x) ** 2 * start_rise
            + x**2 * (3 - 2 * x) * end
            + x**2 * (x - 1) * end_rise
        )
        assert (cubic + fourth / 24.0 * x**2 * (1 - x) ** 2 > 0.0).all()
