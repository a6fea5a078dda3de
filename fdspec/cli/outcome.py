"""What a person wants to see when a cube is done."""

from __future__ import annotations

import logging
import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fdspec.cli.storey_columns import STOREY_COLUMNS
from fdspec.cli.table import counted, filled, grouped, seconds, size, table
from fdspec.measures import best_damper
from fdspec.printable import in_words
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

MANY = 100
"""Records; of more no table is shown."""

AT_ONCE = 1_000_000
"""Histories whose peaks are in memory at once."""

LISTED = 20
"""Histories that did not end well and are shown one by one."""

log = logging.getLogger(__name__)

SHORT = 0.6
"""s; up to this period the study finds friction dampers to help."""


def summary(cube: xr.Dataset, path: Path, elapsed: float) -> str:
    """Return a table of the records and where the cube is."""
    dims = [str(dim) for dim in cube["status"].dims]
    axes = " x ".join(
        counted(cube.sizes[dim], dim.replace("_", " "), *(["intensities"] if dim == "intensity" else []))
        for dim in dims
    )
    histories = counted(cube["status"].size, "history", "histories")
    storeys = f" of {counted(cube.sizes['storey'], 'storey')}" if "storey" in cube.dims else ""
    written = f"{path} ({size(_bytes(path))})"
    lines = [f"{written}: {axes} = {histories}{storeys}, in {seconds(elapsed)}"]
    if "storey" in cube.dims:
        return "\n".join([*_profile_table(cube), *lines])
    if "peak_acceleration" in cube and cube.sizes["record"] <= MANY:
        lines = [_records_table(cube), "", *lines]
    return "\n".join(lines)


def as_data(cube: xr.Dataset, path: Path, elapsed: float) -> dict[str, object]:
    """Return the same for programs."""
    from fdspec.measures.statuses import status_counts

    return {
        "output": str(path),
        "bytes": _bytes(path),
        "dims": {str(dim): cube.sizes[dim] for dim in cube["status"].dims},
        "histories": cube["status"].size,
        "statuses": status_counts(cube),
        "seconds": elapsed,
        "records": [str(name) for name in cube["record"].values],
    }


def _profile_table(cube: xr.Dataset) -> list[str]:
    """Table of the storeys of each building with its dampers as they are given, or nearest to that."""
    from fdspec.measures.summary import nearest_design, summary

    lines: list[str] = []
    shown = [name for name in STOREY_COLUMNS if name in cube]
    for name in cube["building"].values:
        one = nearest_design(cube.sel(building=name))
        if "intensity" in one.dims:
            one = one.sel(intensity=1.0, method="nearest")
        told = summary(one[[*shown, "status"]].load(), percentiles=())
        pairs = [(column, statistic) for column in shown for statistic in ("median", "worst")]
        head = ["storey", *(f"{STOREY_COLUMNS[column].head} {statistic}" for column, statistic in pairs)]
        columns = [
            STOREY_COLUMNS[column].scale * told[column].sel(statistic=statistic).values
            for column, statistic in pairs
        ]
        rows = [
            [str(int(cube["storey"].values[k])), *(f"{values[k]:.4g}" for values in columns)]
            for k in reversed(range(cube.sizes["storey"]))
        ]
        scales = f"slip scale {one['slip_scale'].item():g}, stiffness scale {one['stiffness_scale'].item():g}"
        lines += [f"building {name}, {scales}, over the records", table(head, rows), ""]
    return lines


def _records_table(cube: xr.Dataset) -> str:
    """Table of the records, read a few at a time: the cube may be larger than memory."""
    wanted = cube[[name for name in ("peak_acceleration", "elastic_acceleration", "status") if name in cube]]
    explained = []
    if "intensity" in cube.dims:
        wanted = wanted.sel(intensity=1.0, method="nearest")
        explained.append(f"At intensity {wanted['intensity'].item():g}, as are the bests.")
    several = max(1, AT_ONCE * cube.sizes["record"] // max(1, wanted["status"].size))
    tables = [
        _columns(wanted.isel(record=slice(k, k + several)).load())
        for k in range(0, cube.sizes["record"], several)
    ]
    rows = [list(row) for columns in tables for row in zip(*(cells for _, cells in columns), strict=True)]
    explained.append("min, max: smallest and largest peak absolute acceleration of the floor.")
    if "elastic_acceleration" in cube:
        explained.append(
            "Best damper for periods in a band: pretension (kN), stiffness ratio (SR), and peak acceleration "
            "as share of the frame's without brace, averaged over the band; the lowest on the grid."
        )
    head = [name for name, _ in tables[0]]
    return "\n".join([table(head, rows, left=("record",)), "", *map(filled, explained)])


def _columns(cube: xr.Dataset) -> list[tuple[str, list[str]]]:
    peak = cube["peak_acceleration"].where(cube["status"] == 0) / G
    dims = ["stiffness_ratio", "pretension", "period"]
    columns = [
        ("record", [str(name) for name in cube["record"].values]),
        ("PGA g", [f"{value:.3f}" for value in cube["pga"].values / G]),
        ("min g", [f"{value:.3f}" for value in peak.min(dims).values]),
        ("max g", [f"{value:.3f}" for value in peak.max(dims).values]),
    ]
    if "elastic_acceleration" in cube:
        bands = [
            (f"to {SHORT:g} s", cube.isel(period=np.flatnonzero(cube["period"].values <= SHORT))),
            (f"over {SHORT:g} s", cube.isel(period=np.flatnonzero(cube["period"].values > SHORT))),
        ]
        for name, band in bands:
            if band.sizes["period"]:
                columns += _best(name, band)
    return columns


def _best(name: str, band: xr.Dataset) -> list[tuple[str, list[str]]]:
    best = best_damper(band)
    known = np.isfinite(best["acceleration_ratio"].values)

    def told(values: np.ndarray, form: str) -> list[str]:
        return [form.format(value) if ok else "-" for value, ok in zip(values, known, strict=True)]

    return [
        (f"{name}: kN", told(best["pretension"].values / 1e3, "{:.4g}")),
        ("SR", told(best["stiffness_ratio"].values, "{:.3g}")),
        ("share", told(100.0 * best["acceleration_ratio"].values, "{:.0f} %")),
    ]


def statuses(cube: xr.Dataset) -> tuple[str, int]:
    """Return how the histories ended, with where those are that did not end well, and the number of these."""
    from fdspec.measures.statuses import failed_cells, status_counts

    counts = status_counts(cube)
    told = "status: " + ", ".join(
        f"{grouped(number)} {in_words(meaning)}" for meaning, number in counts.items()
    )
    log.info("%s", told)
    lines = [told]
    for number, cell in enumerate(failed_cells(cube)):
        log.warning("%s", cell)
        if number < LISTED:
            lines.append(f"  {cell}")
    failed = sum(number for meaning, number in counts.items() if meaning != "ok")
    if failed > LISTED:
        lines.append(f"  and {grouped(failed - LISTED)} more; --log lists all, as does fdspec check --all")
    return "\n".join(lines), failed


def _bytes(path: Path) -> int:
    """Size of a file, or of all files of a store."""
    if path.is_file():
        return path.stat().st_size
    return sum(Path(folder, name).stat().st_size for folder, _, names in os.walk(path) for name in names)
