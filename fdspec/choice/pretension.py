"""The best pretension, computed where it is and not read off a grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from fdspec.choice.bench import Bench
from fdspec.choice.search import Scan, scan
from fdspec.choice.variables import BEST, BEST_FOR_ALL
from fdspec.errors import InvalidInput
from fdspec.measures.ensemble import statistic_of
from fdspec.measures.indices import Weights, needs_of, weights_of
from fdspec.model.building import Building
from fdspec.model.grid import Grid
from fdspec.model.link import Link, TensionBrace
from fdspec.model.motion import GroundMotion
from fdspec.runs.bounds import SWEEP_HOURS, refuse_long
from fdspec.runs.cost import PER_SEARCH
from fdspec.runs.cube import assemble, named
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.progress import progress as progress_bar
from fdspec.scheduling.task import plan
from fdspec.scheduling.threads import fan_out

FloatArray = NDArray[np.float64]

RESPONSES: Final = ("peak_acceleration", "peak_displacement", "peak_base_shear", "residual_displacement")
"""What is told of the history at the best pretension."""

THERE: Final = (*RESPONSES, "bare_acceleration", "braced_acceleration")


@dataclass(frozen=True)
class Found:
    """A search's scan, and what every record of its bench has at the best slip force."""

    scan: Scan
    there: dict[str, FloatArray]


