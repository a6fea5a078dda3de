"""The histories of a record in a cube of buildings.

They have numbers: cells first, then braced buildings, then bare frames; see `fdspec.runs.building_cube.ends`.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from fdspec.engines.trajectory import Span
from fdspec.model.building import Building, Frame
from fdspec.model.building_grid import BuildingGrid
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After
from fdspec.runs.building_cube import LINKS, ends, links_of, of_all_length, rows_of, with_devices

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def warm(grid: BuildingGrid) -> None:
    """Load the kernels that these buildings need, compiling them where no cache holds them."""
    from fdspec.engines.frames import runs_beside_others

    if not all(runs_beside_others(building.frame) for building in grid.buildings):
        import fdspec.engines.many_storeys
    if with_devices(grid):
        import fdspec.engines.devices  # noqa: F401


def run_histories(
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
    by_storey = np.empty((histories.size, len(rows_of(grid)), grid.n_storeys))
    totals = np.empty((histories.size, of_all_length(grid)))
    for level in np.unique(levels).tolist():
        at, s = levels == level, float(grid.intensities[level])
        shaken = motion if s == 1.0 else motion.times(s)
        by_storey[at], totals[at] = _run_level(grid, certify, of_level[at], shaken, after, alone)
    return by_storey, totals


def _run_level(
    grid: BuildingGrid,
    certify: bool,
    histories: IntArray,
    motion: GroundMotion,
    after: After,
    alone: bool,
) -> tuple[FloatArray, FloatArray]:
    """Integrate the same, all at the intensity of this motion."""
    if alone or with_devices(grid):
        results = [_run_one(grid, certify, int(history), motion, after, alone) for history in histories]
        of_all = np.zeros((histories.size, of_all_length(grid)))
        for row, (_, whole) in zip(of_all, results, strict=True):
            row[: whole.size] = whole  # an elastic limit has nothing of links
        return np.stack([rows for rows, _ in results]), of_all
    from fdspec.engines.frames import peaks_of_frames
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTALS

    frames = [frame_of(grid, int(history)) for history in histories]
    by_storey = np.empty((len(frames), len(STOREY_RESULTS), grid.n_storeys))
    totals = np.empty((len(frames), len(TOTALS)))
    cells = histories < ends(grid)[0]
    for of, certified in ((cells, certify), (~cells, False)):
        if of.any():
            chosen_frames = [frame for frame, is_one in zip(frames, of, strict=True) if is_one]
            by_storey[of], totals[of] = peaks_of_frames(chosen_frames, motion, certify=certified)
    return by_storey, totals


def _run_one(
    grid: BuildingGrid, certify: bool, history: int, motion: GroundMotion, after: After, alone: bool
) -> tuple[FloatArray, FloatArray]:
    """Integrate one history by its building's engine: rows of `rows_of` (rows, N); TOTALS and links.

    The limits that ride along are those of the elastic frame. Beside a building with devices, one without
    is integrated by both engines: its peaks are those of the engine of frames, to the bit.
    """
    from fdspec.kernels.frame.results import DEMANDS as FIRST_DEMAND
    from fdspec.kernels.frame.results import RESULT, STOREY_RESULTS, TOTALS

    cell = history < ends(grid)[0]
    free_steps = after.free_steps(motion)
    if after.at_rest and cell:
        return _run_to_rest(grid, certify, history, motion, free_steps)
    by_frames = partial(
        _of_frame, motion=motion, certify=certify and cell, free_steps=free_steps, alone=alone
    )
    if not (cell and with_devices(grid)):
        by_storey, totals = by_frames(frame_of(grid, history))
        missing = np.zeros((len(rows_of(grid)) - len(STOREY_RESULTS), grid.n_storeys))
        return np.concatenate([by_storey, missing]), totals
    from fdspec.engines.devices import results_of as results_with_devices

    building = building_of(grid, history)
    storeys, whole, links = results_with_devices(building, motion, free_steps)
    table = np.stack([storeys[name] for name in rows_of(grid)])
    totals = np.array([whole[name] for name in TOTALS])
    if not building.has_devices:
        by_storey, totals = by_frames(frame_of(grid, history))
        table[:FIRST_DEMAND] = by_storey[:FIRST_DEMAND]
        if "peak_base_shear" in rows_of(grid):
            table[rows_of(grid).index("peak_base_shear")] = by_storey[RESULT.peak_storey_shear][0]
    if links_of(grid):
        totals = np.concatenate([totals, *(links[name] for name in LINKS)])
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
    rest = rest_of_building(building_of(grid, history), motion, Span(free_steps, motion.dt, 1), at_start)
    table, totals = peaks_of(
        frame_of(grid, history), motion, certify=certify, free_steps=free_steps + rest.steps
    )
    table[RESULT.residual_displacement] = rest.displacement
    table[RESULT.residual_slip] = rest.slip
    if rest.status != 0:
        totals[TOTAL.status] = rest.status
    return table, totals


def frame_of(grid: BuildingGrid, history: int) -> Frame:
    """Return the building of one history as the kernel takes it: its dampers scaled, held or taken away."""
    from fdspec.kernels.frame import model as row

    _, n_k, n_s = grid.shape
    cells, braced, _ = ends(grid)
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
    given = given._replace(properties=properties)
    return given if grid.buildings[b].is_one_frame else _with_braces_in(grid.buildings[b], given)


def _with_braces_in(building: Building, given: Frame) -> Frame:
    """Return frames beside each other, whose dampers never slip, as one whose braces are part of it."""
    from fdspec.kernels.frame import model as row

    properties = given.properties.copy()
    properties[row.FLOOR_MASS] += properties[row.BRACE_MASS]
    braces = (row.BRACE_MASS, row.BRACE_STIFFNESS, row.BRACE_DAMPING, row.SLIP_FORCE, row.KINETIC_SLIP_FORCE)
    properties[list(braces)] = 0.0
    stiffness = building.stiffness_matrix + building.spring_matrix(given.properties[row.BRACE_STIFFNESS])
    damping = building.damping_matrix + building.spring_matrix(given.properties[row.BRACE_DAMPING])
    springs = (row.STOREY_STIFFNESS, row.GROUND_STIFFNESS, row.STOREY_DAMPING, row.GROUND_DAMPING)
    properties[list(springs)] = 0.0
    return Frame(properties, stiffness, damping)


def building_of(grid: BuildingGrid, history: int) -> Building:
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
