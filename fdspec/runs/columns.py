"""Columns of a sweep, its (stiffness ratio, period) pairs: what the engines return for them."""

from __future__ import annotations

import time
from functools import partial
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray

from fdspec.methods import Method
from fdspec.methods.batch import integrate_by_method
from fdspec.model.building import Building, ModalDamping
from fdspec.model.grid import Grid
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After
from fdspec.variables import CUBE, device_variables

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Columns = tuple[FloatArray, FloatArray, FloatArray]

STRAIN: Final = ("strain_energy_area", "peak_strain_energy")
"""Results of a pass of their own over every history."""

DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""Outputs of frames with devices alone."""


def warm() -> None:
    """Load the kernels, compiling them where no cache holds them."""
    import fdspec.engines.batch  # noqa: F401


def timed(grid: Grid, motion: GroundMotion, certify: bool = True) -> tuple[float, int]:
    """Compute all columns of a small grid in this thread; return its core seconds and changes of phase."""
    from fdspec.kernels.storey.history import RESULTS

    warm()
    columns = np.arange(grid.stiffness_ratio.size * grid.period.size)
    started = time.thread_time()
    results, _, _ = run_columns(grid, certify, False, None, columns, motion)
    return time.thread_time() - started, int(results[..., RESULTS.index("transitions")].sum())


def demands_of(grid: Grid) -> tuple[str, ...]:
    """Return what only a cube of frames with devices or of known height has."""
    if not grid.devices:
        return () if grid.storey_height is None else ("peak_drift_ratio",)
    return tuple(name for name in DEMANDS if name != "peak_drift_ratio" or grid.storey_height is not None)


def frames_of(grid: Grid, columns: IntArray) -> FloatArray:
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


def run_columns(
    grid: Grid,
    certify: bool,
    strain: bool,
    other: Method | None,
    columns: IntArray,
    motion: GroundMotion,
    after: After = NOTHING,
) -> Columns:
    """Integrate some (stiffness ratio, period) pairs: all pretensions, never slipping, without brace.

    Each at every intensity, (m, n_i, n_f, results), (m, n_i, results), (bare, n_i, results), in the order of
    RESULTS; where wanted, those of STRAIN follow, save of braced frames.
    """
    levels, slip_force, kinetic = grid.intensities, grid.slip_force, grid.kinetic_slip_force
    run = partial(_run_forces, grid, certify, strain, other, columns, after)
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
    after: After,
    slip_force: FloatArray,
    kinetic: FloatArray,
    motion: GroundMotion,
) -> Columns:
    """Integrate the same under these slip forces, whatever the intensity."""
    from fdspec.engines.batch import integrate_columns

    frames = frames_of(grid, columns)
    exact = slice(None) if other is None and not grid.devices else slice(0)
    free_steps = after.free_steps(motion)
    integrate = partial(integrate_columns, free_steps=free_steps, at_rest=after.at_rest)
    braced, results = integrate(frames, slip_force[exact], kinetic[exact], motion, certify=certify)
    if grid.devices:
        results = _run_devices(grid, frames, slip_force, kinetic, motion, free_steps)
    if other is not None:
        results = integrate_by_method(other, frames, slip_force, kinetic, motion, free_steps)
    bare = frames[columns < grid.period.size].copy()  # the first stiffness ratio's pairs stand for all
    bare[:, 3:] = 0.0
    free, _ = integrate(bare, np.empty(0), np.empty(0), motion, certify=False)
    if strain:
        from fdspec.engines.strain import strain_of_columns

        never = np.array([np.inf]), np.array([0.0])
        added = strain_of_columns(frames, slip_force, kinetic, motion)
        results = np.concatenate([results, added], axis=-1)
        free = np.concatenate([free, strain_of_columns(bare, *never, motion)[:, 0]], axis=-1)
    return results, braced, free


def _run_devices(
    grid: Grid,
    frames: FloatArray,
    slip_force: FloatArray,
    kinetic: FloatArray,
    motion: GroundMotion,
    free_steps: int,
) -> FloatArray:
    """Integrate frames (m, 6) with devices, all pretensions: (m, n_f, results) in the order of `rows_of`."""
    from fdspec.engines.devices import peaks_of

    rows = rows_of(grid)
    results = np.empty((frames.shape[0], grid.pretension.size, len(rows)))
    for i, (m_f, _, k_f, m_d, c_d, k_d) in enumerate(frames):
        for j, forces in enumerate(zip(slip_force, kinetic, strict=True)):
            damping = ModalDamping(grid.damping_ratio)
            building = Building(m_f, k_f, m_d, k_d, *forces, damping, c_d, **grid.devices)
            storey, whole = peaks_of(building, motion, free_steps)
            found = {name: float(values[0]) for name, values in storey.items()} | whole
            results[i, j] = [found[name] for name in rows]
    return results


def rows_of(grid: Grid) -> tuple[str, ...]:
    """Return the results of a history, in their order."""
    from fdspec.kernels.storey.history import RESULTS

    return (*RESULTS, *demands_of(grid)) if grid.devices else (*RESULTS, *STRAIN)
