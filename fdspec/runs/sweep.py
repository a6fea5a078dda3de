"""Grid and ground motions -> the cube of single-storey frames."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.methods import EXACT, Method, chosen_method
from fdspec.methods.batch import integrate_by_method
from fdspec.model.building import Building, ModalDamping
from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.bounds import SWEEP_HOURS, refuse_large, refuse_long, seconds_of_sweep
from fdspec.runs.cube import assemble, chosen, named
from fdspec.runs.plausible import warn_of_units
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.threads import Task, cores, fan_out, plan
from fdspec.variables import CUBE, INTENSITY_CUBE, STUDY_DIMS, Registry, demand_variables

if TYPE_CHECKING:
    from distributed import Client

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Columns = tuple[FloatArray, FloatArray, FloatArray]

SECONDS_PER_SAMPLE: Final = 8e-9
"""Core time of one history for each sample of its record, roughly; for plans, not for results."""

WINDOW: Final = 512
"""Samples of the record for which histories are computed to see what they cost."""

PROBE: Final = 0.2
"""s of core time after which enough is known of the cost."""

BARE: Final = {
    "elastic_acceleration": "peak_acceleration",
    "bare_peak_displacement": "peak_displacement",
    "bare_peak_base_shear": "peak_base_shear",
    "bare_strain_energy_area": "strain_energy_area",
    "bare_peak_strain_energy": "peak_strain_energy",
}
"""Output over (record, period) -> what it is of the frame without brace."""

BRACED: Final = {
    "braced_acceleration": "peak_acceleration",
    "braced_peak_displacement": "peak_displacement",
    "braced_peak_base_shear": "peak_base_shear",
}
"""Output over (record, stiffness_ratio, period) -> what it is where the damper never slips."""

STRAIN: Final = ("strain_energy_area", "peak_strain_energy")
"""Results of a pass of their own over every history."""

DEMANDS: Final = tuple(v.name for v in demand_variables(()))
"""Outputs of frames with devices alone."""

RESPONSES: Final = tuple(v.name for v in CUBE.values() if v.dims == STUDY_DIMS and v.name not in DEMANDS)
_KNOWN: Final = (*RESPONSES, *BARE, *BRACED)
OUTPUTS: Final = tuple(name for name in _KNOWN if not CUBE[name].on_request)
ON_REQUEST: Final = tuple(name for name in _KNOWN if CUBE[name].on_request)
"""Outputs that are computed only where they are named."""


def sweep(
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    method: str | Method = EXACT,
    period: ArrayLike,
    pretension: ArrayLike,
    stiffness_ratio: ArrayLike,
    floor_mass: float = 20e3,
    brace_mass: float = 50.0,
    damping_ratio: float = 0.05,
    friction_coefficient: float = 0.5,
    kinetic_friction_coefficient: float | None = None,
    normal_force_factor: float = 1.0,
    brace_damping_ratio: float = 0.0,
    storey_height: float | None = None,
    yield_shear: float | None = None,
    hardening_ratio: float = 0.0,
    gravity_load: float | None = None,
    slot_length: float | None = None,
    slot_stiffness: float | None = None,
    recentring_stiffness: float | None = None,
    intensity: ArrayLike | None = None,
    outputs: Iterable[str] | None = None,
    certify: bool = True,
    workers: int | None = None,
    scheduler: str = "threads",
    columns_per_task: int | None = None,
    client: Client | None = None,
    store: str | os.PathLike[str] | None = None,
    restart: bool = False,
    progress: Shown = False,
) -> xr.Dataset:
    """Compute the cube: peaks of a single-storey frame over record, stiffness ratio, pretension and period.

    Each history is integrated exactly, event by event, under a ground acceleration that is linear
    between samples; see `fdspec.simulate` for one of them with its course in time.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Named differently; their names become the ``record`` coordinate.
    method : str or Method
        "exact", or one of the methods that the study compares, as for `fdspec.simulate`; the limits that
        ride along are exact in any case.
    period, pretension, stiffness_ratio : array_like
        Axes in s, N and 1, strictly increasing; see `fdspec.model.grid.Grid`.
    floor_mass, brace_mass : float, kg
        A brace mass of 0 is the massless brace.
    damping_ratio, brace_damping_ratio : float
        Of the frame without its brace, and of the brace on its own.
    friction_coefficient, kinetic_friction_coefficient, normal_force_factor : float
        Slip force = friction_coefficient * normal_force_factor * pretension.
    storey_height, yield_shear, hardening_ratio, gravity_load, slot_length, slot_stiffness,
    recentring_stiffness : float, optional
        Devices of all frames alike, as for `fdspec.Building`: columns that yield, gravity, slots, re-centring
        springs.  With them each history is integrated by itself, a thousand times slower, the cube has the
        demands of `fdspec.variables.demand_variables` too, and a history may end with the status
        ``collapsed``.  The limits that ride along stay those of the elastic frame.
    intensity : array_like, optional
        Factors on the ground motions, positive, strictly increasing: adds the dim ``intensity`` after
        ``record``.  What is told of the records, ``pga`` among it, stays that of factor 1.
    outputs : iterable of str, optional
        Variables of the cube; unless given, all but those of `ON_REQUEST`.
    certify : bool
        Whether to compute ``energy_error``; without it the sweep is faster.
    workers : int, optional
        Threads (or processes); one a core unless given.
    scheduler : str
        A scheduler of dask: "threads", "processes" or "synchronous".
    columns_per_task : int, optional
        (stiffness ratio, period) pairs of one task; about 0.2 s of work unless given.  No result
        depends on it.
    client : distributed.Client, optional
        Any cluster of dask.distributed, in place of threads here.
    store : path, optional
        A Zarr store, ``cube.zarr``, into which the workers write block by block what they compute: more than
        memory holds.  When it is there, from a sweep that was stopped, only what is missing is computed.
    restart : bool
        Whether a store that is there is removed first.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        Dims (record, stiffness_ratio, pretension, period); variables, units and meanings are those
        of `fdspec.variables.CUBE`, with intensities of `fdspec.variables.INTENSITY_CUBE`.  With a store it
        is read from there when it is used.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.
    StoreError
        For a store that holds another sweep, with what differs, or that cannot be written.

    Notes
    -----
    The frame is the study's example (its Figure 7): k_f = floor_mass (2 pi / period)^2,
    k_d = stiffness_ratio k_f; equations (2) to (7).

    A frame whose only strength is its slip force F is the same frame at every intensity s: the response to
    s a_g under F is s times that to a_g under F / s, energies s^2 times, changes of phase the same.  So the
    exact method computes intensities as further slip forces; other methods run the scaled record.
    """
    grid = Grid(
        stiffness_ratio=stiffness_ratio,  # type: ignore[arg-type]
        pretension=pretension,  # type: ignore[arg-type]
        period=period,  # type: ignore[arg-type]
        floor_mass=floor_mass,
        brace_mass=brace_mass,
        damping_ratio=damping_ratio,
        friction_coefficient=friction_coefficient,
        kinetic_friction_coefficient=kinetic_friction_coefficient,
        normal_force_factor=normal_force_factor,
        brace_damping_ratio=brace_damping_ratio,
        storey_height=storey_height,
        yield_shear=yield_shear,
        hardening_ratio=hardening_ratio,
        gravity_load=gravity_load,
        slot_length=slot_length,
        slot_stiffness=slot_stiffness,
        recentring_stiffness=recentring_stiffness,
        intensity=intensity,  # type: ignore[arg-type]
    )
    motions = named(motions)
    usual = usual_outputs(grid)
    wanted = chosen(usual if outputs is None else outputs, (*usual, *ON_REQUEST), certify)
    strain = [name for name in wanted if BARE.get(name, name) in STRAIN]
    other = chosen_method(method)
    if strain and other is not None:
        raise InvalidInput(f"outputs {', '.join(strain)} need method 'exact', got {other.name!r}")
    if grid.devices and (strain or other is not None):
        what = f"method {other.name!r}" if other is not None else f"outputs {', '.join(strain)}"
        raise InvalidInput(f"{what}: not for frames with {', '.join(grid.devices)}")
    n_sr, n_f, n_t = grid.shape
    seconds = seconds_of_sweep(grid, motions, certify)
    refuse_endless(motions, grid, wanted, sum(seconds), store)
    warn_of_units(motions, period=grid.period, slip_force=grid.slip_force, floor_mass=grid.floor_mass)
    run = partial(_run_columns, grid, certify, bool(strain), other)
    fan = partial(
        fan_out,
        motions=motions,
        each=n_f * grid.intensities.size,
        warm=_warm,
        workers=workers,
        scheduler=scheduler,
        client=client,
        progress=progress,
    )
    registry = registry_for(grid)
    cube_of = partial(
        assemble,
        axes={
            "stiffness_ratio": grid.stiffness_ratio,
            "pretension": grid.pretension,
            "period": grid.period,
            "slip_force": grid.slip_force,
            "kinetic_slip_force": grid.kinetic_slip_force,
            **({} if grid.intensity is None else {"intensity": grid.intensity}),
        },
        registry=registry,
        motions=motions,
        title="Peak response of single-storey frames with friction dampers",
        parameters={
            **grid.parameters,
            **({} if other is None else other.parameters),
            "certify": certify,
            "outputs": list(wanted),
        },
        command="fdspec.sweep",
    )
    if store is not None:
        from fdspec.runs.resumable import sweep_into

        return sweep_into(
            store,
            cube_of({}),
            [registry[name] for name in wanted],
            partial(_block, grid, run, wanted),
            fan,
            seconds=sum(seconds)
            if columns_per_task
            else sum(_measured(motions, grid, certify, bool(strain), other)),
            columns_per_task=columns_per_task,
            restart=restart,
        )
    tasks = plan(n_sr * n_t, seconds, columns_per_task, "columns_per_task")
    return cube_of(_variables(grid, len(motions), tasks, fan(run, tasks=tasks), wanted))


def measured(motions: Sequence[GroundMotion], grid: Grid, certify: bool = True) -> float:
    """Wall seconds that a sweep takes on this machine's cores, from some of its histories, computed here.

    They are taken around the strongest shaking, so that it is rather too much.
    """
    return sum(_measured(motions, grid, certify, False, None)) / cores()


def _measured(
    motions: Sequence[GroundMotion], grid: Grid, certify: bool, strain: bool, other: Method | None
) -> list[float]:
    """Core seconds of the histories of each motion."""
    _warm()
    longest = max(motions, key=lambda motion: motion.n)
    peak = int(np.argmax(np.abs(longest.acceleration)))
    first = max(0, min(peak - WINDOW // 4, longest.n - WINDOW))
    window = GroundMotion(longest.acceleration[first : first + WINDOW], longest.dt, name="window")
    nothing = GroundMotion(np.zeros(2), longest.dt, name="nothing")
    ratio = grid.stiffness_ratio[_shares(grid.stiffness_ratio.size, 2)]
    pretension = grid.pretension[_shares(grid.pretension.size, 8)]
    period = grid.period[_shares(grid.period.size, 6)]
    part = replace(grid, stiffness_ratio=ratio, pretension=pretension, period=period)
    spent, histories = 0.0, 0
    for k in range(period.size):  # from the shortest, which costs most
        columns = np.arange(k, ratio.size * period.size, period.size)
        for motion, sign in ((nothing, -1), (window, 1)):  # what a call costs by itself is no history's
            started = time.thread_time()
            _run_columns(part, certify, strain, other, columns, motion)
            spent += sign * (time.thread_time() - started)
        histories += columns.size * pretension.size * grid.intensities.size
        if spent > PROBE:
            break
    each = max(spent / (histories * window.n), SECONDS_PER_SAMPLE / 4.0)
    return [each * motion.n * grid.size for motion in motions]


def _shares(size: int, count: int) -> IntArray:
    """Positions in the middle of equal shares, at most so many."""
    count = min(size, count)
    return ((np.arange(count) + 0.5) * size / count).astype(np.int64)


def bytes_of(motions: Sequence[GroundMotion], grid: Grid, outputs: Iterable[str]) -> dict[str, int]:
    """Bytes of each variable of the cube."""
    n_sr, n_f, n_t = grid.shape
    lengths = {"record": len(motions), "stiffness_ratio": n_sr, "pretension": n_f, "period": n_t}
    lengths["intensity"] = grid.intensities.size
    registry = registry_for(grid)
    return {
        name: math.prod(lengths[dim] for dim in registry[name].dims) * np.dtype(CUBE[name].dtype).itemsize
        for name in outputs
    }


def registry_for(grid: Grid) -> Registry:
    """Return the variables of this grid's cube."""
    return CUBE if grid.intensity is None else INTENSITY_CUBE


