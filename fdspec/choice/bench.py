"""One building under its records: what every set of slip forces does to it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.measures.ensemble import statistic_of
from fdspec.measures.indices import Weights, needs_of, value_of
from fdspec.model.building import Building, Frame
from fdspec.model.motion import GroundMotion
from fdspec.model.standing import below
from fdspec.runs import cost
from fdspec.runs.cube import named
from fdspec.scheduling.task import plan
from fdspec.scheduling.threads import fan_out

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

RESPONSES: Final = (
    "peak_acceleration",
    "peak_displacement",
    "peak_velocity",
    "peak_base_shear",
    "residual_displacement",
    "slip_travel",
    "dissipated_energy",
    "input_energy",
    "status",
    "peak_slip",
    "peak_drift_ratio",
    "strain_energy_area",
    "peak_strain_energy",
)
"""What a history gives.  Of many storeys it is the largest: displacements and residuals are then those
relative to the floor below.  The drift ratio is NaN where no height is known."""

BARE: Final = {
    "elastic_acceleration": "peak_acceleration",
    "bare_peak_displacement": "peak_displacement",
    "bare_peak_base_shear": "peak_base_shear",
    "bare_strain_energy_area": "strain_energy_area",
    "bare_peak_strain_energy": "peak_strain_energy",
}
"""What an index calls a response of the frame without braces -> that response."""

STRAIN: Final = ("strain_energy_area", "peak_strain_energy")

ALONE: Final = "peak_slip"
"""What histories of many storeys side by side leave out: each is integrated by itself where it is needed."""


@dataclass(frozen=True, eq=False)
class Bench:
    """A building, the records it is tried under, and the index it is judged by.

    The building's own slip forces do not matter, only the ratio of kinetic to static friction of each storey
    and whether a storey has a brace at all.
    """

    building: Building
    motions: Sequence[GroundMotion]
    index: str | Weights = "acceleration"
    statistic: str = "mean"
    workers: int | None = None
    """Threads; one a core unless given, and 0 stays in the caller's."""
    also: tuple[str, ...] = ()
    """Responses that cost time of their own, wanted beside what the index takes."""

    def __post_init__(self) -> None:
        if not isinstance(self.building, Building):
            raise InvalidInput(f"building must be a Building, got {type(self.building).__name__}")
        object.__setattr__(self, "motions", named(self.motions))
        statistic_of(self.statistic)
        needs = needs_of(self.index)
        if self.building.has_devices and set(STRAIN) & set(needs):
            raise InvalidInput(
                f"index {self.index!r} needs the strain energy of the frame over time, which is known of "
                "buildings without yielding columns, slots, gravity and links alone"
            )
        if not self.braced_storeys.any():
            raise InvalidInput("the building has no brace (brace_stiffness 0): there is no damper to choose")

    @property
    def braced_storeys(self) -> NDArray[np.bool_]:
        """(N,): where there is a brace."""
        return self.building.brace_stiffness > 0.0

    @cached_property
    def kinetic_ratio(self) -> FloatArray:
        """(N,): kinetic over static slip force; 1 where the building's own tells none."""
        static, kinetic = self.building.slip_force, self.building.kinetic_slip_force
        tells = np.isfinite(static) & (static > 0.0)
        return np.divide(kinetic, static, out=np.ones_like(static), where=tells)

    @cached_property
    def never_slips(self) -> FloatArray:
        """(N,) N: slip forces that no record reaches, little above those that one does.

        With the storey stuck, floor and brace as one obey (m_f + m_d) a = P - B with the brace's force B, and
        the reaction is R = (m_d P + m_f B) / (m_f + m_d) = m_d a + B; so |R| is at most
        m_d max|a| + k_d max|drift| + c_d max|drift rate|.
        """
        if self.storeys == 1:
            name = ("peak_acceleration", "peak_displacement", "peak_velocity")
            rows = [np.array([row]) for row in zip(*(self.braced[of] for of in name), strict=True)]
            reach = np.max([_reach(self.building, *row.T) for row in rows], axis=0)
        else:
            reach = np.max([self._reach(motion) for motion in self.motions], axis=0)
        return np.where(self.braced_storeys, reach * (1.0 + 1e-9), 0.0)

    @cached_property
    def bare(self) -> dict[str, FloatArray]:
        """Response -> (r,): of the frame without its braces."""
        return self._limit(without_braces(self.building))

    @cached_property
    def braced(self) -> dict[str, FloatArray]:
        """Response -> (r,): with dampers that never slip."""
        return {name: values[0] for name, values in self.respond(np.full((1, self.storeys), np.inf)).items()}

    @cached_property
    def braced_storey_shear(self) -> FloatArray:
        """(N,) N: peak storey shears with dampers that never slip, averaged over the records."""
        if self.storeys == 1:
            return np.array([self.braced["peak_base_shear"].mean()])
        peaks = [self.peaks_of(self._stuck, motion)["peak_storey_shear"] for motion in self.motions]
        return np.asarray(np.mean(peaks, axis=0))

    def with_slip_force(self, slip_force: FloatArray) -> Building:
        """The building with these slip forces (N,), its frictions in the same ratio."""
        force = np.where(self.braced_storeys, slip_force, 0.0)
        kinetic = np.where(np.isfinite(force), force * self.kinetic_ratio, np.inf)
        return self.building.with_changes(
            slip_force=force, kinetic_slip_force=np.where(self.braced_storeys, kinetic, 0.0)
        )

    @staticmethod
    def peaks_of(building: Building, motion: GroundMotion) -> dict[str, FloatArray]:
        """Peaks (N,) of every storey, by name: `fdspec.kernels.frame.results.STOREY_RESULTS`."""
        if building.has_devices:
            from fdspec.engines.devices import peaks_of as peaks_with_devices

            return peaks_with_devices(building, motion)[0]
        from fdspec.engines.frames import peaks_of_frames
        from fdspec.kernels.frame.results import STOREY_RESULTS

        by_storey, _ = peaks_of_frames([building.frame], motion, certify=False)
        return dict(zip(STOREY_RESULTS, by_storey[0], strict=True))

    @cached_property
    def _stuck(self) -> Building:
        return self.with_slip_force(np.full(self.storeys, np.inf))

    def _reach(self, motion: GroundMotion) -> FloatArray:
        peak = self.peaks_of(self._stuck, motion)
        velocity = peak["peak_velocity"] + below(peak["peak_velocity"], self.building.stands_on)
        return _reach(self.building, peak["peak_acceleration"], peak["peak_drift"], velocity)

    @property
    def needs(self) -> tuple[str, ...]:
        """Names of the responses that have to be there."""
        return (*needs_of(self.index), *self.also)

    @property
    def storeys(self) -> int:
        """Number of storeys N."""
        return self.building.n_storeys

    def respond(self, slip_force: FloatArray) -> dict[str, FloatArray]:
        """Run the building with each row of slip forces (c, N) under every record: response -> (c, r).

        Strain and input energies cost time, and are NaN unless the index takes them; so is the slip of many
        storeys unless `also` names it.
        """
        forces = np.where(self.braced_storeys, np.asarray(slip_force, dtype=np.float64), 0.0)
        kinetic = np.where(np.isfinite(forces), forces * self.kinetic_ratio, np.inf)
        return _run(self.building, forces, kinetic, self.motions, self.needs, self.workers)

    def index_of(self, responses: Mapping[str, FloatArray]) -> FloatArray:
        """The index of responses (c, r); inf where a history did not end well."""
        bare = {name: self.bare[of] for name, of in BARE.items()}
        found = value_of(self.index, {**responses, **bare})
        return np.where(responses["status"] == 0.0, found, np.inf)

    def judge(self, slip_force: FloatArray) -> FloatArray:
        """The index of each row of slip forces (c, N), over the records together: (c,)."""
        return self.together(self.index_of(self.respond(slip_force)))

    def together(self, indices: FloatArray) -> FloatArray:
        """The statistic of indices (c, r) over the records: (c,); inf where a record has none."""
        with np.errstate(invalid="ignore"):  # a quantile between two infinities
            found = np.asarray(statistic_of(self.statistic)(indices, axis=1))
        return np.where(np.isfinite(indices).all(axis=1), found, np.inf)

    def _limit(self, building: Building) -> dict[str, FloatArray]:
        # One storey without a brace never slips; in a frame it is no storey that could.
        force = np.full((1, self.storeys), np.inf if self.storeys == 1 else 0.0)
        found = _run(building, force, force, self.motions, self.needs, self.workers)
        for motion, peak in zip(self.motions, found["peak_displacement"][0], strict=True):
            if not peak > 0.0:
                raise InvalidInput(
                    f"{motion.name or 'the motion'} does not move the bare frame: there is nothing to reduce"
                )
        return {name: values[0] for name, values in found.items()}


