"""What a choice was made for: structure, dampers, criterion and ground motions, as rows for people."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fdspec.records import catalogue
from fdspec.report.findings import index_name, parameters
from fdspec.report.numbers import listed, percent, rounded
from fdspec.report.targets import SHOWN, has_limits
from fdspec.units import G

if TYPE_CHECKING:
    import xarray as xr

UNKNOWN: Final = "not stated"


def first_mode(mass: Any, stiffness: Any, damping: Any) -> tuple[float, float]:
    """Return period, s, and damping ratio of the first mode: masses (N,), matrices (N, N)."""
    root = 1.0 / np.sqrt(np.asarray(mass, dtype=np.float64))
    values, vectors = np.linalg.eigh(np.asarray(stiffness) * np.outer(root, root))
    omega, shape = float(np.sqrt(values[0])), vectors[:, 0] * root
    ratio = float(shape @ np.asarray(damping) @ shape) / (2.0 * omega)
    return 2.0 * np.pi / omega, ratio


def structure(choice: xr.Dataset) -> str:
    """Return the structure in one sentence: storeys, period, damping ratio, stiffness ratio."""
    asked = parameters(choice)
    period, ratio = first_mode(asked["floor_mass"], asked["stiffness_matrix"], asked["damping_matrix"])
    storeys = len(asked["floor_mass"])
    what = "single-storey frame of" if storeys == 1 else f"frame of {storeys} storeys, first"
    told = f"{what} period {period:.3g} s without braces, damping ratio {ratio:.3g}"
    if storeys == 1:
        told += f", stiffness ratio {asked['brace_stiffness'][0] / asked['stiffness_matrix'][0][0]:.3g}"
    return told


def input_rows(choice: xr.Dataset) -> list[tuple[str, str]]:
    """Return (quantity, value with its unit) of all that the answer depends on, ground motions apart."""
    asked = parameters(choice)
    period, ratio = first_mode(asked["floor_mass"], asked["stiffness_matrix"], asked["damping_matrix"])
    mass, brace = np.array(asked["floor_mass"]), np.array(asked["brace_stiffness"])
    stiffness = storey_stiffness(np.array(asked["stiffness_matrix"]))
    many = mass.size > 1
    first = "First period" if many else "Period"
    kinetic = listed(np.array(asked["kinetic_ratio"]), rounded)
    rows = [
        ("Storeys", f"{mass.size}"),
        ("Floor mass", f"{listed(mass / 1e3, lambda value: f'{value:.4g}')} t"),
        (f"{first} without braces", f"{period:.3g} s"),
        ("Damping ratio" + (" of the first mode" if many else ""), f"{ratio:.3g}"),
    ]
    if stiffness is not None:
        rows += [
            ("Frame stiffness", f"{listed(stiffness / 1e6, rounded)} MN/m"),
            ("Stiffness ratio, brace over frame", listed(brace / stiffness, rounded)),
        ]
    rows += [
        ("Brace stiffness", f"{listed(brace / 1e6, rounded)} MN/m"),
        ("Brace mass", f"{listed(np.array(asked['brace_mass']), lambda value: f'{value:.4g}')} kg"),
        ("Friction coefficient", f"{asked['friction_coefficient']:.3g}"),
        ("Kinetic over static friction", kinetic),
        ("Normal force over pretension", f"{asked['normal_force_factor']:.3g}"),
        *_criterion(choice),
        ("Bounds of friction", f"{asked['lower']:.3g} and {asked['upper']:.3g} times the nominal"),
    ]
    if many:
        rows.append(("Slip forces over the height", asked["distribution"]))
    return rows


def _criterion(choice: xr.Dataset) -> list[tuple[str, str]]:
    """What the recommendation is made by."""
    asked = parameters(choice)
    if not has_limits(choice):
        near = f"within {percent(asked['band'])} of the least"
        return [("What is made least", index_name(choice)), ("Nearly as good", near)]
    levels = ", ".join(f"{level:g}" for level in asked["levels"])
    limits = [
        (f"Limit of {SHOWN[name].words}", SHOWN[name].written(limit))
        for name, limit in asked["limits"].items()
    ]
    least = ("What is made least", "slip force within all limits")
    return [least, *limits, ("Levels of the ground motions", levels), ("Index", index_name(choice))]


def storey_stiffness(matrix: Any) -> Any:
    """Return the stiffness of each storey (N,) of a shear frame's matrix (N, N), None of another frame's."""
    above = np.append(-np.diag(matrix, 1), 0.0)
    values = np.diag(matrix) - above
    shear = np.diag(values + above) - np.diag(above[:-1], 1) - np.diag(above[:-1], -1)
    near = 1e-9 * float(np.abs(matrix).max())
    whole = np.allclose(shear, matrix, rtol=0.0, atol=near)
    return values if whole and np.allclose(values[1:], above[:-1], rtol=0.0, atol=near) else None


MOTION_HEAD: Final = ("record", "event", "station", "magnitude", "PGA, g", "factor", "length, s")


def motion_rows(choice: xr.Dataset) -> list[list[str]]:
    """Return a row a record: event and date, station and component, magnitude, PGA, factor, length."""
    known = {entry.name: entry for entry in catalogue()}
    rows = []
    for name in choice["record"].values:
        at = choice.sel(record=name)
        entry = known.get(str(name))
        station = " ".join(filter(None, (_told(at, "station"), _told(at, "component"))))
        rows.append(
            [
                str(name),
                _told(at, "event") or UNKNOWN,
                station or UNKNOWN,
                UNKNOWN if entry is None else f"{entry.magnitude:g}",
                f"{at['pga'].item() / G:.3f}",
                f"{at['scale_factor'].item():.3f}",
                f"{at['duration'].item():.1f}" if "duration" in at.coords else UNKNOWN,
            ]
        )
    return rows


def _told(at: xr.Dataset, name: str) -> str:
    return str(at[name].item()).strip() if name in at.coords else ""
