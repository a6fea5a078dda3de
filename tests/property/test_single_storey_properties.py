"""What must hold for every single storey, over wide ranges."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import fdspec

PEAKS = ("peak_acceleration", "peak_displacement", "peak_velocity", "peak_storey_shear")


@dataclass(frozen=True)
class Case:
    """A frame and the seed of its motion."""

    frame: dict[str, Any]
    seed: int
    dt: float

    def motion(self, factor: float = 1.0) -> fdspec.GroundMotion:
        rng = np.random.default_rng(self.seed)
        shake = np.convolve(rng.standard_normal(120), np.ones(5) / 5.0, mode="same")
        return fdspec.GroundMotion(3.0 * factor * shake / np.abs(shake).max(), self.dt, name="shake")

    def history(self, factor: float = 1.0, force: float = 1.0, **more: Any) -> xr.Dataset:
        frame = {**self.frame, "slip_force": self.frame["slip_force"] * force}
        return fdspec.simulate(fdspec.Building.single_storey(**frame), self.motion(factor), **more)


def logarithmic(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(math.log(low), math.log(high)).map(math.exp)


frames = st.fixed_dictionaries(
    {
        "period": logarithmic(0.03, 8.0),
        "stiffness_ratio": logarithmic(0.05, 50.0),
        "slip_force": logarithmic(100.0, 5e5),
        "brace_mass": st.one_of(st.just(0.0), logarithmic(1.0, 5000.0)),
        "damping_ratio": st.floats(0.0, 0.3),
        "brace_damping_ratio": st.one_of(st.just(0.0), st.floats(0.01, 0.3)),
    }
)
cases = st.builds(Case, frames, st.integers(0, 10**6), logarithmic(0.002, 0.03))


@given(cases)
def test_energy_closes(case: Case) -> None:
    history = case.history()
    balance = (
        history.input_energy
        - history.kinetic_energy
        - history.strain_energy
        - history.viscous_energy
        - history.friction_energy
    )
    assert abs(float(history.energy_error)) < 1e-9
    assert float(np.abs(balance).max()) <= 1e-9 * float(np.abs(history.input_energy).max())


@given(cases)
def test_mirror(case: Case) -> None:
    one, other = case.history(), case.history(factor=-1.0)
    np.testing.assert_array_equal(one.displacement, -other.displacement)
    np.testing.assert_array_equal(one.transition_time, other.transition_time)
    np.testing.assert_array_equal(one.transition_phase, -other.transition_phase)


@given(cases, st.sampled_from([0.125, 2.0, 8.0]))
def test_motion_and_slip_force_scale_together(case: Case, factor: float) -> None:
    one, other = case.history(), case.history(factor=factor, force=factor)
    np.testing.assert_array_equal(one.transition_time, other.transition_time)
    for name in PEAKS:
        np.testing.assert_allclose(other[name], factor * one[name], rtol=1e-14)


@given(cases)
def test_what_comes_later_moves_nothing_earlier(case: Case) -> None:
    short = case.history()
    whole = case.history(free_vibration=1.0)
    n = short.time.size
    np.testing.assert_array_equal(short.displacement, whole.displacement[:n])
    assert (whole.peak_acceleration >= short.peak_acceleration).all()


@given(cases)
def test_the_damper_obeys(case: Case) -> None:
    """No force above the slip force, sliding only against it, and slip travel only while sliding."""
    history = case.history()
    limit = case.frame["slip_force"]
    assert float(np.abs(history.friction_force).max()) <= limit * (1.0 + 1e-12)
    sliding = history.velocity - history.brace_velocity
    scale = float(np.abs(history.velocity).max() + np.abs(history.brace_velocity).max())
    assert float((sliding * history.phase).min()) >= -1e-9 * scale
    np.testing.assert_allclose(sliding.where(history.phase == 0, 0.0), 0.0, atol=1e-9 * scale)
    assert (np.diff(history.slip_travel[:, 0]) >= -1e-12 * scale).all()
    times = history.transition_time.values
    assert (np.diff(times) >= 0.0).all()


@given(cases)
def test_peaks_are_those_of_the_continuous_motion(case: Case) -> None:
    """Outputs taken eleven times as often never pass the peaks, and come close to them."""
    fine = case.history(dt_out=case.dt / 11.0)
    for name, of in (("acceleration", 0), ("displacement", 0), ("velocity", 0), ("storey_shear", 0)):
        top = float(np.abs(fine[name][:, of]).max())
        peak = float(fine[f"peak_{name}"][of])
        assert top <= peak * (1.0 + 1e-12)
    assert float(np.abs(fine.displacement).max()) == pytest.approx(float(fine.peak_displacement[0]), rel=0.02)


@given(cases)
def test_never_slipping_is_the_braced_frame(case: Case) -> None:
    locked = fdspec.Building.single_storey(**{**case.frame, "slip_force": math.inf})
    high = fdspec.Building.single_storey(**{**case.frame, "slip_force": 1e12})
    one, other = fdspec.simulate(locked, case.motion()), fdspec.simulate(high, case.motion())
    assert int(one.transitions) == 0
    np.testing.assert_array_equal(one.displacement, other.displacement)
