"""Rules that only other kernels call are compiled for those callers: no machine code of their own, no door for Python.

numba turns every function that it compiles into machine code at once, and gives it a wrapper that unpacks
Python's arguments, with the whole rule in it a second time.  Most of what kernels are made of is never run by
itself: it ends inside an entry.  A third of the time to compile goes into code that nobody runs.  While an
entry is compiled, what it calls stays the compiler's intermediate code, to be linked into callers; a rule that
Python calls all the same is compiled for Python then.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import Any, Final

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

OPTIONS: Final[dict[str, Any]] = {"nogil": True, "error_model": "numpy"}
"""What all kernels are compiled with (options.py)."""

_Wrapper = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.py_object, ctypes.c_void_p)
"""A function as CPython calls it: itself, positional arguments, keywords."""

_for_an_entry: ContextVar[bool] = ContextVar("for_an_entry", default=False)


@contextmanager
def for_an_entry() -> Iterator[None]:
    """Compile what is called inside for its callers."""
    token = _for_an_entry.set(True)
    try:
        yield
    finally:
        _for_an_entry.reset(token)


class CalleeLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a rule, kept for linking."""

    def __init__(self, codegen: Any, rule: Callable[..., Any]) -> None:
        super().__init__(codegen, rule.__qualname__)
        alone = cache(lambda: numba.njit(**OPTIONS)(rule))
        self._called = _Wrapper(lambda closure, arguments, keywords: alone()(*arguments))  # noqa: ARG005

    @property
    def codegen(self) -> CalleeLibrary:
        """Whom numba hands the environment of what it has compiled."""
        return self

    def set_env(self, *environment: Any) -> None:
        """Do without one: what is linked into an entry has the entry's."""

    def _finalize_final_module(self) -> None:
        """Leave the code as it is, without a place in memory."""
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        """Return the address of what Python calls: it has the rule compiled for Python first."""
        self._ensure_finalized()
        address = ctypes.cast(self._called, ctypes.c_void_p).value
        return 0 if address is None else address


class CalleeCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, whose code is kept for linking while an entry is compiled."""

    def define_pipelines(self) -> Any:
        """Choose the library that the code goes into, then compile as ever."""
        if _for_an_entry.get():
            self.state.flags.no_cpython_wrapper = True
            self.state.library = CalleeLibrary(self.state.targetctx.codegen(), self.state.func_id.func)
        return super().define_pipelines()