def refuse_endless(
    motions: Sequence[GroundMotion],
    grid: Grid,
    outputs: Iterable[str],
    seconds: float,
    store: str | os.PathLike[str] | None,
) -> None:
    """Raise InvalidInput for a sweep that this machine cannot hold or that takes longer than the limit."""
    what = f"a sweep of {len(motions) * grid.size:.4g} histories"
    size = float(sum(bytes_of(motions, grid, outputs).values()))
    if store is None:
        refuse_large(2.0 * size, what)  # once as the tasks return it, once as the cube
    elif not Path(store).exists():
        refuse_large(size, what, folder=Path(store).absolute().parent)
    refuse_long(seconds, SWEEP_HOURS, what)


def timed(grid: Grid, motion: GroundMotion, certify: bool = True) -> tuple[float, int]:
    """Compute all columns of a small grid in this thread; return its core seconds and changes of phase."""
    from fdspec.kernels.storey.history import RESULTS

    _warm()
    columns = np.arange(grid.stiffness_ratio.size * grid.period.size)
    started = time.thread_time()
    results, _, _ = _run_columns(grid, certify, False, None, columns, motion)
    return time.thread_time() - started, int(results[..., RESULTS.index("transitions")].sum())


def usual_outputs(grid: Grid) -> tuple[str, ...]:
    """Return what a sweep computes unless it is told otherwise."""
    return (*OUTPUTS, *_demands(grid))


