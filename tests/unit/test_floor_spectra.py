"""Floor spectra against a motion made from the changes of phase alone, by matrix exponentials."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

import fdspec
from fdspec.errors import InvalidInput
from fdspec.signals.spectra import elastic_spectra

SAMPLES_A_STEP = 16


def record(seed: int, samples: int = 60) -> fdspec.GroundMotion:
    rng = np.random.default_rng(seed)
    shake = np.convolve(rng.standard_normal(samples), np.ones(5) / 5.0, mode="same")
    return fdspec.GroundMotion(4.0 * shake / np.abs(shake).max(), 0.02, name=f"r{seed}")


def system(phase: int, period: float, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """State (u_f, v_f, u_d, v_d, u_o, v_o, a_g, a_g', 1) of the frame below; and the row of the oscillator's
    absolute acceleration.  The oscillator is driven one way: it pulls at nothing."""
    m_f, m_d, k_f, force = 20e3, 50.0, 20e3 * (2 * math.pi / 0.5) ** 2, 25e3
    c_f, k_d = 0.1 * math.sqrt(k_f * m_f), 4.0 * k_f
    a = np.zeros((9, 9))
    a[0, 1] = a[2, 3] = a[4, 5] = a[6, 7] = 1.0
    if phase == 0:
        shared = np.zeros(9)
        shared[[0, 1, 2]] = -k_f / (m_f + m_d), -c_f / (m_f + m_d), -k_d / (m_f + m_d)
        shared[6] = -1.0
        a[1], a[3] = shared, shared
    else:
        a[1, [0, 1, 6, 8]] = -k_f / m_f, -c_f / m_f, -1.0, -phase * force / m_f
        a[3, [2, 6, 8]] = -k_d / m_d, -1.0, phase * force / m_d
    omega = 2 * math.pi / period
    pull = np.zeros(9)
    pull[[4, 5, 0, 1]] = -(omega**2), -2 * ratio * omega, omega**2, 2 * ratio * omega
    a[5] = pull
    a[5, 6] -= 1.0
    return a, pull


def peak_of_oscillator(motion: fdspec.GroundMotion, period: float, ratio: float) -> float:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=25e3)
    history = fdspec.simulate(frame, motion)
    changes = list(zip(history["transition_time"].values, history["transition_phase"].values, strict=True))
    assert len(changes) > 4
    edges = sorted({*motion.time.tolist(), *(float(t) for t, _ in changes)})
    state, largest = np.zeros(9), 0.0
    state[8] = 1.0
    for start, end in itertools.pairwise(edges):
        phase = next((int(p) for t, p in reversed(changes) if t <= start), 0)
        k = min(int((0.5 * (start + end)) / motion.dt), motion.n - 2)
        rise = (motion.acceleration[k + 1] - motion.acceleration[k]) / motion.dt
        state[6] = motion.acceleration[k] + rise * (start - k * motion.dt)
        state[7] = rise
        if phase == 0:
            state[3] = state[1]
        a, pull = system(phase, period, ratio)
        part = (end - start) / SAMPLES_A_STEP
        step = expm(a * part)
        for _ in range(SAMPLES_A_STEP):
            after = step @ state
            here = max(abs(pull @ state), abs(pull @ after))
            if here > 0.99 * largest:  # an extremum may lie within
                found = minimize_scalar(
                    lambda t, a=a, pull=pull, state=state: -abs(pull @ expm(a * t) @ state),
                    bounds=(0.0, part),
                    method="bounded",
                    options={"xatol": 1e-12},
                )
                largest = max(largest, here, -float(found.fun))
            state = after
    return largest


@pytest.mark.parametrize(("period", "ratio"), [(0.1, 0.05), (0.23, 0.02), (0.5, 0.05), (1.5, 0.0)])
def test_the_oscillator_feels_the_floor(period: float, ratio: float) -> None:
    motion = record(3)
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=25e3)
    found = fdspec.floor_spectra(frame, motion, period=period, damping_ratio=ratio)
    assert int(found["status"].item()) == 0
    wanted = peak_of_oscillator(motion, period, ratio)
    assert found["floor_acceleration"].item() == pytest.approx(wanted, rel=1e-9)


def test_a_stiff_building_hands_on_the_ground() -> None:
    motion = record(4)
    stiff = fdspec.Building([20e3, 20e3], 1e15, 0.0, 0.0, 0.0)
    periods = [0.1, 0.4, 1.0]
    found = fdspec.floor_spectra(stiff, motion, period=periods, damping_ratio=[0.02, 0.05])
    ground = elastic_spectra(motion, periods, [0.02, 0.05])["absolute_acceleration"]
    for storey in (1, 2):
        np.testing.assert_allclose(
            found["floor_acceleration"].sel(storey=storey).values, ground.values, rtol=1e-5
        )


def test_period_zero_is_the_floor_and_the_building_does_not_notice() -> None:
    from fdspec.engines.many_storeys import peaks_of
    from fdspec.runs.floor_spectra import with_oscillator

    building = fdspec.Building.from_periods([30e3, 20e3], 0.5, 0.3, slip_force=[40e3, 20e3], brace_mass=50.0)
    motion = record(5)
    alone, totals = peaks_of(building.frame, motion, certify=False)
    found = fdspec.floor_spectra(building, motion, period=[0.0, 0.4])
    history = fdspec.simulate(building, motion)
    np.testing.assert_allclose(
        found["floor_acceleration"].sel(period=0.0).values.ravel(), history["peak_acceleration"].values
    )
    for storey in (0, 1):
        joined, others = peaks_of(with_oscillator(building, storey, 0.4, 0.05).frame, motion, certify=False)
        assert others[0] == totals[0]
        np.testing.assert_allclose(joined[:, :2], alone, rtol=1e-9, atol=1e-9 * np.abs(alone).max())


def test_the_dataset_says_what_it_is() -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=25e3)
    found = fdspec.floor_spectra(frame, [record(1), record(2)], period=[0.2, 0.4])
    assert isinstance(found, xr.Dataset)
    assert found["floor_acceleration"].dims == ("record", "storey", "damping_ratio", "period")
    assert found["floor_acceleration"].attrs["units"] == "m/s^2"
    assert "records" in found.attrs["parameters"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"period": [-1.0]}, "period: values must be zero or positive"),
        ({"period": [0.2], "damping_ratio": -0.1}, "damping_ratio"),
    ],
)
def test_what_cannot_be_used(change: dict[str, object], message: str) -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=25e3)
    with pytest.raises(InvalidInput, match=message):
        fdspec.floor_spectra(frame, record(1), **change)  # type: ignore[arg-type]


def test_devices_are_refused() -> None:
    frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=25e3, yield_shear=30e3)
    with pytest.raises(InvalidInput, match="without yielding columns"):
        fdspec.floor_spectra(frame, record(1), period=0.2)
