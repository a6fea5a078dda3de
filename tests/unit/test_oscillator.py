"""One oscillator over one step: closed form and series, against the matrix exponential."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm

from fdspec.kernels.mathematics.oscillator import (
    SHORT_ANGLE,
    TERMS,
    advance,
    ahead,
    area,
    expand,
    rate_bound,
    series_order,
    sine_cosine,
    square_integral,
    step_map,
    undamped_ahead,
)
from fdspec.kernels.mathematics.quadrature import SHORT, series_area, series_square, short_square, square_form
from fdspec.kernels.storey.constants import RADIANS

OSCILLATORS = [
    (0.0, 400.0, 0.03),
    (2.0, 400.0, 0.03),
    (40.0, 400.0, 0.03),
    (90.0, 400.0, 0.01),
    (0.5, 0.4, 0.05),
    (0.0, 0.0, 0.05),
    (3.0, 0.0, 0.3),
]
LONG = [(2.0, 400.0, 0.2), (0.0, 2.5e5, 0.05), (40.0, 400.0, 0.3), (90.0, 400.0, 2.0), (5.0, 0.0, 3.0)]
START = (0.02, -0.3, 1.7, -40.0)


def exponential(g: float, w2: float, h: float) -> NDArray[np.float64]:
    """Propagate (x, v, integral of x, p, p')."""
    generator = np.zeros((5, 5))
    generator[0, 1] = 1.0
    generator[1] = (-w2, -g, 0.0, 1.0, 0.0)
    generator[2, 0] = 1.0
    generator[3, 4] = 1.0
    x, v, p0, p1 = START
    return np.asarray(expm(generator * h) @ np.array([x, v, 0.0, p0, p1]))


@pytest.mark.parametrize(("g", "w2", "h"), OSCILLATORS + LONG)
def test_step(g: float, w2: float, h: float) -> None:
    step = step_map(g, w2, h)
    expected = exponential(g, w2, h)
    x, v = advance(step, *START)
    assert x == pytest.approx(expected[0], rel=1e-11, abs=1e-14)
    assert v == pytest.approx(expected[1], rel=1e-11, abs=1e-13)
    assert area(step, *START) == pytest.approx(expected[2], rel=1e-11, abs=1e-14)


@pytest.mark.parametrize(("g", "w2", "h"), OSCILLATORS)
def test_ahead(g: float, w2: float, h: float) -> None:
    x, v, p0, p1 = START
    found = ahead(x, v, g, w2, p0, p1, h, series_order(rate_bound(g, w2) * h))
    assert found == pytest.approx(exponential(g, w2, h)[:3], rel=1e-13, abs=1e-15)


@pytest.mark.parametrize("phase", [1e-6, 0.01, 0.7, RADIANS, 2.0 * SHORT_ANGLE])
def test_ahead_without_damping(phase: float) -> None:
    omega = 500.0
    x, v, p0, p1 = START
    found = undamped_ahead(x, v, omega, 1.0 / omega, p0, p1, phase / omega)
    expected = exponential(0.0, omega * omega, phase / omega)[:3]
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-16)


@given(st.floats(0.0, SHORT_ANGLE))
def test_sine_and_cosine_are_those_of_the_library(angle: float) -> None:
    sine, cosine = sine_cosine(angle)
    assert abs(sine - math.sin(angle)) <= 2.0**-52 * angle
    assert abs(cosine - math.cos(angle)) <= 2.0**-52


@pytest.mark.parametrize(("g", "w2", "h"), OSCILLATORS)
def test_series(g: float, w2: float, h: float) -> None:
    order = series_order(rate_bound(g, w2) * h)
    x, v, p0, p1 = START
    c = np.zeros(TERMS)
    expand(c, order, x, v, g, w2, p0, p1, h)
    for share in (0.3, 1.0):
        expected = exponential(g, w2, share * h)
        polynomial = np.polynomial.Polynomial(c[: order + 1])
        assert polynomial(share) == pytest.approx(expected[0], rel=1e-13, abs=1e-16)
        assert polynomial.deriv()(share) / h == pytest.approx(expected[1], rel=1e-13, abs=1e-15)
        assert series_area(c, order, h, share) == pytest.approx(expected[2], rel=1e-13, abs=1e-17)


@pytest.mark.parametrize(("g", "w2", "h"), OSCILLATORS)
def test_viscous_work(g: float, w2: float, h: float) -> None:
    """Two quadratures of v^2 against the energy balance of the oscillator itself."""
    order = series_order(rate_bound(g, w2) * h)
    x, v, p0, p1 = START
    c, d = np.zeros(TERMS), np.zeros(TERMS)
    expand(c, order, x, v, g, w2, p0, p1, h)
    form = square_integral(square_form(g, w2, h, True), *START)
    assert series_square(c, order, h, 1.0) == pytest.approx(form, rel=1e-12)
    short = min(1.0, SHORT / max(rate_bound(g, w2) * h, 1e-9))
    expand(d, order, x, v, g, w2, p0, p1, short * h)
    assert short_square(d, order, short * h) == pytest.approx(series_square(c, order, h, short), rel=1e-13)
    fine = np.linspace(0.0, 1.0, 20001)
    speed = np.polynomial.Polynomial(c[: order + 1]).deriv()(fine) / h
    assert form == pytest.approx(np.trapezoid(speed**2, fine * h), rel=1e-7)
