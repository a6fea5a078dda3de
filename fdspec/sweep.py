"""Grid and ground motions -> the cube: tasks of many histories each, fanned out by dask."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

import dask
import numpy as np
import xarray as xr
from dask.callbacks import Callback
from numpy.typing import ArrayLike, NDArray

from fdspec.errors import InvalidInput
from fdspec.grid import Grid
from fdspec.motion import GroundMotion
from fdspec.progress import progress as progress_bar
from fdspec.store import provenance
from fdspec.variables import CUBE, STUDY_DIMS, describe

FloatArray = NDArray[np.float64]

SECONDS_PER_SAMPLE: Final = 12e-9
"""Core time of one history for each sample of its record, roughly; for plans, not for results."""

TASK_SECONDS: Final = 0.2
"""Aimed length of a task: long against what dask spends on one, short against the whole."""

LIMITS: Final = ("elastic_acceleration", "braced_acceleration")
RESPONSES: Final = tuple(v.name for v in CUBE.values() if v.dims == STUDY_DIMS)
OUTPUTS: Final = (*RESPONSES, *LIMITS)


def sweep(
    motions: GroundMotion | Sequence[GroundMotion],
    *,
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
    outputs: Iterable[str] | None = None,
    certify: bool = True,
    workers: int | None = None,
    scheduler: str = "threads",
    columns_per_task: int | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Compute the cube: peaks of a single-storey frame over record, stiffness ratio, pretension and period.

    Each history is integrated exactly, event by event, under a ground acceleration that is linear
    between samples; see `fdspec.simulate` for one of them with its course in time.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Named differently; their names become the ``record`` coordinate.
    period, pretension, stiffness_ratio : array_like
        Axes in s, N and 1, strictly increasing; see `fdspec.grid.Grid`.
    floor_mass, brace_mass : float, kg
        A brace mass of 0 is the massless brace.
    damping_ratio, brace_damping_ratio : float
        Of the frame without its brace, and of the brace on its own.
    friction_coefficient, kinetic_friction_coefficient, normal_force_factor : float
        Slip force = friction_coefficient * normal_force_factor * pretension.
    outputs : iterable of str, optional
        Variables of the cube; all unless given.
    certify : bool
        Whether to compute ``energy_error``; without it the sweep is faster.
    workers : int, optional
        Threads (or processes); one a core unless given.
    scheduler : str
        A scheduler of dask: "threads", "processes" or "synchronous".
    columns_per_task : int, optional
        (stiffness ratio, period) pairs of one task; about 0.2 s of work unless given.  No result
        depends on it.
    progress : bool
        Show a bar on stderr where it is a terminal.

    Returns
    -------
    xarray.Dataset
        Dims (record, stiffness_ratio, pretension, period); variables, units and meanings are those
        of `fdspec.variables.CUBE`.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Notes
    -----
    The frame is the study's example (its Figure 7): k_f = floor_mass (2 pi / period)^2,
    k_d = stiffness_ratio k_f; equations (2) to (7).
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
    )
    motions = _named(motions)
    wanted = _wanted(outputs, certify)
    for argument, value in (("workers", workers), ("columns_per_task", columns_per_task)):
        if value is not None and value < 1:
            raise InvalidInput(f"{argument} must be at least 1, got {value}")

    tasks = [
        (r, columns)
        for r, motion in enumerate(motions)
        for columns in _chunks(grid, motion, certify, columns_per_task)
    ]
    histories = len(motions) * grid.size
    energy = certify or bool({"input_energy", "energy_error"} & set(wanted))
    records = [dask.delayed(motion, pure=False, traverse=False) for motion in motions]
    work = [
        dask.delayed(_run_columns, pure=False)(grid, columns, records[r], energy, certify)
        for r, columns in tasks
    ]
    with progress_bar(histories, "histories", shown=progress) as done, _reported(done):
        _warm()
        parts = dask.compute(*work, scheduler=scheduler, num_workers=workers or os.cpu_count())
    return _assemble(grid, motions, tasks, parts, wanted, certify)


def estimate(motions: Sequence[GroundMotion], grid: Grid, certify: bool = True) -> float:
    """Wall seconds that a sweep is expected to take on this machine's cores, roughly."""
    samples = sum(motion.n for motion in motions)
    cost = samples * grid.size * SECONDS_PER_SAMPLE * (1.35 if certify else 1.0)
    return cost / (os.cpu_count() or 1)


def _warm() -> None:
    """Load the kernels, compiling them where no cache holds them, before many threads want them."""
    import fdspec.columns  # noqa: F401


def _named(motions: GroundMotion | Sequence[GroundMotion]) -> tuple[GroundMotion, ...]:
    given = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    if not given:
        raise InvalidInput("motions must hold at least one GroundMotion, is empty")
    for k, motion in enumerate(given):
        if not isinstance(motion, GroundMotion):
            raise InvalidInput(f"motions[{k}] must be a GroundMotion, got {type(motion).__name__}")
    names = [motion.name for motion in given]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise InvalidInput(f"motions must have different names, {name!r} stands twice")
    return given


