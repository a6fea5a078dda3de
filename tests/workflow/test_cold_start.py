"""Many processes that start at once on an empty cache of kernels: one compiles, all get the right numbers."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fdspec

ROOT = Path(__file__).resolve().parents[2]

ONE = """
from tests.workflow.test_cold_start import {answer}
print({answer}())
"""


def motion() -> fdspec.GroundMotion:
    noise = np.random.default_rng(8).standard_normal(80)
    return fdspec.GroundMotion(noise, 0.02, "short").scaled_to_pga(4.0)


def spectra() -> str:
    """Return a checksum of what the kernel that compiles fastest computes."""
    from fdspec.signals.spectra import elastic_spectra

    return hashlib.sha256(elastic_spectra(motion(), [0.2, 1.0]).absolute_acceleration.values).hexdigest()


def cube() -> str:
    """Return a checksum of a small cube."""
    computed = fdspec.sweep(motion(), period=[0.2, 0.5], pretension=[20e3, 90e3], stiffness_ratio=4.0)
    return hashlib.sha256(b"".join(computed[name].values.tobytes() for name in computed)).hexdigest()


def start_cold(count: int, cache: Path, answer: str) -> list[str]:
    """Start processes at once that share an empty cache; return what each says, when all ended well."""
    environment = {**os.environ, "FDSPEC_CACHE_DIR": str(cache), "PYTHONPATH": str(ROOT)}
    arguments = [sys.executable, "-W", "error", "-c", ONE.format(answer=answer)]
    processes = [
        subprocess.Popen(
            arguments, cwd=ROOT, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        for _ in range(count)
    ]
    told = [process.communicate(timeout=900) for process in processes]
    assert [process.returncode for process in processes] == [0] * count, told
    return [out.strip() for out, _ in told]


@pytest.mark.slow
def test_ten_at_once_ten_times(tmp_path: Path) -> None:
    for attempt in range(10):
        assert set(start_cold(10, tmp_path / str(attempt), "spectra")) == {spectra()}


@pytest.mark.slow
@pytest.mark.parametrize("attempt", range(int(os.environ.get("FDSPEC_COLD_STARTS", "1"))))
def test_ten_at_once_with_every_kernel_of_the_cube(tmp_path: Path, attempt: int) -> None:
    """FDSPEC_COLD_STARTS=10 repeats it as often; each takes a minute on two cores."""
    assert set(start_cold(10, tmp_path, "cube")) == {cube()}
