"""What a table of storeys shows, in the units of drawings."""

from __future__ import annotations

from typing import Final, NamedTuple

from fdspec.units import G


class Column(NamedTuple):
    """A column: its head, and the factor from SI."""

    head: str
    scale: float


STOREY_COLUMNS: Final = {
    "peak_acceleration": Column("acc. g", 1.0 / G),
    "peak_drift": Column("drift mm", 1e3),
    "peak_slip": Column("slip mm", 1e3),
    "slip_travel": Column("travel mm", 1e3),
    "peak_storey_shear": Column("shear kN", 1e-3),
    "peak_brace_force": Column("brace kN", 1e-3),
    "residual_drift": Column("residual mm", 1e3),
}
"""Variable -> its column; what a cube or a history does not have is left out."""

LINK_COLUMNS: Final = {
    "peak_link_slip": Column("slip mm", 1e3),
    "residual_link_slip": Column("residual mm", 1e3),
    "peak_link_force": Column("force kN", 1e-3),
    "link_energy": Column("energy kJ", 1e-3),
    "link_events": Column("phases", 1.0),
}
"""The same of links."""
