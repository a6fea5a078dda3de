"""Slip forces of a building: one for all storeys, in proportion to storey shear, or free in each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fdspec.choice.bench import Bench
from fdspec.choice.search import FINEST, POINTS, Function, Scan, scan
from fdspec.choice.variables import OPTIMUM
from fdspec.errors import InvalidInput
from fdspec.measures.indices import Weights, weights_of
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.cube import assemble
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.progress import progress as progress_bar

FloatArray = NDArray[np.float64]

DISTRIBUTIONS: Final = ("uniform", "shear", "free")

FRAME_POINTS: Final = 24
FRAME_FINEST: Final = 2.0**-8
"""Of the scan of many storeys, whose valleys are wide and whose histories cost more."""

BAND: Final = 0.05

SPREAD: Final = 0.5
"""Standard deviation of the logarithm of slip forces about a start in half of the first population."""


def optimise(
    building: Building,
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    index: str | Weights = "acceleration",
    distribution: str = "free",
    statistic: str = "mean",
    population: int = 10,
    generations: int = 30,
    seed: int = 0,
    workers: int | None = None,
    progress: Shown = False,
) -> xr.Dataset:
    """Find the slip forces that lower a performance index of a building most, over an ensemble of records.

    Parameters
    ----------
    building : Building
        Its braces and frame count; its own slip forces tell nothing but the ratio of kinetic to static
        friction of each storey.
    motions : GroundMotion or sequence of them
        Named differently.
    index : str or mapping of str to float
        What is to be least; see `fdspec.measures.index_of`.  Of many storeys the largest counts, and
        displacement is that relative to the floor below.
    distribution : str
        "uniform": one force for all storeys; "shear": in proportion to the storey shears of the braced
        building, their peaks averaged over the records; "free": one force a storey.
    statistic : str
        What is to be least over the records: "mean", "median", "p84" or "worst".
    population, generations : int
        Of the search for a free distribution: members of the population for each storey with a brace, and
        how often they are renewed at most.
    seed : int
        Of that search.  The same seed gives the same bits, whatever the number of workers.
    workers : int, optional
        Threads; one a core unless given.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        `slip_force`, N, over storey; `index`, of all records together, and `index_of_record`;
        `start_slip_force` and `start_index` over distribution: the best uniform and proportional forces,
        which a free search starts from; `generation_index`, the least index up to each generation;
        `evaluations`.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Notes
    -----
    A distribution of one number is scanned and refined as `fdspec.best_pretension` is.  A free one is
    searched by differential evolution (Storn and Price 1997, scipy's), a genetic approach like that of
    Moreschi and of Asahina and others, which the study names.  The first population holds the best forces
    of the other distributions, half of it is scattered about them, half over all forces below which a
    damper slips at all; the best member is never lost, so a free distribution is at least as good as they.
    """
    if distribution not in DISTRIBUTIONS:
        raise InvalidInput(f"distribution must be one of {', '.join(DISTRIBUTIONS)}, got {distribution!r}")
    _require("population", population, 1)
    _require("generations", generations, 0)
    _require("seed", seed, 0)
    one = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    bench = Bench(building, one, index, statistic, workers)
    started = ("uniform", "shear") if distribution == "free" else (distribution,)
    members = population * int(bench.braced_storeys.sum())
    total = len(started) + (generations + 1 if distribution == "free" else 0)
    with progress_bar(total, "searches and generations", shown=progress) as done:
        tried = 0
        starts = np.empty((len(started), bench.storeys))
        values = np.empty(len(started))
        for row, name in enumerate(started):
            starts[row], values[row], places = _scaled(bench, shape_of(bench, name))
            tried += places
            done(1)
        best = int(values.argmin())
        force, least = starts[best], float(values[best])
        course = np.array([least])
        if distribution == "free":
            force, course, places = _evolved(bench, starts, values, members, generations, seed, done)
            tried += places
    indices = bench.index_of(bench.respond(force[np.newaxis]))[0]
    return assemble(
        {
            "slip_force": force,
            "index": np.float64(course[-1]),
            "index_of_record": indices,
            "start_slip_force": starts,
            "start_index": values,
            "generation_index": course,
            "evaluations": np.int64(tried),
        },
        {
            "storey": np.arange(1, bench.storeys + 1),
            "distribution": list(started),
            "generation": np.arange(course.size),
        },
        OPTIMUM,
        bench.motions,
        title="Best slip forces of a building with friction dampers",
        parameters={
            **{name: value for name, value in building.parameters.items() if "slip_force" not in name},
            "index": weights_of(index),
            "distribution": distribution,
            "statistic": statistic,
            "population": population,
            "generations": generations,
            "seed": seed,
        },
        command="fdspec.optimise",
    )


def _require(name: str, count: object, least: int) -> None:
    if not (isinstance(count, int) and count >= least):
        raise InvalidInput(f"{name} must be a whole number of at least {least}, got {count!r}")


def shape_of(bench: Bench, distribution: str) -> FloatArray:
    """Return the slip forces (N,) of a distribution of one number, up to that number; the largest is 1."""
    if distribution == "uniform":
        return np.where(bench.braced_storeys, 1.0, 0.0)
    shear = np.where(bench.braced_storeys, bench.braced_storey_shear, 0.0)
    return np.asarray(shear / shear.max())


def best_scale(bench: Bench, shape: FloatArray, band: float = BAND, judge: Function | None = None) -> Scan:
    """Scan the factor on a shape (N,) up to where no damper slips any more: a `Scan` over the factor.

    judge: takes slip forces (c, N) and returns what is to be least (c,), the bench's own unless given.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = np.where(shape > 0.0, bench.never_slips / shape, 0.0)
    points, finest = (FRAME_POINTS, FRAME_FINEST) if bench.storeys > 1 else (POINTS, FINEST)
    top = float(needed.max())

    def judged(factor: FloatArray) -> FloatArray:
        return (judge or bench.judge)(factor[:, np.newaxis] * shape)

    return scan(judged, top, points=points, finest=finest, share=band)


def _scaled(bench: Bench, shape: FloatArray) -> tuple[FloatArray, float, int]:
    found = best_scale(bench, shape)
    return found.best * shape, found.least, found.x.size


def _evolved(
    bench: Bench,
    starts: FloatArray,
    values: FloatArray,
    members: int,
    generations: int,
    seed: int,
    done: Any,
) -> tuple[FloatArray, FloatArray, int]:
    """Evolve free slip forces from a population that holds the starts: forces, course and evaluations."""
    from scipy.optimize import differential_evolution

    braced = bench.braced_storeys
    top = bench.never_slips[braced]
    rng = np.random.default_rng(seed)
    size = max(members, 5, len(starts))
    shares = np.minimum(starts[:, braced] / top, 1.0)
    first = rng.uniform(0.0, 1.0, (size, top.size))
    about = np.arange(len(starts), max(size // 2, len(starts)))
    spread = np.exp(SPREAD * rng.standard_normal((about.size, top.size)))
    first[about] = np.cbrt(np.minimum(shares[about % len(starts)] * spread, 1.0))
    first[: len(starts)] = np.cbrt(shares)
    course = []
    count = 0

    def forces(genes: FloatArray) -> FloatArray:
        """Slip forces (c, N) of members (c, storeys with a brace): the cube spreads out what is weak."""
        full = np.zeros((genes.shape[0], bench.storeys))
        full[:, braced] = genes**3 * top
        return full

    def judged(columns: FloatArray) -> FloatArray:
        nonlocal count
        genes = np.atleast_2d(columns.T)
        count += genes.shape[0]
        found = bench.judge(forces(genes))
        return np.where(np.isfinite(found), found, np.finfo(float).max)

    def note(intermediate_result: Any) -> None:
        course.append(float(intermediate_result.fun))
        done(1)

    found = differential_evolution(
        judged,
        [(0.0, 1.0)] * top.size,
        init=first,
        maxiter=generations,
        rng=rng,
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=note,
        tol=1e-6,
    )
    force, least = forces(found.x[np.newaxis])[0], float(found.fun)
    best = int(values.argmin())
    if values[best] <= least:  # a start came back changed by the rounding of its cube root, and no better
        force, least = starts[best], float(values[best])
    history = np.minimum.accumulate([float(values[best]), *course])
    history[-1] = least
    return force, np.asarray(history), count
