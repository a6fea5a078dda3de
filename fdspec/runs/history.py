"""The trajectory of one building -> the Dataset of its history."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from fdspec.engines.demands import brace_force_of, column_shear_of
from fdspec.engines.trajectory import DeviceTrajectory, FloatArray, Span, Trajectory, TrajectoryWithDevices
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.model.standing import below
from fdspec.store import provenance
from fdspec.variables import HISTORY, describe

ROUNDING = 1e-9
"""Share of a step by which an instant may lie past one that it is meant to be."""


def history_of(
    building: Building,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    trajectory: Trajectory,
    method: dict[str, object],
) -> xr.Dataset:
    """Return the Dataset of a history: variables, units and meanings are those of `fdspec.variables.HISTORY`.

    start: initial displacement and velocity of floors and braces, (2, 2, N); method: parameters of another
    method than the exact one.
    """
    time = np.arange(span.outputs, dtype=np.float64) * span.dt_out
    variables = {
        "ground_acceleration": ("time", _ground_at(motion, time, span.dt_out)),
        **_over_time(building, trajectory),
        **_at_end(building, trajectory),
    }
    coords = _coordinates(building, motion, time)
    if not np.isnan(building.storey_height).any():
        variables["peak_drift_ratio"] = ("storey", trajectory.peak_drift / building.storey_height)
    if trajectory.end is not None:
        variables["end_state"] = ("state", trajectory.end)
    if isinstance(trajectory, TrajectoryWithDevices):
        variables |= _of_devices(building, trajectory.devices)
        if not building.is_one_frame:
            coords["stands_on"] = ("storey", building.stands_on)
        if building.links:
            coords["link"] = list(building.link_names)
    dataset = xr.Dataset(variables, coords=coords)
    dataset.attrs = provenance(
        "Response history of a building with friction dampers",
        {
            **building.parameters,
            "dt_out": span.dt_out,
            "free_steps": span.free_steps,
            "initial_displacement": start[0],
            "initial_velocity": start[1],
            **method,
        },
        (motion,),
        command="fdspec.simulate",
    )
    return describe(dataset, HISTORY)


def _over_time(building: Building, trajectory: Trajectory) -> dict[str, Any]:
    """Return the variables over time."""
    floor_below = below(trajectory.displacement, building.stands_on)
    drift = trajectory.displacement - floor_below
    brace_drift = trajectory.brace_displacement - floor_below
    kinetic = 0.5 * (
        trajectory.velocity**2 @ building.floor_mass + trajectory.brace_velocity**2 @ building.brace_mass
    )
    strain = 0.5 * (
        np.einsum("ti,ij,tj->t", trajectory.displacement, building.stiffness_matrix, trajectory.displacement)
        + brace_drift**2 @ building.brace_stiffness
    )
    braced = building.brace_stiffness > 0.0
    slip = np.where(braced, trajectory.displacement - trajectory.brace_displacement, 0.0)
    each = ("time", "storey")
    return {
        "displacement": (each, trajectory.displacement),
        "velocity": (each, trajectory.velocity),
        "acceleration": (each, trajectory.acceleration),
        "drift": (each, drift),
        "storey_shear": (each, trajectory.storey_shear),
        "brace_displacement": (each, trajectory.brace_displacement),
        "brace_velocity": (each, trajectory.brace_velocity),
        "friction_force": (each, trajectory.friction_force),
        "slip": (each, slip),
        "brace_force": (each, brace_force_of(building, trajectory)),
        "column_shear": (each, column_shear_of(building, trajectory)),
        "phase": (each, trajectory.phase.astype(np.int8)),
        "slip_travel": (each, trajectory.slip_travel),
        "kinetic_energy": ("time", kinetic),
        "strain_energy": ("time", strain),
        "viscous_energy": ("time", trajectory.viscous_energy),
        "friction_energy": ("time", trajectory.storey_friction_energy.sum(axis=1)),
        "storey_friction_energy": (each, trajectory.storey_friction_energy),
        "input_energy": ("time", trajectory.input_energy),
    }


def _at_end(building: Building, trajectory: Trajectory) -> dict[str, Any]:
    """Return changes of phase, peaks, residuals and totals."""
    residual = trajectory.residual_displacement
    storeys = np.arange(1, building.n_storeys + 1)
    return {
        "transition_time": ("transition", trajectory.transition_time),
        "transition_storey": ("transition", storeys[trajectory.transition_storey]),
        "transition_phase": ("transition", trajectory.transition_phase.astype(np.int8)),
        "peak_acceleration": ("storey", trajectory.peak_acceleration),
        "peak_displacement": ("storey", trajectory.peak_displacement),
        "peak_velocity": ("storey", trajectory.peak_velocity),
        "peak_drift": ("storey", trajectory.peak_drift),
        "peak_storey_shear": ("storey", trajectory.peak_storey_shear),
        "peak_base_shear": ((), trajectory.peak_base_shear),
        "residual_displacement": ("storey", residual),
        "peak_slip": ("storey", trajectory.peak_slip),
        "residual_slip": ("storey", trajectory.residual_slip),
        "peak_brace_force": ("storey", trajectory.peak_brace_force),
        "peak_column_shear": ("storey", trajectory.peak_column_shear),
        "residual_drift": ("storey", building.drifts(residual)),
        "storey_transitions": (
            "storey",
            np.bincount(trajectory.transition_storey, minlength=building.n_storeys).astype(np.int64),
        ),
        "transitions": ((), np.int64(trajectory.transition_time.size)),
        "dissipated_energy": ((), trajectory.dissipated_energy),
        "energy_error": ((), trajectory.energy_error),
        "status": ((), np.int8(trajectory.status)),
    }


def _coordinates(building: Building, motion: GroundMotion, time: FloatArray) -> dict[str, Any]:
    """Return instants, storeys, slip forces and what is known of the record."""
    told = {
        "record": motion.name,
        "pga": motion.pga,
        "dt": motion.dt,
        "duration": motion.duration,
        "samples": motion.n,
        "scale_factor": motion.scale_factor,
        "event": motion.event,
        "station": motion.station,
        "component": motion.component,
        "source": motion.source,
        "history": "; ".join(motion.history),
        "checksum": motion.checksum,
    }
    return {
        "time": time,
        "storey": np.arange(1, building.n_storeys + 1),
        "slip_force": ("storey", building.slip_force),
        "kinetic_slip_force": ("storey", building.kinetic_slip_force),
        **{name: ((), value) for name, value in told.items()},
    }


def _ground_at(motion: GroundMotion, time: FloatArray, dt_out: float) -> FloatArray:
    """Ground acceleration at outputs, of which rounding may put one just behind the record's last sample."""
    shaking = time <= motion.time[-1] + ROUNDING * dt_out
    found = np.where(shaking, np.interp(time, motion.time, motion.acceleration), 0.0)
    return np.asarray(found, dtype=np.float64)


