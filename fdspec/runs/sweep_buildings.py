"""Buildings and ground motions -> the cube of N-storey buildings."""

from __future__ import annotations

import logging
import math
import os
import time
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.model.building_grid import BuildingGrid, Buildings
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After, zero_or_positive
from fdspec.runs.bounds import SWEEP_HOURS, refuse_large, refuse_long
from fdspec.runs.building_cube import (
    CELLS,
    LIMITS,
    axes_of,
    bytes_of,
    ends,
    is_alone,
    known_outputs,
    parameters_of,
    registry_for,
    rows_of,
    usual_outputs,
    variables_of,
    with_devices,
)
from fdspec.runs.building_histories import run_histories, warm
from fdspec.runs.cost import seconds_of_history
from fdspec.runs.cube import assemble, chosen, named
from fdspec.runs.plausible import warn_of_units
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.task import Task, cores, plan, require_per_task
from fdspec.scheduling.threads import fan_out

if TYPE_CHECKING:
    from fdspec.scheduling.task import Client

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LONG: Final = 60.0
"""s of work above which it is told what a stop would lose."""

log = logging.getLogger(__name__)

SAMPLE: Final = 8
"""Histories that are computed to see what all take."""

WINDOW: Final = 400
"""Samples of the record that they are computed under."""


