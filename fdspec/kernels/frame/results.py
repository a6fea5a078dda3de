"""What a history of N storeys gives, and what its steps go by: named apart from the kernels that compile."""

from __future__ import annotations

from fdspec.compiler.positions import positions

RADIANS = 2.5
"""Longest phase of a step; no result depends on it."""

STOREY_RESULTS = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_drift",
    "peak_storey_shear",
    "peak_brace_displacement",
    "residual_displacement",
    "residual_brace_displacement",
    "slip_travel",
    "storey_transitions",
    "storey_friction_energy",
    "residual_slip",
    "peak_slip",
    "peak_brace_force",
    "peak_column_shear",
)
"""First rows of ``by_storey`` (22, N); the first six of them are the peaks, the last three the demands."""
RESULT = positions(STOREY_RESULTS)

DEMANDS = RESULT.peak_slip
DEMAND_ROWS = 3
"""First row and number of the peaks that histories side by side leave out."""

END = len(STOREY_RESULTS)
END_ROWS = 7
"""First row and number of the rows that follow, the state at the end: displacement, velocity, offset, sliding
velocity, phase, and how the next segment begins."""

COUNTS = RESULT.storey_transitions
"""Row of the number of changes of phase."""

TOTALS = ("transitions", "dissipated_energy", "viscous_energy", "input_energy", "energy_error", "status")
"""Entries of ``totals`` (6,)."""
TOTAL = positions(TOTALS)

NO_TIME = 1e-13
"""Fraction of a record step that counts as its end."""
