"""The cube of N-storey buildings: which outputs it has, how large it is, where results stand in it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from fdspec.model.building_grid import BuildingGrid
from fdspec.model.motion import GroundMotion
from fdspec.runs.after import NOTHING, After
from fdspec.scheduling.task import Task
from fdspec.variables import (
    BUILDING_CUBE,
    BUILDING_DIMS,
    INTENSITY_BUILDING_CUBE,
    Registry,
    device_variables,
    link_variables,
)

FloatArray = NDArray[np.float64]

CELLS: Final = BUILDING_DIMS[1:]
"""The dims of a record's histories, the last fastest."""

LIMITS: Final = ("elastic_acceleration", "braced_acceleration")
DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""Outputs of sweeps with devices alone."""
LINKS: Final = tuple(v.name for v in link_variables(()))
"""Outputs of sweeps whose buildings have the same links."""
RESPONSES: Final = tuple(
    v.name for v in BUILDING_CUBE.values() if v.dims[:4] == BUILDING_DIMS and v.name not in (*DEMANDS, *LINKS)
)
OUTPUTS: Final = (*(name for name in RESPONSES if not BUILDING_CUBE[name].on_request), *LIMITS)
ON_REQUEST: Final = tuple(name for name in RESPONSES if BUILDING_CUBE[name].on_request)
"""Outputs that are computed only where they are named, or where each history is integrated by itself.

Histories that run side by side leave them out.
"""


def usual_outputs(grid: BuildingGrid, after: After = NOTHING) -> tuple[str, ...]:
    """Return what a sweep of these buildings computes unless it is told otherwise."""
    by_itself = after != NOTHING or with_devices(grid)
    return known_outputs(grid) if by_itself else (*OUTPUTS, *demands_of(grid))


def known_outputs(grid: BuildingGrid) -> tuple[str, ...]:
    """Return what can be computed of these buildings: of devices, where there are some."""
    return (*OUTPUTS, *ON_REQUEST, *demands_of(grid))


def demands_of(grid: BuildingGrid) -> tuple[str, ...]:
    """Return what only a cube with devices in it, or of known heights, has of each storey."""
    known = all(not np.isnan(building.storey_height).any() for building in grid.buildings)
    if not with_devices(grid):
        return ("peak_drift_ratio",) if known else ()
    of_storeys = tuple(name for name in DEMANDS if known or name != "peak_drift_ratio")
    return (*of_storeys, *(LINKS if links_of(grid) else ()))


def links_of(grid: BuildingGrid) -> tuple[str, ...]:
    """Return the names of the links; none where buildings differ in them: there is no axis for all then."""
    names = {building.link_names for building in grid.buildings}
    return names.pop() if len(names) == 1 else ()


def with_devices(grid: BuildingGrid) -> bool:
    """Whether any building has devices: then all cells have the results that devices add."""
    return any(building.has_devices for building in grid.buildings)


def is_alone(grid: BuildingGrid, wanted: Sequence[str], after: After) -> bool:
    """Whether each history is integrated by itself, for what those side by side leave out."""
    return after != NOTHING or (not with_devices(grid) and bool(set(ON_REQUEST) & set(wanted)))


def registry_for(grid: BuildingGrid) -> Registry:
    """Return the variables of this grid's cube."""
    return BUILDING_CUBE if grid.intensity is None else INTENSITY_BUILDING_CUBE


def rows_of(grid: BuildingGrid) -> tuple[str, ...]:
    """Return the names of what each storey has of its own."""
    from fdspec.kernels.frame.results import STOREY_RESULTS

    of_devices = [name for name in demands_of(grid) if name not in LINKS] if with_devices(grid) else ()
    # Where several frames stand on the ground, the shear there is none of a storey's.
    on_ground = () if all(building.is_one_frame for building in grid.buildings) else ("peak_base_shear",)
    return (*STOREY_RESULTS, *of_devices, *on_ground)


def of_all_length(grid: BuildingGrid) -> int:
    """Return how many numbers a history has beside those of storeys: TOTALS, then LINKS link by link."""
    from fdspec.kernels.frame.results import TOTALS

    return len(TOTALS) + len(LINKS) * len(links_of(grid))


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


def axes_of(grid: BuildingGrid) -> dict[str, object]:
    """Return the coordinates of this grid's cube."""
    return {
        "building": list(grid.names),
        "stiffness_scale": grid.stiffness_scale,
        "slip_scale": grid.slip_scale,
        **({} if grid.intensity is None else {"intensity": grid.intensity}),
        "storey": np.arange(1, grid.n_storeys + 1),
        "slip_force": grid.slip_force,
        "kinetic_slip_force": grid.kinetic_slip_force,
        **_standing(grid),
        **({"link": list(links_of(grid))} if links_of(grid) else {}),
        "brace_stiffness": grid.brace_stiffness,
        "bare_period": [float(building.bare_periods[0]) for building in grid.buildings],
        "braced_period": grid.braced_period,
    }


