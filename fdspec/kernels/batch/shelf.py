"""Plans put away as rows of numbers, so that many histories can be taken up in turn."""

from __future__ import annotations

from typing import NamedTuple

from fdspec.compiler.options import inlined, inner
from fdspec.compiler.records import place_of, read, size_of, write
from fdspec.kernels.mathematics.oscillator import StepMap
from fdspec.kernels.storey.constants import Plan


class Stride(NamedTuple):
    """Step maps of floor and brace apart over a whole step."""

    floor: StepMap
    brace: StepMap


N_SHELF = size_of(Plan)
"""Numbers of a plan."""

N_STRIDE = size_of(Stride)
"""Numbers of two step maps."""

STICK_MAP = place_of(Plan, "stick_map")
"""Place of the map of a step of stick in a plan's row."""


@inner
def put_plan(shelf, i, plan):
    """Put a plan away in row i."""
    write(shelf, i, plan)


@inlined
def take_plan(shelf, i):
    """Take up the plan of row i."""
    return read(Plan, shelf, i)