def without_braces(building: Building) -> Building:
    """The bare frame of a building."""
    return building.with_changes(
        brace_mass=0.0,
        brace_stiffness=0.0,
        slip_force=0.0,
        kinetic_slip_force=0.0,
        brace_damping=0.0,
        slot_length=None,
        slot_stiffness=None,
        recentring_stiffness=None,
    )


def _reach(
    building: Building, acceleration: FloatArray, drift: FloatArray, drift_rate: FloatArray
) -> FloatArray:
    """Bound on the reactions (N,) of dampers that never slip, from peaks (N,)."""
    return np.asarray(
        building.brace_mass * acceleration
        + building.brace_stiffness * drift
        + building.brace_damping * drift_rate
    )


def _with(frame: Frame, slip_force: FloatArray, kinetic_slip_force: FloatArray) -> Frame:
    from fdspec.kernels.frame.model import KINETIC_SLIP_FORCE, SLIP_FORCE

    properties = frame.properties.copy()
    properties[SLIP_FORCE] = slip_force
    properties[KINETIC_SLIP_FORCE] = kinetic_slip_force
    return frame._replace(properties=properties)


def _run(
    building: Building,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    motions: Sequence[GroundMotion],
    needs: Collection[str],
    workers: int | None,
) -> dict[str, FloatArray]:
    """Run a building with each row of slip forces (c, N) under every motion: response -> (c, r)."""
    count, storeys = slip_force.shape
    if building.has_devices:
        work: Any = partial(_run_devices, building, slip_force, kinetic_slip_force)
    elif storeys == 1:
        work = partial(_run_storey, building, slip_force[:, 0], kinetic_slip_force[:, 0])
    else:
        work = partial(_run_frame, building, slip_force, kinetic_slip_force)
    times = count * (cost.STRAIN if set(STRAIN) & set(needs) else 1.0)
    seconds = [times * cost.seconds_of_history(building, motion.dt, motion.n) for motion in motions]
    tasks = plan(count, seconds, None, "candidates")
    work = partial(work, needs)
    if workers == 0:
        parts = [work(items, motions[record]) for record, items in tasks]
    else:
        parts = fan_out(
            work,
            motions,
            tasks,
            each=1,
            warm=partial(_warm, building, needs),
            workers=workers,
            scheduler="threads",
            progress=False,
        )
    table = np.empty((len(RESPONSES), count, len(motions)))
    for (record, items), part in zip(tasks, parts, strict=True):
        table[:, items, record] = part
    return dict(zip(RESPONSES, table, strict=True))


