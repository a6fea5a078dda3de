"""The engine for buildings with devices: hands the kernel its arrays and takes them back."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fdspec.engines.trajectory import DeviceTrajectory, FloatArray, IntArray, Span, TrajectoryWithDevices
from fdspec.kernels.devices import layout as row
from fdspec.kernels.devices.history import RADIANS, TOTALS, integrate
from fdspec.kernels.devices.output import FLOOR_TRACES, LINK_TRACES, TOTAL_TRACES
from fdspec.kernels.devices.peaks import (
    PEAK_ACCELERATION,
    PEAK_DISPLACEMENT,
    PEAK_DRIFT,
    PEAK_ROWS,
    PEAK_SHEAR,
    PEAK_VELOCITY,
)
from fdspec.model.building import Building
from fdspec.model.device_frame import DeviceFrame
from fdspec.model.motion import GroundMotion
from fdspec.variables import device_variables

DEMANDS = tuple(variable.name for variable in device_variables(()))
"""What only the results of buildings with devices have of each storey."""


class Outcome(NamedTuple):
    """What one run of the kernel leaves."""

    floors: FloatArray
    sliders: FloatArray
    mode: IntArray
    tally: FloatArray
    peaks: FloatArray
    totals: dict[str, float]

    @property
    def end(self) -> FloatArray:
        """The state at the end, from which another history goes on."""
        return np.concatenate([self.floors.ravel(), self.sliders.ravel(), self.mode.ravel()])


class Traces(NamedTuple):
    """Room for the trajectory."""

    log_times: FloatArray
    log: IntArray
    floors: FloatArray
    links: FloatArray
    energies: FloatArray


def _room(changes: int, outputs: int, size: int, links: int) -> Traces:
    return Traces(
        np.empty(changes),
        np.empty((2, changes), np.int64),
        np.full((outputs, len(FLOOR_TRACES), size), np.nan),
        np.full((outputs, len(LINK_TRACES), links), np.nan),
        np.full((outputs, len(TOTAL_TRACES)), np.nan),
    )


def run(
    frame: DeviceFrame,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    traces: Traces | None = None,
    resume: FloatArray | None = None,
    *,
    radians: float = RADIANS,
    extra_terms: int = 0,
) -> Outcome:
    """Integrate a frame with devices once.

    start: displacement and velocity of floors and braces, (2, 2, N), m and m/s.  resume: the end of another
    history (`Outcome.end`), to go on from in place of the start.  radians: longest phase of a
    step; extra_terms: terms of the series beyond those that rounding leaves; neither moves a result.
    """
    size = frame.mass.size - 1
    links = frame.places.shape[1]
    floors = np.zeros((2, size + 1))
    floors[:, 1:] = start[:, 0]
    sliders = np.zeros((2, links))
    sliders[0] = frame.fastened
    for storey in np.flatnonzero(frame.dampers >= 0):
        j = frame.dampers[storey]
        sliders[0, j] = start[0, 0, storey] - start[0, 1, storey]
        if frame.places[row.KIND, j] == row.WITH_MASS:
            sliders[1, j] = start[1, 0, storey] - start[1, 1, storey]
    mode = np.zeros((row.MODE_ROWS, links), np.int64)
    if resume is not None:
        parts = np.split(resume, np.cumsum([floors.size, sliders.size]))
        floors, sliders = parts[0].reshape(floors.shape).copy(), parts[1].reshape(sliders.shape).copy()
        mode = np.ascontiguousarray(parts[2].reshape(mode.shape), dtype=np.int64)
    tally = np.empty((row.TALLY_ROWS, links))
    peaks = np.empty((PEAK_ROWS, frame.carried.shape[0]))
    totals = np.empty(len(TOTALS))
    room = _room(0, 0, size, links) if traces is None else traces
    integrate(
        *frame[:10],
        motion.acceleration,
        motion.dt,
        span.free_steps,
        radians,
        extra_terms,
        resume is not None,
        floors,
        sliders,
        mode,
        room.log_times,
        room.log,
        span.dt_out,
        room.floors,
        room.links,
        room.energies,
        tally,
        peaks,
        totals,
    )
    return Outcome(floors, sliders, mode, tally, peaks, dict(zip(TOTALS, totals.tolist(), strict=True)))


def integrate_devices(
    building: Building,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    resume: FloatArray | None = None,
    *,
    radians: float = RADIANS,
    extra_terms: int = 0,
) -> TrajectoryWithDevices:
    """Integrate a building with devices; arguments as for `run`."""
    frame = building.device_frame
    size = building.n_storeys
    links = frame.places.shape[1]
    # Twice: how many changes of phase there are is known at the end.
    options: dict[str, Any] = {"radians": radians, "extra_terms": extra_terms}
    first = run(frame, motion, span, start, None, resume, **options)
    traces = _room(int(first.totals["events"]), span.outputs, size, links)
    outcome = run(frame, motion, span, start, traces, resume, **options)
    return _trajectory(building, frame, traces, outcome)


def _of_storeys(values: FloatArray, places: IntArray, absent: float = 0.0) -> FloatArray:
    """Take, along the last axis, what belongs to each storey's damper or columns."""
    taken = np.full((*values.shape[:-1], places.size), absent)
    there = places >= 0
    taken[..., there] = values[..., places[there]]
    return taken


