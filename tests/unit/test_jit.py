"""What fdspec.compiler.options asks of the compiler, looked up in what came of it."""

from __future__ import annotations

import gc
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numba
import numpy as np
import pytest
from llvmlite.binding import get_host_cpu_features
from numba import config
from numba.core.registry import cpu_target

from fdspec.compiler import options
from fdspec.compiler.callees import CalleeLibrary
from fdspec.compiler.options import entry, fma, inlined, inner, maker, seldom, wide

compiled = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="without the JIT nothing is compiled")

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


@pytest.fixture
def kept_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compile entries in this process, whatever an earlier one has kept."""
    monkeypatch.setattr(options, "CACHE", None)


def rules() -> tuple[Any, Any, Any]:
    @inner
    def twice(x):
        return 2.0 * x

    @maker
    def row(x, n):
        made = np.empty(n)
        for i in range(n):
            made[i] = twice(x) + i
        return made

    @inner
    def third(row):
        return row[2]

    return twice, row, third


@compiled
@pytest.mark.usefixtures("kept_nowhere")
def test_what_an_entry_calls_has_no_machine_code_until_python_calls_it() -> None:
    twice, row, third = rules()

    @entry(numba.float64(numba.float64))
    def both(x):
        return third(row(x, 3))

    assert both(4.0) == 10.0
    for rule in (twice, row, third):
        (made,) = rule.overloads.values()
        assert isinstance(made.library, CalleeLibrary)
    assert twice(1.5) == 3.0
    assert twice(1.5) == 3.0
    np.testing.assert_array_equal(row(1.0, 3), [2.0, 3.0, 4.0])
    assert third(np.array([5.0, 6.0, 7.0])) == 7.0
    assert twice(1) == 2.0  # another type, with nothing else at work: code like any other
    assert not isinstance(twice.overloads[(numba.int64,)].library, CalleeLibrary)


@compiled
@pytest.mark.usefixtures("kept_nowhere")
def test_entries_share_what_they_call() -> None:
    twice, row, third = rules()

    @entry(numba.float64(numba.float64))
    def first(x):
        return third(row(x, 3))

    library = next(iter(twice.overloads.values())).library

    @entry(numba.float64(numba.float64))
    def second(x):
        return third(row(x, 4)) + twice(x)

    assert first(1.0) == 4.0
    assert second(1.0) == 6.0
    assert next(iter(twice.overloads.values())).library is library


@compiled
@pytest.mark.usefixtures("kept_nowhere")
def test_rules_kept_for_an_entry_are_whole_for_any_other_caller() -> None:
    """What comes later links a rule of an entry with all that this calls in turn."""
    twice, row, third = rules()

    @inner
    def fourfold(x):
        return twice(twice(x))

    @inner
    def eightfold(x):
        return fourfold(twice(x)) + 0.0 * third(row_of_three)

    row_of_three = np.ones(3)

    @entry(numba.float64(numba.float64))
    def first(x):
        return eightfold(x) + row(x, 1)[0]

    @inner
    def later(x):
        return eightfold(x) + fourfold(x)

    @numba.njit
    def elsewhere(x):
        return eightfold(x) + row(x, 2)[1]

    assert first(1.0) == 10.0
    assert later(1.0) == 12.0
    assert elsewhere(1.0) == 11.0
    assert eightfold(0.5) == 4.0


@compiled
@pytest.mark.usefixtures("kept_nowhere")
def test_a_rule_is_compiled_once_for_all_constants() -> None:
    twice, row, third = rules()

    @entry(numba.float64(numba.float64))
    def constants(x):
        return twice(1.0) + twice(x) + third(row(2.0, 3)) + third(row(3.0, 4))

    assert constants(2.0) == 2.0 + 4.0 + 6.0 + 8.0
    for rule in (twice, row, third):
        assert len(rule.overloads) == 1


@compiled
@pytest.mark.usefixtures("kept_nowhere")
def test_entries_are_compiled_by_several_threads_at_once() -> None:
    twice, row, third = rules()
    start = threading.Barrier(4)

    def compile_one(k: int) -> float:
        start.wait()

        @entry(numba.float64(numba.float64))
        def one(x):
            return third(row(x, 3 + k)) + twice(k * x)

        found: float = one(1.0)
        return found

    with ThreadPoolExecutor(4) as threads:
        assert list(threads.map(compile_one, range(4))) == [4.0, 6.0, 8.0, 10.0]
    assert "resolve_function_type" not in vars(cpu_target.typing_context)
    assert gc.isenabled()


@compiled
@pytest.mark.usefixtures("kept_nowhere")
@pytest.mark.parametrize("collects", [True, False])
def test_what_is_changed_while_an_entry_is_compiled_is_as_before(collects: bool) -> None:
    """An entry that fails to compile leaves garbage collection and numba's resolution as they were."""

    @entry(numba.float64(numba.float64))
    def sound(x):
        return x + x

    was = gc.isenabled()
    (gc.enable if collects else gc.disable)()
    try:
        with pytest.raises(numba.TypingError):

            @entry(numba.float64(numba.float64))
            def unsound(x):
                return x + "text"

        assert gc.isenabled() is collects
    finally:
        (gc.enable if was else gc.disable)()
    assert "resolve_function_type" not in vars(cpu_target.typing_context)
    assert sound(1.0) == 2.0
