"""The table of a choice: a row a storey, with what slots and braces are cut by."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fdspec.report.findings import STATISTIC, parameters, statistic
from fdspec.report.numbers import kilonewtons, rounded

if TYPE_CHECKING:
    import xarray as xr


def storey_rows(choice: xr.Dataset) -> tuple[list[str], list[list[str]]]:
    """Return the head and the rows: forces (kN), brace (MN/m), drift and slip (mm).

    Drift and slip stand there twice, as the statistic over records with friction as recommended, and as the
    largest of any record with friction at its bounds.
    """
    name = parameters(choice)["statistic"]
    head = ["storey", "slip force, kN", "pretension, kN", "band, kN", "brace, MN/m", "brace must carry, kN"]
    head += [f"drift, mm, {name}", "largest", f"slip, mm, {name}", "largest slip"]
    over = statistic(choice)
    rows = []
    for storey in choice["storey"].values:
        at = choice.sel(storey=storey)
        start, end = at["band_pretension"].values
        row = [
            str(storey),
            kilonewtons(at["slip_force"].item()),
            kilonewtons(at["pretension"].item()),
            "none" if np.isnan(start) else f"{kilonewtons(start)} to {kilonewtons(end)}",
            rounded(at["brace_stiffness"].item() / 1e6),
            kilonewtons(at["brace_force"].item()),
        ]
        for demand in ("storey_drift", "storey_slip"):
            values = 1e3 * at[demand].sel(case=["chosen", "lower", "upper"])
            row += [
                rounded(float(over(values.sel(case="chosen").values, axis=0))),
                rounded(float(values.max())),
            ]
        rows.append(row)
    return head, rows


def storey_caption(choice: xr.Dataset) -> str:
    """Say what the columns are."""
    which = STATISTIC[parameters(choice)["statistic"]]
    level = choice["storey_level"].item()
    under = "" if level == 1.0 else f", all under the records times {level:g}"
    return (
        "Counted from the ground; the band is that of all storeys together. Drift and slip: the "
        f"{which} over the records with friction as recommended, and the largest of any record with friction "
        f"at its bounds; the brace at its upper bound{under}. A slot must leave the slip free to either side "
        "of the bolt."
    )