def _demands(grid: Grid) -> tuple[str, ...]:
    """Return what only a cube of frames with devices has."""
    if not grid.devices:
        return ()
    return tuple(name for name in DEMANDS if name != "peak_drift_ratio" or grid.storey_height is not None)


def _warm() -> None:
    import fdspec.engines.batch  # noqa: F401


def _frames(grid: Grid, columns: IntArray) -> FloatArray:
    """Rows of floor mass, damping, stiffness, brace mass, damping, stiffness for these pairs."""
    ratio, period = np.unravel_index(columns, (grid.stiffness_ratio.size, grid.period.size))
    stiffness = grid.floor_mass * (2.0 * np.pi / grid.period[period]) ** 2
    brace = grid.stiffness_ratio[ratio] * stiffness
    rows = np.empty((columns.size, 6))
    rows[:, 0] = grid.floor_mass
    rows[:, 1] = 2.0 * grid.damping_ratio * np.sqrt(stiffness * grid.floor_mass)
    rows[:, 2] = stiffness
    rows[:, 3] = grid.brace_mass
    rows[:, 4] = 2.0 * grid.brace_damping_ratio * np.sqrt(brace * grid.brace_mass)
    rows[:, 5] = brace
    return rows


def _run_columns(
    grid: Grid,
    certify: bool,
    strain: bool,
    other: Method | None,
    columns: IntArray,
    motion: GroundMotion,
) -> Columns:
    """Integrate some (stiffness ratio, period) pairs: all pretensions, never slipping, without brace.

    Each at every intensity, (m, n_i, n_f, results), (m, n_i, results), (bare, n_i, results), in the order of
    RESULTS; where wanted, those of STRAIN follow, save of braced frames.
    """
    levels, slip_force, kinetic = grid.intensities, grid.slip_force, grid.kinetic_slip_force
    run = partial(_run_forces, grid, certify, strain, other, columns)
    if scales(grid, other):
        # R(s a, F) = s R(a, F / s): further slip forces of the same frames under the same motion.
        each = levels[:, np.newaxis]
        found, braced, bare = run((slip_force / each).ravel(), (kinetic / each).ravel(), motion)
        found = found.reshape(columns.size, levels.size, slip_force.size, -1)
        parts = (found, braced[:, np.newaxis], bare[:, np.newaxis])
        return cast("Columns", tuple(part * _growth(levels, part) for part in parts))
    runs = [run(slip_force, kinetic, motion if s == 1.0 else motion.times(s)) for s in levels.tolist()]
    return cast("Columns", tuple(np.stack(part, axis=1) for part in zip(*runs, strict=True)))


