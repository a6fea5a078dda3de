"""Floor response spectra: what an oscillator on a floor of a building feels, exactly."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.damping import DampingMatrix
from fdspec.model.grid import axis
from fdspec.model.motion import GroundMotion
from fdspec.model.number_check import not_negative_number
from fdspec.runs.cube import assemble, named
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.task import plan
from fdspec.scheduling.threads import fan_out
from fdspec.variables import CUBE, Registry, Variable, motion_variables, registry_of

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LIGHT: Final = 1e-14
"""Mass of the oscillator over its floor's.

In tune with a mode it changes the response by about LIGHT / (4 zeta zeta_mode): 1e-12 where both
ratios are 0.05.
"""

SECONDS_PER_SAMPLE: Final = 2e-6
"""Core time of one history for each sample and storey to the power 1.5, roughly; for plans alone."""

_DIMS: Final = ("record", "storey", "damping_ratio", "period")

FLOOR_SPECTRA: Final[Registry] = registry_of(
    motion_variables(("record",)),
    (
        Variable("storey", ("storey",), "1", "storey of the floor, counted from 1 at the ground", "int64"),
        Variable("damping_ratio", ("damping_ratio",), "1", "damping ratio of the oscillator"),
        Variable(
            "period", ("period",), "s", "undamped natural period of the oscillator; 0 rides on the floor"
        ),
        Variable(
            "floor_acceleration",
            _DIMS,
            "m/s^2",
            "largest absolute acceleration of an oscillator on the floor",
        ),
        Variable("status", _DIMS, "", "how the integration ended", "int8", CUBE["status"].attributes),
    ),
)
"""The variables of floor spectra."""


def floor_spectra(
    building: Building,
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    period: ArrayLike,
    damping_ratio: ArrayLike = 0.05,
    workers: int | None = None,
    progress: Shown = False,
) -> xr.Dataset:
    """Compute the response spectra of the motions of a building's floors.

    Parameters
    ----------
    building : Building
        Without yielding columns, slots, gravity and links.
    motions : GroundMotion or sequence of them
        Named differently.
    period : array_like, s
        Undamped natural periods of the oscillators, rising; 0 is the floor itself.
    damping_ratio : float or array_like
        Of the oscillators, from 0 up.
    workers : int, optional
        Threads; one a core unless given.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        Over (record, storey, damping_ratio, period): ``floor_acceleration``, m/s2, the largest absolute
        acceleration of the oscillator in its continuous motion until the record's end, and ``status``.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Notes
    -----
    The oscillator is one more mass of the building, so light (`LIGHT`) that the building does not feel it:
    the same engine integrates both, event by event, and no step or interpolation of the floor's motion comes
    between.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=20e3)
    >>> motion = fdspec.GroundMotion([0.0, 3.0, -2.0, 0.0], 0.1, name="mine")
    >>> spectra = fdspec.floor_spectra(frame, motion, period=[0.0, 0.2, 0.5])
    >>> dict(spectra.floor_acceleration.sizes)
    {'record': 1, 'storey': 1, 'damping_ratio': 1, 'period': 3}
    """
    if not isinstance(building, Building):
        raise InvalidInput(f"building must be a Building, got {type(building).__name__}")
    if building.has_devices:
        raise InvalidInput(
            "floor spectra are of buildings without yielding columns, slots, gravity and links"
        )
    given = named(motions)
    try:
        periods = axis(period, zero=True)
    except ValueError as error:
        raise InvalidInput(f"period: {error}") from None
    ratios = np.atleast_1d(np.asarray(damping_ratio, dtype=float))
    for ratio in ratios.tolist():
        not_negative_number("damping_ratio", ratio)
    shape = (building.n_storeys, ratios.size, periods.size)
    count = int(np.prod(shape))
    each = count * SECONDS_PER_SAMPLE * building.n_storeys**1.5
    tasks = plan(count, [each * motion.n for motion in given], None, "oscillators")
    parts = fan_out(
        partial(_run, building, ratios, periods),
        given,
        tasks,
        each=1,
        warm=_warm,
        workers=workers,
        scheduler="threads",
        progress=progress,
    )
    table = np.empty((2, len(given), count))
    for (record, items), part in zip(tasks, parts, strict=True):
        table[:, record, items] = part
    acceleration, status = table.reshape(2, len(given), *shape)
    return assemble(
        {"floor_acceleration": acceleration, "status": status.astype(np.int8)},
        {"storey": np.arange(1, shape[0] + 1), "damping_ratio": ratios, "period": periods},
        FLOOR_SPECTRA,
        given,
        title="Floor response spectra of a building with friction dampers",
        parameters={**building.parameters, "period": periods, "damping_ratio_of_oscillators": ratios},
        command="fdspec.floor_spectra",
    )


def with_oscillator(building: Building, storey: int, period: float, damping_ratio: float) -> Building:
    """Return the building with one more mass, the last, on a spring and a dashpot on a floor.

    storey: of the floor, counted from 0.
    """
    size = building.n_storeys
    mass = LIGHT * float(building.floor_mass[storey])
    omega = 2.0 * np.pi / period
    between = np.zeros(size + 1)
    between[storey], between[size] = -1.0, 1.0
    joined = np.outer(between, between)
    stiffness, damping = np.zeros((size + 1, size + 1)), np.zeros((size + 1, size + 1))
    stiffness[:size, :size], damping[:size, :size] = building.stiffness_matrix, building.damping_matrix

    def longer(values: FloatArray) -> FloatArray:
        return np.append(values, 0.0)

    return Building(
        np.append(building.floor_mass, mass),
        stiffness + mass * omega**2 * joined,
        longer(building.brace_mass),
        longer(building.brace_stiffness),
        longer(building.slip_force),
        longer(building.kinetic_slip_force),
        DampingMatrix(damping + 2.0 * damping_ratio * omega * mass * joined),
        longer(building.brace_damping),
    )


def _warm() -> None:
    import fdspec.engines.many_storeys  # noqa: F401


def _run(
    building: Building, ratios: FloatArray, periods: FloatArray, items: IntArray, motion: GroundMotion
) -> FloatArray:
    """Integrate some of the oscillators: peak acceleration and status, (2, items)."""
    from fdspec.engines.many_storeys import peaks_of
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTALS

    shape = (building.n_storeys, ratios.size, periods.size)
    row = STOREY_RESULTS.index("peak_acceleration")
    found = np.empty((2, items.size))
    for column, item in enumerate(items.tolist()):
        storey, ratio, period = (int(k) for k in np.unravel_index(item, shape))
        rides = periods[period] == 0.0
        one = building if rides else with_oscillator(building, storey, periods[period], ratios[ratio])
        by_storey, totals = peaks_of(one.frame, motion, certify=False)
        found[:, column] = by_storey[row, storey if rides else -1], totals[TOTALS.index("status")]
    return found
