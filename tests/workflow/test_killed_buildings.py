"""Six storeys under 22 records from files, by one command that is killed and goes on to the same bits."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.store import chunks, description
from fdspec.store.check import check
from fdspec.variables import BUILDING_CUBE

ROOT = Path(__file__).resolve().parents[2]

SIX = """\
floor_mass = [60e3, 60e3, 60e3, 60e3, 60e3, 50e3]
storey_stiffness = [90e6, 85e6, 80e6, 70e6, 60e6, 50e6]
brace_stiffness = [160e6, 150e6, 140e6, 120e6, 100e6, 80e6]
brace_mass = 100
slip_force = [250e3, 240e3, 220e3, 190e3, 150e3, 90e3]
kinetic_ratio = 0.9
damping_ratio = 0.03
"""


def written(folder: Path) -> Path:
    """Write a study of the building under 22 records, 4 factors on slip forces and 3 on stiffness: 264."""
    (folder / "six.toml").write_text(SIX, encoding="utf-8")
    names = []
    for number in range(22):
        rng = np.random.default_rng(number)
        shake = np.convolve(rng.standard_normal(500), np.ones(8) / 8.0, mode="same")
        shake *= 0.4 / np.abs(shake).max()
        names.append(f'{{ path = "r{number:02}.txt", units = "g", dt = 0.02, name = "r{number:02}" }}')
        np.savetxt(folder / f"r{number:02}.txt", shake)
    (folder / "study.toml").write_text(
        f'buildings = ["six.toml"]\nrecords = [{", ".join(names)}]\n'
        "slip_scale = [0.25, 0.5, 1.0, inf]\nstiffness_scale = [0.5, 1.0, 2.0]\n",
        encoding="utf-8",
    )
    return folder


def start(folder: Path, *options: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-m", "fdspec", "sweep", "study.toml", *options],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "SOURCE_DATE_EPOCH": "1700000000"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )


def blocks_done(store: Path) -> set[int]:
    if not description.is_store(store):
        return set()
    blocks, _ = description.described(store)
    status = BUILDING_CUBE["status"]
    return {n for n in range(len(blocks)) if chunks.chunk_path(store, blocks, n, status).exists()}


@pytest.mark.slow
def test_killed_at_five_instants_and_resumed_to_the_same_bits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, store = written(tmp_path), tmp_path / "killed.zarr"
    deaths, before = 0, set[int]()
    for wanted in (1, 5, 20, 60, 120):
        process = start(folder, "-o", store.name, "--threads", "2")
        until = time.monotonic() + 60
        while process.poll() is None and time.monotonic() < until and len(blocks_done(store)) < wanted:
            time.sleep(0.005)
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            deaths += 1
        process.communicate()
        there = blocks_done(store)
        assert before <= there, "a finished block is gone"
        assert {finding.what for finding in check(store) if finding.passed is False} >= (
            {"checksums"} if len(there) < len(description.described(store)[0]) else set()
        )
        before = there
    assert deaths >= 3
    last = start(folder, "-o", store.name)
    _, errors = last.communicate()
    assert last.returncode == 0, errors
    assert {finding.what for finding in check(store) if finding.passed is False} == set()
    study = fdspec.runs.building_study.BuildingStudy.read(folder / "study.toml")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    plain: xr.Dataset = fdspec.runs.studies.compute(study, study.motions())
    resumed = fdspec.open(store, lazily=False)
    assert resumed.identical(plain)
    assert resumed["status"].size == 264
