"""Grid and ground motions -> the cube of single-storey frames."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.methods import EXACT, Method, chosen_method
from fdspec.model.grid import Grid
from fdspec.model.link import Link, TensionBrace
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After, zero_or_positive
from fdspec.runs.bounds import SWEEP_HOURS, refuse_large, refuse_long
from fdspec.runs.columns import DEMANDS, STRAIN, Columns, demands_of, rows_of, run_columns, warm
from fdspec.runs.cost import seconds_of_sweep
from fdspec.runs.cube import assemble, chosen, named
from fdspec.runs.pilot import probed
from fdspec.runs.plausible import warn_of_units
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.task import Task, plan, require_per_task
from fdspec.scheduling.threads import fan_out
from fdspec.variables import CUBE, INTENSITY_CUBE, STUDY_DIMS, Registry

if TYPE_CHECKING:
    from fdspec.scheduling.task import Client

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

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

COLUMNS: Final = ("stiffness_ratio", "period")
"""The dims of a sweep's columns, the second fastest; a column is all pretensions of a pair."""

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
    collapse_drift: float | None = None,
    links: Sequence[Link | TensionBrace] = (),
    intensity: ArrayLike | None = None,
    free_vibration: float = 0.0,
    at_rest: bool = False,
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
    between samples; see `fdspec.simulate` for one of them with its time series.

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
    storey_height, yield_shear, hardening_ratio, gravity_load, slot_length, slot_stiffness, \
    recentring_stiffness, collapse_drift : float, optional
        Devices of all frames alike, as for `fdspec.Building`: columns that yield, gravity, slots, re-centring
        springs; so are ``links``, a sequence of `Link` and `TensionBrace` between floor 1 and the ground.
        With them each history is integrated by itself, a thousand times slower, the cube has the demands of
        `fdspec.variables.device_variables` too, and a history may end with the status ``collapsed``.  The
        limits that ride along stay those of the elastic frame.
    intensity : array_like, optional
        Factors on the ground motions, positive, strictly increasing: adds the dim ``intensity`` after
        ``record``.  What is told of the records, ``pga`` among it, stays that of factor 1.
    free_vibration : float, s
        How long each history goes on after its motion's end, the ground at rest; rounded up to whole steps of
        the motion.
    at_rest : bool
        Go on from there until the energy left can make no damper slip, and give ``residual_displacement`` and
        ``residual_slip`` where the frame comes to rest: 0 where a damper has no friction.  Peaks are those up
        to where nothing slips any more.  A history that takes more than 2 million steps to get there has the
        status ``transition_cap_reached``.
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
        collapse_drift=collapse_drift,
        links=links,  # type: ignore[arg-type]
        intensity=intensity,  # type: ignore[arg-type]
    )
    motions = named(motions)
    usual = usual_outputs(grid)
    wanted = chosen(usual if outputs is None else outputs, (*usual, *ON_REQUEST), certify)
    strain = [name for name in wanted if BARE.get(name, name) in STRAIN]
    other = chosen_method(method)
    after = After(zero_or_positive("free_vibration", free_vibration), at_rest)
    refuse_together(grid, other, strain, after)
    n_sr, n_f, n_t = grid.shape
    seconds = seconds_of_sweep(grid, motions, certify)
    refuse_endless(motions, grid, wanted, sum(seconds), store)
    warn_of_units(motions, period=grid.period, slip_force=grid.slip_force, floor_mass=grid.floor_mass)
    run = partial(run_columns, grid, certify, bool(strain), other, after=after)
    fan = partial(
        fan_out,
        motions=motions,
        each=n_f * grid.intensities.size,
        warm=warm,
        workers=workers,
        scheduler=scheduler,
        client=client,
        progress=progress,
    )
    registry = registry_for(grid)
    cube_of = partial(
        assemble,
        axes=_axes(grid),
        registry=registry,
        motions=motions,
        title="Peak response of single-storey frames with friction dampers",
        parameters={
            **grid.parameters,
            **({} if other is None else other.parameters),
            **after.parameters,
            "certify": certify,
            "outputs": list(wanted),
        },
        command="fdspec.sweep",
    )
    require_per_task(columns_per_task, "columns_per_task")
    if store is not None:
        from fdspec.runs.resumable import sweep_into

        return sweep_into(
            store,
            cube_of({}),
            [registry[name] for name in wanted],
            partial(_block, grid, run, wanted),
            fan,
            items=COLUMNS,
            seconds=sum(seconds)
            if columns_per_task
            else sum(probed(motions, grid, certify, bool(strain), other)),
            items_per_task=columns_per_task,
            restart=restart,
        )
    tasks = plan(n_sr * n_t, seconds, columns_per_task, "columns_per_task")
    return cube_of(_variables(grid, len(motions), tasks, fan(run, tasks=tasks), wanted))


