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

from fdspec.engines.trajectory import Span
from fdspec.errors import InvalidInput
from fdspec.model.building import Building, Frame
from fdspec.model.building_grid import BuildingGrid, Buildings
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After, zero_or_positive
from fdspec.runs.bounds import SWEEP_HOURS, refuse_large, refuse_long
from fdspec.runs.cost import seconds_of_history
from fdspec.runs.cube import assemble, chosen, named
from fdspec.runs.plausible import warn_of_units
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.task import Task, cores, plan, require_per_task
from fdspec.scheduling.threads import fan_out
from fdspec.variables import BUILDING_CUBE, BUILDING_DIMS, INTENSITY_BUILDING_CUBE, Registry, device_variables

if TYPE_CHECKING:
    from fdspec.scheduling.task import Client

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LONG: Final = 60.0
"""s of work above which it is told what a stop would lose."""

log = logging.getLogger(__name__)

CELLS: Final = BUILDING_DIMS[1:]
"""The dims of a record's histories, the last fastest."""

SAMPLE: Final = 8
"""Histories that are computed to see what all take."""

WINDOW: Final = 400
"""Samples of the record that they are computed under."""

LIMITS: Final = ("elastic_acceleration", "braced_acceleration")
DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""Outputs of sweeps with devices alone."""
RESPONSES: Final = tuple(
    v.name for v in BUILDING_CUBE.values() if v.dims[:4] == BUILDING_DIMS and v.name not in DEMANDS
)
OUTPUTS: Final = (*(name for name in RESPONSES if not BUILDING_CUBE[name].on_request), *LIMITS)
ON_REQUEST: Final = tuple(name for name in RESPONSES if BUILDING_CUBE[name].on_request)
"""Outputs that are computed only where they are named, or where each history is integrated by itself.

