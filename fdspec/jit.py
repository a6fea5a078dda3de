"""The only place that sets numba options, each with its reason.

Two decorators: ``inner`` for the small rules that kernels are made of, ``entry`` for the few
functions that Python calls.

nogil          dask's threads run kernels side by side; a scheduler's heartbeat goes on beside them.
error_model    "numpy": a division by zero gives inf or nan, which ends in a status, not in a raise.
no fastmath    it breaks isnan and changes bits with the machine.
no parallel    one level of parallelism only: the scheduler's.
no cfunc       nothing here is called from C; its wrappers cost time and memory to compile.
signatures     entries are compiled for one explicit signature: nothing compiles a second time for
               another type, and processes that start together write the same cache entry.
cache          entries only: what they call is compiled into them.  numba knows an entry to be stale
               when its own file has changed, not when a callee's has, so the cache folder is named
               after the source of all kernels.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba import config, types

Function = TypeVar("Function", bound=Callable[..., Any])

KERNELS = Path(__file__).with_name("kernels")

float1d = types.Array(types.float64, 1, "C")
ground1d = types.Array(types.float64, 1, "C", readonly=True)
float2d = types.Array(types.float64, 2, "C")
float3d = types.Array(types.float64, 3, "C")
int1d = types.Array(types.int64, 1, "C")


def record_of(cls: type) -> types.Type:
    """The numba type of a NamedTuple whose fields are all floats."""
    return types.NamedUniTuple(types.float64, len(cls._fields), cls)  # type: ignore[attr-defined]


def source_key() -> str:
    """Name of the kernels' source: changes when any of their files does."""
    digest = hashlib.sha256()
    for path in sorted([*KERNELS.glob("*.py"), Path(__file__)]):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path | None:
    """A writable folder for compiled kernels, or None when there is none to be had.

    ``FDSPEC_CACHE_DIR`` wins, then numba's own ``NUMBA_CACHE_DIR``, then the user's cache folder,
    then the system's temporary folder (read-only homes are common on clusters).
    """
    named = os.environ.get("FDSPEC_CACHE_DIR") or config.CACHE_DIR
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    user = f"fdspec-{os.getuid()}" if hasattr(os, "getuid") else "fdspec"
    candidates = [Path(named)] if named else [home / "fdspec", Path(tempfile.gettempdir()) / user]
    for candidate in candidates:
        folder = candidate / source_key()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return None


CACHE = cache_folder()


def inner(function: Function) -> Function:
    """Compile a rule that other kernels call; LLVM inlines it where that pays.

    It makes no arrays, and so counts no references to those it is handed: counting is atomic, and in
    a step of a microsecond it cost as much as the arithmetic.
    """
    compiled: Function = numba.njit(nogil=True, error_model="numpy", _nrt=False, no_cfunc_wrapper=True)(
        function
    )
    return compiled


def inlined(function: Function) -> Function:
    """Compile a rule of the time loop; a call would copy its tuples of constants onto the stack."""
    compiled: Function = numba.njit(
        nogil=True,
        error_model="numpy",
        _nrt=False,
        forceinline=True,
        no_cfunc_wrapper=True,
    )(function)
    return compiled


def entry(signature: Any) -> Callable[[Function], Function]:
    """Compile a function that Python calls, for one signature, through the cache."""

    def decorate(function: Function) -> Function:
        previous = config.CACHE_DIR
        config.CACHE_DIR = str(CACHE) if CACHE else ""
        try:
            compiled: Function = numba.njit(
                signature, nogil=True, error_model="numpy", cache=CACHE is not None
            )(function)
        finally:
            config.CACHE_DIR = previous
        return compiled

    return decorate
