"""First roots of eight polynomials at once against the scalar search, one by one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from fdspec.kernels.frame_batch.eight import ALL, WIDTH
from fdspec.kernels.frame_batch.first_roots import first_roots
from fdspec.kernels.mathematics.polynomial_roots import NO_ROOT, first_root

ORDER = 24
Array = NDArray[np.float64]


def eight_roots(polynomials: Array) -> tuple[Array, int]:
    """First roots of polynomials (8, n + 1), and the set that is left undecided."""
    n = polynomials.shape[1] - 1
    room = np.concatenate([polynomials.T.ravel(), np.zeros(WIDTH)])
    undecided = first_roots(room, 0, n, ALL, (n + 1) * WIDTH)
    return room[-WIDTH:], undecided


def ringing(rng: np.random.Generator) -> Array:
    """A velocity as a slip has it: a slow part, and a brace that rings through some two radians."""
    k = np.arange(ORDER + 1.0)
    factorial = np.cumprod(np.concatenate([[1.0], k[1:]]))
    theta = rng.uniform(0.5, 2.5)
    angle = rng.uniform(0.0, 2.0 * np.pi)
    ring = np.cos(angle + 0.5 * np.pi * k) * theta**k / factorial
    c = 10.0 ** rng.uniform(-2.0, 1.0) * ring
    c[:2] += rng.uniform(0.0, 2.0), rng.uniform(-2.0, 2.0)
    c[0] = abs(c[0]) + 1e-6
    return np.asarray(c)


def test_agree_with_the_scalar_search() -> None:
    rng = np.random.default_rng(5)
    decided = crossings = 0
    for _ in range(400):
        polynomials = np.array([ringing(rng) for _ in range(WIDTH)])
        roots, undecided = eight_roots(polynomials)
        for lane, c in enumerate(polynomials):
            if undecided >> lane & 1:
                assert roots[lane] == NO_ROOT
                continue
            want = first_root(c, 0, ORDER, 1.0)
            assert roots[lane] == pytest.approx(want, abs=1e-12)
            decided += 1
            crossings += want <= 1.0
    assert decided > 2900
    assert 300 < crossings < decided - 300


def test_neighbours_and_longer_ones_touch_no_bit() -> None:
    rng = np.random.default_rng(6)
    polynomials = np.array([ringing(rng) for _ in range(WIDTH)])
    roots, undecided = eight_roots(polynomials)
    turned, apart = eight_roots(polynomials[::-1])
    np.testing.assert_array_equal(turned[::-1], roots)
    assert [apart >> lane & 1 for lane in range(WIDTH)][::-1] == [
        undecided >> lane & 1 for lane in range(WIDTH)
    ]
    longer, still = eight_roots(np.pad(polynomials, ((0, 0), (0, 5))))
    np.testing.assert_array_equal(longer, roots)
    assert still == undecided


def test_two_roots_close_to_each_other_are_left_to_the_scalar_search() -> None:
    """(x - 0.3)^2 +- 1e-9: a dip that ends just above zero, or just below."""
    for rest, want in ((1e-9, NO_ROOT), (-1e-9, 0.3 - np.sqrt(1e-9))):
        c = np.zeros(ORDER + 1)
        c[:3] = 0.09 + rest, -0.6, 1.0
        roots, undecided = eight_roots(np.tile(c, (WIDTH, 1)))
        assert undecided == ALL
        assert (roots == NO_ROOT).all()
        assert first_root(c, 0, ORDER, 1.0) == pytest.approx(want, abs=1e-9)


def test_what_is_no_number_is_left_undecided() -> None:
    c = np.full(ORDER + 1, np.nan)
    assert eight_roots(np.tile(c, (WIDTH, 1)))[1] == ALL
    c = np.zeros(ORDER + 1)
    c[:2] = 1.0, -np.inf
    assert eight_roots(np.tile(c, (WIDTH, 1)))[1] == ALL


def test_a_root_at_the_end_is_one() -> None:
    c = np.zeros(ORDER + 1)
    c[:2] = 1.0, -1.0
    roots, undecided = eight_roots(np.tile(c, (WIDTH, 1)))
    assert undecided == 0
    np.testing.assert_array_equal(roots, 1.0)
