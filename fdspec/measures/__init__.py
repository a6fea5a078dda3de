"""Measures of a cube: what an engineer reads off it, Dataset -> Dataset.

What has to run the engine again, such as a pretension between those of the grid, is in `fdspec.choice`.
"""

from typing import TYPE_CHECKING

from fdspec.measures.claims import study_claims
from fdspec.measures.damper import best_damper
from fdspec.measures.ensemble import STATISTICS, best_for_all, ensemble
from fdspec.measures.grid_best import best_on_grid
from fdspec.measures.hysteresis import hysteresis
from fdspec.measures.indices import INDICES, index_of, indices, needs_of
from fdspec.measures.reduction import reduction
from fdspec.measures.residual import residual
from fdspec.measures.slip_load import slip_load_spectrum
from fdspec.measures.summary import summary
from fdspec.on_demand import submodules

__all__ = [
    "INDICES",
    "STATISTICS",
    "best_damper",
    "best_for_all",
    "best_on_grid",
    "ensemble",
    "hysteresis",
    "index_of",
    "indices",
    "needs_of",
    "reduction",
    "residual",
    "slip_load_spectrum",
    "study_claims",
    "summary",
]

if not TYPE_CHECKING:
    __getattr__ = submodules(__name__)
