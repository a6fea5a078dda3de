"""The methods that the study compares: one interface, one schema, errors that say what is wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest

import fdspec
from fdspec.errors import IntegrationError, InvalidInput
from fdspec.methods import (
    METHODS,
    Bilinear,
    BoucWen,
    Dimova,
    EquivalentLinear,
    Method,
    Newmark,
    RigidPlastic,
    StateSpace,
    chosen_method,
)

QUICK: dict[str, Method] = {
    "newmark": Newmark(dt=1e-4),
    "dimova": Dimova(velocity_band=0.01, dt=1e-3),
    "bilinear": Bilinear(dt=1e-3),
    "rigid-plastic": RigidPlastic(dt=1e-3),
    "bouc-wen": BoucWen(rtol=1e-5),
    "equivalent-linear": EquivalentLinear(),
    "state-space": StateSpace(),
}


def noise(seconds: float = 4.0, dt: float = 0.02) -> fdspec.GroundMotion:
    rng = np.random.default_rng(20260601)
    n = round(seconds / dt) + 1
    x = rng.standard_normal(n) * np.sin(np.linspace(0.0, np.pi, n)) ** 2
    return fdspec.GroundMotion(4.0 * x / np.max(np.abs(x)), dt, "noise")


def two_storeys(slip_force: tuple[float, float] = (50e3, 30e3), brace_mass: float = 300.0) -> fdspec.Building:
    return fdspec.Building(
        floor_mass=[20e3, 18e3],
        storey_stiffness=[9e6, 7e6],
        brace_mass=brace_mass,
        brace_stiffness=[25e6, 20e6],
        slip_force=slip_force,
        damping=fdspec.ModalDamping(0.03),
    )


def test_every_method_of_the_study_is_there() -> None:
    assert set(METHODS) == set(QUICK)
    for name, method in METHODS.items():
        assert method.name == name
        assert chosen_method(name) == method()
        assert method.__doc__
        assert "study" in method.__doc__
    assert chosen_method("exact") is None


@pytest.mark.parametrize("name", QUICK)
def test_a_history_has_the_exact_engines_schema(name: str) -> None:
    building, motion = two_storeys(), noise()
    exact = fdspec.simulate(building, motion, free_vibration=0.5, dt_out=0.03)
    other = fdspec.simulate(building, motion, method=QUICK[name], free_vibration=0.5, dt_out=0.03)
    # From the exact engine alone another history can go on.
    shared = set(exact.variables) - {"end_state"}
    assert set(other.variables) == shared
    for key in shared:
        assert other[key].dims == exact[key].dims, key
        assert other[key].dtype == exact[key].dtype, key
        assert other[key].attrs == exact[key].attrs, key
    np.testing.assert_array_equal(other.time, exact.time)
    assert np.isfinite(other.displacement).all()
    assert name in other.attrs["source"]
    assert f'"method": "{name}"' in other.attrs["parameters"]
    # Each idealises friction in its own way, but all see the same building under the same ground.
    assert 0.2 < float(other.peak_drift.max() / exact.peak_drift.max()) < 1.6
    assert other.energy_error < 5e-3
    balance = other.kinetic_energy + other.strain_energy + other.viscous_energy + other.friction_energy
    np.testing.assert_allclose(
        balance, other.input_energy, rtol=0.0, atol=6e-3 * other.input_energy[-1].item()
    )


@pytest.mark.parametrize("name", QUICK)
def test_a_sweep_has_the_exact_engines_schema(name: str) -> None:
    axes = {"period": [0.3, 0.6], "stiffness_ratio": [1.0, 6.0], "pretension": [0.0, 60e3, math.inf]}
    motion = noise(2.0)
    exact, other = fdspec.sweep(motion, **axes), fdspec.sweep(motion, method=QUICK[name], **axes)
    assert set(other.variables) == set(exact.variables)
    assert other.peak_acceleration.dims == exact.peak_acceleration.dims
    assert (other.status == 0).all()
    assert other.elastic_acceleration.identical(exact.elastic_acceleration)
    free = other.peak_acceleration.isel(pretension=0) / exact.peak_acceleration.isel(pretension=0)
    np.testing.assert_allclose(free, 1.0, rtol=2e-3)
    one = fdspec.simulate(
        fdspec.Building.single_storey(period=0.6, stiffness_ratio=6.0, slip_force=30e3),
        motion,
        method=QUICK[name],
    )
    # An integrator that chooses its steps answers the last bit of a damping with another choice.
    within = 1e-3 if name in {"dimova", "bouc-wen"} else 1e-9
    cell = other.sel(record="noise", period=0.6, stiffness_ratio=6.0, pretension=60e3)
    for variable in ("peak_acceleration", "peak_displacement", "peak_base_shear", "dissipated_energy"):
        assert cell[variable].item() == pytest.approx(one[variable].item(), rel=within), variable
    assert cell.transitions == one.transitions


@pytest.mark.parametrize("storeys", [1, 2])
@pytest.mark.parametrize("name", QUICK)
@pytest.mark.parametrize("slip_force", [0.0, math.inf], ids=["free", "never slips"])
def test_own_limits(name: str, slip_force: float, storeys: int) -> None:
    """Without friction or without slip each is a linear frame; the rigid one without slip is the ground."""
    massive = name in {"newmark", "dimova", "state-space"}
    if storeys == 1:
        building = fdspec.Building(
            20e3, 3.2e6, 300.0 if massive else 0.0, 12.8e6, slip_force, damping=fdspec.ModalDamping(0.05)
        )
    else:
        building = two_storeys((slip_force, slip_force), 300.0 if massive else 0.0)
    motion = noise()
    other = fdspec.simulate(building, motion, method=QUICK[name])
    assert other.sizes["transition"] == 0
    if name == "rigid-plastic" and slip_force > 0.0:
        np.testing.assert_allclose(other.peak_acceleration, motion.pga, rtol=1e-9)
        assert other.peak_drift.max() < 1e-4
        return
    exact = fdspec.simulate(building, motion)
    # Fixed steps: (omega dt)^2 / 12 or less, over 4 s; samples of a peak: (omega dt)^2 / 8.
    np.testing.assert_allclose(other.peak_acceleration, exact.peak_acceleration, rtol=2e-3)
    scale = float(np.abs(exact.displacement).max())
    np.testing.assert_allclose(other.displacement, exact.displacement, rtol=0.0, atol=3e-3 * scale)


@pytest.mark.parametrize(
    ("method", "within"),
    [(Bilinear(dt=1e-4), 1e-5), (BoucWen(exponent=60.0), 1e-2), (Dimova(velocity_band=1e-5, dt=1e-3), 1e-3)],
    ids=lambda value: getattr(value, "name", ""),
)
def test_massless_brace(method: Method, within: float) -> None:
    """The limits that lead to the exact engine's massless brace: in dt, in the exponent, in the band."""
    building = fdspec.Building(20e3, 3.2e6, 0.0, 12.8e6, 30e3, damping=fdspec.ModalDamping(0.05))
    motion = noise()
    exact, other = fdspec.simulate(building, motion), fdspec.simulate(building, motion, method=method)
    assert exact.transitions > 8
    assert other.peak_displacement.item() == pytest.approx(exact.peak_displacement.item(), rel=within)
    assert other.dissipated_energy.item() == pytest.approx(exact.dissipated_energy.item(), rel=2 * within)


