"""What a person wants to see when a cube is done."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fdspec.cli.table import counted, seconds, size, table
from fdspec.measures import best_damper
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

AXES = ("record", "stiffness_ratio", "pretension", "period")

SHORT = 0.6
"""s; up to this period the study finds friction dampers to help."""


def summary(cube: xr.Dataset, path: Path, elapsed: float) -> str:
    """Return a table of the records and where the cube is."""
    axes = " x ".join(counted(cube.sizes[dim], dim.replace("_", " ")) for dim in AXES)
    histories = counted(math.prod(cube.sizes[dim] for dim in AXES), "history", "histories")
    written = f"{path} ({size(path.stat().st_size)})"
    lines = [f"{written}: {axes} = {histories}, in {seconds(elapsed)}"]
    if "peak_acceleration" in cube:
        lines = [_records_table(cube), "", *lines]
    return "\n".join(lines)


def _records_table(cube: xr.Dataset) -> str:
    peak = cube["peak_acceleration"].where(cube["status"] == 0) / G
    dims = ["stiffness_ratio", "pretension", "period"]
    columns = [
        ("record", [str(name) for name in cube["record"].values]),
        ("PGA g", [f"{value:.3f}" for value in cube["pga"].values / G]),
        ("min g", [f"{value:.3f}" for value in peak.min(dims).values]),
        ("max g", [f"{value:.3f}" for value in peak.max(dims).values]),
    ]
    explained = ["min, max: smallest and largest peak absolute acceleration of the floor."]
    if "elastic_acceleration" in cube:
        bands = [
            (f"to {SHORT:g} s", cube.isel(period=np.flatnonzero(cube["period"].values <= SHORT))),
            (f"over {SHORT:g} s", cube.isel(period=np.flatnonzero(cube["period"].values > SHORT))),
        ]
        for name, band in bands:
            if band.sizes["period"]:
                columns += _best(name, band)
        explained += [
            "Best damper for periods in a band: pretension (kN), stiffness ratio (SR), and peak acceleration",
            "as share of the frame's without brace, averaged over the band; the lowest on the grid.",
        ]
    rows = zip(*(cells for _, cells in columns), strict=True)
    return "\n".join([table([head for head, _ in columns], rows, left=("record",)), "", *explained])


def _best(name: str, band: xr.Dataset) -> list[tuple[str, list[str]]]:
    best = best_damper(band)
    known = np.isfinite(best["acceleration_ratio"].values)

    def told(values: np.ndarray, form: str) -> list[str]:
        return [form.format(value) if ok else "-" for value, ok in zip(values, known, strict=True)]

    return [
        (f"{name}: kN", told(best["pretension"].values / 1e3, "{:.4g}")),
        ("SR", told(best["stiffness_ratio"].values, "{:.3g}")),
        ("share", told(best["acceleration_ratio"].values, "{:.0%}")),
    ]
