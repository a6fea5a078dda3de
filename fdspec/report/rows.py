"""The table of a choice: a row a record."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

ACCELERATIONS = ("bare", "braced", "chosen", "lower", "upper")


def record_rows(choice: xr.Dataset) -> tuple[list[str], list[list[str]]]:
    """Return the head and the rows: PGA, accelerations in every case (g), drifts (mm), index, regret."""
    head = ["record", "PGA", *ACCELERATIONS, "drift bare", "chosen", "index", "regret"]
    rows = []
    for name in choice["record"].values:
        at = choice.sel(record=name)
        peak, drift = at["peak_acceleration"] / G, at["peak_drift"] * 1e3
        rows.append(
            [
                str(name),
                f"{at['pga'].item() / G:.3f}",
                *(f"{peak.sel(case=case).item():.3f}" for case in ACCELERATIONS),
                *(f"{drift.sel(case=case).item():.1f}" for case in ("bare", "chosen")),
                f"{at['index_of_record'].sel(case='chosen').item():.3f}",
                f"{100.0 * at['regret'].item():.0f} %",
            ]
        )
    return head, rows
