"""How many steps a history would take: told before it starts, for one that would never end is refused.

Segments of motion are at most a radian of whatever moves in them.  A brace of next to no mass, a weak dashpot
under a massless brace or a record step of many periods make so many of them that a history takes days.
"""

from __future__ import annotations

import os
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.engines.frame_rates import rates_of
from fdspec.errors import InvalidInput
from fdspec.kernels.devices import layout as row
from fdspec.kernels.frame.results import RADIANS as FRAME_RADIANS
from fdspec.kernels.storey.constants import RADIANS
from fdspec.model.building import Building

FloatArray = NDArray[np.float64]

MAX_STEPS: Final = 1e9
"""Steps of one history above which it is refused: minutes of one core."""

VARIABLE: Final = "FDSPEC_MAX_STEPS"
"""Name of the environment variable that sets another limit."""


def fastest_rate(mass: ArrayLike, damping: ArrayLike, stiffness: ArrayLike) -> FloatArray:
    """Return the rate, 1/s, at which derivatives of an oscillator may grow: g/2 + sqrt(g^2/4 + omega^2).

    Without mass that is stiffness over damping, and 0 without damping: such a brace follows at once.
    """
    m, c, k = np.broadcast_arrays(*(np.asarray(x, np.float64) for x in (mass, damping, stiffness)))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        half = 0.5 * c / m
        massive = half + np.sqrt(half * half + k / m)
        massless = np.where(c > 0.0, k / c, 0.0)
    return np.asarray(np.where(m > 0.0, massive, massless))


def steps_of_storeys(storeys: ArrayLike, dt: float, record_steps: int) -> FloatArray:
    """Return the steps of histories of single storeys, as many as if their dampers slipped all the time.

    storeys: rows of floor mass, damping, stiffness, brace mass, damping, stiffness and slip force (..., 7 or
    more), SI units.  dt: record step, s; record_steps: how many there are, those of free vibration included.
    One that never slips (an infinite slip force) takes the steps of floor and brace as one.
    """
    m, c, k, md, cd, kd, force = np.moveaxis(np.asarray(storeys, np.float64)[..., :7], -1, 0)
    floor = fastest_rate(m, c, k)
    parts = parts_of_storeys(storeys, dt)
    sliding = np.maximum(floor, fastest_rate(md, cd, kd))
    segments = np.maximum(1.0, np.ceil(sliding * dt / parts / RADIANS))
    return np.asarray(record_steps * parts * np.where(np.isinf(force), 1.0, segments))


def parts_of_storeys(storeys: ArrayLike, dt: float) -> FloatArray:
    """Return the steps of single storeys (..., 6 or more) in each record step of dt, s: the kernels' own."""
    m, c, k, md, cd, kd = np.moveaxis(np.asarray(storeys, np.float64)[..., :6], -1, 0)
    fastest = np.maximum(fastest_rate(m + md, c + cd, k + kd), fastest_rate(m, c, k))
    return np.asarray(np.maximum(1.0, np.ceil(fastest * dt / RADIANS)))


def steps_of_building(building: Building, dt: float) -> float:
    """Return the most steps that a history takes in each record step of dt, s, changes not counted."""
    if building.n_storeys == 1 and not building.has_devices:
        return float(steps_of_storeys(np.array(building.storey), dt, 1))
    fastest = float(rates_of(building.frame).max())
    if building.has_devices:
        fastest = max(fastest, float(_link_rates(building).max(initial=0.0)))
    return max(1.0, float(np.ceil(fastest * dt / FRAME_RADIANS)))


def most_steps() -> float:
    """Return the limit: ``FDSPEC_MAX_STEPS`` where it is set, else `MAX_STEPS`."""
    text = os.environ.get(VARIABLE, "")
    if not text:
        return MAX_STEPS
    try:
        limit = float(text)
    except ValueError:
        limit = 0.0
    if not limit > 0.0:
        raise InvalidInput(f"{VARIABLE} must be a positive number of steps, got {text!r}")
    return limit


def refuse_endless(building: Building, dt: float, record_steps: int, limit: float | None = None) -> None:
    """Raise InvalidInput for a history that would take more steps than the limit, `most_steps` unless given.

    dt: record step, s; record_steps: how many there are, those of free vibration included.  For several
    storeys the rates are bounds, as in their engine.
    """
    most = most_steps() if limit is None else limit
    m, md, kd, cd = building.floor_mass, building.brace_mass, building.brace_stiffness, building.brace_damping
    slips = np.isfinite(building.slip_force)
    brace = np.where(slips, fastest_rate(md, cd, kd), 0.0)
    links = _link_rates(building) if building.has_devices else np.zeros(0)
    steps = record_steps * steps_of_building(building, dt)
    if steps <= most:
        return
    i = int(np.argmax(brace))
    frame = float(_frame_rate(building))
    if record_steps > most:
        cause = f"{record_steps:.3g} record steps of dt {dt:g} s, free_vibration included"
    elif links.max(initial=0.0) > max(frame, brace[i]):
        cause = f"slots, springs and masses of links (up to {links.max():.3g} rad/s), with dt {dt:g} s,"
    elif brace[i] > frame:
        cause = (
            f"brace_mass {md[i]:g} kg, brace_damping {cd[i]:g} N s/m and brace_stiffness {kd[i]:g} N/m "
            f"(storey {i + 1}, {brace[i]:.3g} rad/s), with dt {dt:g} s,"
        )
    else:
        cause = f"floors of {m.min():g} kg and more (up to {frame:.3g} rad/s), with dt {dt:g} s,"
    raise InvalidInput(
        f"{cause} would take about {steps:.2g} steps; at most {most:.3g} are taken, "
        f"set max_steps or {VARIABLE} to allow more"
    )


def _link_rates(building: Building) -> FloatArray:
    """Bounds on the rates, 1/s, of what moves at each link of a building with devices, bolts in bearing."""
    frame = building.device_frame
    bearing = np.where(np.isfinite(frame.links[row.SLOT_LENGTH]), frame.links[row.SLOT_STIFFNESS], 0.0)
    stiffness = frame.links[row.STIFFNESS] + frame.links[row.RECENTRING] + bearing
    ends = np.minimum(frame.mass[frame.places[row.UPPER]], frame.mass[frame.places[row.LOWER]])
    mass = np.where(frame.links[row.MASS] > 0.0, frame.links[row.MASS], ends)
    lag = fastest_rate(0.0, frame.links[row.DAMPING], np.where(frame.links[row.MASS] > 0.0, 0.0, stiffness))
    return np.maximum(fastest_rate(mass, frame.links[row.DAMPING], 2.0 * stiffness), lag)


def _frame_rate(building: Building) -> FloatArray:
    """Bound on the rate, 1/s, of floors and braces moving as one: by the largest sums of rows."""
    braces = building.brace_stiffness + np.append(building.brace_stiffness[1:], 0.0)
    dashpots = building.brace_damping + np.append(building.brace_damping[1:], 0.0)
    stiffness = (np.abs(building.stiffness_matrix).sum(axis=1) + 2.0 * braces) / building.floor_mass
    damping = (np.abs(building.damping_matrix).sum(axis=1) + 2.0 * dashpots) / building.floor_mass
    return fastest_rate(1.0, damping.max(), stiffness.max())
