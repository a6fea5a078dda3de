"""The same bits on processors of other kinds, which the compiler is told to work for."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PRINT_BITS = """
import hashlib

import numpy as np

import fdspec

time = 0.01 * np.arange(1500)
motion = fdspec.GroundMotion(3.0 * np.sin(7.0 * time) * np.exp(-0.2 * time), 0.01, name="sine")
cube = fdspec.sweep(
    motion,
    period=np.linspace(0.1, 2.0, 40),
    stiffness_ratio=[1.0, 4.0],
    pretension=np.linspace(5e3, 3e5, 9),
)
assert int(cube.transitions.sum()) > 10_000
for name in sorted(cube.data_vars):
    print(name, hashlib.sha256(np.ascontiguousarray(cube[name].values).tobytes()).hexdigest())
"""


def bits(**variables: str) -> str:
    """Hashes of a sweep's variables, computed under these environment variables."""
    done = subprocess.run(
        [sys.executable, "-c", PRINT_BITS],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_a_processor_without_vectors_and_fused_sums_gives_the_same_bits(tmp_path: Path) -> None:
    plain = bits(FDSPEC_CACHE_DIR=str(tmp_path), NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="")
    assert plain.count("\n") > 10
    assert plain == bits()
