"""The largest magnitude on a segment by one step to its turn, against the search of the whole series."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdspec.kernels.mathematics.extremum import Weights, top_inside
from fdspec.kernels.mathematics.oscillator import TERMS, expand, series_order
from fdspec.kernels.mathematics.polynomial_roots import largest_magnitude
from fdspec.kernels.storey.constants import Branch, branch
from fdspec.kernels.types import Force, Motion

FLOOR_MASS, BRACE_MASS = 20e3, 50.0
POINTS = np.linspace(0.0, 1.0, 2001)

shares = st.floats(-1.0, 1.0)


def oscillators(period: float, ratio: float) -> tuple[Branch, Branch]:
    """Floor and brace."""
    stiffness = FLOOR_MASS * (2.0 * math.pi / period) ** 2
    damping = 0.1 * math.sqrt(stiffness * FLOOR_MASS)
    return branch(FLOOR_MASS, damping, stiffness), branch(BRACE_MASS, 0.0, ratio * stiffness)


def series(b: Branch, x: float, v: float, p0: float, p1: float, h: float) -> np.ndarray:
    """Of displacement over the segment."""
    c = np.zeros(TERMS)
    expand(c, 20, x, v, b.g, b.w2, p0, p1, h)
    return c


def weighed(w: Weights, floor: np.ndarray, brace: np.ndarray, h: float) -> np.ndarray:
    """The quantity's series, one term shorter."""
    rate = np.arange(1, TERMS) / h
    c = w.u * floor[:-1] + w.v * rate * floor[1:] + w.d * brace[:-1]
    c[0] += w.base
    c[20:] = 0.0
    return np.ascontiguousarray(c)


@settings(max_examples=600, derandomize=True)
@given(
    st.floats(0.1, 3.0),
    st.floats(0.5, 10.0),
    st.floats(0.02, 1.0),
    st.tuples(shares, shares, shares, shares),
    st.tuples(shares, shares),
    st.sampled_from(["displacement", "velocity", "acceleration", "shear"]),
)
def test_the_turn_is_what_the_search_finds(
    period: float,
    ratio: float,
    phase: float,
    motion: tuple[float, float, float, float],
    ground: tuple[float, float],
    quantity: str,
) -> None:
    f, b = oscillators(period, ratio)
    rings = quantity == "shear"
    h = phase / (b if rings else f).rate
    u, v, d, e = motion
    start = Motion(0.1 * u, 0.1 * v * f.rate, 0.01 * d, 0.01 * e * b.rate)
    force = Force(3.0 * ground[0], 30.0 * ground[1], 2000.0 * ground[0], 30.0 * ground[1])
    floor = series(f, start.u, start.v, force.p0, force.p1, h)
    brace = series(b, start.d, start.e, force.b0, force.b1, h)
    k, c, kd = FLOOR_MASS * f.w2, FLOOR_MASS * f.g, BRACE_MASS * b.w2
    w = {
        "displacement": Weights(1.0, 0.0, 0.0, 0.0),
        "velocity": Weights(0.0, 1.0, 0.0, 0.0),
        "acceleration": Weights(-f.w2, -f.g, 0.0, 0.4),
        "shear": Weights(k, c, kd, 0.0),
    }[quantity]
    series_of_it = weighed(w, floor, brace if rings else np.zeros(TERMS), h)
    polynomial = np.polynomial.Polynomial(series_of_it)
    fourth = float(np.abs(polynomial.deriv(4)(POINTS)).max()) * 1.01
    rise, fall = (
        np.polynomial.Polynomial(floor).deriv()(1.0) / h,
        np.polynomial.Polynomial(brace).deriv()(1.0) / h,
    )
    end = Motion(float(floor.sum()), float(rise), float(brace.sum()), float(fall))
    top, sure = top_inside(f, b, series_order(f.rate * h), rings, w, start, end, force, h, fourth, 0.0)
    size = np.abs(series_of_it).sum()
    searched = largest_magnitude(series_of_it, 19, 0.0)
    if sure:
        assert top == pytest.approx(searched, rel=1e-12, abs=1e-13 * size)
    else:
        assert top <= searched + 1e-13 * size


def test_pieces_of_half_a_radian_are_mostly_sure() -> None:
    rng = np.random.default_rng(3)
    f, b = oscillators(0.5, 4.0)
    h = 0.5 / f.rate
    found = []
    for u, v, p in rng.uniform(-1.0, 1.0, (500, 3)):
        start, force = Motion(0.1 * u, 0.1 * v * f.rate, 0.0, 0.0), Force(3.0 * p, 0.0, 0.0, 0.0)
        floor = series(f, start.u, start.v, force.p0, 0.0, h)
        line = np.polynomial.Polynomial(floor)
        end = Motion(line(1.0), line.deriv()(1.0) / h, 0.0, 0.0)
        w = Weights(1.0, 0.0, 0.0, 0.0)
        fourth = float(np.abs(line.deriv(4)(POINTS)).max()) * 1.01
        found.append(top_inside(f, b, 15, False, w, start, end, force, h, fourth, 0.0)[1])
    assert np.mean(found) > 0.8
