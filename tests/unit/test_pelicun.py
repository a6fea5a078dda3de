"""Pelicun's table of demands: its header, units, rows, and what is left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from fdspec.errors import InvalidInput, StoreError
from fdspec.store.pelicun import write_pelicun

DIMS = ("record", "intensity", "building", "stiffness_scale", "slip_scale")


def cube(intensities: int = 1, statuses: tuple[int, int] = (0, 0)) -> xr.Dataset:
    rng = np.random.default_rng(1)
    shape = (2, intensities, 1, 1, 1)
    names = ("peak_acceleration", "peak_drift", "residual_drift")
    status = np.broadcast_to(np.array(statuses, np.int8).reshape(2, 1, 1, 1, 1), shape)
    about = {"flag_values": np.array([0, 2, 5], np.int8), "flag_meanings": "ok non_finite_state collapsed"}
    return xr.Dataset(
        {
            **{name: ((*DIMS, "storey"), rng.uniform(-1.0, 1.0, (*shape, 3))) for name in names},
            "status": (DIMS, status, about),
        },
        coords={
            "record": ["a", "b"],
            "pga": ("record", [2.0, 3.0]),
            "intensity": [1.5, 2.0][:intensities],
            "storey": [1, 2, 3],
        },
    )


def rows_of(path: Path) -> list[list[str]]:
    return [line.split(",") for line in path.read_text().splitlines()]


def test_a_row_a_record_and_a_column_a_demand(tmp_path: Path) -> None:
    given, path = cube(), tmp_path / "demands.csv"
    write_pelicun(given, path, storey_height=3.2)
    head, units, *rows = rows_of(path)
    assert head == [
        "", "1-PFA-0-1", "1-PFA-1-1", "1-PFA-2-1", "1-PFA-3-1", "1-PID-1-1", "1-PID-2-1", "1-PID-3-1",
        "1-RID-1-1", "1-RID-2-1", "1-RID-3-1",
    ]  # fmt: skip
    assert units == ["Units", *["mps2"] * 4, *["rad"] * 6]
    assert [row[0] for row in rows] == ["0", "1"]
    numbers = np.array([[float(cell) for cell in row[1:]] for row in rows])
    np.testing.assert_array_equal(numbers[:, 0], [3.0, 4.5])
    one = given.isel(intensity=0, building=0, stiffness_scale=0, slip_scale=0)
    np.testing.assert_array_equal(numbers[:, 1:4], abs(one["peak_acceleration"]))
    np.testing.assert_array_equal(numbers[:, 4:7], abs(one["peak_drift"]) / 3.2)
    np.testing.assert_array_equal(numbers[:, 7:], abs(one["residual_drift"]) / 3.2)


def test_failures_are_marked_and_collapses_kept(tmp_path: Path) -> None:
    path = tmp_path / "demands.csv"
    write_pelicun(cube(statuses=(2, 5)), path, storey_height=3.0)
    assert [row[-1] for row in rows_of(path)] == ["ERROR", "ea", "1", "0"]


def test_ratios_of_the_cube_need_no_height(tmp_path: Path) -> None:
    given = cube()
    given["peak_drift_ratio"] = given["peak_drift"] / 3.0
    write_pelicun(given, tmp_path / "demands.csv")
    assert rows_of(tmp_path / "demands.csv")[0][-1] == "1-PID-3-1"


def test_what_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="several values along intensity"):
        write_pelicun(cube(2), tmp_path / "a.csv", storey_height=3.0)
    with pytest.raises(InvalidInput, match="give storey_height"):
        write_pelicun(cube(), tmp_path / "a.csv")
    with pytest.raises(InvalidInput, match="storey_height must be positive"):
        write_pelicun(cube(), tmp_path / "a.csv", storey_height=0.0)
    with pytest.raises(InvalidInput, match="cube of buildings"):
        write_pelicun(cube().isel(storey=0), tmp_path / "a.csv", storey_height=3.0)
    with pytest.raises(StoreError):
        write_pelicun(cube(), tmp_path / "a.nc", storey_height=3.0)
    assert not list(tmp_path.iterdir())