def sweep_buildings(
    motions: GroundMotion | Sequence[GroundMotion],
    buildings: Buildings,
    *,
    slip_scale: ArrayLike,
    stiffness_scale: ArrayLike,
    intensity: ArrayLike | None = None,
    free_vibration: float = 0.0,
    at_rest: bool = False,
    outputs: Iterable[str] | None = None,
    certify: bool = True,
    workers: int | None = None,
    scheduler: str = "threads",
    cells_per_task: int | None = None,
    client: Client | None = None,
    store: str | os.PathLike[str] | None = None,
    restart: bool = False,
    progress: Shown = False,
) -> xr.Dataset:
    """Compute the cube of buildings: peaks of every storey over record, building and two factors on dampers.

    Each history is integrated exactly, event by event, under a ground acceleration that is linear
    between samples; see `fdspec.simulate` for one of them with its time series.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Named differently; their names become the ``record`` coordinate.
    buildings : Building, sequence of them, or mapping of names to them
        All with the same number of storeys N; the names become the ``building`` coordinate, "1", "2"
        and so on where there are none.
    slip_scale : array_like
        Factors on the slip forces of all dampers, which is on their pretension; strictly increasing.
        0 slides freely, infinity never slips.  A slip force that is 0 or infinite stays so under every
        factor.
    stiffness_scale : array_like
        Factors on the stiffness of all braces, positive, strictly increasing.  A dashpot beside a brace
        goes with the square root: the brace keeps its damping ratio.  The frame's own damping stays.
    intensity : array_like, optional
        Factors on the ground motions, positive, strictly increasing: adds the dim ``intensity`` after
        ``record``.  What is told of the records, ``pga`` among it, stays that of factor 1.
    free_vibration : float, s
        How long each history goes on after its motion's end, the ground at rest; rounded up to whole steps of
        the motion.
    at_rest : bool
        Go on from there until the energy left can make no damper slip, and give ``residual_displacement``,
        ``residual_drift`` and ``residual_slip`` where the building comes to rest; twice the work.
    outputs : iterable of str, optional
        Variables of the cube; unless given, all but those of `ON_REQUEST`: ``peak_slip``,
        ``peak_brace_force``, ``peak_column_shear``.  Histories that run side by side have no room for them.
        With one of them, with free_vibration, at_rest or devices, each history is integrated by itself, which
        takes longer and moves the other results by rounding; unless outputs are given, they are there then.
    certify : bool
        Whether to compute ``energy_error``; without it the sweep is faster.
    workers : int, optional
        Threads (or processes); one a core unless given.
    scheduler : str
        A scheduler of dask: "threads", "processes" or "synchronous".
    cells_per_task : int, optional
        Histories of one task; about 0.2 s of work unless given.  No result depends on it.
    client : distributed.Client, optional
        Any cluster of dask.distributed, in place of threads here.
    store : path, optional
        A Zarr store, ``cube.zarr``, into which the workers write block by block what they compute.  When it
        is there, from a sweep that was stopped, only what is missing is computed.
    restart : bool
        Whether a store that is there is removed first.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        Where a building has columns that yield, slots, gravity or links, all cells have the demands on
        these too (`fdspec.variables.device_variables`), and a history may end with the status ``collapsed``.
        Dims (record, building, stiffness_scale, slip_scale) and, for what each storey has of its own,
        storey; variables, units and meanings are those of `fdspec.variables.BUILDING_CUBE`, with intensities
        of `fdspec.variables.INTENSITY_BUILDING_CUBE`.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.
    StoreError
        For a store that holds another sweep, with what differs, or that cannot be written.

    Notes
    -----
    Without a store, results are held in memory until the end: a sweep that is stopped loses them.  Where that
    is more than a minute of work a warning is logged.

    The equations of motion are the study's (19) to (25).  Of the limits that ride along,
    ``elastic_acceleration`` is the frame without braces.  A damper that slides freely is another
    building: the braces stand on the floors and swing there, and ``slip_scale`` 0 computes it.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.from_periods([40e3, 40e3], 0.5, 0.3, slip_force=50e3, brace_mass=50.0)
    >>> motion = fdspec.GroundMotion([0.0, 3.0, -2.0, 0.0], 0.1, name="mine")
    >>> cube = fdspec.sweep_buildings(motion, {"office": frame}, slip_scale=[0.5, 1], stiffness_scale=1)
    >>> dict(cube.peak_drift.sizes)
    {'record': 1, 'building': 1, 'stiffness_scale': 1, 'slip_scale': 2, 'storey': 2}
    """
    grid = BuildingGrid(buildings, stiffness_scale, slip_scale, intensity)
    after = After(zero_or_positive("free_vibration", free_vibration), at_rest)
    if at_rest and with_devices(grid):
        raise InvalidInput("at_rest is for dampers alone, not for buildings with devices")
    motions = named(motions)
    require_per_task(cells_per_task, "cells_per_task")
    usual = usual_outputs(grid, after)
    wanted = chosen(usual if outputs is None else outputs, known_outputs(grid), certify)
    each = ends(grid)[-1 if set(LIMITS) & set(wanted) else 0]
    histories = grid.intensities.size * each
    refuse_endless(motions, grid, wanted, store)
    seconds = _seconds(motions, grid, histories)
    warn_of_units(
        motions,
        period=[building.bare_periods[0] for building in grid.buildings],
        slip_force=grid.slip_force,
        floor_mass=[building.floor_mass.min() for building in grid.buildings],
    )
    fan = partial(
        fan_out,
        motions=motions,
        each=1,
        warm=partial(warm, grid),
        workers=workers,
        scheduler=scheduler,
        client=client,
        progress=progress,
    )
    cube_of = partial(
        assemble,
        axes=axes_of(grid),
        registry=registry_for(grid),
        motions=motions,
        title="Peak response of buildings with friction dampers",
        parameters={**parameters_of(grid, wanted, certify), **after.parameters},
        command="fdspec.sweep_buildings",
    )
    if store is not None:
        from fdspec.runs.resumable import sweep_into

        return sweep_into(
            store,
            cube_of({}),
            [registry_for(grid)[name] for name in wanted],
            partial(_block, grid, certify, wanted, after),
            fan,
            items=CELLS,
            seconds=sum(seconds),
            items_per_task=cells_per_task,
            restart=restart,
        )
    tasks = plan(histories, seconds, cells_per_task, "cells_per_task")
    if (expected := sum(seconds) / cores()) > LONG:
        log.warning(
            "about %.0f min of work are held in memory until the end, and lost when it is stopped; with a "
            "store, store='cube.zarr', what is finished is kept",
            expected / 60.0,
        )
    run = partial(run_histories, grid, certify, each, after=after, alone=is_alone(grid, wanted, after))
    parts = fan(run, tasks=tasks)
    return cube_of(variables_of(grid, rows_of(grid), len(motions), tasks, parts, wanted))


