"""A random cell's answer by each of fdspec's ways: a sweep of one point, and one simulated history."""

from __future__ import annotations

from typing import NamedTuple

import xarray as xr
from numpy.typing import ArrayLike

import fdspec
from tests.cells import FLOOR_MASS, Cell

PEAKS = ("peak_acceleration", "peak_displacement", "peak_velocity", "peak_base_shear")


class Answer(NamedTuple):
    """``peaks``: as PEAKS, SI units."""

    peaks: tuple[float, ...]
    transitions: int
    slip_travel: float
    residual_displacement: float
    energy_error: float


def answer_of(dataset: xr.Dataset) -> Answer:
    assert dataset.status.item() == 0
    travel = dataset.slip_travel
    return Answer(
        tuple(float(dataset[name].item()) for name in PEAKS),
        int(dataset.transitions.item()),
        float(travel[-1].item() if "time" in travel.dims else travel.item()),
        float(dataset.residual_displacement.item()),
        float(dataset.energy_error.item()),
    )


def swept(cell: Cell, acceleration: ArrayLike, dt: float) -> Answer:
    """The cell as a cube of one point; friction coefficient 1 makes pretension the slip force."""
    kinetic = cell.kinetic_slip_force / cell.slip_force if cell.slip_force > 0.0 else 1.0
    cube = fdspec.sweep(
        fdspec.GroundMotion(acceleration, dt, name="cell"),
        period=[cell.period],
        pretension=[cell.slip_force],
        stiffness_ratio=[cell.stiffness_ratio],
        floor_mass=FLOOR_MASS,
        brace_mass=cell.brace_mass,
        damping_ratio=cell.damping_ratio,
        friction_coefficient=1.0,
        kinetic_friction_coefficient=kinetic,
        brace_damping_ratio=cell.brace_damping_ratio,
        scheduler="synchronous",
    )
    return answer_of(cube.squeeze())


def building_of(cell: Cell) -> fdspec.Building:
    return fdspec.Building.single_storey(
        period=cell.period,
        stiffness_ratio=cell.stiffness_ratio,
        slip_force=cell.slip_force,
        floor_mass=FLOOR_MASS,
        brace_mass=cell.brace_mass,
        damping_ratio=cell.damping_ratio,
        kinetic_slip_force=cell.kinetic_slip_force,
        brace_damping_ratio=cell.brace_damping_ratio,
    )


def simulated(cell: Cell, acceleration: ArrayLike, dt: float) -> Answer:
    """The cell as one history with its trajectory."""
    motion = fdspec.GroundMotion(acceleration, dt, name="cell")
    return answer_of(fdspec.simulate(building_of(cell), motion))
