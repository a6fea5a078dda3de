"""Every history ends in a status: what is no longer a number, or never ends, is said to be so."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fdspec
from fdspec.errors import IntegrationError
from fdspec.kernels.types import NON_FINITE_STATE

ROOT = Path(__file__).resolve().parents[2]

AXES = {"period": [0.5], "pretension": [1e4, 1e5, np.inf], "stiffness_ratio": [4.0]}


@pytest.fixture(params=[1e308, 1e200])
def monstrous(request: pytest.FixtureRequest) -> fdspec.GroundMotion:
    """A motion whose rates, or whose energies, are beyond the largest float."""
    with pytest.warns(UserWarning, match="the unit looks wrong"):
        return fdspec.GroundMotion(request.param * np.array([0.0, 1.0, -1.0, 1.0, 0.0]), 0.01, name="m")


def test_a_sweep_keeps_the_status(monstrous: fdspec.GroundMotion) -> None:
    cube = fdspec.sweep(monstrous, **AXES)
    assert (cube.status == NON_FINITE_STATE).all()


@pytest.mark.parametrize("storeys", [1, 2])
def test_simulate_raises_it(monstrous: fdspec.GroundMotion, storeys: int) -> None:
    building = fdspec.Building([20e3] * storeys, 3e6, 50.0, 12e6, 5e4)
    with pytest.raises(IntegrationError, match="non_finite_state"):
        fdspec.simulate(building, monstrous)


UNCOMPILED = """
import numpy as np
from fdspec.kernels.mathematics.oscillator import TERMS
from fdspec.kernels.storey import step
from fdspec.kernels.storey.constants import RADIANS, plan
from fdspec.kernels.storey.output import TRACES
from fdspec.kernels.types import N_STATE, OK, STATE, TRANSITION_CAP_REACHED, Motion, Storey

step.TRANSITION_CAP = 3
scheme = plan(Storey(20e3, 2.5e4, 3.2e6, 50.0, 0.0, 12.6e6, 5e3, 5e3), 0.01, RADIANS)
s = np.empty(N_STATE)
series = [np.empty(TERMS) for _ in range(3)]
step.begin(scheme, Motion(0.0, 0.0, 0.0, 0.0), s)
none = np.empty(0), np.empty(0, np.int64), np.empty((0, len(TRACES)))
for k in range(200):
    a0, a1 = 3.0 * np.sin(0.13 * np.array([k, k + 1.0]))
    flags = False, False, False
    step.take_step(
        scheme, np.empty(0), s, 0.01 * k, a0, (a1 - a0) / 0.01, *flags, *series, *none, 0.0, 0, 0.0
    )
    if s[STATE.status] != OK:
        break
assert s[STATE.status] == TRANSITION_CAP_REACHED, s[STATE.status]
assert s[STATE.transitions] == 3, s[STATE.transitions]
"""


def test_a_history_without_end_is_given_up() -> None:
    """The same step as compiled, uncompiled and with a cap of three changes of phase."""
    subprocess.run(
        [sys.executable, "-W", "ignore", "-c", UNCOMPILED],
        cwd=ROOT,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        check=True,
    )