def _warm(building: Building, needs: Collection[str]) -> None:
    if building.n_storeys == 1:
        import fdspec.engines.batch
    else:
        from fdspec.engines.frames import runs_beside_others

        if building.has_devices:
            import fdspec.engines.devices
        if ALONE in needs or not runs_beside_others(building.frame):
            import fdspec.engines.many_storeys
    if set(STRAIN) & set(needs) and building.n_storeys == 1:
        import fdspec.engines.strain
    elif set(STRAIN) & set(needs):
        import fdspec.engines.frame_strain  # noqa: F401


def _run_storey(
    building: Building,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    needs: Collection[str],
    items: IntArray,
    motion: GroundMotion,
) -> FloatArray:
    """Run one single-storey frame with some of the slip forces (c,): (len(RESPONSES), items)."""
    from fdspec.engines.batch import integrate_columns
    from fdspec.kernels.storey.history import RESULTS

    force, kinetic = slip_force[items], kinetic_slip_force[items]
    rows = np.array([building.storey[:6]])
    _, found = integrate_columns(rows, force, kinetic, motion, certify=False)
    table = np.full((len(RESPONSES), items.size), np.nan)
    for row, name in enumerate(RESPONSES):
        if name in RESULTS:
            table[row] = found[0, :, RESULTS.index(name)]
    table[RESPONSES.index("residual_displacement")] = np.abs(
        found[0, :, RESULTS.index("residual_displacement")]
    )
    drift = table[RESPONSES.index("peak_displacement")]
    table[RESPONSES.index("peak_drift_ratio")] = drift / building.storey_height[0]
    if set(STRAIN) & set(needs):
        from fdspec.engines.strain import strain_of_columns

        table[-2:] = strain_of_columns(rows, force, kinetic, motion)[0].T
    return table