def _wanted(outputs: Iterable[str] | None, certify: bool) -> tuple[str, ...]:
    names = OUTPUTS if outputs is None else tuple(outputs)
    for name in names:
        if name not in OUTPUTS:
            raise InvalidInput(f"outputs: {name!r} is none of {', '.join(OUTPUTS)}")
    kept = tuple(name for name in OUTPUTS if name in (*names, "status"))
    return kept if certify else tuple(name for name in kept if name != "energy_error")


def _chunks(
    grid: Grid, motion: GroundMotion, certify: bool, columns_per_task: int | None
) -> Iterator[NDArray[np.int64]]:
    """Split the (stiffness ratio, period) pairs of one record into tasks.

    Each task takes every n-th pair, so that stiff and soft frames, dear and cheap, share it.
    """
    n_sr, _, n_t = grid.shape
    columns = n_sr * n_t
    if columns_per_task is None:
        seconds = estimate((motion,), grid, certify) * (os.cpu_count() or 1)
        count = max(1, min(columns, round(seconds / TASK_SECONDS)))
    else:
        count = math.ceil(columns / columns_per_task)
    for first in range(count):
        yield np.arange(first, columns, count)


def _frames(grid: Grid, columns: NDArray[np.int64]) -> FloatArray:
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
    grid: Grid, columns: NDArray[np.int64], motion: GroundMotion, energy: bool, certify: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrate some (stiffness ratio, period) pairs: all pretensions, never slipping, without brace."""
    from fdspec.columns import integrate_columns

    frames = _frames(grid, columns)
    braced, results = integrate_columns(
        frames, grid.slip_force, grid.kinetic_slip_force, motion, energy=energy, certify=certify
    )
    bare = frames[columns < grid.period.size].copy()  # the first stiffness ratio's pairs stand for all
    bare[:, 3:] = 0.0
    free, _ = integrate_columns(bare, np.empty(0), np.empty(0), motion, energy=False, certify=False)
    return results, braced[:, 0], free[:, 0]


@contextmanager
def _reported(done: Callable[[int], None]) -> Iterator[None]:
    """Tell ``done`` of the histories that each finished task held."""

    def posttask(key: Any, result: Any, dsk: Any, state: Any, worker_id: Any) -> None:  # noqa: ARG001
        if isinstance(result, tuple):
            done(result[0].shape[0] * result[0].shape[1])

    with Callback(posttask=posttask):
        yield


def _assemble(
    grid: Grid,
    motions: Sequence[GroundMotion],
    tasks: Sequence[tuple[int, NDArray[np.int64]]],
    parts: Sequence[tuple[FloatArray, FloatArray, FloatArray]],
    wanted: Sequence[str],
    certify: bool,
) -> xr.Dataset:
    from fdspec.kernels.sdof import RESULTS

    n_sr, n_f, n_t = grid.shape
    n_r = len(motions)
    responses = {
        name: np.empty((n_r, n_sr, n_f, n_t), dtype=CUBE[name].dtype) for name in wanted if name in RESULTS
    }
    limits = {"braced_acceleration": np.empty((n_r, n_sr, n_t)), "elastic_acceleration": np.empty((n_r, n_t))}
    for (r, columns), (out, braced, free) in zip(tasks, parts, strict=True):
        ratio, period = np.unravel_index(columns, (n_sr, n_t))
        for name, values in responses.items():
            values[r, ratio, :, period] = out[:, :, RESULTS.index(name)]
        limits["braced_acceleration"][r, ratio, period] = braced
        limits["elastic_acceleration"][r, columns[columns < n_t]] = free
    variables: dict[str, Any] = {name: (STUDY_DIMS, values) for name, values in responses.items()}
    variables |= {name: (CUBE[name].dims, limits[name]) for name in wanted if name in limits}
    dataset = xr.Dataset(variables, coords=_coordinates(grid, motions))
    parameters = {name: getattr(grid, name) for name in grid.__dataclass_fields__}
    dataset.attrs = provenance(
        "Peak response of single-storey frames with friction dampers",
        {**parameters, "certify": certify, "outputs": list(wanted)},
        motions,
        command="fdspec.sweep",
    )
    return describe(dataset, CUBE)


def _coordinates(grid: Grid, motions: Sequence[GroundMotion]) -> dict[str, Any]:
    def told(of: Any) -> tuple[str, list[Any]]:
        return ("record", [of(motion) for motion in motions])

    return {
        "record": [motion.name for motion in motions],
        "stiffness_ratio": grid.stiffness_ratio,
        "pretension": grid.pretension,
        "period": grid.period,
        "slip_force": ("pretension", grid.slip_force),
        "kinetic_slip_force": ("pretension", grid.kinetic_slip_force),
        "pga": told(lambda m: m.pga),
        "dt": told(lambda m: m.dt),
        "duration": told(lambda m: m.duration),
        "samples": told(lambda m: m.n),
        "scale_factor": told(lambda m: m.scale_factor),
        "event": told(lambda m: m.event),
        "station": told(lambda m: m.station),
        "component": told(lambda m: m.component),
        "source": told(lambda m: m.source),
        "history": told(lambda m: "; ".join(m.history)),
        "checksum": told(lambda m: m.checksum),
    }
