"""Exact seismic response of buildings with friction dampers.

The names below load on first use, so that `import fdspec` and `fdspec --help` start at once.  So do the
packages: `fdspec.figures`, `fdspec.measures`, `fdspec.signals` and so on need no import of their own.
"""

from typing import TYPE_CHECKING

from fdspec.on_demand import submodules
from fdspec.version import __version__ as __version__

if TYPE_CHECKING:
    from fdspec.choice.distribution import optimise as optimise
    from fdspec.choice.pretension import best_pretension as best_pretension
    from fdspec.choice.recommendation import choose as choose
    from fdspec.errors import ClusterError as ClusterError
    from fdspec.errors import DiskError as DiskError
    from fdspec.errors import FdspecError as FdspecError
    from fdspec.errors import IntegrationError as IntegrationError
    from fdspec.errors import InvalidInput as InvalidInput
    from fdspec.errors import RecordError as RecordError
    from fdspec.errors import StoreError as StoreError
    from fdspec.errors import StudyError as StudyError
    from fdspec.measures.fragility import fragility as fragility
    from fdspec.measures.risk import risk as risk
    from fdspec.measures.summary import summary as summary
    from fdspec.model.building import Building as Building
    from fdspec.model.damping import DampingMatrix as DampingMatrix
    from fdspec.model.damping import ModalDamping as ModalDamping
    from fdspec.model.damping import RayleighDamping as RayleighDamping
    from fdspec.model.link import Link as Link
    from fdspec.model.link import TensionBrace as TensionBrace
    from fdspec.model.motion import GroundMotion as GroundMotion
    from fdspec.model.side_by_side import side_by_side as side_by_side
    from fdspec.records import load_record as load_record
    from fdspec.records import read_record as read_record
    from fdspec.runs.floor_spectra import floor_spectra as floor_spectra
    from fdspec.runs.inelastic_spectra import inelastic_spectra as inelastic_spectra
    from fdspec.runs.simulate import simulate as simulate
    from fdspec.runs.study import Study as Study
    from fdspec.runs.sweep import sweep as sweep
    from fdspec.runs.sweep_buildings import sweep_buildings as sweep_buildings
    from fdspec.store.combine import combine as combine
    from fdspec.store.export import export as export
    from fdspec.store.netcdf import open as open  # noqa: A004
    from fdspec.store.netcdf import save as save

_NAMES = {
    "choice": ("best_pretension", "choose", "optimise"),
    "errors": (
        "ClusterError",
        "DiskError",
        "FdspecError",
        "IntegrationError",
        "InvalidInput",
        "RecordError",
        "StoreError",
        "StudyError",
    ),
    "measures": ("summary",),
    "model.building": ("Building",),
    "model.damping": ("DampingMatrix", "ModalDamping", "RayleighDamping"),
    "model.link": ("Link", "TensionBrace"),
    "model.motion": ("GroundMotion",),
    "model.side_by_side": ("side_by_side",),
    "records": ("load_record", "read_record"),
    "measures.fragility": ("fragility",),
    "measures.risk": ("risk",),
    "runs.floor_spectra": ("floor_spectra",),
    "runs.inelastic_spectra": ("inelastic_spectra",),
    "runs.simulate": ("simulate",),
    "runs.study": ("Study",),
    "runs.sweep": ("sweep",),
    "runs.sweep_buildings": ("sweep_buildings",),
    "store": ("combine", "export", "open", "save"),
}
"""Module -> its names that are the package's own; the imports above tell type checkers the same."""

_HOME = {name: module for module, names in _NAMES.items() for name in names}

__all__ = ["__version__", *_HOME]  # noqa: PLE0604 (strings, all of them)

_submodule = submodules(__name__)


def __getattr__(name: str) -> object:
    if name not in _HOME:
        return _submodule(name)
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
