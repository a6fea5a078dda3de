"""Exact seismic response of buildings with friction dampers.

The names below load on first use, so that `import fdspec` and `fdspec --help` start at once.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

__version__ = "0.1.0"

if TYPE_CHECKING:
    from fdspec.building import Building
    from fdspec.choice.distribution import optimise
    from fdspec.choice.pretension import best_pretension
    from fdspec.choice.recommendation import choose
    from fdspec.damping import DampingMatrix, ModalDamping, RayleighDamping
    from fdspec.motion import GroundMotion
    from fdspec.records import load_record, read_record
    from fdspec.simulate import simulate
    from fdspec.store.export import export
    from fdspec.store.netcdf import open, save  # noqa: A004
    from fdspec.study import Study
    from fdspec.sweep import sweep
    from fdspec.sweep_buildings import sweep_buildings

__all__ = [
    "Building",
    "DampingMatrix",
    "GroundMotion",
    "ModalDamping",
    "RayleighDamping",
    "Study",
    "__version__",
    "best_pretension",
    "choose",
    "export",
    "load_record",
    "open",
    "optimise",
    "read_record",
    "save",
    "simulate",
    "sweep",
    "sweep_buildings",
]

_HOME = {
    "Building": "building",
    "DampingMatrix": "damping",
    "GroundMotion": "motion",
    "ModalDamping": "damping",
    "RayleighDamping": "damping",
    "Study": "study",
    "best_pretension": "choice",
    "choose": "choice",
    "export": "store",
    "load_record": "records",
    "open": "store",
    "optimise": "choice",
    "read_record": "records",
    "save": "store",
    "simulate": "simulate",
    "sweep": "sweep",
    "sweep_buildings": "sweep_buildings",
}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


class _Package(ModuleType):
    """The package itself, where `sweep` and `simulate` are the functions, whatever is imported first.

    Importing the file `fdspec/sweep.py` would bind the submodule over the function of the same name.
    """

    def __setattr__(self, name: str, value: object) -> None:
        if name in _HOME and isinstance(value, ModuleType):
            return
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