def refuse_endless(
    motions: Sequence[GroundMotion],
    grid: BuildingGrid,
    outputs: Iterable[str],
    store: str | os.PathLike[str] | None,
) -> None:
    """Raise InvalidInput for a sweep that this machine cannot hold or that takes longer than the limit."""
    outputs = tuple(outputs)
    histories = grid.intensities.size * ends(grid)[-1 if set(LIMITS) & set(outputs) else 0]
    what = f"a sweep of {len(motions) * histories:.4g} histories"
    size = float(sum(bytes_of(motions, grid, outputs).values()))
    if store is None:
        refuse_large(2.0 * size, what)  # once as the tasks return it, once as the cube
    elif not Path(store).exists():
        refuse_large(size, what, folder=Path(store).absolute().parent)
    refuse_long(sum(_seconds(motions, grid, histories)), SWEEP_HOURS, what)


def measured(
    motions: Sequence[GroundMotion], grid: BuildingGrid, certify: bool = True, outputs: Iterable[str] = ()
) -> float:
    """Core seconds that a sweep takes, from a few of its histories, computed here.

    They are taken around the strongest shaking, so that it is rather too much.
    """
    warm(grid)
    longest = max(motions, key=lambda motion: motion.n)
    peak = int(np.argmax(np.abs(longest.acceleration)))
    first = max(0, min(peak - WINDOW // 4, longest.n - WINDOW))
    window = GroundMotion(longest.acceleration[first : first + WINDOW], longest.dt, name="window")
    cells = ends(grid)[0]
    count = min(cells, SAMPLE)
    chosen_cells = ((np.arange(count) + 0.5) * cells / count).astype(np.int64)
    alone = is_alone(grid, tuple(outputs), NOTHING)
    run = partial(run_histories, grid, certify, ends(grid)[-1], motion=window, alone=alone)
    run(chosen_cells[:1])  # loads the kernels
    started = time.thread_time()
    run(chosen_cells)
    each = (time.thread_time() - started) / (count * window.n)
    return each * sum(motion.n for motion in motions) * grid.intensities.size * ends(grid)[-1]


def rough_seconds(motions: Sequence[GroundMotion], grid: BuildingGrid) -> float:
    """Core time of all histories, s, roughly."""
    return sum(_seconds(motions, grid, grid.intensities.size * ends(grid)[-1]))


def _seconds(motions: Sequence[GroundMotion], grid: BuildingGrid, histories: int) -> list[float]:
    """Core time of so many histories under each motion, s, roughly."""
    return [
        histories
        * max(seconds_of_history(building, motion.dt, motion.n) for building in grid.buildings)
        * math.sqrt(max(1.0, float(grid.stiffness_scale.mean())))
        for motion in motions
    ]


def _block(
    grid: BuildingGrid,
    certify: bool,
    wanted: Sequence[str],
    after: After,
    cells: IntArray,
    motion: GroundMotion,
) -> dict[str, NDArray[np.generic]]:
    """Compute the part of the cube that these cells, a block of all three axes, make up."""
    b, k, s = map(np.unique, np.unravel_index(cells, grid.shape))
    # What lacks an axis is computed with the block that comes first along it.
    first = {"building": True, "stiffness_scale": k[0] == 0, "slip_scale": s[0] == 0}
    registry = registry_for(grid)
    mine = [name for name in wanted if all(first[dim] for dim in CELLS if dim not in registry[name].dims)]
    items = [cells]
    if set(LIMITS) & set(mine):
        end, braced, _ = ends(grid)
        items += [end + (b[:, np.newaxis] * grid.shape[1] + k).ravel(), braced + b]
    each = ends(grid)[-1]
    levels = each * np.arange(grid.intensities.size)[:, np.newaxis]
    numbers = (levels + np.concatenate(items)).ravel()
    task = Task(0, np.arange(numbers.size))
    done = run_histories(grid, certify, each, numbers, motion, after, is_alone(grid, wanted, after))
    return variables_of(grid.part(b, k, s), rows_of(grid), 1, [task], [done], mine)