def best_pretension(
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    period: ArrayLike,
    stiffness_ratio: ArrayLike,
    index: str | Weights = "acceleration",
    statistic: str | None = None,
    band: float = 0.05,
    floor_mass: float = 20e3,
    brace_mass: float = 50.0,
    damping_ratio: float = 0.05,
    friction_coefficient: float = 0.5,
    kinetic_friction_coefficient: float | None = None,
    normal_force_factor: float = 1.0,
    brace_damping_ratio: float = 0.0,
    storey_height: float | None = None,
    yield_shear: float | None = None,
    hardening_ratio: float = 0.0,
    gravity_load: float | None = None,
    slot_length: float | None = None,
    slot_stiffness: float | None = None,
    recentring_stiffness: float | None = None,
    collapse_drift: float | None = None,
    links: Sequence[Link | TensionBrace] = (),
    workers: int | None = None,
    progress: Shown = False,
) -> xr.Dataset:
    """Find the pretension that lowers a performance index most, by computing histories where it may be.

    All pretensions from 0 to that at which the damper no longer slips are scanned, many at once.  Intervals
    that seem to hide a lower value, by the slopes beside them, are divided until they are 1/4096 of the
    range or promise less than 1e-5 of the index.  A dip narrower than the scan can be missed; that happens
    in a few frames of a hundred where kinetic friction lies below static.  Nothing is interpolated: every
    number returned is that of a history.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Named differently.
    period, stiffness_ratio : array_like
        Of the frames, s and 1; every pair is one.
    index : str or mapping of str to float
        What is to be least; see `fdspec.measures.index_of`.
    statistic : str, optional
        "mean", "median", "p84" or "worst" of the index over the records, for one pretension that serves
        all of them; unless given, each record has its own best.
    band : float
        Share above the least index that counts as nearly as good.
    floor_mass, brace_mass, damping_ratio, friction_coefficient, kinetic_friction_coefficient, \
    normal_force_factor, brace_damping_ratio, storey_height, yield_shear, hardening_ratio, gravity_load, \
    slot_length, slot_stiffness, recentring_stiffness, collapse_drift, links
        As for `fdspec.sweep`.
    workers : int, optional
        Threads; one a core unless given.  No result depends on it.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        Over (record, stiffness_ratio, period), without record where there is a statistic: `pretension`
        (the lowest with the least index) and `slip_force`, N; `index`; `band_start` and `band_end`, N,
        of the stretch of pretensions about it within the band, which ends at infinity where a damper that
        never slips is within it; `bands`, N, all such stretches.  Over record in any case: the responses
        there and the limits `bare_acceleration`, `braced_acceleration`.  With a statistic also
        `index_of_record` and `regret`, how far that lies above the record's own least index, as a share.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Examples
    --------
    >>> import fdspec
    >>> best = fdspec.best_pretension(fdspec.load_record("FSR1"), period=0.5, stiffness_ratio=4)
    >>> bool(best.index.item() < 0.6)
    True
    """
    grid = Grid(
        stiffness_ratio=stiffness_ratio,  # type: ignore[arg-type]
        pretension=np.array([0.0]),
        period=period,  # type: ignore[arg-type]
        floor_mass=floor_mass,
        brace_mass=brace_mass,
        damping_ratio=damping_ratio,
        friction_coefficient=friction_coefficient,
        kinetic_friction_coefficient=kinetic_friction_coefficient,
        normal_force_factor=normal_force_factor,
        brace_damping_ratio=brace_damping_ratio,
        storey_height=storey_height,
        yield_shear=yield_shear,
        hardening_ratio=hardening_ratio,
        gravity_load=gravity_load,
        slot_length=slot_length,
        slot_stiffness=slot_stiffness,
        recentring_stiffness=recentring_stiffness,
        collapse_drift=collapse_drift,
        links=links,  # type: ignore[arg-type]
    )
    if grid.friction_coefficient == 0.0:
        raise InvalidInput(
            "friction_coefficient must be positive: without friction no pretension matters, got 0"
        )
    if not 0.0 <= band < np.inf:
        raise InvalidInput(f"band must be zero or positive, got {band!r}")
    motions = named(motions)
    needs_of(index)
    n_sr, _, n_t = grid.shape
    shape = (len(motions), n_sr, n_t)
    own = _of_records(grid, motions, index, band, workers, progress)
    force_of = grid.friction_coefficient * grid.normal_force_factor
    if statistic is None:
        variables = _told(own, shape, band, force_of)
        variables |= {name: _of_each(own.reshape(shape), name) for name in THERE}
    else:
        statistic_of(statistic)
        together = np.empty(n_sr * n_t, dtype=object)
        with progress_bar(n_sr * n_t, "frames", shown=progress) as done:
            for column in range(n_sr * n_t):
                together[column] = _searched(_bench(grid, column, motions, index, workers, statistic), band)
                done(1)
        variables = _told(together, shape[1:], band, force_of)
        variables |= {name: _of_all(together.reshape(shape[1:]), name) for name in THERE}
        least = np.array([found.scan.least for found in own.ravel()]).reshape(shape)
        indices = _of_all(together.reshape(shape[1:]), "index")
        # A search may miss a record's own least by a little; what was found together then shows it.
        variables |= {"index_of_record": indices, "regret": indices / np.minimum(least, indices) - 1.0}
    variables["bare_acceleration"] = variables["bare_acceleration"][:, 0]
    axes = {
        "stiffness_ratio": grid.stiffness_ratio,
        "period": grid.period,
        "stretch": np.arange(1, variables["bands"].shape[-2] + 1),
        "bound": ["start", "end"],
    }
    parameters = {name: value for name, value in grid.parameters.items() if name != "pretension"}
    return assemble(
        variables,
        axes,
        BEST if statistic is None else BEST_FOR_ALL,
        motions,
        title="Best pretension of single-storey frames with friction dampers",
        parameters={**parameters, "index": weights_of(index), "statistic": statistic or "none", "band": band},
        command="fdspec.best_pretension",
    )


def _bench(
    grid: Grid,
    column: int,
    motions: Sequence[GroundMotion],
    index: str | Weights,
    workers: int | None,
    statistic: str = "mean",
) -> Bench:
    """Put one pair of stiffness ratio and period on a bench; its slip force tells the ratio of frictions."""
    ratio, period = divmod(column, grid.period.size)
    building = Building.single_storey(
        period=float(grid.period[period]),
        stiffness_ratio=float(grid.stiffness_ratio[ratio]),
        slip_force=grid.friction_coefficient,
        kinetic_slip_force=grid.kinetic_friction_coefficient,
        floor_mass=grid.floor_mass,
        brace_mass=grid.brace_mass,
        damping_ratio=grid.damping_ratio,
        brace_damping_ratio=grid.brace_damping_ratio,
        **grid.devices,
    )
    return Bench(building, motions, index, statistic, workers)


