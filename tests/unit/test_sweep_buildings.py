"""The cube of buildings: each cell is its history, one storey is the other sweep, no split moves a bit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import xarray as xr

import fdspec
from fdspec.errors import InvalidInput
from fdspec.runs.building_cube import ON_REQUEST, OUTPUTS

AXES: dict[str, Any] = {"slip_scale": [0.0, 0.3, 1.0, np.inf], "stiffness_scale": [0.5, 1.0, 3.0]}
COUNTED = ("status", "transitions", "storey_transitions")
OVER_TIME = ("slip_travel", "storey_friction_energy", "input_energy")
"""Variables of a history that end with what a cube holds."""


def record(name: str, seed: int = 1, samples: int = 120) -> fdspec.GroundMotion:
    rng = np.random.default_rng(seed)
    shake = np.convolve(rng.standard_normal(samples), np.ones(5) / 5.0, mode="same")
    return fdspec.GroundMotion(4.0 * shake / np.abs(shake).max(), 0.02, name=name)


def motions() -> list[fdspec.GroundMotion]:
    return [record("a"), record("b", 2, 60)]


def scaled(building: fdspec.Building, stiffness_scale: float, slip_scale: float) -> fdspec.Building:
    """What a cell stands for, through the front door."""

    def force(given: Sequence[float]) -> list[float]:
        return [f if f == 0.0 or math.isinf(f) else f * slip_scale for f in given]

    return fdspec.Building(
        building.floor_mass,
        building.storey_stiffness,
        building.brace_mass,
        building.brace_stiffness * stiffness_scale,
        force(building.slip_force),
        force(building.kinetic_slip_force),
        building.damping,
        building.brace_damping * math.sqrt(stiffness_scale),
    )


def unlike() -> dict[str, fdspec.Building]:
    """Three storeys: kinetic friction, damped braces; no brace, a free and a locked damper; a full matrix."""
    plain: dict[str, Any] = {
        "floor_mass": [30e3, 25e3, 20e3],
        "storey_stiffness": [40e6, 30e6, 20e6],
        "brace_mass": [50.0, 80.0, 0.0],
        "brace_stiffness": [80e6, 60e6, 50e6],
        "slip_force": [50e3, 40e3, 20e3],
    }
    matrix = fdspec.Building(**plain).stiffness_matrix.copy()
    matrix[0, 2] = matrix[2, 0] = -2e6
    return {
        "plain": fdspec.Building(
            **plain, kinetic_slip_force=[40e3, 40e3, 15e3], brace_damping=[2e3, 0.0, 3e3]
        ),
        "mixed": fdspec.Building(
            [30e3, 25e3, 20e3],
            40e6,
            [0.0, 50.0, 60.0],
            [0.0, 80e6, 70e6],
            [0.0, 0.0, math.inf],
            damping=fdspec.RayleighDamping(0.03, 0.3, 0.1),
        ),
        "matrix": fdspec.Building(**{**plain, "storey_stiffness": matrix}),
    }


@pytest.fixture(scope="module")
def cube() -> xr.Dataset:
    return fdspec.sweep_buildings(motions(), unlike(), **AXES)


def test_every_cell_is_its_history(cube: xr.Dataset) -> None:
    for name, stiffness, slip in itertools.product(unlike(), AXES["stiffness_scale"], AXES["slip_scale"]):
        history = fdspec.simulate(scaled(unlike()[name], stiffness, slip), record("b", 2, 60))
        cell = cube.sel(record="b", building=name, stiffness_scale=stiffness, slip_scale=slip)
        for variable in (v for v in cell.data_vars if v in history):
            told = history[variable].isel(time=-1) if variable in OVER_TIME else history[variable]
            text = f"{variable} of {name}, {stiffness}, {slip}"
            if variable in COUNTED:
                np.testing.assert_array_equal(cell[variable], told, text)
            elif variable == "energy_error":
                assert cell[variable] < 1e-11, text
            else:  # the cube's histories run side by side, in another engine
                atol = 1e-12 * float(np.abs(told).max())
                np.testing.assert_allclose(cell[variable], told, rtol=1e-12, atol=atol, err_msg=text)
        assert cell.slip_force.values.tolist() == history.slip_force.values.tolist()
        assert cell.kinetic_slip_force.values.tolist() == history.kinetic_slip_force.values.tolist()


@pytest.mark.parametrize("name", ["plain", "mixed", "matrix"])
def test_peaks_of_braces_are_those_of_their_courses(cube: xr.Dataset, name: str) -> None:
    """Sampled finely: a trajectory reaches its peak to (omega h)^2 / 8, and never beyond."""
    motion, axes = record("b", 2, 60), {"stiffness_scale": 3.0, "slip_scale": 0.3}
    h = motion.dt / 2000
    history = fdspec.simulate(scaled(unlike()[name], *axes.values()), motion, dt_out=h)
    sampled = np.abs(history.brace_displacement).max("time").values
    peak = cube.peak_brace_displacement.sel(record="b", building=name, **axes).values
    fastest = math.sqrt(3.0 * 80e6 / 50.0)  # rad/s, of a brace that slips
    assert (sampled <= peak * (1.0 + 1e-12)).all()
    np.testing.assert_allclose(sampled, peak, rtol=(fastest * h) ** 2 / 8.0)


def test_it_slips_and_closes_its_energy(cube: xr.Dataset) -> None:
    assert int(np.abs(cube.status).sum()) == 0
    assert (cube.transitions.sel(building="plain", slip_scale=[0.3, 1.0]) > 10).all()
    assert float(np.abs(cube.energy_error).max()) < 1e-9
    np.testing.assert_array_equal(cube.storey_transitions.sum("storey"), cube.transitions)
    np.testing.assert_allclose(cube.storey_friction_energy.sum("storey"), cube.dissipated_energy, rtol=1e-13)
    np.testing.assert_array_equal(cube.peak_base_shear, cube.peak_storey_shear.sel(storey=1))


def test_limits(cube: xr.Dataset) -> None:
    """Dampers held are infinite slip forces, a damper of slip force 0 among them; bare is without braces."""
    for name in ("plain", "matrix"):
        held = cube.peak_acceleration.sel(building=name, slip_scale=np.inf)
        np.testing.assert_array_equal(held, cube.braced_acceleration.sel(building=name))
    mixed = unlike()["mixed"]
    locked = fdspec.Building(
        mixed.floor_mass, 40e6, mixed.brace_mass, mixed.brace_stiffness, [0.0, math.inf, math.inf],
        damping=mixed.damping,
    )  # fmt: skip
    np.testing.assert_allclose(
        cube.braced_acceleration.sel(record="a", building="mixed", stiffness_scale=1.0),
        fdspec.simulate(locked, record("a")).peak_acceleration,
        rtol=1e-12,
    )
    for name, building in unlike().items():
        bare = fdspec.Building(
            building.floor_mass, building.storey_stiffness, 0.0, 0.0, 0.0, damping=building.damping
        )
        np.testing.assert_allclose(
            cube.elastic_acceleration.sel(record="a", building=name),
            fdspec.simulate(bare, record("a")).peak_acceleration,
            rtol=1e-12,
        )


def test_periods(cube: xr.Dataset) -> None:
    for name, building in unlike().items():
        assert float(cube.bare_period.sel(building=name)) == building.bare_periods[0]
        for stiffness in AXES["stiffness_scale"]:
            np.testing.assert_allclose(
                cube.braced_period.sel(building=name, stiffness_scale=stiffness),
                scaled(building, stiffness, 1.0).braced_periods[0],
                rtol=1e-14,
            )


def test_one_storey_is_the_single_storey_sweep() -> None:
    periods, ratios, forces = [0.1, 0.4, 1.0], [0.5, 4.0, 10.0], [0.0, 8e3, 30e3, np.inf]
    common = {"brace_mass": 80.0, "brace_damping_ratio": 0.03}
    frames = {
        str(period): fdspec.Building.single_storey(period, 1.0, 10e3, kinetic_slip_force=8e3, **common)
        for period in periods
    }
    axes = {"slip_scale": np.array(forces) / 10e3, "stiffness_scale": ratios}
    many = fdspec.sweep_buildings(motions(), frames, **axes)
    assert not set(ON_REQUEST) & set(many.data_vars)
    many = many.assign(fdspec.sweep_buildings(motions(), frames, **axes, outputs=ON_REQUEST).data_vars)
    one = fdspec.sweep(
        motions(),
        period=periods,
        stiffness_ratio=ratios,
        pretension=forces,
        friction_coefficient=1.0,
        kinetic_friction_coefficient=0.8,
        **common,
    ).transpose("record", "period", "stiffness_ratio", "pretension")
    many = many.isel(storey=0)
    assert int(one.transitions.sum()) > 1000
    np.testing.assert_array_equal(many.transitions, one.transitions)
    for name in one.data_vars:
        if name not in ("energy_error", "status", "transitions"):
            scale = float(np.abs(one[name]).max())
            np.testing.assert_allclose(
                many[name], one[name], rtol=1e-9, atol=1e-12 * scale, err_msg=str(name)
            )


@pytest.mark.parametrize(
    "how",
    [
        {"workers": 1},
        {"workers": 2, "cells_per_task": 1},
        {"cells_per_task": 7},
        {"scheduler": "synchronous", "cells_per_task": 1000},
    ],
)
def test_no_split_moves_a_bit(cube: xr.Dataset, how: dict[str, Any]) -> None:
    other = fdspec.sweep_buildings(motions(), unlike(), **AXES, **how)
    assert other.drop_attrs(deep=False).identical(cube.drop_attrs(deep=False))


def test_no_neighbour_moves_a_bit(cube: xr.Dataset) -> None:
    alone = fdspec.sweep_buildings(
        motions()[1], {"plain": unlike()["plain"]}, slip_scale=0.3, stiffness_scale=3.0
    )
    among = cube.sel(record=["b"], building=["plain"], slip_scale=[0.3], stiffness_scale=[3.0])
    assert alone.drop_attrs(deep=False).identical(among.drop_attrs(deep=False))


def test_certificate_moves_no_bit(cube: xr.Dataset) -> None:
    plain = fdspec.sweep_buildings(motions(), unlike(), **AXES, certify=False)
    assert set(cube.data_vars) - set(plain.data_vars) == {"energy_error"}
    for name in plain.data_vars:
        np.testing.assert_array_equal(cube[name], plain[name], err_msg=str(name))


@pytest.mark.parametrize("outputs", [["peak_drift"], ["braced_acceleration", "status"], ["transitions"]])
def test_outputs(cube: xr.Dataset, outputs: list[str]) -> None:
    few = fdspec.sweep_buildings(motions(), unlike(), **AXES, outputs=outputs)
    assert set(few.data_vars) == {*outputs, "status"}
    for name in few.data_vars:
        np.testing.assert_array_equal(few[name], cube[name])


def test_all_outputs_and_their_order(cube: xr.Dataset) -> None:
    assert tuple(cube.data_vars) == OUTPUTS
    assert cube.peak_drift.dims == ("record", "building", "stiffness_scale", "slip_scale", "storey")
    assert cube.storey.values.tolist() == [1, 2, 3]


@pytest.mark.parametrize("given", [unlike()["plain"], [unlike()["plain"], unlike()["mixed"]]])
def test_buildings_without_names_are_counted(given: Any) -> None:
    swept = fdspec.sweep_buildings(record("a", samples=5), given, slip_scale=1, stiffness_scale=1)
    assert swept.building.values.tolist() == [str(k + 1) for k in range(swept.sizes["building"])]


def test_provenance_names_all_that_an_answer_depends_on(cube: xr.Dataset) -> None:
    assert "fdspec.sweep_buildings" in cube.attrs["history"]
    for part in ('"mixed": {"floor_mass": [30000.0', '"slip_scale": [0.0, 0.3, 1.0, "inf"]', '"name": "b"'):
        assert part in cube.attrs["parameters"]


def test_there_and_back(cube: xr.Dataset, tmp_path: Any) -> None:
    fdspec.save(cube, tmp_path / "cube.nc")
    assert fdspec.open(tmp_path / "cube.nc").identical(cube)


LOW = fdspec.Building(20e3, 10e6, 50.0, 20e6, 30e3)


@pytest.mark.parametrize(
    ("buildings", "change", "said"),
    [
        ({}, {}, "buildings must hold at least one Building, is empty"),
        ({"": LOW}, {}, "buildings must have names that are text, got ''"),
        ({1: LOW}, {}, "buildings must have names that are text, got 1"),
        ([LOW, 3.0], {}, "building '2' must be a Building, got float"),
        (
            {"low": LOW, **unlike()},
            {},
            (
                "buildings must all have the same number of storeys, but 'low' has 1 and 'plain' has 3: "
                "sweep them apart"
            ),
        ),
        (LOW, {"slip_scale": [1.0, 0.5]}, "slip_scale: values must increase, got 0.5 at index 1 after 1"),
        (LOW, {"slip_scale": -1.0}, "slip_scale: values must be zero or positive, got -1 at index 0"),
        (LOW, {"stiffness_scale": 0}, "stiffness_scale: values must be positive, got 0 at index 0"),
        (LOW, {"stiffness_scale": np.inf}, "stiffness_scale: values must be finite, got inf at index 0"),
        (LOW, {"workers": 0}, "workers must be at least 1, got 0"),
        (LOW, {"cells_per_task": 0}, "cells_per_task must be at least 1, got 0"),
        (
            LOW,
            {"outputs": ["peak_acc"]},
            f"outputs: 'peak_acc' is none of {', '.join((*OUTPUTS, *ON_REQUEST))}",
        ),
    ],
)
def test_mistakes_are_named(buildings: Any, change: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        fdspec.sweep_buildings(record("a"), buildings, **{**AXES, **change})
    assert str(caught.value) == said