def refuse_together(grid: Grid, method: Method | None, strain: Sequence[str], after: After) -> None:
    """Raise InvalidInput for what cannot be had together: strain energy, devices, other methods, rest."""
    energies = f"outputs {', '.join(strain)}"
    other = "" if method is None else f"method {method.name!r}"
    if strain and method is not None:
        raise InvalidInput(f"{energies} need method 'exact', got {method.name!r}")
    if grid.devices and (strain or method is not None):
        raise InvalidInput(f"{other or energies}: not for frames with {', '.join(grid.devices)}")
    if strain and after != NOTHING:
        raise InvalidInput(f"{energies} end with the motion: not with free_vibration or at_rest")
    if after.at_rest and (method is not None or grid.devices):
        what = other or "frames with devices"
        raise InvalidInput(f"at_rest is for the exact method and dampers alone, not for {what}")


def _axes(grid: Grid) -> dict[str, object]:
    """Return the coordinates of this grid's cube."""
    axes: dict[str, object] = {
        "stiffness_ratio": grid.stiffness_ratio,
        "pretension": grid.pretension,
        "period": grid.period,
        "slip_force": grid.slip_force,
        "kinetic_slip_force": grid.kinetic_slip_force,
    }
    return axes if grid.intensity is None else {**axes, "intensity": grid.intensity}


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


def usual_outputs(grid: Grid) -> tuple[str, ...]:
    """Return what a sweep computes unless it is told otherwise."""
    return (*OUTPUTS, *demands_of(grid))


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
    rows = rows_of(grid)
    n_sr, n_f, n_t = grid.shape
    n_i = grid.intensities.size
    responses: dict[str, NDArray[Any]] = {
        name: np.empty((n_r, n_i, n_sr, n_f, n_t), dtype=CUBE[name].dtype)
        for name in wanted
        if CUBE[name].dims == STUDY_DIMS
    }
    bare: dict[str, NDArray[Any]] = {name: np.empty((n_r, n_i, n_t)) for name in wanted if name in BARE}
    braced: dict[str, NDArray[Any]] = {
        name: np.empty((n_r, n_i, n_sr, n_t)) for name in wanted if name in BRACED
    }
    for (r, columns), (out, held, free) in zip(tasks, parts, strict=True):
        ratio, period = np.unravel_index(columns, (n_sr, n_t))
        for name, values in responses.items():
            if name not in rows and grid.storey_height is not None:  # peak_drift_ratio
                drift_ratio = out[..., rows.index("peak_displacement")] / grid.storey_height
                values[r, :, ratio, :, period] = drift_ratio
            else:
                values[r, :, ratio, :, period] = out[..., rows.index(name)]
        for name, values in braced.items():
            values[r, :, ratio, period] = held[..., rows.index(BRACED[name])]
        for name, values in bare.items():
            values[r, :, columns[columns < n_t]] = free[..., rows.index(BARE[name])]
    found = responses | bare | braced
    return found if grid.intensity is not None else {name: values[:, 0] for name, values in found.items()}
