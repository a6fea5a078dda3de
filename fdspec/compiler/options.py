"""The only place that sets numba options, each with its reason.

Three decorators: ``inner`` for the small rules that kernels are made of, ``maker`` for what makes their
arrays, ``entry`` for the few functions that Python calls.

nogil          dask's threads run kernels side by side; a scheduler's heartbeat goes on beside them.
error_model    "numpy": a division by zero gives inf or nan, which ends in a status, not in a raise.
no fastmath    it breaks isnan and changes bits with the machine.
no parallel    one level of parallelism only: the scheduler's.
no cfunc       nothing here is called from C; its wrappers cost time and memory to compile.
signatures     entries are compiled for one explicit signature: nothing compiles a second time for
               another type.
wide vectors   on most processors that have vectors of 512 bits LLVM uses 256, since the wide ones may
               slow down what runs beside them; loops over lanes are little else, and ask for them.
callees        rules that only other kernels call have no machine code of their own and no door for Python,
               and are compiled once for all constants: that halves the time to compile (callees.py).
seldom         long searches that few steps need are not inlined: that saves a quarter of the time to compile.
fused          a product and a sum in one instruction, where a formula says so by ``fma``: rounded once on
               every processor, so that the same bits come of it everywhere.  The compiler's own leave to
               fuse would give a history other bits beside neighbours than alone.
cache          entries only: what they call is compiled into them.  numba knows an entry to be stale
               when its own file has changed, not when a callee's has, so the cache folder is named
               after the source of all kernels.  One process compiles, others wait, and nothing is read that
               others may have written or that is damaged (cache.py).
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeVar

import llvmlite
import numba
import numpy as np
from llvmlite.binding import get_host_cpu_features, get_host_cpu_name
from numba import config, types
from numba.extending import intrinsic

from fdspec.compiler.cache import cache_folder, compiling, tell
from fdspec.compiler.callees import OPTIONS, CalleeCompiler, for_an_entry, once_for_all_constants

Function = TypeVar("Function", bound=Callable[..., Any])

KERNELS = Path(__file__).parents[1] / "kernels"

float1d = types.Array(types.float64, 1, "C")
float2d = types.Array(types.float64, 2, "C")
float3d = types.Array(types.float64, 3, "C")
int1d = types.Array(types.int64, 1, "C")
given1d = types.Array(types.float64, 1, "C", readonly=True)
given2d = types.Array(types.float64, 2, "C", readonly=True)


def record_of(cls: type) -> types.Type:
    """The numba type of a NamedTuple whose fields are all floats."""
    return types.NamedUniTuple(types.float64, len(cls._fields), cls)  # type: ignore[attr-defined]


def source_key() -> str:
    """Name of the kernels' source and of the compiler: changes when any of their files does."""
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted([*KERNELS.rglob("*.py"), *Path(__file__).parent.glob("*.py")]):
        digest.update(path.relative_to(KERNELS.parent).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


CACHE = (
    None
    if config.DISABLE_JIT
    else cache_folder(source_key(), os.environ.get("FDSPEC_CACHE_DIR") or config.CACHE_DIR)
)
"""Where compiled kernels are kept: ``FDSPEC_CACHE_DIR`` wins, then numba's own ``NUMBA_CACHE_DIR``."""


CALLEE: Final[dict[str, Any]] = {**OPTIONS, "no_cfunc_wrapper": True, "pipeline_class": CalleeCompiler}


def _callee(function: Function, **options: Any) -> Function:
    compiled = numba.njit(**options, **CALLEE)(function)
    callee: Function = compiled if config.DISABLE_JIT else once_for_all_constants(compiled)
    return callee


def inner(function: Function) -> Function:
    """Compile a rule that other kernels call; LLVM inlines it where that pays.

    It makes no arrays, and so counts no references to those it is handed: counting is atomic, and in
    a step of a microsecond it cost as much as the arithmetic.
    """
    # Unless told, numba forces a kernel into all its callers if the first of those is forced into its own.
    return _callee(function, _nrt=False, forceinline=False)


def inlined(function: Function) -> Function:
    """Compile a rule of the time loop; a call would copy its tuples of constants onto the stack."""
    return _callee(function, _nrt=False, forceinline=True)


def maker(function: Function) -> Function:
    """Compile what makes arrays, or views of them, for an entry: it hands them back counted."""
    return _callee(function)


if config.DISABLE_JIT:

    def wide() -> None:
        """Do nothing: without the JIT there are no vectors."""

    def seldom() -> None:
        """Do nothing: without the JIT nothing is inlined."""

    def fma(a: float, b: float, c: float) -> float:
        """Give a b + c, here rounded twice: Python has had an fma only since 3.13."""
        return a * b + c

    def lowest(bits: int) -> int:
        """Give the place of the lowest bit that is set; some must be."""
        return (bits & -bits).bit_length() - 1

else:

    def _marking(attribute: str) -> Callable[[Any, Any, Any, Any], Any]:
        """Give the code of an intrinsic that marks the function in which it stands."""

        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
            # llvmlite's own method knows few attributes; it keeps them in a set.
            if isinstance(builder.function.attributes, set):
                set.add(builder.function.attributes, attribute)
            return context.get_dummy_value()

        return code

    @intrinsic  # type: ignore[untyped-decorator]
    def wide(typing_context: Any) -> Any:  # noqa: ARG001
        """Let the compiler use its widest vectors in the kernel that calls this."""
        return types.void(), _marking('"prefer-vector-width"="512"')

    @intrinsic  # type: ignore[untyped-decorator]
    def seldom(typing_context: Any) -> Any:  # noqa: ARG001
        """Keep the kernel that calls this out of those that call it: it is long, and few steps need it."""
        return types.void(), _marking("noinline")

    @intrinsic  # type: ignore[untyped-decorator]
    def fma(typing_context: Any, a: Any, b: Any, c: Any) -> Any:  # noqa: ARG001
        """Give a b + c, rounded once."""

        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
            return builder.fma(*arguments)

        return types.float64(types.float64, types.float64, types.float64), code

    @intrinsic  # type: ignore[untyped-decorator]
    def lowest(typing_context: Any, bits: Any) -> Any:  # noqa: ARG001
        """Give the place of the lowest bit that is set; some must be."""

        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:  # noqa: ARG001
            return builder.cttz(*arguments, context.get_constant(types.boolean, 1))

        return types.int64(types.int64), code


def entry(signature: Any) -> Callable[[Function], Function]:
    """Compile a function that Python calls, for one signature, through the cache."""

    @for_an_entry()
    def decorate(function: Function) -> Function:
        if CACHE is None:
            compiled: Function = numba.njit(signature, **OPTIONS)(function)
            return compiled
        previous = config.CACHE_DIR
        try:
            with compiling(CACHE, _identity(function)) as folder:
                config.CACHE_DIR = str(folder)
                compiled = numba.njit(signature, cache=True, **OPTIONS)(function)
        except OSError as error:  # the folder is full, or gone since it was found
            tell(f"{CACHE}: {error.strerror or error}")
            compiled = numba.njit(signature, **OPTIONS)(function)
        finally:
            config.CACHE_DIR = previous
        return compiled

    return decorate


def _identity(function: Callable[..., Any]) -> str:
    """Name of a function for the cache: its file, what compiles it, the processor."""
    file = function.__code__.co_filename
    state = Path(file).stat()
    made_by = (sys.version, llvmlite.__version__, np.__version__)
    cpu = (get_host_cpu_name(), get_host_cpu_features().flatten(), config.CPU_NAME, config.CPU_FEATURES)
    text = repr((file, state.st_mtime_ns, state.st_size, made_by, cpu))
    return f"{function.__name__}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