def _standing(grid: BuildingGrid) -> dict[str, object]:
    """Return the floors that storeys stand on, where any building has frames beside each other."""
    if all(building.is_one_frame for building in grid.buildings):
        return {}
    return {"stands_on": [building.stands_on for building in grid.buildings]}


def bytes_of(motions: Sequence[GroundMotion], grid: BuildingGrid, outputs: Iterable[str]) -> dict[str, int]:
    """Bytes of each variable of the cube."""
    lengths = dict(zip(BUILDING_DIMS, (len(motions), *grid.shape), strict=True))
    lengths |= {"storey": grid.n_storeys, "intensity": grid.intensities.size, "link": len(links_of(grid))}
    registry = registry_for(grid)
    return {
        name: math.prod(lengths[dim] for dim in registry[name].dims) * np.dtype(registry[name].dtype).itemsize
        for name in outputs
    }


def ends(grid: BuildingGrid) -> tuple[int, int, int]:
    """Where histories of a record at one intensity end: of cells, of braced buildings, of bare frames."""
    n_b, n_k, n_s = grid.shape
    cells = n_b * n_k * n_s
    return cells, cells + n_b * n_k, cells + n_b * n_k + n_b


def variables_of(
    grid: BuildingGrid,
    rows: Sequence[str],
    n_r: int,
    tasks: Sequence[Task],
    parts: Sequence[tuple[FloatArray, FloatArray]],
    wanted: Sequence[str],
) -> dict[str, NDArray[np.generic]]:
    """Put what the tasks returned where it stands in the cube."""
    from fdspec.kernels.frame.results import TOTALS

    cells, braced, bare = ends(grid)
    n_i = grid.intensities.size
    histories = 1 + max(int(task.items.max()) for task in tasks)
    by_storey = np.empty((len(rows), n_r, histories, grid.n_storeys))
    # The tasks' grid may be a whole of which this one is a part, so how many links it has is told by them.
    length = parts[0][1].shape[1]
    n_links = (length - len(TOTALS)) // len(LINKS)
    totals = np.empty((length, n_r, histories))
    for (r, items), (of_storeys, of_all) in zip(tasks, parts, strict=True):
        by_storey[:, r, items] = of_storeys.transpose(1, 0, 2)
        totals[:, r, items] = of_all.T
    levels = (n_r, n_i, histories // n_i)
    results = dict(zip(rows, by_storey.reshape(len(rows), *levels, grid.n_storeys), strict=True))
    of_histories, of_links = np.split(totals.reshape(-1, *levels), [len(TOTALS)])
    results |= dict(zip(TOTALS, of_histories, strict=True))
    if n_links:
        each = of_links.reshape(len(LINKS), n_links, *levels)
        results |= dict(zip(LINKS, np.moveaxis(each, 1, -1), strict=True))
    results["peak_base_shear"] = results.get("peak_base_shear", results["peak_storey_shear"])[..., 0]
    n_b, n_k, n_s = grid.shape
    residual = results["residual_displacement"][:, :, :cells]
    of_buildings = residual.reshape(n_r, n_i, n_b, n_k * n_s, grid.n_storeys)
    results["residual_drift"] = np.stack(
        [building.drifts(of_buildings[:, :, b]) for b, building in enumerate(grid.buildings)], axis=2
    ).reshape(residual.shape)
    if "peak_drift_ratio" in wanted and "peak_drift_ratio" not in results:
        height = np.stack([building.storey_height for building in grid.buildings])
        drift = results["peak_drift"][:, :, :cells].reshape(n_r, n_i, n_b, n_k * n_s, grid.n_storeys)
        results["peak_drift_ratio"] = (drift / height[:, np.newaxis]).reshape(n_r, n_i, cells, -1)
    acceleration = results["peak_acceleration"]
    limits = {
        "elastic_acceleration": acceleration[:, :, braced:bare],
        "braced_acceleration": acceleration[:, :, cells:braced],
    }
    lengths = {"record": n_r, "building": n_b, "stiffness_scale": n_k, "slip_scale": n_s}
    lengths |= {"storey": grid.n_storeys, "intensity": n_i, "link": n_links}
    registry = registry_for(grid)
    variables: dict[str, NDArray[np.generic]] = {}
    for name in wanted:
        variable = registry[name]
        values = limits[name] if name in limits else results[name][:, :, :cells]
        shape = [lengths[dim] for dim in variable.dims]
        variables[name] = values.reshape(shape).astype(variable.dtype)
    return variables
