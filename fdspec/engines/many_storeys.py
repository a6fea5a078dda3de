"""The N-storey engine: hands the kernel its arrays and takes them back."""

from __future__ import annotations

import numpy as np

from fdspec.engines.trajectory import FloatArray, IntArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.kernels.frame.entry import integrate
from fdspec.kernels.frame.output import STOREY_TRACES, TOTAL_TRACES
from fdspec.kernels.frame.results import END, END_ROWS, RADIANS, STOREY_RESULTS, TOTALS
from fdspec.model.building import Building, Frame
from fdspec.model.motion import GroundMotion


def peaks_of(
    frame: Frame, motion: GroundMotion, *, certify: bool, free_steps: int = 0
) -> tuple[FloatArray, FloatArray]:
    """Integrate a frame from rest, without its trajectory.

    certify: whether the balance of all energies is wanted.  free_steps: steps of dt with the ground at rest
    that follow.  Returns the rows of STOREY_RESULTS for each
    storey (rows, N), and TOTALS.
    """
    size = frame.properties.shape[1]
    by_storey = np.empty((END + END_ROWS, size))
    totals = np.empty(len(TOTALS))
    integrate(
        frame.properties,
        frame.dense_stiffness,
        frame.dense_damping,
        motion.acceleration,
        motion.dt,
        free_steps,
        certify,
        np.zeros((4, size)),
        RADIANS,
        0,
        np.empty(0),
        np.empty(0, np.int64),
        np.empty(0, np.int64),
        motion.dt,
        np.empty((0, len(STOREY_TRACES), size)),
        np.empty((0, len(TOTAL_TRACES))),
        by_storey,
        totals,
    )
    return by_storey[:END], totals


def integrate_many_storeys(
    building: Building,
    motion: GroundMotion,
    span: Span,
    start: FloatArray,
    resume: FloatArray | None = None,
    *,
    radians: float = RADIANS,
    extra_terms: int = 0,
) -> Trajectory:
    """Integrate a building of any number of storeys.

    start: displacement and velocity of floors and braces, (2, 2, N), m and m/s.  resume: the end of another
    history, to go on from in place of the start.  radians: longest phase of a step; extra_terms: terms of the
    series beyond those that rounding leaves; neither moves a result.
    """
    size = building.n_storeys
    frame = building.frame
    apart = (start[1, 0] != start[1, 1]) & np.isinf(building.slip_force) & (building.brace_mass > 0.0)
    if apart.any():
        storey = int(np.argmax(apart))
        raise InvalidInput(
            f"initial_velocity of floor and brace must be equal where the damper never slips, "
            f"got {start[1, 0, storey]:g} and {start[1, 1, storey]:g} m/s in storey {storey + 1}"
        )
    state = np.ascontiguousarray(start.transpose(1, 0, 2).reshape(4, size))
    if resume is not None:
        state = np.ascontiguousarray(resume.reshape(END_ROWS, size))
    by_storey = np.empty((END + END_ROWS, size))
    totals = np.empty(len(TOTALS))
    no_traces = np.empty((0, len(STOREY_TRACES), size)), np.empty((0, len(TOTAL_TRACES)))

    def run(
        times: FloatArray, storeys: IntArray, phases: IntArray, traces: FloatArray, energies: FloatArray
    ) -> None:
        integrate(
            frame.properties,
            frame.dense_stiffness,
            frame.dense_damping,
            motion.acceleration,
            motion.dt,
            span.free_steps,
            True,
            state,
            radians,
            extra_terms,
            times,
            storeys,
            phases,
            span.dt_out,
            traces,
            energies,
            by_storey,
            totals,
        )

    def room(changes: int) -> tuple[FloatArray, IntArray, IntArray]:
        return np.empty(changes), np.empty(changes, np.int64), np.empty(changes, np.int64)

    # Twice: how many changes of phase there are is known at the end.
    run(*room(0), *no_traces)
    changes = room(int(totals[TOTALS.index("transitions")]))
    traces = np.full((span.outputs, len(STOREY_TRACES), size), np.nan)
    energies = np.full((span.outputs, len(TOTAL_TRACES)), np.nan)
    run(*changes, traces, energies)

    trajectory = {name: np.ascontiguousarray(traces[:, i]) for i, name in enumerate(STOREY_TRACES)}
    work = {name: np.ascontiguousarray(energies[:, i]) for i, name in enumerate(TOTAL_TRACES)}
    result = dict(zip(STOREY_RESULTS, by_storey[:END], strict=True))
    total = dict(zip(TOTALS, totals, strict=True))
    return Trajectory(
        displacement=trajectory["displacement"],
        velocity=trajectory["velocity"],
        acceleration=trajectory["acceleration"],
        brace_displacement=trajectory["brace_displacement"],
        brace_velocity=trajectory["brace_velocity"],
        friction_force=trajectory["friction_force"],
        phase=np.nan_to_num(trajectory["phase"]).astype(np.int64),
        slip_travel=trajectory["slip_travel"],
        storey_friction_energy=trajectory["storey_friction_energy"],
        storey_shear=trajectory["storey_shear"],
        input_energy=work["input_energy"],
        viscous_energy=work["viscous_energy"],
        transition_time=changes[0],
        transition_storey=changes[1],
        transition_phase=changes[2],
        peak_acceleration=result["peak_acceleration"],
        peak_displacement=result["peak_displacement"],
        peak_velocity=result["peak_velocity"],
        peak_drift=result["peak_drift"],
        peak_storey_shear=result["peak_storey_shear"],
        peak_base_shear=float(result["peak_storey_shear"][0]),
        residual_displacement=result["residual_displacement"],
        peak_slip=result["peak_slip"],
        residual_slip=result["residual_slip"],
        peak_brace_force=result["peak_brace_force"],
        peak_column_shear=result["peak_column_shear"],
        dissipated_energy=float(total["dissipated_energy"]),
        energy_error=float(total["energy_error"]),
        status=int(total["status"]),
        end=by_storey[END:].ravel(),
    )