def _searched(bench: Bench, band: float) -> Found:
    top = float(bench.never_slips[0])
    found = scan(lambda force: bench.judge(force[:, np.newaxis]), top, share=band)
    there = bench.respond(np.array([[found.best]]))
    return Found(
        found,
        {
            **{name: there[name][0] for name in RESPONSES},
            "index": bench.index_of(there)[0],
            "bare_acceleration": bench.bare["peak_acceleration"],
            "braced_acceleration": bench.braced["peak_acceleration"],
        },
    )


def _of_records(
    grid: Grid,
    motions: Sequence[GroundMotion],
    index: str | Weights,
    band: float,
    workers: int | None,
    progress: Shown,
) -> NDArray[np.object_]:
    """Search each column under each record by itself: Found (records, columns)."""
    n_sr, _, n_t = grid.shape
    seconds = [motion.n * n_sr * n_t * PER_SEARCH for motion in motions]
    refuse_long(sum(seconds), SWEEP_HOURS, f"a search for {n_sr * n_t:.4g} frames")
    tasks = plan(n_sr * n_t, seconds, None, "columns")
    parts = fan_out(
        partial(_search_columns, grid, index, band),
        motions,
        tasks,
        each=1,
        warm=_warm,
        workers=workers,
        scheduler="threads",
        progress=progress,
        what="searches",
    )
    all_found = np.empty((len(motions), n_sr * n_t), dtype=object)
    for (record, columns), found in zip(tasks, parts, strict=True):
        for column, one in zip(columns, found, strict=True):
            all_found[record, column] = one
    return all_found


def _search_columns(
    grid: Grid, index: str | Weights, band: float, columns: NDArray[np.int64], motion: GroundMotion
) -> list[Found]:
    return [_searched(_bench(grid, int(column), (motion,), index, workers=0), band) for column in columns]


def _warm() -> None:
    import fdspec.engines.batch
    import fdspec.engines.strain  # noqa: F401


def _told(
    found: NDArray[np.object_], shape: tuple[int, ...], band: float, force_of: float
) -> dict[str, NDArray[Any]]:
    """Read best and bands off scans of slip forces: arrays of this shape, by name."""
    scans: list[Scan] = [one.scan for one in found.ravel()]
    bands = [one.bands(band) for one in scans]
    table = np.full((len(scans), max(1, *(len(each) for each in bands)), 2), np.nan)
    about = np.full((len(scans), 2), np.nan)
    for row, (one, stretches) in enumerate(zip(scans, bands, strict=True)):
        table[row, : len(stretches)] = stretches
        holds = (stretches[:, 0] <= one.best) & (one.best <= stretches[:, 1])
        about[row] = stretches[holds][0] if holds.any() else np.nan
    best = np.array([one.best for one in scans])
    least = np.array([one.least for one in scans])
    told = {
        "pretension": best / force_of,
        "slip_force": best,
        "index": np.where(np.isfinite(least), least, np.nan),
        "band_start": about[:, 0] / force_of,
        "band_end": about[:, 1] / force_of,
        "bands": table / force_of,
    }
    return {name: values.reshape(*shape, *values.shape[1:]) for name, values in told.items()}


def _of_each(found: NDArray[np.object_], name: str) -> FloatArray:
    """What a record has there, of searches (records, stiffness ratios, periods) of one record each."""
    return np.array([one.there[name][0] for one in found.ravel()]).reshape(found.shape)


def _of_all(found: NDArray[np.object_], name: str) -> FloatArray:
    """The same of searches (stiffness ratios, periods) of all records together."""
    values = np.stack([one.there[name] for one in found.ravel()], axis=-1)
    return values.reshape(-1, *found.shape)
