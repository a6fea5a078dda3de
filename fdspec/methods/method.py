"""What every method has: a name, parameters that are checked when it is made, and `integrate`."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


@dataclass(frozen=True, kw_only=True)
class Method(ABC):
    """One way of computing the response of a building with friction dampers."""

    name: ClassVar[str]
    """What ``method=`` takes."""

    @abstractmethod
    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history; start: displacement and velocity of floors and braces, (2, 2, N), m, m/s."""

    def model(self, building: Building) -> Building:
        """Return the building that the method solves, where it is another than the one given."""
        return building

    @property
    def parameters(self) -> dict[str, object]:
        """Name and parameters: for a file that says where it comes from."""
        return {"method": self.name} | {
            f"method_{field.name}": getattr(self, field.name) for field in fields(self)
        }


def positive(method: Method, name: str, unit: str = "") -> None:
    """Raise InvalidInput unless this parameter is a positive number."""
    value = getattr(method, name)
    good = isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value < math.inf
    if not good:
        suffix = f" in {unit}" if unit else ""
        raise InvalidInput(
            f"{name} of method {method.name!r} must be a positive number{suffix}, got {value!r}"
        )


def parts_of(motion: GroundMotion, dt: float) -> int:
    """Steps in each interval of the record, none longer than dt."""
    return max(1, math.ceil(motion.dt / dt - 1e-9))


def intervals(motion: GroundMotion, span: Span) -> FloatArray:
    """Ground acceleration at both ends of each interval of the record's dt, (m, 2), m/s2; at last at rest."""
    shaken = np.column_stack([motion.acceleration[:-1], motion.acceleration[1:]])
    return np.vstack([shaken, np.zeros((span.free_steps, 2))])


def without_brace_mass(building: Building) -> Building:
    """Return the building with massless braces."""
    return Building(
        building.floor_mass,
        building.storey_stiffness,
        np.zeros(building.n_storeys),
        building.brace_stiffness,
        building.slip_force,
        building.kinetic_slip_force,
        building.damping,
        building.brace_damping,
    )


def no_brace_damping(method: Method, building: Building) -> None:
    """Raise InvalidInput where a brace has a dashpot, which the method's element has no place for."""
    if building.brace_damping.any():
        raise InvalidInput(
            f"brace_damping must be 0 for method {method.name!r}, got {building.brace_damping.max():g} N s/m"
        )
