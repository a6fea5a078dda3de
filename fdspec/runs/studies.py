"""What is done with a study of either kind, of single-storey frames or of buildings: a rule for each kind."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import singledispatch
from typing import TYPE_CHECKING, Any, NamedTuple

import fdspec.runs.sweep as of_frames
import fdspec.runs.sweep_buildings as of_buildings
from fdspec.model.grid import GRID_FIELDS
from fdspec.model.motion import GroundMotion
from fdspec.runs.bounds import seconds_of_sweep
from fdspec.runs.building_study import BuildingStudy
from fdspec.runs.cost import measured as cost_of
from fdspec.runs.cube import chosen
from fdspec.runs.study import Study
from fdspec.scheduling.threads import cores

if TYPE_CHECKING:
    import xarray as xr

Motions = Sequence[GroundMotion]
AnyStudy = Study | BuildingStudy


class Planned(NamedTuple):
    """What a study will take."""

    axes: tuple[tuple[str, int], ...]
    histories: int
    seconds: float
    """Core time, from a measured sample."""
    transitions: float | None
    """Changes of phase of a history, where they were counted."""
    n_bytes: int


@singledispatch
def compute(study: Any, motions: Motions, **how: Any) -> xr.Dataset:
    """Return the cube of a study; how: where and how it is computed, as `sweep` takes it."""
    raise TypeError(f"no study: {type(study).__name__}")


@singledispatch
def parameters(study: Any) -> dict[str, object]:
    """Return the parameters that stand in the study's cube, save its records."""
    raise TypeError(f"no study: {type(study).__name__}")


@singledispatch
def expected(study: Any, motions: Motions) -> float:
    """Return the seconds that the study takes on this machine, rather too many."""
    raise TypeError(f"no study: {type(study).__name__}")


@singledispatch
def rough_seconds(study: Any, motions: Motions) -> float:
    """Return the core time of a study, s, roughly, with nothing computed."""
    raise TypeError(f"no study: {type(study).__name__}")


@singledispatch
def planned(study: Any, motions: Motions) -> Planned:
    """Return what the study will take, of time by a measured sample."""
    raise TypeError(f"no study: {type(study).__name__}")


@singledispatch
def refuse_endless(study: Any, motions: Motions, store: str | os.PathLike[str] | None) -> None:
    """Raise InvalidInput for a study that this machine cannot hold, or that takes longer than the limit."""
    raise TypeError(f"no study: {type(study).__name__}")


@compute.register
def _(study: Study, motions: Motions, **how: Any) -> xr.Dataset:
    grid = {name: getattr(study.grid, name) for name in GRID_FIELDS}
    return of_frames.sweep(motions, **grid, outputs=study.outputs, certify=study.certify, **how)


@compute.register
def _(study: BuildingStudy, motions: Motions, **how: Any) -> xr.Dataset:
    grid = study.grid
    return of_buildings.sweep_buildings(
        motions,
        dict(zip(grid.names, grid.buildings, strict=True)),
        stiffness_scale=grid.stiffness_scale,
        slip_scale=grid.slip_scale,
        outputs=study.outputs,
        certify=study.certify,
        **how,
    )


@parameters.register
def _(study: Study) -> dict[str, object]:
    usual = of_frames.usual_outputs(study.grid)
    outputs = usual if study.outputs is None else study.outputs
    wanted = chosen(outputs, (*usual, *of_frames.ON_REQUEST), study.certify)
    return {**study.grid.parameters, "certify": study.certify, "outputs": list(wanted)}


@parameters.register
def _(study: BuildingStudy) -> dict[str, object]:
    wanted = chosen(study.outputs, of_buildings.known_outputs(study.grid), study.certify)
    return of_buildings.parameters_of(study.grid, wanted, study.certify)


@expected.register
def _(study: Study, motions: Motions) -> float:
    return of_frames.measured(motions, study.grid, study.certify)


@expected.register
def _(study: BuildingStudy, motions: Motions) -> float:
    return of_buildings.measured(motions, study.grid, study.certify) / cores()


@rough_seconds.register
def _(study: Study, motions: Motions) -> float:
    return sum(seconds_of_sweep(study.grid, motions, study.certify))


@rough_seconds.register
def _(study: BuildingStudy, motions: Motions) -> float:
    return of_buildings.rough_seconds(motions, study.grid)


@planned.register
def _(study: Study, motions: Motions) -> Planned:
    n_sr, n_f, n_t = study.grid.shape
    cost = cost_of(study.grid, motions, study.certify)
    samples = sum(motion.n for motion in motions)
    sizes = of_frames.bytes_of(motions, study.grid, study.outputs or of_frames.usual_outputs(study.grid))
    return Planned(
        (("stiffness ratios", n_sr), ("pretensions", n_f), ("periods", n_t)),
        len(motions) * study.grid.size,
        cost.of_sweep(study.grid, motions),
        cost.transitions_per_sample * samples / len(motions),
        sum(sizes.values()),
    )


@planned.register
def _(study: BuildingStudy, motions: Motions) -> Planned:
    n_b, n_k, n_s = study.grid.shape
    sizes = of_buildings.bytes_of(
        motions, study.grid, study.outputs or of_buildings.known_outputs(study.grid)
    )
    return Planned(
        (
            ("buildings", n_b),
            ("storeys", study.grid.n_storeys),
            ("stiffness scales", n_k),
            ("slip scales", n_s),
        ),
        len(motions) * n_b * n_k * n_s,
        of_buildings.measured(motions, study.grid, study.certify),
        None,
        sum(sizes.values()),
    )


@refuse_endless.register
def _(study: Study, motions: Motions, store: str | os.PathLike[str] | None) -> None:
    rough = rough_seconds(study, motions)
    of_frames.refuse_endless(
        motions, study.grid, study.outputs or of_frames.usual_outputs(study.grid), rough, store
    )


@refuse_endless.register
def _(study: BuildingStudy, motions: Motions, store: str | os.PathLike[str] | None) -> None:
    of_buildings.refuse_endless(
        motions, study.grid, study.outputs or of_buildings.known_outputs(study.grid), store
    )
