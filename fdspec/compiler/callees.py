"""Rules that only other kernels call are compiled for those callers, and only as far as these need it.

numba does for every function what it does for one that Python calls: it writes a wrapper that unpacks
Python's arguments, with the function in it a second time, optimises both together with a copy of all that is
called from there, makes machine code of it, and does so again for each constant among the arguments.  Most of
what kernels are made of is never run by itself: it ends inside an entry.  While an entry is compiled, what it
calls is compiled once for the types of its arguments, has no wrapper, and stays the compiler's intermediate
code, to be linked into the entry and optimised there.  That halves the time to compile, and changes no bit.

A rule that Python calls all the same, as tests do, is compiled for Python then.
"""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import Any, Final

import numba
from numba import types
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import PassManager
from numba.core.registry import cpu_target

OPTIONS: Final[dict[str, Any]] = {"nogil": True, "error_model": "numpy"}
"""What all kernels are compiled with (options.py)."""

UNUSED_PASSES: Final = frozenset(
    {
        "WithLifting",
        "InlineClosureLikes",
        "RewriteDynamicRaises",
        "MakeFunctionToJitFunction",
        "InlineInlinables",
        "FindLiterallyCalls",
        "LiteralUnroll",
        "InlineOverloads",
        "NopythonRewrites",
        "NoPythonSupportedFeatureValidation",
        "AnnotateTypes",
        "DumpParforDiagnostics",
    }
)
"""Passes of numba for what no rule has in it: ``with``, functions inside, raises, expressions of arrays."""

_Wrapper = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.py_object, ctypes.c_void_p)
"""A function as CPython calls it: itself, positional arguments, keywords."""

_for_an_entry: ContextVar[bool] = ContextVar("for_an_entry", default=False)


@contextmanager
def for_an_entry() -> Iterator[None]:
    """Compile what is called inside for its callers; one thread at a time, as numba compiles anyway.

    Garbage is not looked for meanwhile: a compiler makes many small objects that last as long as it runs.
    """
    with global_compiler_lock:
        token = _for_an_entry.set(True)
        collects = gc.isenabled()
        gc.disable()
        try:
            with _operators_resolved_once():
                yield
        finally:
            _for_an_entry.reset(token)
            if collects:
                gc.enable()


@contextmanager
def _operators_resolved_once() -> Iterator[None]:
    """Have numba remember what an operator does with numbers: for each product it tries all that it knows."""
    context = cpu_target.typing_context
    resolve = context.resolve_function_type
    known: dict[Any, Any] = {}

    def remembered(function: Any, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        numbers = all(isinstance(kind, (types.Number, types.Boolean)) for kind in arguments)
        if keywords or not numbers or not isinstance(function, types.Function):
            return resolve(function, arguments, keywords)
        key = function, arguments
        if key not in known:
            known[key] = resolve(function, arguments, keywords)
        return known[key]

    context.resolve_function_type = remembered
    try:
        yield
    finally:
        del context.resolve_function_type


class CalleeLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a rule, kept for linking."""

    def __init__(self, codegen: Any, rule: Callable[..., Any]) -> None:
        super().__init__(codegen, rule.__qualname__)
        self._whole: Any = None
        alone = cache(lambda: numba.njit(**OPTIONS)(rule))
        self._called = _Wrapper(lambda closure, arguments, keywords: alone()(*arguments))  # noqa: ARG005

    @property
    def codegen(self) -> CalleeLibrary:
        """Whom numba hands the environment of what it has compiled."""
        return self

    def set_env(self, *environment: Any) -> None:
        """Do without one: what is linked into an entry has the entry's."""

    @property
    def calls(self) -> list[CPUCodeLibrary]:
        """What the rule calls."""
        return list(self._linking_libraries)

    def finalize(self) -> None:
        """Leave the code as it is: neither linked nor optimised, without a place in memory."""
        self._raise_if_finalized()
        self._finalize_dynamic_globals()
        self._finalized = True

    def own_module(self) -> Any:
        """Return the rule's code, which others may have a copy of."""
        return super()._get_module_for_linking()

    def _get_module_for_linking(self) -> Any:
        """Return the code of the rule and of all that it calls."""
        if self._whole is None:
            whole = self.own_module().clone()
            for called in _called_by(self):
                whole.link_in(_module_of(called), preserve=True)
            self._whole = whole
        return self._whole

    def get_pointer_to_function(self, name: str) -> int:  # noqa: ARG002
        """Return the address of what Python calls: it has the rule compiled for Python first."""
        self._ensure_finalized()
        address = ctypes.cast(self._called, ctypes.c_void_p).value
        return 0 if address is None else address


def _module_of(library: CPUCodeLibrary) -> Any:
    if isinstance(library, CalleeLibrary):
        return library.own_module()
    return library._get_module_for_linking()  # noqa: SLF001


def _called_by(library: CalleeLibrary) -> list[CPUCodeLibrary]:
    """Return all that a rule calls, each after whatever calls it: the linker takes what it was asked for."""
    seen: set[CPUCodeLibrary] = set()
    callees_first: list[CPUCodeLibrary] = []

    def visit(one: CPUCodeLibrary) -> None:
        if one in seen:
            return
        seen.add(one)
        for called in one.calls if isinstance(one, CalleeLibrary) else ():
            visit(called)
        callees_first.append(one)

    visit(library)
    return callees_first[-2::-1]


class CalleeCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, whose code is kept for linking while an entry is compiled."""

    def define_pipelines(self) -> Any:
        """Choose the library that the code goes into, and leave out the passes that rules have no use for."""
        pipelines = super().define_pipelines()
        if not _for_an_entry.get():
            return pipelines
        self.state.flags.no_cpython_wrapper = True
        self.state.library = CalleeLibrary(self.state.targetctx.codegen(), self.state.func_id.func)
        (whole,) = pipelines
        lean = PassManager(whole.pipeline_name)
        for step, description in whole.passes:
            if step.__name__ not in UNUSED_PASSES:
                lean.add_pass(step, description)
        lean.finalize()
        return [lean]


def once_for_all_constants(dispatcher: Any) -> Any:
    """Have numba compile a rule for the types of its arguments, whatever their values: LLVM knows those."""
    ask = dispatcher.get_call_template

    def get_call_template(arguments: Any, keywords: Any) -> Any:
        plain = {name: types.unliteral(kind) for name, kind in keywords.items()}
        return ask(tuple(types.unliteral(kind) for kind in arguments), plain)

    dispatcher.get_call_template = get_call_template
    return dispatcher
