"""One recommendation for one building and its records, with what it gains and how wrong it may be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from fdspec.choice.bench import Bench, without_braces
from fdspec.choice.by_storey import demands_of
from fdspec.choice.distribution import DISTRIBUTIONS, best_scale, optimise, shape_of
from fdspec.choice.search import Scan
from fdspec.choice.targets import Target, meet
from fdspec.choice.variables import CHOICE
from fdspec.errors import InvalidInput
from fdspec.measures.indices import Weights, weights_of
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.runs.cube import assemble
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.progress import progress as progress_bar

FloatArray = NDArray[np.float64]

CASES: Final = ("bare", "braced", "chosen", "lower", "upper")
"""Without braces; dampers that never slip; the recommendation; and that with friction at its bounds."""

RESPONSES: Final = {
    "peak_acceleration": "peak_acceleration",
    "peak_drift": "peak_displacement",
    "peak_base_shear": "peak_base_shear",
    "residual_drift": "residual_displacement",
    "slip_travel": "slip_travel",
    "dissipated_energy": "dissipated_energy",
}
"""Variable of the choice -> what a bench calls it."""

STIFFNESS_SCALE: Final = (0.5, 1.0, 2.0)
"""Factors on the braces' stiffness that are compared."""


def choose(
    building: Building,
    motions: GroundMotion | Sequence[GroundMotion],
    *,
    index: str | Weights = "acceleration",
    statistic: str = "mean",
    distribution: str = "uniform",
    lower: float = 0.8,
    upper: float = 1.2,
    band: float = 0.05,
    friction_coefficient: float = 0.5,
    normal_force_factor: float = 1.0,
    stiffness_scale: Sequence[float] = STIFFNESS_SCALE,
    limits: Mapping[str, float] | None = None,
    levels: Sequence[float] = (1.0,),
    seed: int = 0,
    workers: int | None = None,
    progress: Shown = False,
) -> xr.Dataset:
    """Recommend a pretension for one building and its records, and tell what it gains and may lose.

    Parameters
    ----------
    building : Building
        With its braces; its own slip forces tell nothing but the ratio of kinetic to static friction.
    motions : GroundMotion or sequence of them
        Named differently.
    index : str or mapping of str to float
        What is to be least; see `fdspec.measures.index_of`.
    statistic : str
        "mean", "median", "p84" or "worst" of it over the records.
    distribution : str
        Of the slip forces over the storeys: "uniform", "shear" or "free"; see `fdspec.optimise`.
    lower, upper : float
        Property modification factors on the slip force for the bounding analysis, 0 < lower <= 1 <= upper:
        ASCE/SEI 7-22, 18.2.4.5, asks that structures with damping systems be analysed with the least and
        with the largest properties that wear, temperature, testing and production leave room for.
    band : float
        Share above the least index that counts as nearly as good.
    friction_coefficient, normal_force_factor : float
        Pretension = slip force / (friction_coefficient * normal_force_factor).
    stiffness_scale : sequence of float
        Factors on the stiffness of all braces whose best is compared.
    limits : mapping of str to float, optional
        Recommend the least slip force that meets these instead, see `fdspec.choice.targets.meet`; where none
        does, that which comes closest.  Not with a free distribution.
    levels : sequence of float
        Factors on the motions at each of which the limits must be met.
    seed : int
        Of the search for a free distribution.
    workers : int, optional
        Threads; one a core unless given.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    xarray.Dataset
        The variables of `fdspec.choice.variables.CHOICE`: the recommendation and its band by storey; over
        (case, record) the responses of the bare and the braced frame, of the recommendation and of
        friction at its bounds, and of each storey (``storey_slip``, ``storey_drift``, ``storey_brace_force``
        and others, under the motions times ``storey_level``, the largest level); every pretension tried and
        the index there; the same for other braces.  With limits: ``limits_met``, ``used`` and
        ``meeting_slip_force``; the band is then the lowest stretch that meets them, NaN where there is none.
        `fdspec.report` makes text and a page of it.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Examples
    --------
    >>> import fdspec
    >>> frame = fdspec.Building.single_storey(period=0.5, stiffness_ratio=4, slip_force=1)
    >>> choice = fdspec.choose(frame, fdspec.load_record("FSR1"), stiffness_scale=[1])
    >>> bool(choice["index"].sel(case="chosen") < choice["index"].sel(case="braced"))
    True
    """
    _refuse_wrong(distribution, lower, upper, band)
    per_pretension = _per_pretension(friction_coefficient, normal_force_factor)
    scales = sorted({1.0, *(float(scale) for scale in stiffness_scale)})
    if not 0.0 < scales[0] <= scales[-1] < np.inf:
        raise InvalidInput(f"stiffness_scale must be positive and finite, got {list(stiffness_scale)!r}")
    given = (motions,) if isinstance(motions, GroundMotion) else tuple(motions)
    bench = Bench(building, given, index, statistic, workers)
    shape, scans, of_record = _searches(bench, distribution, seed, scales, band, progress)
    found = scans[1.0]
    if not np.isfinite(found.least):
        raise InvalidInput("no history of this building ended well: there is nothing to recommend")
    target = None
    force, stretch = found.best * shape, _stretch(found, band)
    if limits:
        target = meet(
            building,
            given,
            limits,
            levels=levels,
            statistic=statistic,
            distribution=distribution,
            lower=lower,
            upper=upper,
            workers=workers,
            progress=progress,
        )
        force, stretch = target.slip_force, target.stretch
    cases = {"chosen": force, "lower": lower * force, "upper": upper * force}
    responses, indices = _cases(bench, cases)
    level = max(levels) if limits else 1.0
    storeys = _by_storey(bench, cases, level)
    trials, trial_indices = found.x, of_record
    if target is not None:  # what is recommended was no trial of the search for the least index
        trials, trial_indices = _with_cases(trials, of_record, cases, indices)
    ends = _per_storey(stretch, shape)
    own = indices[CASES.index("chosen")]
    least = np.minimum(of_record.min(axis=0), own)  # the choice may be better than every trial
    variables = {
        "slip_force": force,
        "pretension": force / per_pretension,
        "band_slip_force": ends,
        "band_pretension": ends / per_pretension,
        "brace_stiffness": building.brace_stiffness,
        "brace_force": storeys["storey_brace_force"][CASES.index("upper")].max(axis=0),
        "scaled_index": np.array([scans[scale].least for scale in scales]),
        "scaled_pretension": np.array([scans[scale].best * shape for scale in scales]) / per_pretension,
        "trial_pretension": trials[:, np.newaxis] * shape / per_pretension,
        "trial_index": bench.together(trial_indices),
        "trial_index_of_record": trial_indices,
        "index": bench.together(indices),
        "index_of_record": indices,
        "regret": own / least - 1.0,
        **responses,
        "storey_level": np.float64(level),
        **storeys,
    }
    axes: dict[str, Any] = {
        "storey": np.arange(1, bench.storeys + 1),
        "bound": ["start", "end"],
        "case": list(CASES),
        "stiffness_scale": np.array(scales),
    }
    asked: dict[str, object] = {}
    if target is not None and limits:
        variables |= _met(target, shape)
        axes |= _axes_of(target, limits)
        asked = {"limits": dict(limits), "levels": axes["level"]}
    return assemble(
        variables,
        axes,
        CHOICE,
        bench.motions,
        title="Recommended pretension of a building with friction dampers",
        parameters={
            **{name: value for name, value in building.parameters.items() if "slip_force" not in name},
            "kinetic_ratio": bench.kinetic_ratio,
            "index": weights_of(index),
            "statistic": statistic,
            "distribution": distribution,
            "lower": lower,
            "upper": upper,
            "band": band,
            "friction_coefficient": friction_coefficient,
            "normal_force_factor": normal_force_factor,
            "seed": seed,
            **asked,
        },
        command="fdspec.choose",
    )


