"""The search for the least value of functions with kinks, valleys, dips and plateaus."""

import numpy as np
import pytest
from numpy.typing import NDArray

from fdspec.choice.search import FINEST, Scan, scan

FloatArray = NDArray[np.float64]


@pytest.mark.parametrize("seed", range(30))
def test_the_least_of_a_function_with_kinks_is_found(seed: int) -> None:
    """The largest of several parabolas, as a response is the largest of several peaks, flat at the end."""
    rng = np.random.default_rng(seed)
    centre, width, height = rng.uniform(0, 9, 6), rng.uniform(1, 9, 6), rng.uniform(0.2, 1, 6)

    def function(x: FloatArray) -> FloatArray:
        at = np.minimum(x, 8.0)[:, np.newaxis]
        return np.max(height + ((at - centre) / width) ** 2, axis=1)

    found = scan(function, 10.0)
    brute = np.linspace(0.0, 10.0, 200_001)
    values = function(brute)
    assert abs(found.best - brute[values.argmin()]) <= FINEST * 10.0 or found.least <= values.min()
    (band,) = found.bands(0.05)
    inside = brute[values <= 1.05 * values.min()]
    assert band[0] == pytest.approx(inside[0], abs=2 * FINEST * 10.0)
    end = np.inf if inside[-1] == 10.0 else inside[-1]
    assert band[1] == pytest.approx(end, abs=2 * FINEST * 10.0)


def test_every_value_is_one_of_the_function() -> None:
    found = scan(lambda x: np.abs(x - 3.1) + 1.0, 10.0)
    assert np.array_equal(found.y, np.abs(found.x - 3.1) + 1.0)
    assert (np.diff(found.x) > 0).all()


def test_equal_minima_are_one_band_each() -> None:
    found = scan(lambda x: 1.0 + np.minimum(np.abs(x - 2.0), np.abs(x - 7.0)), 10.0)
    bands = found.bands(0.05)
    assert bands.shape == (2, 2)
    assert bands == pytest.approx(np.array([[1.95, 2.05], [6.95, 7.05]]), abs=5e-3)
    assert found.best == pytest.approx(2.0, abs=5e-3) or found.best == pytest.approx(7.0, abs=5e-3)


def test_a_plateau_is_one_band_and_the_lowest_place_is_the_best() -> None:
    found = scan(lambda x: np.maximum(1.0, np.abs(x - 5.0)), 10.0)
    assert found.least == 1.0
    (band,) = found.bands(0.0)
    assert band == pytest.approx([4.0, 6.0], abs=0.05)
    assert found.best == band[0]


def test_a_band_that_holds_the_end_has_no_end() -> None:
    found = scan(lambda x: 2.0 - np.minimum(x, 9.0) / 9.0, 10.0)
    assert found.bands(0.05)[0, 1] == np.inf


def test_a_narrow_dip_beside_the_least_value_is_seen() -> None:
    def function(x: FloatArray) -> FloatArray:
        return 1.0 + 0.001 * np.abs(x - 5.0) - 0.004 * np.maximum(0.0, 1.0 - np.abs(x - 6.3) / 0.05)

    assert scan(function, 10.0).best == pytest.approx(6.3, abs=0.02)


def test_places_without_a_value_are_never_the_best() -> None:
    def function(x: FloatArray) -> FloatArray:
        return np.where((x > 4.0) & (x < 6.0), np.nan, 1.0 + np.abs(x - 5.0))

    found = scan(function, 10.0)
    assert found.least == pytest.approx(2.0, abs=1e-2)
    assert np.isinf(found.y[(found.x > 4.0) & (found.x < 6.0)]).all()


def test_nothing_known_is_nothing_told() -> None:
    none = Scan(np.array([0.0, 1.0]), np.array([np.inf, np.inf]))
    assert np.isnan(none.best)
    assert none.bands(0.05).size == 0
    assert scan(lambda x: np.full_like(x, np.nan), 1.0).bands(0.05).size == 0
