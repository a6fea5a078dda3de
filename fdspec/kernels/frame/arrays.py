"""The arrays of one history of a frame, bundled: what it reads, where it works, what it fills.

The time loop takes them out of their bundles once.  Inside it, handing bundles on costs 8 to 20 % at one to
four storeys.
"""

from __future__ import annotations

from typing import Any, NamedTuple


class Matrices(NamedTuple):
    """What is beside the springs and dashpots of a frame; (0, 0) where there is nothing."""

    stiffness: Any
    damping: Any
    """(N, N), N/m and N s/m."""
    stiffness_lanes: Any
    damping_lanes: Any
    """The same with zeros up to a multiple of four."""


class Room(NamedTuple):
    """Zeroed arrays to work in; see `model`, `taylor` and `reset` for their rows."""

    model: Any
    """(MODEL_ROWS, lanes)."""
    state: Any
    motion: Any
    """(4, N): at a step's start, and at an instant within it."""
    tally: Any
    """(TALLY_ROWS, N)."""
    series: Any
    """(QUANTITIES, lanes + 1, TERMS)."""
    momentum: Any
    """(TERMS,)."""
    reach: Any
    """(REACH_ROWS, lanes)."""
    speeds: Any
    """(2, lanes + 1)."""
    c: Any
    """(TERMS,) one series."""
    instants: Any
    signs: Any
    kind: Any
    phase: Any
    vanishing: Any
    touching: Any
    """(N,) of each storey."""


class Log(NamedTuple):
    """Changes of phase in the order of time, as many as there is room for."""

    times: Any
    storeys: Any
    phases: Any


class Traces(NamedTuple):
    """What is written at the output instants, (m, len(STOREY_TRACES), N) and (m, len(TOTAL_TRACES))."""

    storeys: Any
    energies: Any


class Results(NamedTuple):
    """Rows of ``by_storey`` and ``totals``, see `results`; the first three are parts of the fourth."""

    peaks: Any
    counts: Any
    demands: Any
    by_storey: Any
    totals: Any


class Strain(NamedTuple):
    """What a history of the strain energy has besides."""

    room: Any
    """(max(TERMS, N),)."""
    result: Any
    """(3,), as in :data:`fdspec.kernels.storey.strain.STRAIN_RESULTS`."""


class Balance(NamedTuple):
    """Energies at the end, J: work of the ground and its most, loss in dashpots; stored at the start."""

    input: float
    most_input: float
    viscous: float
    stored: float
