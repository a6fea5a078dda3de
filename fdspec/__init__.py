"""Exact seismic response of buildings with friction dampers.

The names below load on first use, so that `import fdspec` and `fdspec --help` start at once.
"""

from typing import TYPE_CHECKING

__version__ = "0.1.0"

if TYPE_CHECKING:
    from fdspec.choice.distribution import optimise
    from fdspec.choice.pretension import best_pretension
    from fdspec.choice.recommendation import choose
    from fdspec.model.building import Building
    from fdspec.model.damping import DampingMatrix, ModalDamping, RayleighDamping
    from fdspec.model.motion import GroundMotion
    from fdspec.records import load_record, read_record
    from fdspec.runs.simulate import simulate
    from fdspec.runs.study import Study
    from fdspec.runs.sweep import sweep
    from fdspec.runs.sweep_buildings import sweep_buildings
    from fdspec.store.export import export
    from fdspec.store.netcdf import open, save  # noqa: A004

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
    "Building": "model.building",
    "DampingMatrix": "model.damping",
    "GroundMotion": "model.motion",
    "ModalDamping": "model.damping",
    "RayleighDamping": "model.damping",
    "Study": "runs.study",
    "best_pretension": "choice",
    "choose": "choice",
    "export": "store",
    "load_record": "records",
    "open": "store",
    "optimise": "choice",
    "read_record": "records",
    "save": "store",
    "simulate": "runs.simulate",
    "sweep": "runs.sweep",
    "sweep_buildings": "runs.sweep_buildings",
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
