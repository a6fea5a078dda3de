"""What every cube has, whatever is swept: records as a coordinate, chosen outputs, provenance."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import xarray as xr

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.store import provenance
from fdspec.variables import Registry, describe


def named(motions: GroundMotion | Sequence[GroundMotion]) -> tuple[GroundMotion, ...]:
    """Return the motions, one or many, whose names differ."""
    given = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    if not given:
        raise InvalidInput("motions must hold at least one GroundMotion, is empty")
    for k, motion in enumerate(given):
        if not isinstance(motion, GroundMotion):
            raise InvalidInput(f"motions[{k}] must be a GroundMotion, got {type(motion).__name__}")
    seen = set()
    for motion in given:
        if motion.name in seen:
            raise InvalidInput(f"motions must have different names, {motion.name!r} stands twice")
        seen.add(motion.name)
    return given


def chosen(outputs: Iterable[str] | None, known: Sequence[str], certify: bool) -> tuple[str, ...]:
    """Return the outputs asked for, in the order of the known ones, and the status in any case."""
    names = known if outputs is None else tuple(outputs)
    for name in names:
        if name not in known:
            raise InvalidInput(f"outputs: {name!r} is none of {', '.join(known)}")
    kept = tuple(name for name in known if name in (*names, "status"))
    return kept if certify else tuple(name for name in kept if name != "energy_error")


def assemble(
    variables: Mapping[str, Any],
    axes: Mapping[str, Any],
    registry: Registry,
    motions: Sequence[GroundMotion],
    *,
    title: str,
    parameters: Mapping[str, object],
    command: str,
) -> xr.Dataset:
    """Return the cube of these variables, name -> values, with dims and attributes from the registry.

    axes: name -> values of the coordinates beside those of the records.
    """
    coordinates = {"record": [motion.name for motion in motions], **axes, **_told(motions)}
    dataset = xr.Dataset(
        {name: (registry[name].dims, values) for name, values in variables.items()},
        coords={name: (registry[name].dims, values) for name, values in coordinates.items()},
    )
    dataset.attrs = provenance(title, parameters, motions, command=command)
    return describe(dataset, registry)


def _told(motions: Sequence[GroundMotion]) -> dict[str, list[Any]]:
    return {
        "pga": [motion.pga for motion in motions],
        "dt": [motion.dt for motion in motions],
        "duration": [motion.duration for motion in motions],
        "samples": [motion.n for motion in motions],
        "scale_factor": [motion.scale_factor for motion in motions],
        "event": [motion.event for motion in motions],
        "station": [motion.station for motion in motions],
        "component": [motion.component for motion in motions],
        "source": [motion.source for motion in motions],
        "history": ["; ".join(motion.history) for motion in motions],
        "checksum": [motion.checksum for motion in motions],
    }