def _of_devices(building: Building, devices: DeviceTrajectory) -> dict[str, Any]:
    """Return the variables that only buildings with devices have."""
    each = ("time", "storey")
    variables: dict[str, Any] = {
        "kinetic_energy": ("time", devices.kinetic_energy),
        "strain_energy": ("time", devices.strain_energy),
        "bearing_energy": ("time", devices.bearing_energy),
        "gravity_energy": ("time", devices.gravity_energy),
        "yielding_energy": ("time", devices.column_work.sum(axis=1)),
        "links_energy": ("time", devices.link_work.sum(axis=1)),
        "plastic_deformation": (each, devices.plastic_deformation),
    }
    for name, values in devices.storeys.items():
        if name != "peak_drift_ratio":
            variables[name] = ("storey", values.astype(HISTORY[name].dtype))
    if building.links:
        over_time, link = ("time", "link"), "link"
        variables["link_slip"] = (over_time, devices.link_slip)
        variables["link_force"] = (over_time, devices.link_force)
        variables["link_phase"] = (over_time, devices.link_phase.astype(np.int8))
        for name in (
            "peak_link_slip",
            "residual_link_slip",
            "peak_link_force",
            "link_energy",
            "link_events",
            "link_contacts",
        ):
            variables[name] = (link, getattr(devices, name))
    return variables