def scales(grid: Grid, other: Method | None) -> bool:
    """Whether a sweep's frames have no strength or length but their slip forces, and its method none either.

    Columns yield at a shear of their own, slots end at a length, frames collapse at a drift; other methods
    have tolerances in absolute terms.
    """
    return other is None and not grid.devices


def _growth(levels: FloatArray, part: FloatArray) -> FloatArray:
    """Return by what each result of `part` (.., n_i, .., results) grows from intensity 1 to each level."""
    from fdspec.kernels.storey.history import RESULTS

    degrees = np.array([CUBE[name].degree for name in (*RESULTS, *STRAIN)[: part.shape[-1]]], dtype=float)
    growth: FloatArray = levels[:, np.newaxis] ** degrees
    return growth[:, np.newaxis] if part.ndim == 4 else growth


def _run_forces(
    grid: Grid,
    certify: bool,
    strain: bool,
    other: Method | None,
    columns: IntArray,
    slip_force: FloatArray,
    kinetic: FloatArray,
    motion: GroundMotion,
) -> Columns:
    """Integrate the same under these slip forces, whatever the intensity."""
    from fdspec.engines.batch import integrate_columns

    frames = _frames(grid, columns)
    exact = slice(None) if other is None and not grid.devices else slice(0)
    braced, results = integrate_columns(frames, slip_force[exact], kinetic[exact], motion, certify=certify)
    if grid.devices:
        results = _run_devices(grid, frames, slip_force, kinetic, motion)
    if other is not None:
        results = integrate_by_method(other, frames, slip_force, kinetic, motion)
    bare = frames[columns < grid.period.size].copy()  # the first stiffness ratio's pairs stand for all
    bare[:, 3:] = 0.0
    free, _ = integrate_columns(bare, np.empty(0), np.empty(0), motion, certify=False)
    if strain:
        from fdspec.engines.strain import strain_of_columns

        never = np.array([np.inf]), np.array([0.0])
        added = strain_of_columns(frames, slip_force, kinetic, motion)
        results = np.concatenate([results, added], axis=-1)
        free = np.concatenate([free, strain_of_columns(bare, *never, motion)[:, 0]], axis=-1)
    return results, braced, free


