"""A sweep and the same histories one by one, on a motion so short that kernels also run uncompiled.

The two take different ways through the kernels: a sweep shares work between slip forces and leaves out the
trajectory. Kernels' coverage is measured here, with the JIT off.
"""

import itertools

import numpy as np
import pytest
import xarray as xr

import fdspec

PERIOD, PRETENSION, STIFFNESS_RATIO = (0.1, 0.6), (0.0, 20e3, 70e3, np.inf), (0.5, 4.0)
SHARED = ("peak_acceleration", "peak_displacement", "peak_velocity", "peak_base_shear", "dissipated_energy")


def short_motion() -> fdspec.GroundMotion:
    """Three seconds of noise under a bell, 4 m/s2 at most, from a fixed seed."""
    rng = np.random.default_rng(20260101)
    noise = rng.standard_normal(150) * np.sin(np.linspace(0.0, np.pi, 150)) ** 2
    return fdspec.GroundMotion(noise, 0.02, "short").scaled_to_pga(4.0)


def short_sweep(**settings: object) -> xr.Dataset:
    axes = {"period": PERIOD, "pretension": PRETENSION, "stiffness_ratio": STIFFNESS_RATIO}
    return fdspec.sweep([short_motion()], **axes, **settings)


def test_a_sweep_is_its_histories() -> None:
    cube = short_sweep().sel(record="short")
    assert cube.transitions.sum() > 100
    for period, pretension, ratio in itertools.product(PERIOD, PRETENSION, STIFFNESS_RATIO):
        cell = cube.sel(period=period, pretension=pretension, stiffness_ratio=ratio)
        frame = fdspec.Building.single_storey(
            period=period, stiffness_ratio=ratio, slip_force=0.5 * pretension
        )
        history = fdspec.simulate(frame, short_motion())
        assert cell.transitions == history.transitions, (period, pretension, ratio)
        for name in SHARED:
            np.testing.assert_allclose(cell[name], history[name].squeeze(), rtol=1e-10, atol=1e-12)
        assert abs(cell.energy_error) < 1e-9
        assert abs(history.energy_error) < 1e-9


def test_limits_are_the_ends_of_the_axis() -> None:
    cube = short_sweep()
    free, locked = cube.peak_acceleration.isel(pretension=0), cube.peak_acceleration.isel(pretension=-1)
    np.testing.assert_allclose(
        cube.elastic_acceleration.broadcast_like(free).transpose(*free.dims), free, rtol=1e-10
    )
    np.testing.assert_allclose(cube.braced_acceleration, locked, rtol=1e-10)


def test_without_the_energy_balance_the_rest_keeps_its_bits() -> None:
    certified, plain = short_sweep(), short_sweep(certify=False)
    assert "energy_error" not in plain
    for name in SHARED:
        assert certified[name].identical(plain[name]), name


@pytest.mark.parametrize("slip_force", [(0.0, 30e3), (20e3, 30e3), (np.inf, 20e3)])
def test_a_building_closes_its_energy(slip_force: tuple[float, float]) -> None:
    building = fdspec.Building(
        floor_mass=[20e3, 18e3],
        storey_stiffness=[6e6, 5e6],
        brace_mass=[50.0, 40.0],
        brace_stiffness=[20e6, 15e6],
        slip_force=slip_force,
        damping=fdspec.ModalDamping(0.03),
    )
    history = fdspec.simulate(building, short_motion())
    assert history.status == 0
    assert history.transitions > 5
    assert abs(history.energy_error) < 1e-9


@pytest.mark.parametrize(("brace_mass", "kinetic"), [(50.0, None), (0.0, None), (0.0, 15e3)])
def test_strain_energy_is_that_of_the_other_formulation(brace_mass: float, kinetic: float | None) -> None:
    """Area and maximum, by the closed form of one storey and by the series of many."""
    from fdspec.engines.frame_strain import strain_of_frame
    from fdspec.engines.strain import strain_of_storeys

    frame = fdspec.Building.single_storey(0.6, 4.0, 20e3, brace_mass=brace_mass, kinetic_slip_force=kinetic)
    one = strain_of_storeys(np.array([frame.storey]), short_motion())[0]
    many = strain_of_frame(frame.frame, short_motion())
    np.testing.assert_allclose(one, many, rtol=1e-10)
    assert one[1] > 0.0
