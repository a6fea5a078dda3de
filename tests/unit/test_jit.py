"""What fdspec.compiler.options asks of the compiler, looked up in what came of it."""

from __future__ import annotations

import re

import numba
import numpy as np
import pytest
from llvmlite.binding import get_host_cpu_features
from numba import config

from fdspec.compiler.options import fma, inlined, inner, seldom, wide

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


def fused(a: float, b: float, c: float) -> float:
    return fma(a, b, c)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="Python rounds the product first")
def test_a_fused_sum_is_rounded_once() -> None:
    x = 1.0 + 2.0**-30
    assert numba.njit(fused)(x, x, -(x * x)) == 2.0**-60


def test_a_fused_sum_without_rounding_is_the_sum() -> None:
    assert numba.njit(fused)(3.0, -0.5, 4.0) == 2.5


@inner
def seldom_called(x: float) -> float:
    seldom()
    return x + 1.0


@inlined
def always_copied(x: float) -> float:
    return seldom_called(x) + 1.0


def calling(x: float) -> float:
    return always_copied(x)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_what_is_seldom_needed_is_called_and_not_copied() -> None:
    compiled = numba.njit(calling)
    assert compiled(1.0) == 3.0
    (code,) = compiled.inspect_llvm().values()
    assert re.search(r"call .*seldom_called", code)
    assert not re.search(r"call .*always_copied", code)