def _refuse_wrong(distribution: str, lower: float, upper: float, band: float) -> None:
    if distribution not in DISTRIBUTIONS:
        raise InvalidInput(f"distribution must be one of {', '.join(DISTRIBUTIONS)}, got {distribution!r}")
    if not 0.0 < lower <= 1.0 <= upper < np.inf:
        raise InvalidInput(f"lower and upper must be positive, about 1, got {lower!r} and {upper!r}")
    if not 0.0 <= band < np.inf:
        raise InvalidInput(f"band must be zero or positive, got {band!r}")


def _per_pretension(friction_coefficient: float, normal_force_factor: float) -> float:
    """Slip force per pretension."""
    for name, value in (
        ("friction_coefficient", friction_coefficient),
        ("normal_force_factor", normal_force_factor),
    ):
        if not 0.0 < value < np.inf:
            raise InvalidInput(f"{name} must be positive and finite, got {value!r}")
    return friction_coefficient * normal_force_factor


def _axes_of(target: Target, limits: Mapping[str, float]) -> dict[str, Any]:
    """Coordinates of what is told of the limits."""
    return {
        "level": sorted({one.level for one in target.demands}),
        "limited": list(limits),
        "stretch": np.arange(1, len(target.bands) + 1),
    }


def _searches(
    bench: Bench, distribution: str, seed: int, scales: Sequence[float], band: float, progress: Shown
) -> tuple[FloatArray, dict[float, Scan], FloatArray]:
    """Return the shape, the search over its scale by stiffness, and indices of the first by record."""
    with progress_bar(len(scales) + 1, "searches", shown=progress) as done:
        shape = _shape(bench, distribution, seed)
        done(1)
        found, of_record = _searched(bench, shape, band)
        done(1)
        scans = {1.0: found}
        for scale in scales:
            if scale != 1.0:
                other = replace(bench, building=_with_braces(bench.building, scale))
                scans[scale] = best_scale(other, shape, band)
                done(1)
    return shape, scans, of_record


