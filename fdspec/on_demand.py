"""Modules that a package imports when somebody asks for them: `import fdspec` alone reaches every name."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import ModuleType


def submodules(package: str) -> Callable[[str], ModuleType]:
    """Give the ``__getattr__`` of a package: the module of the name that is asked for."""

    def find(name: str) -> ModuleType:
        module = f"{package}.{name}"
        try:
            if name.startswith("__"):
                raise ModuleNotFoundError(name=module)
            return import_module(module)
        except ModuleNotFoundError as error:
            if error.name != module:
                raise  # it is there, and what it needs is not
            raise AttributeError(f"module {package!r} has no attribute {name!r}", name=name) from None

    return find