def _run_devices(
    grid: Grid, frames: FloatArray, slip_force: FloatArray, kinetic: FloatArray, motion: GroundMotion
) -> FloatArray:
    """Integrate frames (m, 6) with devices, all pretensions: (m, n_f, results) in the order of `_rows`."""
    from fdspec.engines.devices import peaks_of

    rows = _rows(grid)
    results = np.empty((frames.shape[0], grid.pretension.size, len(rows)))
    for i, (m_f, _, k_f, m_d, c_d, k_d) in enumerate(frames):
        for j, forces in enumerate(zip(slip_force, kinetic, strict=True)):
            damping = ModalDamping(grid.damping_ratio)
            building = Building(m_f, k_f, m_d, k_d, *forces, damping, c_d, **grid.devices)
            storey, whole = peaks_of(building, motion)
            found = {name: float(values[0]) for name, values in storey.items()} | whole
            found["peak_base_shear"] = found["peak_storey_shear"]
            results[i, j] = [found[name] for name in rows]
    return results


def _rows(grid: Grid) -> tuple[str, ...]:
    """Return the results of a history, in their order."""
    from fdspec.kernels.storey.history import RESULTS

    return (*RESULTS, *_demands(grid)) if grid.devices else (*RESULTS, *STRAIN)


def _block(
    grid: Grid,
    run: Callable[[IntArray, GroundMotion], Columns],
    wanted: Sequence[str],
    columns: IntArray,
    motion: GroundMotion,
) -> dict[str, NDArray[np.generic]]:
    """Compute the part of the cube that these columns, a block of (stiffness ratio, period), make up."""
    ratio, period = map(np.unique, np.unravel_index(columns, (grid.stiffness_ratio.size, grid.period.size)))
    part = replace(grid, stiffness_ratio=grid.stiffness_ratio[ratio], period=grid.period[period])
    mine = [name for name in wanted if ratio[0] == 0 or "stiffness_ratio" in CUBE[name].dims]
    return _variables(part, 1, [Task(0, np.arange(columns.size))], [run(columns, motion)], mine)


def _variables(
    grid: Grid,
    n_r: int,
    tasks: Sequence[Task],
    parts: Sequence[Columns],
    wanted: Sequence[str],
) -> dict[str, NDArray[Any]]:
    """Put what the tasks returned where it stands in the cube."""
    rows = _rows(grid)
    n_sr, n_f, n_t = grid.shape
    n_i = grid.intensities.size
    responses: dict[str, NDArray[Any]] = {
        name: np.empty((n_r, n_i, n_sr, n_f, n_t), dtype=CUBE[name].dtype) for name in wanted if name in rows
    }
    bare: dict[str, NDArray[Any]] = {name: np.empty((n_r, n_i, n_t)) for name in wanted if name in BARE}
    braced: dict[str, NDArray[Any]] = {
        name: np.empty((n_r, n_i, n_sr, n_t)) for name in wanted if name in BRACED
    }
    for (r, columns), (out, held, free) in zip(tasks, parts, strict=True):
        ratio, period = np.unravel_index(columns, (n_sr, n_t))
        for name, values in responses.items():
            values[r, :, ratio, :, period] = out[..., rows.index(name)]
        for name, values in braced.items():
            values[r, :, ratio, period] = held[..., rows.index(BRACED[name])]
        for name, values in bare.items():
            values[r, :, columns[columns < n_t]] = free[..., rows.index(BARE[name])]
    found = responses | bare | braced
    return found if grid.intensity is not None else {name: values[:, 0] for name, values in found.items()}
