"""Hypothesis profiles and the way to ../shared, the folder of reference files some machines have."""

import os
import signal
import tempfile
import uuid
from pathlib import Path

import pytest
from hypothesis import settings

# A shell has its background jobs ignore Ctrl-C, and so do their children: the tests of Ctrl-C need it.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Matrices here are small: the threads of a BLAS would wait for each other, for minutes where a core is busy.
for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

SHARED = Path(__file__).resolve().parents[2] / "shared"

# Records that a developer has linked would change what the catalogue's names give. No fixture: some tests
# load records when they are collected.
os.environ["FDSPEC_RECORDS"] = str(Path(tempfile.gettempdir()) / f"fdspec-{uuid.uuid4().hex}" / "none.toml")

# No deadline: the first call of a kernel compiles it. CI draws the same examples in every run.
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.register_profile("dev", deadline=None, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "dev")


def pytest_report_header() -> str:
    return f"../shared: {'found' if SHARED.is_dir() else 'not found, tests that need it skip'}"


@pytest.fixture(scope="session")
def shared() -> Path:
    """Give the folder of reference files beside the clone, or skip."""
    if not SHARED.is_dir():
        pytest.skip("../shared is not on this machine")
    return SHARED
