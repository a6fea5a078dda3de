"""A campaign as an office runs it: AT2 files, six storeys, one command, killed, resumed, handed on."""

from __future__ import annotations

import csv
import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.cli.main import main
from fdspec.model.motion import GroundMotion
from fdspec.records.writing import write_record
from fdspec.store import chunks, description
from fdspec.store.check import check
from fdspec.variables import INTENSITY_BUILDING_CUBE
from tests.workflow.test_killed_buildings import SIX, start

WHOLE = os.environ.get("FDSPEC_CAMPAIGN") == "whole"
"""Whether all 2 640 histories are run, some four minutes on two busy cores; else every fifth intensity."""

INTENSITY = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0][:: 1 if WHOLE else 5]
SLIP_SCALE = [0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0, 1.25, 1.6, 2.0]
RECORDS = 22


def campaign(folder: Path) -> Path:
    """Write the files of 22 records x 12 intensities, or some, x 10 factors on slip forces."""
    (folder / "six.toml").write_text(SIX + "storey_height = 3.2\n", encoding="utf-8")
    (folder / "records").mkdir()
    for number in range(RECORDS):
        rng = np.random.default_rng(number)
        shake = np.convolve(rng.standard_normal(500), np.ones(8) / 8.0, mode="same")
        motion = GroundMotion(3.0 * shake / np.abs(shake).max(), 0.02, name=f"R{number:02}")
        write_record(motion, folder / "records" / f"R{number:02}.AT2")
    (folder / "study.toml").write_text(
        f'buildings = ["six.toml"]\nrecords = ["records/*.AT2"]\nintensity = {INTENSITY}\n'
        f"slip_scale = {SLIP_SCALE}\nstiffness_scale = [1.0]\n",
        encoding="utf-8",
    )
    return folder


def done(store: Path) -> float:
    """Share of the store's blocks that are finished."""
    if not description.is_store(store):
        return 0.0
    blocks, _ = description.described(store)
    status = INTENSITY_BUILDING_CUBE["status"]
    finished = [chunks.chunk_path(store, blocks, n, status).exists() for n in range(len(blocks))]
    return sum(finished) / len(finished)


@pytest.mark.slow
def test_a_campaign_killed_at_five_instants_ends_in_the_same_bits_and_in_pelicun_s_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, store = campaign(tmp_path), tmp_path / "killed.zarr"
    deaths = 0
    for share in (0.01, 0.2, 0.4, 0.6, 0.8):
        process = start(folder, "-o", store.name, "--threads", "2")
        until = time.monotonic() + 300
        while process.poll() is None and time.monotonic() < until and done(store) < share:
            time.sleep(0.005)
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            deaths += 1
        process.communicate()
        assert share <= done(store) < 1.0
    assert deaths == 5
    for name in (store.name, "whole.zarr"):
        process = start(folder, "-o", name, "--threads", "2")
        _, errors = process.communicate()
        assert process.returncode == 0, errors
    assert all(finding.passed is not False for finding in check(store))
    cube, whole = (fdspec.open(folder / name, lazily=False) for name in ("killed.zarr", "whole.zarr"))
    assert cube["status"].size == RECORDS * len(INTENSITY) * len(SLIP_SCALE)
    assert (cube["status"] == 0).all()
    assert cube.drop_attrs().identical(whole.drop_attrs())

    monkeypatch.chdir(folder)
    at = ["--at", "slip_scale=1", "--at", "intensity=1.5"]
    assert main(["export", "killed.zarr", "--format", "pelicun", *at, "--storey-height", "3.2"]) == 0
    lines = Path("killed-pelicun.csv").read_text(encoding="utf-8").splitlines()
    head, units, *rows = list(csv.reader(lines))
    assert len(rows) == RECORDS
    assert set(units[1:]) == {"mps2", "rad"}
    one = cube.sel(slip_scale=1.0, intensity=1.5).squeeze(["building", "stiffness_scale"])
    table = dict(zip(head, np.array(rows, float).T, strict=True))
    for k in range(1, 7):
        at_storey = one.sel(storey=k)
        np.testing.assert_array_equal(table[f"1-PFA-{k}-1"], at_storey["peak_acceleration"].values)
        np.testing.assert_allclose(table[f"1-PID-{k}-1"], at_storey["peak_drift"].values / 3.2, rtol=1e-15)