@pytest.mark.parametrize("name", ["newmark", "state-space", "bilinear", "rigid-plastic"])
def test_free_vibration_from_an_initial_state(name: str) -> None:
    still = fdspec.GroundMotion(np.zeros(2), 0.01)
    building = two_storeys(brace_mass=0.0 if name == "bilinear" else 300.0)
    start = {"initial_displacement": [0.001, 0.0015], "initial_velocity": [0.2, -0.1], "free_vibration": 2.0}
    other = fdspec.simulate(building, still, method=QUICK[name], **start)
    assert other.displacement[0].values.tolist() == [0.001, 0.0015]
    assert other.transitions > 0
    if name == "rigid-plastic":
        return
    exact = fdspec.simulate(building, still, **start)
    scale = float(np.abs(exact.displacement).max())
    np.testing.assert_allclose(other.displacement, exact.displacement, rtol=0.0, atol=5e-3 * scale)


@pytest.mark.parametrize("name", ["newmark", "dimova", "state-space", "bilinear", "bouc-wen"])
def test_a_storey_without_a_brace(name: str) -> None:
    building = fdspec.Building(
        [20e3, 18e3],
        [9e6, 7e6],
        [300.0, 0.0],
        [25e6, 0.0],
        [50e3, 0.0],
        damping=fdspec.ModalDamping(0.03),
    )
    motion = noise()
    exact, other = fdspec.simulate(building, motion), fdspec.simulate(building, motion, method=QUICK[name])
    assert other.peak_drift[1].item() == pytest.approx(exact.peak_drift[1].item(), rel=0.2)
    assert (other.transition_storey == 1).all()
    assert not other.friction_force[:, 1].any()