def peaks_of(
    building: Building, motion: GroundMotion, free_steps: int = 0
) -> tuple[dict[str, FloatArray], dict[str, float]]:
    """Integrate a building from rest, without its trajectory.

    Returns what each storey has of its own by name, (N,), and what the building has: ``transitions``,
    energies, ``energy_error``, ``status``.
    """
    return results_of(building, motion, free_steps)[:2]


def results_of(
    building: Building, motion: GroundMotion, free_steps: int = 0
) -> tuple[dict[str, FloatArray], dict[str, float], dict[str, FloatArray]]:
    """Return the same, and what each link has of its own by name, (M,)."""
    frame = building.device_frame
    span = Span(free_steps, motion.dt, 1)
    outcome = run(frame, motion, span, np.zeros((2, 2, building.n_storeys)))
    storeys = storey_results(building, frame, outcome)
    totals = {
        "transitions": float(storeys["storey_transitions"].sum()),
        "dissipated_energy": _friction(frame, outcome),
        "viscous_energy": outcome.totals["viscous_energy"],
        "input_energy": outcome.totals["input_energy"],
        "energy_error": outcome.totals["energy_error"],
        "status": outcome.totals["status"],
    }
    return storeys, totals, link_results(frame, outcome)


def link_results(frame: DeviceFrame, outcome: Outcome) -> dict[str, Any]:
    """Return what each of the building's links has at the end of a history, by name, (M,)."""
    tally, others = outcome.tally, frame.others
    return {
        "peak_link_slip": tally[row.PEAK_SLIP, others],
        "residual_link_slip": outcome.sliders[0, others],
        "peak_link_force": tally[row.PEAK_FORCE, others],
        "link_energy": tally[row.WORK, others],
        "link_events": tally[row.EVENTS, others].astype(np.int64),
        "link_contacts": tally[row.CONTACTS, others].astype(np.int64),
    }


def _friction(frame: DeviceFrame, outcome: Outcome) -> float:
    """Energy (J) dissipated in all dampers and links."""
    work = outcome.tally[row.WORK]
    return float(work.sum() - work[frame.columns[frame.columns >= 0]].sum())


def storey_results(building: Building, frame: DeviceFrame, outcome: Outcome) -> dict[str, FloatArray]:
    """Return what each storey has of its own at the end of a history, by name, (N,)."""
    dampers, columns = frame.dampers, frame.columns
    size = dampers.size
    tally, peaks = outcome.tally, outcome.peaks[:, :size]
    displacement = outcome.floors[0, 1:].copy()
    offset = _of_storeys(outcome.sliders[0], dampers)
    can_yield = columns >= 0
    peak_deformation = np.where(can_yield, peaks[PEAK_DRIFT], 0.0)
    share = np.where(can_yield, building.hardening_ratio, 1.0)
    elastic_shear = share * frame_stiffness(building) * peaks[PEAK_DRIFT]
    return {
        "peak_acceleration": peaks[PEAK_ACCELERATION],
        "peak_displacement": peaks[PEAK_DISPLACEMENT],
        "peak_velocity": peaks[PEAK_VELOCITY],
        "peak_drift": peaks[PEAK_DRIFT],
        "peak_storey_shear": peaks[PEAK_SHEAR],
        # On the ground: of the first storey, of all frames where several stand there.
        "peak_base_shear": np.full(
            size, outcome.peaks[PEAK_SHEAR, size if outcome.peaks.shape[1] > size else 0]
        ),
        "peak_brace_displacement": np.where(
            dampers >= 0, _of_storeys(tally[row.PEAK_TOP], dampers), peaks[PEAK_DISPLACEMENT]
        ),
        "residual_displacement": displacement,
        "residual_brace_displacement": displacement - offset,
        "slip_travel": _of_storeys(tally[row.TRAVEL], dampers),
        "storey_transitions": _of_storeys(tally[row.EVENTS], dampers),
        "storey_friction_energy": _of_storeys(tally[row.WORK], dampers),
        "peak_slip": _of_storeys(tally[row.PEAK_SLIP], dampers),
        "residual_slip": offset,
        "peak_brace_force": _of_storeys(tally[row.PEAK_FORCE], dampers),
        "peak_column_shear": np.where(can_yield, _of_storeys(tally[row.PEAK_FORCE], columns), elastic_shear),
        "peak_column_deformation": peak_deformation,
        "plastic_drift": _of_storeys(outcome.sliders[0], columns),
        "ductility": peak_deformation * frame_stiffness(building) / building.yield_shear,
        "column_energy": _of_storeys(tally[row.WORK], columns),
        "column_events": _of_storeys(tally[row.EVENTS], columns),
        "slot_events": _of_storeys(tally[row.CONTACTS], dampers),
        "peak_drift_ratio": peaks[PEAK_DRIFT] / building.storey_height,
    }


