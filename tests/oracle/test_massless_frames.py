"""Massless braces against an integrator of their first-order law that shares no code with the kernels."""

from __future__ import annotations

import numpy as np
import pytest

import fdspec
from fdspec.engines.many_storeys import integrate_many_storeys
from fdspec.engines.trajectory import Span
from tests.massless_frames import draw
from tests.oracle import massless_events

SAMPLES = 60


def lasting(changes: list[tuple[float, int, int]], shortest: float) -> list[tuple[int, int]]:
    """Storey and phase of the changes, without slip that is over in less than ``shortest`` (s).

    Free vibration without damping comes to swing just to the slip force, where rounding decides: a
    reaction of 1 + 2e-16 times that force lasts 1e-8 of a period.
    """
    kept: list[tuple[float, int, int]] = []
    for time, storey, phase in changes:
        began = next((k for k in range(len(kept) - 1, -1, -1) if kept[k][1] == storey), None)
        if phase == 0 and began is not None and kept[began][2] != 0 and time - kept[began][0] < shortest:
            del kept[began]
        else:
            kept.append((time, storey, phase))
    return [(storey, phase) for _, storey, phase in kept]


def differences(seed: int) -> list[str]:
    """Where engine and oracle disagree on the frame of this seed; its braces have no mass."""
    building, motion, start, _ = draw(
        seed, storeys=(1, 2, 2, 3), shortest_period=0.15, weakest_dashpot=1e-2, all_massless=True
    )
    motion = fdspec.GroundMotion(motion.acceleration[:SAMPLES], motion.dt)
    got = integrate_many_storeys(building, motion, Span(0, motion.duration, 2), start)
    frame = massless_events.Frame(
        building.floor_mass,
        building.stiffness_matrix,
        building.damping_matrix,
        building.brace_stiffness,
        building.brace_damping,
        building.slip_force,
        building.kinetic_slip_force,
    )
    offset = np.where(building.brace_stiffness > 0.0, start[0, 0] - start[0, 1], 0.0)
    want = massless_events.Integrator(frame).run(
        motion.acceleration, motion.dt, start[0, 0], start[1, 0], offset
    )
    found = []
    for name, a, b in (
        ("peak_acceleration", got.peak_acceleration, want.acceleration),
        ("peak_displacement", got.peak_displacement, want.displacement),
        ("residual_displacement", got.residual_displacement, want.final[: building.n_storeys]),
    ):
        scale = want.displacement.max() if name == "residual_displacement" else b.max()
        if not np.abs(a - b).max() <= 1e-9 * scale:
            found.append(f"seed {seed}: {name} {a} and {b}")
    rubbing = building.slip_force > 0.0
    travel = np.abs(got.slip_travel[-1] - want.travel)[rubbing]
    if not travel.max(initial=0.0) <= 1e-9 * max(want.travel.max(), want.displacement.max()):
        found.append(f"seed {seed}: slip_travel {got.slip_travel[-1]} and {want.travel}")
    shortest = 1e-6 * motion.dt
    times, storeys, phases = got.transition_time, got.transition_storey, got.transition_phase
    ours = lasting(list(zip(times.tolist(), storeys.tolist(), phases.tolist(), strict=True)), shortest)
    theirs = lasting(want.changes, shortest)
    # Forces of a billionth of those in the frame change phase by rounding as well.
    if building.slip_force[rubbing].min(initial=np.inf) > 1.0 and ours != theirs:
        found.append(f"seed {seed}: {len(ours)} and {len(theirs)} changes of phase")
    return found


def test_few_frames() -> None:
    assert [told for seed in range(10, 16) for told in differences(seed)] == []


@pytest.mark.slow
def test_hundreds_of_frames() -> None:
    assert [told for seed in range(16, 300) for told in differences(seed)] == []
