"""What fdspec.jit asks of the compiler, looked up in what came of it."""

from __future__ import annotations

import numba
import numpy as np
import pytest
from llvmlite.binding import get_host_cpu_features
from numba import config

from fdspec.jit import wide

needs_wide_vectors = pytest.mark.skipif(
    bool(config.DISABLE_JIT) or not get_host_cpu_features().get("avx512f"),
    reason="no vectors of 512 bits here",
)


def scaled(x: np.ndarray, factor: float) -> None:
    for k in range(64):
        x[k] = factor * x[k] + factor


def scaled_widely(x: np.ndarray, factor: float) -> None:
    wide()
    for k in range(64):
        x[k] = factor * x[k] + factor


@needs_wide_vectors
def test_a_kernel_that_asks_for_wide_vectors_gets_them() -> None:
    compiled = numba.njit(scaled_widely)
    x, y = np.arange(64.0), np.arange(64.0)
    compiled(x, 0.3)
    scaled(y, 0.3)
    np.testing.assert_array_equal(x, y)
    (code,) = compiled.inspect_asm().values()
    assert "zmm" in code


def test_asking_changes_no_number() -> None:
    x, y = np.arange(64.0), np.arange(64.0)
    numba.njit(scaled)(x, 0.3)
    numba.njit(scaled_widely)(y, 0.3)
    np.testing.assert_array_equal(x, y)