def _trajectory(
    building: Building, frame: DeviceFrame, traces: Traces, outcome: Outcome
) -> TrajectoryWithDevices:
    floor = {name: traces.floors[:, i] for i, name in enumerate(FLOOR_TRACES)}
    link = {name: traces.links[:, i] for i, name in enumerate(LINK_TRACES)}
    energy = {name: traces.energies[:, i] for i, name in enumerate(TOTAL_TRACES)}
    dampers, columns, others = frame.dampers, frame.columns, frame.others
    storey_of = np.full(frame.places.shape[1], -1)
    storey_of[dampers[dampers >= 0]] = np.flatnonzero(dampers >= 0)
    ours = storey_of[traces.log[0]] >= 0
    totals = outcome.totals
    result = storey_results(building, frame, outcome)
    drift = building.drifts(floor["displacement"])
    elastic = np.where(columns >= 0, building.hardening_ratio, 1.0) * frame_stiffness(building)
    storey = int(totals["collapse_storey"])
    devices = DeviceTrajectory(
        brace_force=_of_storeys(link["force"], dampers),
        column_shear=elastic * drift + _of_storeys(link["force"], columns),
        plastic_deformation=_of_storeys(link["offset"], columns),
        kinetic_energy=energy["kinetic_energy"],
        strain_energy=energy["strain_energy"],
        bearing_energy=energy["bearing_energy"],
        gravity_energy=energy["gravity_energy"],
        column_work=_of_storeys(link["work"], columns),
        link_slip=link["offset"][:, others],
        link_force=link["force"][:, others],
        link_phase=np.nan_to_num(link["phase"][:, others]).astype(np.int64),
        link_work=link["work"][:, others],
        storeys={name: result[name] for name in DEMANDS},
        **link_results(frame, outcome),
        collapse_storey=storey + 1,
        collapse_time=totals["collapse_time"],
        collapse_drift=float(frame.drift_limit[storey]) if storey >= 0 else np.inf,
    )
    displacement, velocity = floor["displacement"], floor["velocity"]
    return TrajectoryWithDevices(
        displacement=np.ascontiguousarray(displacement),
        velocity=np.ascontiguousarray(velocity),
        acceleration=np.ascontiguousarray(floor["acceleration"]),
        brace_displacement=displacement - _of_storeys(link["offset"], dampers),
        brace_velocity=velocity - _of_storeys(link["sliding_velocity"], dampers),
        friction_force=_of_storeys(link["friction_force"], dampers),
        phase=np.nan_to_num(_of_storeys(link["phase"], dampers)).astype(np.int64),
        slip_travel=_of_storeys(link["travel"], dampers),
        storey_friction_energy=_of_storeys(link["work"], dampers),
        storey_shear=np.ascontiguousarray(floor["storey_shear"]),
        input_energy=energy["input_energy"],
        viscous_energy=energy["viscous_energy"],
        transition_time=traces.log_times[ours],
        transition_storey=storey_of[traces.log[0]][ours],
        transition_phase=traces.log[1][ours],
        peak_acceleration=result["peak_acceleration"],
        peak_displacement=result["peak_displacement"],
        peak_velocity=result["peak_velocity"],
        peak_drift=result["peak_drift"],
        peak_storey_shear=result["peak_storey_shear"],
        peak_base_shear=float(result["peak_base_shear"][0]),
        residual_displacement=result["residual_displacement"],
        peak_slip=result["peak_slip"],
        residual_slip=result["residual_slip"],
        peak_brace_force=result["peak_brace_force"],
        peak_column_shear=result["peak_column_shear"],
        dissipated_energy=_friction(frame, outcome),
        energy_error=totals["energy_error"],
        status=int(totals["status"]),
        end=outcome.end,
        devices=devices,
    )


def frame_stiffness(building: Building) -> FloatArray:
    """Stiffness of each storey's columns, N/m, (N,); 0 where the frame is a matrix."""
    if building.storey_stiffness.ndim == 2:
        return np.zeros(building.n_storeys)
    return building.storey_stiffness
