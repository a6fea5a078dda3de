"""Rules that only other kernels call are compiled for those callers: no machine code of their own.

numba turns every function that it compiles into machine code at once, and most of those that kernels are made
of are never run by themselves: they end inside an entry.  A fifth of the time to compile goes into code that
nobody runs.  While an entry is compiled, what it calls stays the compiler's intermediate code, to be linked
into callers; called from Python all the same, it is finished then.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

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

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self._in_memory = False
        self._keep: list[Any] = []
        self._environment: tuple[Any, ...] = ()

    @property
    def codegen(self) -> CalleeLibrary:
        """Whom numba hands the environment of what it has compiled."""
        return self

    def set_env(self, *environment: Any) -> None:
        """Keep the environment until there is a place in memory that knows it."""
        self._environment = environment

    def _finalize_final_module(self) -> None:
        """Leave the code as it is, without a place in memory."""
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return the address of a function that finishes the code when it is called, and calls it."""
        self._ensure_finalized()

        def finish(closure: int, arguments: Any, keywords: int) -> Any:
            if not self._in_memory:
                super(CalleeLibrary, self)._finalize_final_module()
                self._codegen.set_env(*self._environment)
                self._in_memory = True
            return _Wrapper(super(CalleeLibrary, self).get_pointer_to_function(name))(
                closure, arguments, keywords
            )

        self._keep.append(_Wrapper(finish))
        address = ctypes.cast(self._keep[-1], ctypes.c_void_p).value
        return 0 if address is None else address


class CalleeCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, whose code is kept for linking while an entry is compiled."""

    def define_pipelines(self) -> Any:
        """Choose the library that the code goes into, then compile as ever."""
        if _for_an_entry.get():
            codegen = self.state.targetctx.codegen()
            self.state.library = CalleeLibrary(codegen, self.state.func_id.func_qualname)
        return super().define_pipelines()
