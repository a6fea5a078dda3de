"""What is done with a study of either kind, of single-storey frames or of buildings.

What buildings need is imported where one is met: a study of frames starts without it.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import fdspec.runs.sweep as of_frames
from fdspec.model.grid import GRID_FIELDS
from fdspec.model.motion import GroundMotion
from fdspec.runs.cost import seconds_of_sweep
from fdspec.runs.cube import chosen
from fdspec.runs.pilot import measured as cost_of
from fdspec.runs.pilot import wall_seconds
from fdspec.runs.study import Study
from fdspec.scheduling.task import cores

if TYPE_CHECKING:
    import xarray as xr

    from fdspec.runs.building_study import BuildingStudy

    AnyStudy = Study | BuildingStudy

Motions = Sequence[GroundMotion]


class Planned(NamedTuple):
    """What a study will take."""

    axes: tuple[tuple[str, int], ...]
    histories: int
    seconds: float
    """Core time, from a measured sample."""
    transitions: float | None
    """Changes of phase of a history, where they were counted."""
    n_bytes: int


def compute(study: AnyStudy, motions: Motions, **how: Any) -> xr.Dataset:
    """Return the cube of a study; how: where and how it is computed, as `fdspec.sweep` takes it."""
    grid = study.grid
    what: dict[str, Any] = {"outputs": study.outputs, "certify": study.certify, **how}
    what |= {"free_vibration": study.after.free_vibration, "at_rest": study.after.at_rest}
    if isinstance(study, Study):
        return of_frames.sweep(motions, **{name: getattr(grid, name) for name in GRID_FIELDS}, **what)
    import fdspec.runs.sweep_buildings as of_buildings

    return of_buildings.sweep_buildings(
        motions,
        dict(zip(study.grid.names, study.grid.buildings, strict=True)),
        stiffness_scale=study.grid.stiffness_scale,
        slip_scale=study.grid.slip_scale,
        intensity=study.grid.intensity,
        **what,
    )


def outputs_of(study: AnyStudy) -> tuple[str, ...]:
    """Return the variables of the study's cube, in their order."""
    if isinstance(study, Study):
        usual = of_frames.usual_outputs(study.grid)
        known = (*usual, *of_frames.ON_REQUEST)
    else:
        from fdspec.runs import building_cube

        usual, known = (
            building_cube.usual_outputs(study.grid, study.after),
            building_cube.known_outputs(study.grid),
        )
    return chosen(usual if study.outputs is None else study.outputs, known, study.certify)


def parameters(study: AnyStudy) -> dict[str, object]:
    """Return the parameters that stand in the study's cube, save its records."""
    outputs = outputs_of(study)
    if isinstance(study, Study):
        told = {**study.grid.parameters, "certify": study.certify, "outputs": list(outputs)}
    else:
        from fdspec.runs import building_cube

        told = building_cube.parameters_of(study.grid, outputs, study.certify)
    return {**told, **study.after.parameters}


def expected(study: AnyStudy, motions: Motions) -> float:
    """Return the seconds that the study takes on this machine, rather too many."""
    if isinstance(study, Study):
        return study.after.times(motions) * wall_seconds(motions, study.grid, study.certify)
    return study.after.times(motions) * _measured(study, motions) / cores()


def rough_seconds(study: AnyStudy, motions: Motions) -> float:
    """Return the core time of a study, s, roughly, with nothing computed."""
    times = study.after.times(motions)
    if isinstance(study, Study):
        return times * sum(seconds_of_sweep(study.grid, motions, study.certify))
    import fdspec.runs.sweep_buildings as of_buildings

    return times * of_buildings.rough_seconds(motions, study.grid)


def _measured(study: BuildingStudy, motions: Motions) -> float:
    import fdspec.runs.sweep_buildings as of_buildings

    return of_buildings.measured(motions, study.grid, study.certify, outputs_of(study))


def with_intensity(study: AnyStudy, intensity: Sequence[float]) -> AnyStudy:
    """Return the same study over these factors on its records."""
    if isinstance(study, Study):
        return replace(study, grid=replace(study.grid, intensity=intensity))  # type: ignore[arg-type]
    return replace(study, grid=study.grid.with_intensity(list(intensity)))


def refuse_endless(study: AnyStudy, motions: Motions, store: str | os.PathLike[str] | None) -> None:
    """Raise InvalidInput for a study that this machine cannot hold, or that takes longer than the limit."""
    outputs = outputs_of(study)
    if isinstance(study, Study):
        of_frames.refuse_endless(motions, study.grid, outputs, rough_seconds(study, motions), store)
    else:
        import fdspec.runs.sweep_buildings as of_buildings

        of_buildings.refuse_endless(motions, study.grid, outputs, store)


def planned(study: AnyStudy, motions: Motions) -> Planned:
    """Return what the study will take, of time by a measured sample."""
    outputs = outputs_of(study)
    if isinstance(study, Study):
        n_sr, n_f, n_t = study.grid.shape
        cost = cost_of(study.grid, motions, study.certify)
        samples = sum(motion.n for motion in motions)
        intensity = study.grid.intensity
        levels = () if intensity is None else (("intensities", intensity.size),)
        return Planned(
            (*levels, ("stiffness ratios", n_sr), ("pretensions", n_f), ("periods", n_t)),
            len(motions) * study.grid.size,
            study.after.times(motions) * cost.of_sweep(study.grid, motions),
            cost.transitions_per_sample * samples / len(motions),
            sum(of_frames.bytes_of(motions, study.grid, outputs).values()),
        )
    from fdspec.runs import building_cube

    intensity = study.grid.intensity
    levels = () if intensity is None else (("intensities", intensity.size),)
    n_b, n_k, n_s = study.grid.shape
    storeys = study.grid.n_storeys
    return Planned(
        (*levels, ("buildings", n_b), ("storeys", storeys), ("stiffness scales", n_k), ("slip scales", n_s)),
        len(motions) * study.grid.intensities.size * n_b * n_k * n_s,
        study.after.times(motions) * _measured(study, motions),
        None,
        sum(building_cube.bytes_of(motions, study.grid, outputs).values()),
    )