def _shape(bench: Bench, distribution: str, seed: int) -> FloatArray:
    """Slip forces (N,) of the distribution over the largest of them."""
    if distribution != "free":
        return shape_of(bench, distribution)
    best = optimise(
        bench.building,
        bench.motions,
        index=bench.index,
        statistic=bench.statistic,
        seed=seed,
        workers=bench.workers,
    )["slip_force"].values
    return np.asarray(best / best.max()) if best.max() > 0.0 else shape_of(bench, "uniform")


def _searched(bench: Bench, shape: FloatArray, band: float) -> tuple[Scan, FloatArray]:
    """Scan, and keep the index of each record in every trial: (trials, records)."""
    factors, indices = [], []
    largest = int(shape.argmax())

    def judged(forces: FloatArray) -> FloatArray:
        each = bench.index_of(bench.respond(forces))
        factors.append(forces[:, largest])
        indices.append(each)
        return bench.together(each)

    found = best_scale(bench, shape, band, judged)
    order = np.argsort(np.concatenate(factors), kind="stable")
    return found, np.concatenate(indices)[order]


def _with_braces(building: Building, scale: float) -> Building:
    """The building with braces of another stiffness, whose dashpots keep their damping ratio."""
    return building.with_changes(
        brace_stiffness=scale * building.brace_stiffness,
        brace_damping=np.sqrt(scale) * building.brace_damping,
    )


def _cases(bench: Bench, forces: dict[str, FloatArray]) -> tuple[dict[str, FloatArray], FloatArray]:
    """Responses (cases, records) by name, and indices (cases, records)."""
    given = bench.respond(np.array([forces[case] for case in CASES[2:]]))
    rows = {name: [bench.bare[name], bench.braced[name], *given[name]] for name in given}
    table = {name: np.array(values) for name, values in rows.items()}
    return {name: table[of] for name, of in RESPONSES.items()}, bench.index_of(table)


def _by_storey(bench: Bench, forces: dict[str, FloatArray], level: float) -> dict[str, FloatArray]:
    """Demands (cases, records, N) of every storey, the motions times a level.

    A light brace rings when friction changes its sign, and so carries more than the slip force.
    """
    never = np.full(bench.storeys, np.inf)
    with_forces = [never, *(forces[case] for case in CASES[2:])]
    designs = [without_braces(bench.building), *(bench.with_slip_force(force) for force in with_forces)]
    shaken = bench if level == 1.0 else replace(bench, motions=[m.times(level) for m in bench.motions])
    return demands_of(designs, shaken)


def _with_cases(
    trials: FloatArray, of_record: FloatArray, cases: dict[str, FloatArray], indices: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Trials (t,) and the records' indices there (t, records), with those of the cases among them."""
    places = np.concatenate([trials, [force.max() for force in cases.values()]])
    values = np.concatenate([of_record, [indices[CASES.index(case)] for case in cases]])
    ascending, first = np.unique(places, return_index=True)
    return ascending, values[first]


def _stretch(found: Scan, band: float) -> FloatArray:
    """First and last place (2,) of the stretch about the best that is nearly as good."""
    bands = found.bands(band)
    return np.asarray(bands[(bands[:, 0] <= found.best) & (found.best <= bands[:, 1])][0])


def _met(target: Target, shape: FloatArray) -> dict[str, Any]:
    """What a choice holds of its limits."""
    levels = sorted({one.level for one in target.demands})
    used = np.array([one.value / one.limit for one in target.demands]).reshape(len(levels), -1)
    stretches = [_per_storey(stretch, shape) for stretch in target.bands]
    return {
        "used": used,
        "limits_met": np.int64(target.met),
        "meeting_slip_force": np.array(stretches).reshape(-1, 2, shape.size),
    }


def _per_storey(factor: FloatArray, shape: FloatArray) -> FloatArray:
    """Factors (m,), infinite ones among them, times a shape (N,): 0 where that is."""
    with np.errstate(invalid="ignore"):
        return np.where(shape > 0.0, factor[:, np.newaxis] * shape, 0.0)
