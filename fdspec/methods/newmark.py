"""The study's own scheme."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fdspec.engines.trajectory import FloatArray, Span, Trajectory
from fdspec.errors import InvalidInput
from fdspec.methods.method import Method, intervals, parts_of, positive
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion

ROOM = 100_000
"""Changes of phase for which there is room at first; a history with more of them is run again."""


@dataclass(frozen=True, kw_only=True)
class Newmark(Method):
    """Step by step with a fixed step, as the study published it, for N storeys.

    Newmark's relations with gamma = 1/2, the study's (30) to (35); three nested loops of iteration, for the
    accelerations of the floors (36), the reactions of sticking storeys (37) and the accelerations of sliding
    braces (38); the phase is checked at the end of each step by (23) and (25).  A change of phase is seen up
    to a step late, and the error falls with the first power of the step.

    Parameters
    ----------
    dt : float, s
        Longest step; a whole number of steps fit between two samples.
    beta : float
        1/4, average acceleration, or 1/6, linear acceleration.
    tolerance : float
        At which the iterations end: the difference of two estimates, relative to the larger of 1 (in
        m/s2 or N) and the estimate.

    Notes
    -----
    The study's flow chart (its Figure 3) is missing from its text; the nesting here is the order in which it
    names the loops, outermost first.  It does not print what happens to the velocities where sliding ends:
    here (32) sets the brace's to the floor's.  The iterations settle while beta (omega dt)^2 < 1 for the
    brace standing by itself; beyond, the history ends with status ``iteration_not_converged``.  A brace that
    may slip needs mass, for (38) divides by it.
    """

    name: ClassVar[str] = "newmark"

    dt: float = 1e-6
    beta: float = 0.25
    tolerance: float = 1e-6

    def __post_init__(self) -> None:
        positive(self, "dt", "s")
        positive(self, "tolerance")
        if not any(abs(self.beta - beta) < 1e-9 for beta in (1.0 / 4.0, 1.0 / 6.0)):
            raise InvalidInput(f"beta of method {self.name!r} must be 1/4 or 1/6, got {self.beta!r}")

    def integrate(
        self, building: Building, motion: GroundMotion, span: Span, start: FloatArray
    ) -> Trajectory:
        """Integrate one history."""
        from fdspec.kernels.fixed_step import newmark as kernel

        braced = building.brace_stiffness > 0.0
        slips = braced & np.isfinite(building.slip_force)
        if (slips & (building.brace_mass == 0.0)).any():
            raise InvalidInput(
                f"brace_mass must be positive for method {self.name!r} where the damper may slip: "
                "the study's equation (38) divides by it"
            )
        size = building.n_storeys
        storeys = np.stack(
            [
                building.floor_mass,
                building.brace_mass,
                building.brace_stiffness,
                building.brace_damping,
                np.where(braced, building.slip_force, np.inf),
                np.where(slips, building.kinetic_slip_force, 0.0),
            ]
        )
        state = np.ascontiguousarray(start.transpose(1, 0, 2).reshape(4, size))
        results, totals = np.empty((len(kernel.STOREY_RESULTS), size)), np.empty(len(kernel.TOTALS))
        room = ROOM
        while True:
            times, storey, phase = np.empty(room), np.empty(room, np.int64), np.empty(room, np.int64)
            traces = np.full((span.outputs, len(kernel.STOREY_TRACES), size), np.nan)
            energies = np.full((span.outputs, len(kernel.TOTAL_TRACES)), np.nan)
            kernel.integrate(
                storeys,
                building.stiffness_matrix.copy(),
                building.damping_matrix.copy(),
                intervals(motion, span),
                motion.dt,
                parts_of(motion, self.dt),
                self.beta,
                self.tolerance,
                state,
                times,
                storey,
                phase,
                span.dt_out,
                traces,
                energies,
                results,
                totals,
            )
            total = dict(zip(kernel.TOTALS, totals.tolist(), strict=True))
            changes = int(total["transitions"])
            if changes <= room:
                break
            room = changes
        trajectory = {name: np.ascontiguousarray(traces[:, i]) for i, name in enumerate(kernel.STOREY_TRACES)}
        peak = dict(zip(kernel.STOREY_RESULTS, results, strict=True))
        told = trajectory.pop("phase")
        return Trajectory(
            **trajectory,
            phase=np.nan_to_num(told).astype(np.int64),
            input_energy=energies[:, 0].copy(),
            viscous_energy=energies[:, 1].copy(),
            transition_time=times[:changes],
            transition_storey=storey[:changes],
            transition_phase=phase[:changes],
            **peak,
            peak_base_shear=float(peak["peak_storey_shear"][0]),
            dissipated_energy=total["dissipated_energy"],
            energy_error=total["energy_error"],
            status=int(total["status"]),
        )
