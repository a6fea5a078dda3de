"""What the damper does: reaction, the end of sliding, the start of it."""

from __future__ import annotations

import pytest

from fdspec.kernels.friction import GOES_ON, onset_acceleration, phase_after_stop, reaction
from fdspec.kernels.types import STICK, Storey

STOREY = Storey(20e3, 3e4, 3e6, 50.0, 20.0, 12e6, 1e5, 8e4)


@pytest.mark.parametrize(
    ("sign", "held", "expected"),
    [
        (1, 0.0, STICK),
        (1, 1e5, STICK),
        (1, -1e5, STICK),
        (-1, 1e5, STICK),
        (1, -1.0001e5, -1),
        (-1, 1.0001e5, 1),
        (1, 1.0001e5, GOES_ON),
        (-1, -1.0001e5, GOES_ON),
    ],
)
def test_phase_after_stop(sign: int, held: float, expected: int) -> None:
    assert phase_after_stop(sign, held, STOREY.slip_force) == expected


def test_reaction_keeps_one_acceleration() -> None:
    u, v, d = 0.01, 0.2, 0.003
    held = reaction(STOREY, u, v, d)
    floor = -(held + STOREY.floor_damping * v + STOREY.floor_stiffness * u) / STOREY.floor_mass
    brace = (held - STOREY.brace_damping * v - STOREY.brace_stiffness * d) / STOREY.brace_mass
    assert floor == pytest.approx(brace, rel=1e-12)


def test_onset_acceleration() -> None:
    assert onset_acceleration(STOREY, 1e5) == pytest.approx(2e4 * (1 / 20e3 + 1 / 50.0))
    assert onset_acceleration(STOREY, -1e5) == onset_acceleration(STOREY, 1e5)
    assert onset_acceleration(STOREY._replace(brace_mass=0.0), 1e5) == 0.0