Histories that run side by side leave them out.
"""


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
    between samples; see `fdspec.simulate` for one of them with its trajectory.

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
    if at_rest and _with_devices(grid):
        raise InvalidInput("at_rest is for dampers alone, not for buildings with devices")
    motions = named(motions)
    require_per_task(cells_per_task, "cells_per_task")
    usual = usual_outputs(grid, after)
    wanted = chosen(usual if outputs is None else outputs, known_outputs(grid), certify)
    each = _ends(grid)[-1 if set(LIMITS) & set(wanted) else 0]
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
        warm=partial(_warm, grid),
        workers=workers,
        scheduler=scheduler,
        client=client,
        progress=progress,
    )
    cube_of = partial(
        assemble,
        axes=_axes(grid),
        registry=_registry(grid),
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
            [_registry(grid)[name] for name in wanted],
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
    run = partial(_run, grid, certify, each, after=after, alone=_alone(grid, wanted, after))
    parts = fan(run, tasks=tasks)
    return cube_of(_variables(grid, _rows(grid), len(motions), tasks, parts, wanted))


def usual_outputs(grid: BuildingGrid, after: After = NOTHING) -> tuple[str, ...]:
    """Return what a sweep of these buildings computes unless it is told otherwise."""
    by_itself = after != NOTHING or _with_devices(grid)
    return known_outputs(grid) if by_itself else (*OUTPUTS, *_demands(grid))


def known_outputs(grid: BuildingGrid) -> tuple[str, ...]:
    """Return what can be computed of these buildings: of devices, where there are some."""
    return (*OUTPUTS, *ON_REQUEST, *_demands(grid))


def parameters_of(grid: BuildingGrid, wanted: Sequence[str], certify: bool) -> dict[str, object]:
    """Return all that the cube of a grid depends on beside the records."""
    return {
        "buildings": {
            name: building.parameters for name, building in zip(grid.names, grid.buildings, strict=True)
        },
        "stiffness_scale": grid.stiffness_scale,
        "slip_scale": grid.slip_scale,
        **({} if grid.intensity is None else {"intensity": grid.intensity}),
        "certify": certify,
        "outputs": list(wanted),
    }


def bytes_of(motions: Sequence[GroundMotion], grid: BuildingGrid, outputs: Iterable[str]) -> dict[str, int]:
    """Bytes of each variable of the cube."""
    lengths = dict(zip(BUILDING_DIMS, (len(motions), *grid.shape), strict=True))
    lengths |= {"storey": grid.n_storeys, "intensity": grid.intensities.size}
    registry = _registry(grid)
    return {
        name: math.prod(lengths[dim] for dim in registry[name].dims) * np.dtype(registry[name].dtype).itemsize
        for name in outputs
    }


def refuse_endless(
    motions: Sequence[GroundMotion],
    grid: BuildingGrid,
    outputs: Iterable[str],
    store: str | os.PathLike[str] | None,
) -> None:
    """Raise InvalidInput for a sweep that this machine cannot hold or that takes longer than the limit."""
    outputs = tuple(outputs)
    histories = grid.intensities.size * _ends(grid)[-1 if set(LIMITS) & set(outputs) else 0]
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
    _warm(grid)
    longest = max(motions, key=lambda motion: motion.n)
    peak = int(np.argmax(np.abs(longest.acceleration)))
    first = max(0, min(peak - WINDOW // 4, longest.n - WINDOW))
    window = GroundMotion(longest.acceleration[first : first + WINDOW], longest.dt, name="window")
    cells = _ends(grid)[0]
    count = min(cells, SAMPLE)
    chosen_cells = ((np.arange(count) + 0.5) * cells / count).astype(np.int64)
    alone = _alone(grid, tuple(outputs), NOTHING)
    run = partial(_run, grid, certify, _ends(grid)[-1], motion=window, alone=alone)
    run(chosen_cells[:1])  # loads the kernels
    started = time.thread_time()
    run(chosen_cells)
    each = (time.thread_time() - started) / (count * window.n)
    return each * sum(motion.n for motion in motions) * grid.intensities.size * _ends(grid)[-1]


def rough_seconds(motions: Sequence[GroundMotion], grid: BuildingGrid) -> float:
    """Core time of all histories, s, roughly."""
    return sum(_seconds(motions, grid, grid.intensities.size * _ends(grid)[-1]))


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
    registry = _registry(grid)
    mine = [name for name in wanted if all(first[dim] for dim in CELLS if dim not in registry[name].dims)]
    items = [cells]
    if set(LIMITS) & set(mine):
        end, braced, _ = _ends(grid)
        items += [end + (b[:, np.newaxis] * grid.shape[1] + k).ravel(), braced + b]
    each = _ends(grid)[-1]
    levels = each * np.arange(grid.intensities.size)[:, np.newaxis]
    numbers = (levels + np.concatenate(items)).ravel()
    task = Task(0, np.arange(numbers.size))
    done = _run(grid, certify, each, numbers, motion, after, _alone(grid, wanted, after))
    return _variables(grid.part(b, k, s), _rows(grid), 1, [task], [done], mine)


def _alone(grid: BuildingGrid, wanted: Sequence[str], after: After) -> bool:
    """Whether each history is integrated by itself, for what those side by side leave out."""
    return after != NOTHING or (not _with_devices(grid) and bool(set(ON_REQUEST) & set(wanted)))


def _registry(grid: BuildingGrid) -> Registry:
    return BUILDING_CUBE if grid.intensity is None else INTENSITY_BUILDING_CUBE


def _ends(grid: BuildingGrid) -> tuple[int, int, int]:
    """Where histories of a record at one intensity end: of cells, of braced buildings, of bare frames."""
    n_b, n_k, n_s = grid.shape
    cells = n_b * n_k * n_s
    return cells, cells + n_b * n_k, cells + n_b * n_k + n_b


def _frame(grid: BuildingGrid, history: int) -> Frame:
    """Return the building of one history as the kernel takes it: its dampers scaled, held or taken away."""
    from fdspec.kernels.frame import model as row

    _, n_k, n_s = grid.shape
    cells, braced, _ = _ends(grid)
    column = history // n_s if history < cells else history - cells
    b, k = divmod(column, n_k) if history < braced else (history - braced, 0)
    given = grid.buildings[b].frame
    properties = given.properties.copy()
    if history < braced:
        properties[row.BRACE_STIFFNESS] = grid.brace_stiffness[b, k]
        properties[row.BRACE_DAMPING] = grid.brace_damping[b, k]
    else:
        properties[[row.BRACE_MASS, row.BRACE_STIFFNESS, row.BRACE_DAMPING]] = 0.0
    if history < cells:
        properties[row.SLIP_FORCE] = grid.slip_force[b, history % n_s]
        properties[row.KINETIC_SLIP_FORCE] = grid.kinetic_slip_force[b, history % n_s]
    else:
        never = np.where(properties[row.BRACE_STIFFNESS] > 0.0, np.inf, 0.0)
        properties[[row.SLIP_FORCE, row.KINETIC_SLIP_FORCE]] = never
    return given._replace(properties=properties)


def _building(grid: BuildingGrid, history: int) -> Building:
    """Return the building of one cell, with its dampers scaled."""
    _, n_k, n_s = grid.shape
    column, s = divmod(history, n_s)
    b, k = divmod(column, n_k)
    return grid.buildings[b].with_changes(
        brace_stiffness=grid.brace_stiffness[b, k],
        brace_damping=grid.brace_damping[b, k],
        slip_force=grid.slip_force[b, s],
        kinetic_slip_force=grid.kinetic_slip_force[b, s],
    )


def _with_devices(grid: BuildingGrid) -> bool:
    """Whether any building has devices: then all cells have the results that devices add."""
    return any(building.has_devices for building in grid.buildings)


def _warm(grid: BuildingGrid) -> None:
    from fdspec.engines.frames import runs_beside_others

    if not all(runs_beside_others(building.frame) for building in grid.buildings):
        import fdspec.engines.many_storeys
    if _with_devices(grid):
        import fdspec.engines.devices  # noqa: F401


def _run(
    grid: BuildingGrid,
    certify: bool,
    each: int,
    histories: IntArray,
    motion: GroundMotion,
    after: After = NOTHING,
    alone: bool = False,
) -> tuple[FloatArray, FloatArray]:
    """Integrate some histories of a record: results by storey (m, rows, N) and totals (m, entries).

    each: histories at one intensity; those of the first come first.  alone: whether each is integrated by
    itself.
    """
    levels, of_level = np.divmod(histories, each)
    by_storey = np.empty((histories.size, len(_rows(grid)), grid.n_storeys))
    totals = np.empty((histories.size, len(_totals())))
    for level in np.unique(levels).tolist():
        at, s = levels == level, float(grid.intensities[level])
        shaken = motion if s == 1.0 else motion.times(s)
        by_storey[at], totals[at] = _run_level(grid, certify, of_level[at], shaken, after, alone)
    return by_storey, totals


def _totals() -> tuple[str, ...]:
    from fdspec.kernels.frame.results import TOTALS

    return TOTALS


def _run_level(
    grid: BuildingGrid,
    certify: bool,
    histories: IntArray,
    motion: GroundMotion,
    after: After,
    alone: bool,
) -> tuple[FloatArray, FloatArray]:
    """Integrate the same, all at the intensity of this motion."""
    if alone or _with_devices(grid):
        results = [_run_one(grid, certify, int(history), motion, after, alone) for history in histories]
        return np.stack([rows for rows, _ in results]), np.stack([whole for _, whole in results])
    from fdspec.engines.frames import peaks_of_frames
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTALS

    frames = [_frame(grid, int(history)) for history in histories]
    by_storey = np.empty((len(frames), len(STOREY_RESULTS), grid.n_storeys))
    totals = np.empty((len(frames), len(TOTALS)))
    cells = histories < _ends(grid)[0]
    for of, certified in ((cells, certify), (~cells, False)):
        if of.any():
            chosen_frames = [frame for frame, is_one in zip(frames, of, strict=True) if is_one]
            by_storey[of], totals[of] = peaks_of_frames(chosen_frames, motion, certify=certified)
    return by_storey, totals


def _run_one(
    grid: BuildingGrid, certify: bool, history: int, motion: GroundMotion, after: After, alone: bool
) -> tuple[FloatArray, FloatArray]:
    """Integrate one history by the engine for its building: rows of `_rows` (rows, N), and TOTALS.

    The limits that ride along are those of the elastic frame. Beside a building with devices, one without
    is integrated by both engines: its peaks are those of the engine of frames, to the bit.
    """
    from fdspec.kernels.frame.results import DEMANDS as FIRST_DEMAND
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTALS

    cell = history < _ends(grid)[0]
    free_steps = after.free_steps(motion)
    if after.at_rest and cell:
        return _run_to_rest(grid, certify, history, motion, free_steps)
    by_frames = partial(
        _of_frame, motion=motion, certify=certify and cell, free_steps=free_steps, alone=alone
    )
    if not (cell and _with_devices(grid)):
        by_storey, totals = by_frames(_frame(grid, history))
        missing = np.zeros((len(_rows(grid)) - len(STOREY_RESULTS), grid.n_storeys))
        return np.concatenate([by_storey, missing]), totals
    from fdspec.engines.devices import peaks_of as peaks_with_devices

    building = _building(grid, history)
    storeys, whole = peaks_with_devices(building, motion, free_steps)
    table = np.stack([storeys[name] for name in _rows(grid)])
    totals = np.array([whole[name] for name in TOTALS])
    if not building.has_devices:
        by_storey, totals = by_frames(_frame(grid, history))
        table[:FIRST_DEMAND] = by_storey[:FIRST_DEMAND]
    return table, totals


def _of_frame(
    frame: Frame, motion: GroundMotion, certify: bool, free_steps: int, alone: bool
) -> tuple[FloatArray, FloatArray]:
    """Integrate one frame as if beside others, to the bit, or alone, with all rows of STOREY_RESULTS."""
    if not alone:
        from fdspec.engines.frames import peaks_of_frames

        by_storey, totals = peaks_of_frames([frame], motion, certify=certify)
        return by_storey[0], totals[0]
    from fdspec.engines.many_storeys import peaks_of

    return peaks_of(frame, motion, certify=certify, free_steps=free_steps)


def _run_to_rest(
    grid: BuildingGrid, certify: bool, history: int, motion: GroundMotion, free_steps: int
) -> tuple[FloatArray, FloatArray]:
    """Integrate one cell until no damper can slip any more, with the position in which it comes to rest."""
    from fdspec.engines.many_storeys import peaks_of
    from fdspec.engines.rest import rest_of_building
    from fdspec.kernels.frame.results import RESULT, TOTAL

    at_start = np.zeros((2, 2, grid.n_storeys))
    rest = rest_of_building(_building(grid, history), motion, Span(free_steps, motion.dt, 1), at_start)
    table, totals = peaks_of(
        _frame(grid, history), motion, certify=certify, free_steps=free_steps + rest.steps
    )
    table[RESULT.residual_displacement] = rest.displacement
    table[RESULT.residual_slip] = rest.slip
    if rest.status != 0:
        totals[TOTAL.status] = rest.status
    return table, totals


def _rows(grid: BuildingGrid) -> tuple[str, ...]:
    """Return the names of what each storey has of its own."""
    from fdspec.kernels.frame.results import STOREY_RESULTS

    return (*STOREY_RESULTS, *(_demands(grid) if _with_devices(grid) else ()))


def _demands(grid: BuildingGrid) -> tuple[str, ...]:
    """Return what only a cube with devices in it, or of known heights, has of each storey."""
    known = all(not np.isnan(building.storey_height).any() for building in grid.buildings)
    if not _with_devices(grid):
        return ("peak_drift_ratio",) if known else ()
    return tuple(name for name in DEMANDS if known or name != "peak_drift_ratio")


def _variables(
    grid: BuildingGrid,
    rows: Sequence[str],
    n_r: int,
    tasks: Sequence[Task],
    parts: Sequence[tuple[FloatArray, FloatArray]],
    wanted: Sequence[str],
) -> dict[str, NDArray[np.generic]]:
    """Put what the tasks returned where it stands in the cube."""
    from fdspec.kernels.frame.results import TOTALS

    cells, braced, bare = _ends(grid)
    n_i = grid.intensities.size
    histories = 1 + max(int(task.items.max()) for task in tasks)
    by_storey = np.empty((len(rows), n_r, histories, grid.n_storeys))
    totals = np.empty((len(TOTALS), n_r, histories))
    for (r, items), (of_storeys, of_all) in zip(tasks, parts, strict=True):
        by_storey[:, r, items] = of_storeys.transpose(1, 0, 2)
        totals[:, r, items] = of_all.T
    levels = (n_r, n_i, histories // n_i)
    results = dict(zip(rows, by_storey.reshape(len(rows), *levels, grid.n_storeys), strict=True))
    results |= dict(zip(TOTALS, totals.reshape(len(TOTALS), *levels), strict=True))
    results["peak_base_shear"] = results["peak_storey_shear"][..., 0]
    results["residual_drift"] = np.diff(results["residual_displacement"], prepend=0.0)
    if "peak_drift_ratio" in wanted and "peak_drift_ratio" not in results:
        n_b, n_k, n_s = grid.shape
        height = np.stack([building.storey_height for building in grid.buildings])
        drift = results["peak_drift"][:, :, :cells].reshape(n_r, n_i, n_b, n_k * n_s, grid.n_storeys)
        results["peak_drift_ratio"] = (drift / height[:, np.newaxis]).reshape(n_r, n_i, cells, -1)
    acceleration = results["peak_acceleration"]
    limits = {
        "elastic_acceleration": acceleration[:, :, braced:bare],
        "braced_acceleration": acceleration[:, :, cells:braced],
    }
    n_b, n_k, n_s = grid.shape
    lengths = {"record": n_r, "building": n_b, "stiffness_scale": n_k, "slip_scale": n_s}
    lengths |= {"storey": grid.n_storeys, "intensity": n_i}
    registry = _registry(grid)
    variables: dict[str, NDArray[np.generic]] = {}
    for name in wanted:
        variable = registry[name]
        values = limits[name] if name in limits else results[name][:, :, :cells]
        shape = [lengths[dim] for dim in variable.dims]
        variables[name] = values.reshape(shape).astype(variable.dtype)
    return variables


def _axes(grid: BuildingGrid) -> dict[str, object]:
    return {
        "building": list(grid.names),
        "stiffness_scale": grid.stiffness_scale,
        "slip_scale": grid.slip_scale,
        **({} if grid.intensity is None else {"intensity": grid.intensity}),
        "storey": np.arange(1, grid.n_storeys + 1),
        "slip_force": grid.slip_force,
        "kinetic_slip_force": grid.kinetic_slip_force,
        "brace_stiffness": grid.brace_stiffness,
        "bare_period": [float(building.bare_periods[0]) for building in grid.buildings],
        "braced_period": grid.braced_period,
    }