def test_the_published_iteration_says_when_it_does_not_settle() -> None:
    """beta (omega dt)^2 >= 1 for the brace: the fixed point of (38) runs away."""
    frame = fdspec.Building.single_storey(period=0.1, stiffness_ratio=10.0, slip_force=20e3)
    with pytest.raises(IntegrationError, match="iteration_not_converged"):
        fdspec.simulate(frame, noise(), method=Newmark(dt=2e-3))
    cube = fdspec.sweep(
        noise(), method=Newmark(dt=2e-3), period=[0.1], stiffness_ratio=[10.0], pretension=[40e3]
    )
    assert cube.status.item() == 3


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: Newmark(dt=0.0), "dt of method 'newmark' must be a positive number in s, got 0.0"),
        (lambda: Newmark(beta=0.3), "beta of method 'newmark' must be 1/4 or 1/6, got 0.3"),
        (lambda: Newmark(tolerance=-1.0), "tolerance of method 'newmark' must be a positive number"),
        (lambda: Dimova(velocity_band=math.nan), "velocity_band of method 'dimova'"),
        (lambda: BoucWen(exponent=0.5), "exponent of method 'bouc-wen' must be at least 1, got 0.5"),
        (lambda: BoucWen(beta=1.5), "beta of method 'bouc-wen' must be at most 1, got 1.5"),
        (lambda: EquivalentLinear(share=2.0), "share of method 'equivalent-linear' must be at most 1"),
        (lambda: fdspec.simulate(two_storeys(), noise(), method="euler"), "method must be one of exact, new"),
        (
            lambda: fdspec.simulate(two_storeys(brace_mass=0.0), noise(), method="newmark"),
            "brace_mass must be positive for method 'newmark' where the damper may slip",
        ),
        (
            lambda: fdspec.simulate(two_storeys(brace_mass=0.0), noise(), method="state-space"),
            "for massless braces use 'bilinear'",
        ),
        (
            lambda: fdspec.simulate(two_storeys(brace_mass=1.0), noise(), method=StateSpace(dt=1e-3)),
            "must be shorter than half a period of the braces",
        ),
        (
            lambda: fdspec.simulate(two_storeys(), noise(), method=Bilinear(dt=1e-8)),
            "at most 10000000 are kept",
        ),
    ],
)
def test_errors_name_what_is_wrong(make: object, complaint: str) -> None:
    with pytest.raises(InvalidInput, match=complaint):
        make()  # type: ignore[operator]


def test_elements_without_a_dashpot_refuse_one() -> None:
    frame = fdspec.Building.single_storey(0.5, 4.0, 50e3, brace_damping_ratio=0.1)
    for name in ("bilinear", "bouc-wen", "equivalent-linear"):
        with pytest.raises(InvalidInput, match=f"brace_damping must be 0 for method '{name}'"):
            fdspec.simulate(frame, noise(), method=name)


def test_strain_outputs_are_the_exact_engines_alone() -> None:
    with pytest.raises(InvalidInput, match="need method 'exact', got 'newmark'"):
        fdspec.sweep(
            noise(),
            method="newmark",
            period=0.5,
            stiffness_ratio=4,
            pretension=50e3,
            outputs=["strain_energy_area"],
        )
