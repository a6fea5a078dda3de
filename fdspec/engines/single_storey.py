"""The single-storey engine behind `simulate`: hands the kernel its arrays and takes them back."""

from __future__ import annotations

import math

import numpy as np

from fdspec.engines.trajectory import FloatArray, IntArray, Rest, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.kernels.storey.constants import RADIANS
from fdspec.kernels.storey.entry import integrate
from fdspec.kernels.storey.history import RESULTS
from fdspec.kernels.storey.output import TRACES
from fdspec.kernels.types import N_STATE, Motion
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion


class Runner:
    """The kernel with a building of one storey, a motion and a start: each call integrates it anew."""

    def __init__(
        self,
        building: Building,
        motion: GroundMotion,
        span: Span,
        start: FloatArray,
        resume: FloatArray | None,
        radians: float = RADIANS,
    ) -> None:
        """Take arguments as of `integrate_single_storey`."""
        storey = building.storey
        if storey.brace_mass == 0.0 and storey.brace_stiffness == 0.0:  # no brace: nothing to slip on
            storey = storey._replace(slip_force=math.inf, kinetic_slip_force=0.0)
        state = Motion(*(float(x) for x in (start[0, 0, 0], start[1, 0, 0], start[0, 1, 0], start[1, 1, 0])))
        if math.isinf(storey.slip_force) and state.v != state.e:
            raise InvalidInput(
                f"initial_velocity of floor and brace must be equal where the damper never slips, "
                f"got {state.v:g} and {state.e:g} m/s"
            )
        self.storey, self.state, self.motion, self.span = storey, state, motion, span
        self.resume, self.radians = resume, radians
        self.result, self.end = np.empty(len(RESULTS)), np.empty(N_STATE)

    def __call__(
        self, times: FloatArray, phases: IntArray, traces: FloatArray, *, at_rest: bool = False
    ) -> int:
        """Fill times, phases and traces; return the record steps taken to come to rest after the span."""
        if self.resume is not None:
            self.end[:] = self.resume
        taken: int = integrate(
            self.storey,
            self.motion.acceleration,
            self.motion.dt,
            self.span.free_steps,
            at_rest,
            self.radians,
            self.state,
            self.resume is not None,
            self.end,
            times,
            phases,
            self.span.dt_out,
            traces,
            self.result,
        )
        return taken


def rest_of_single_storey(
    building: Building, motion: GroundMotion, span: Span, start: FloatArray, resume: FloatArray | None
) -> Rest:
    """Go on after the span until nothing can slip any more."""
    run = Runner(building, motion, span, start, resume)
    steps = run(np.empty(0), np.empty(0, np.int64), np.empty((0, len(TRACES))), at_rest=True)
    result = dict(zip(RESULTS, run.result, strict=True))
    return Rest(
        steps,
        np.array([result["residual_displacement"]]),
        np.array([result["residual_slip"]]),
        int(result["status"]),
    )


def integrate_single_storey(
    building: Building,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    resume: FloatArray | None = None,
    *,
    radians: float = RADIANS,
) -> Trajectory:
    """Integrate a building of one storey.

    start: displacement and velocity of floor and brace, (2, 2, 1), m and m/s.  resume: the end of another
    history, to go on from in place of the start.  radians: longest phase of a segment that is searched for
    roots; it moves no result.
    """
    run = Runner(building, motion, span, start, resume, radians)
    storey = run.storey
    traces = np.full((span.outputs, len(TRACES)), np.nan)
    run(np.empty(0), np.empty(0, np.int64), traces)
    changes = int(run.result[RESULTS.index("transitions")])
    times, phases = np.empty(changes), np.empty(changes, np.int64)
    if changes:
        run(times, phases, traces)
    trajectory = dict(zip(TRACES, traces.T[:, :, np.newaxis], strict=True))
    peak = dict(zip(RESULTS, run.result, strict=True))
    shear = (
        storey.floor_stiffness * trajectory["displacement"]
        + storey.floor_damping * trajectory["velocity"]
        + storey.brace_stiffness * trajectory["brace_displacement"]
        + storey.brace_damping * trajectory["brace_velocity"]
    )
    return Trajectory(
        displacement=trajectory["displacement"],
        velocity=trajectory["velocity"],
        acceleration=trajectory["acceleration"],
        brace_displacement=trajectory["brace_displacement"],
        brace_velocity=trajectory["brace_velocity"],
        friction_force=trajectory["friction_force"],
        phase=np.nan_to_num(trajectory["phase"]).astype(np.int64),  # NaN where a broken history never came
        slip_travel=trajectory["slip_travel"],
        storey_friction_energy=trajectory["friction_energy"],
        storey_shear=shear,
        input_energy=trajectory["input_energy"][:, 0],
        viscous_energy=trajectory["viscous_energy"][:, 0],
        transition_time=times,
        transition_storey=np.zeros(changes, np.int64),
        transition_phase=phases,
        peak_acceleration=np.array([peak["peak_acceleration"]]),
        peak_displacement=np.array([peak["peak_displacement"]]),
        peak_velocity=np.array([peak["peak_velocity"]]),
        peak_drift=np.array([peak["peak_displacement"]]),
        peak_storey_shear=np.array([peak["peak_base_shear"]]),
        peak_base_shear=float(peak["peak_base_shear"]),
        residual_displacement=np.array([peak["residual_displacement"]]),
        peak_slip=np.array([peak["peak_slip"]]),
        residual_slip=np.array([peak["residual_slip"]]),
        peak_brace_force=np.array([peak["peak_brace_force"]]),
        peak_column_shear=np.array([peak["peak_column_shear"]]),
        dissipated_energy=float(peak["dissipated_energy"]),
        energy_error=float(peak["energy_error"]),
        status=int(peak["status"]),
        end=run.end,
    )