def _largest(
    building: Building, row: Mapping[str, FloatArray], total: Mapping[str, float]
) -> dict[str, float]:
    """Responses of a building from those of its storeys (N,) and of the whole."""
    residual = building.drifts(row["residual_displacement"])
    return {
        "peak_acceleration": float(row["peak_acceleration"].max()),
        "peak_displacement": float(row["peak_drift"].max()),
        "peak_velocity": float(row["peak_velocity"].max()),
        "peak_base_shear": float(row.get("peak_base_shear", row["peak_storey_shear"])[0]),
        "residual_displacement": float(np.abs(residual).max()),
        "slip_travel": float(row["slip_travel"].max()),
        "peak_slip": float(row["peak_slip"].max()),
        "peak_drift_ratio": float((row["peak_drift"] / building.storey_height).max()),
        **{name: float(total[name]) for name in ("dissipated_energy", "input_energy", "status")},
    }


def _run_devices(
    building: Building,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    needs: Collection[str],  # noqa: ARG001 - what they need is there
    items: IntArray,
    motion: GroundMotion,
) -> FloatArray:
    """Run a building with devices with some of the rows of slip forces (c, N): (len(RESPONSES), items)."""
    from fdspec.engines.devices import peaks_of

    table = np.full((len(RESPONSES), items.size), np.nan)
    braced = building.brace_stiffness > 0.0
    for column, item in enumerate(items):
        one = building.with_changes(
            slip_force=np.where(braced, slip_force[item], 0.0),
            kinetic_slip_force=np.where(braced, kinetic_slip_force[item], 0.0),
        )
        found = _largest(one, *peaks_of(one, motion))
        table[:, column] = [found.get(name, np.nan) for name in RESPONSES]
    return table


def _run_frame(
    building: Building,
    slip_force: FloatArray,
    kinetic_slip_force: FloatArray,
    needs: Collection[str],
    items: IntArray,
    motion: GroundMotion,
) -> FloatArray:
    """Run a frame with some of the rows of slip forces (c, N): (len(RESPONSES), items)."""
    from fdspec.kernels.frame.results import STOREY_RESULTS, TOTALS

    frames = [_with(building.frame, slip_force[item], kinetic_slip_force[item]) for item in items]
    by_storey, totals = _peaks(frames, motion, one_by_one=ALONE in needs)
    table = np.full((len(RESPONSES), items.size), np.nan)
    for column, one in enumerate(frames):
        row = dict(zip(STOREY_RESULTS, by_storey[column], strict=True))
        found = _largest(building, row, dict(zip(TOTALS, totals[column], strict=True)))
        if set(STRAIN) & set(needs):
            from fdspec.engines.frame_strain import strain_of_frame

            found |= dict(zip(STRAIN, strain_of_frame(one, motion)[:2], strict=True))
        table[:, column] = [found.get(name, np.nan) for name in RESPONSES]
    return table


def _peaks(
    frames: Sequence[Frame], motion: GroundMotion, *, one_by_one: bool
) -> tuple[FloatArray, FloatArray]:
    """Peaks by storey and totals of frames; one by one they tell the slip too, and differ by rounding."""
    if not one_by_one:
        from fdspec.engines.frames import peaks_of_frames

        return peaks_of_frames(frames, motion, certify=False)
    from fdspec.engines.many_storeys import peaks_of

    found = [peaks_of(frame, motion, certify=False) for frame in frames]
    return np.stack([rows for rows, _ in found]), np.stack([totals for _, totals in found])
