"""Inelastic response spectra of ground motions, at constant strength, ductility or reduction factor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fdspec.engines.bilinear import (
    MOST_ROOTS,
    Oscillator,
    bilinear_peaks,
    ductility_strengths,
    elastic_strength,
)
from fdspec.errors import InvalidInput
from fdspec.kernels.bilinear.history import RESULTS
from fdspec.model.motion import GroundMotion
from fdspec.model.number_check import finite_number
from fdspec.runs.cost import PER_OSCILLATOR
from fdspec.runs.cube import assemble, named
from fdspec.runs.spectra_variables import registry
from fdspec.scheduling.task import plan
from fdspec.scheduling.threads import fan_out
from fdspec.signals.spectra import SHORTEST

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

HISTORIES_OF_A_SCAN: Final = 150
"""Histories that the search for one period's strengths takes, roughly."""

AXES: Final = {
    "strength": "strength",
    "ductility": "ductility_target",
    "reduction_factor": "reduction_factor",
}


def inelastic_spectra(
    motions: GroundMotion | Sequence[GroundMotion],
    period: ArrayLike,
    *,
    damping_ratio: float = 0.05,
    hardening_ratio: float = 0.0,
    strength: ArrayLike | None = None,
    ductility: ArrayLike | None = None,
    reduction_factor: ArrayLike | None = None,
    collapse_ductility: float | None = None,
    workers: int | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Compute spectra of an oscillator whose spring yields: peaks are exact, of the continuous motion.

    Parameters
    ----------
    motions : GroundMotion or sequence of them
        Named differently; their names become the ``record`` coordinate.
    period : array_like, s
        Natural periods of the elastic oscillator, strictly increasing.  0 is a rigid block that slides.
        Others are at least a twentieth of the longest time step.
    damping_ratio : float
        Of the elastic oscillator, at least 0 and below 1.  The dashpot stays as it is while the spring
        yields.
    hardening_ratio : float
        Stiffness after yield over stiffness before, below 1.  Zero is elastoplastic; below zero the
        spring loses force as it yields.
    strength : array_like, m/s2, optional
        Yield strengths over mass.
    ductility : array_like, optional
        Ductilities, 1 or more, for which strengths are searched.
    reduction_factor : array_like, optional
        Elastic strength over yield strength, 1 or more.  Exactly one of the three is given.
    collapse_ductility : float, optional
        Ductility at which a history ends as collapsed.  For a negative hardening ratio that at which the
        spring's force is used up, one more than the inverse of its magnitude; else none.
    workers : int, optional
        Threads; one a core unless given.
    progress : bool
        Show a bar on stderr where it is a terminal.

    Returns
    -------
    xarray.Dataset
        Over (record, period, strength | ductility_target | reduction_factor); variables, units and meanings
        are those of `fdspec.runs.spectra_variables.registry`.  Of a ductility, ``strength`` is the smallest
        above which it is never exceeded; ``roots`` says how many strengths give it exactly, for ductility
        is not monotonic in strength, and ``root_strength`` which.

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Notes
    -----
    The oscillator starts at rest; after the record's end it goes on until it cannot yield any more
    and no larger displacement can come.  Per unit mass u'' + c u' + f(u) = -a_g.

    Examples
    --------
    >>> import fdspec
    >>> motion = fdspec.load_record("FSR1")
    >>> spectra = inelastic_spectra(motion, [0.2, 0.5, 1.0], ductility=[2, 4])
    >>> spectra.strength.shape
    (1, 3, 2)
    """
    records = named(motions)
    periods = _increasing("period", period)
    shortest = max(motion.dt for motion in records) * SHORTEST
    for value in periods[(periods != 0.0) & (periods < shortest)]:
        raise InvalidInput(
            f"period must be 0 or at least {shortest:g} s, a twentieth of the longest dt, not {value:g}"
        )
    kind, levels = _levels(strength=strength, ductility=ductility, reduction_factor=reduction_factor)
    oscillator = Oscillator(
        _between("damping_ratio", damping_ratio, 0.0, 1.0),
        _between("hardening_ratio", hardening_ratio, -math.inf, 1.0),
        _collapse(collapse_ductility, hardening_ratio),
    )
    each = HISTORIES_OF_A_SCAN if kind == "ductility" else levels.size
    seconds = [periods.size * each * motion.n * PER_OSCILLATOR for motion in records]
    tasks = plan(periods.size, seconds, None, "period")
    parts = fan_out(
        partial(_work, oscillator, periods, kind, levels),
        records,
        tasks,
        each=1,
        warm=_warm,
        workers=workers,
        scheduler="threads",
        progress=progress,
        what="periods",
    )
    shape = (len(records), periods.size, levels.size)
    peaks = np.empty((*shape, len(RESULTS)))
    strengths, roots = np.empty(shape), np.empty((*shape, MOST_ROOTS))
    counts, elastic = np.empty(shape, np.int64), np.empty(shape[:2])
    for task, part in zip(tasks, parts, strict=True):
        at = (task.record, task.items)
        peaks[at], strengths[at], roots[at], counts[at], elastic[at] = part
    return assemble(
        _variables(kind, periods, peaks, strengths, roots, counts, elastic),
        {"period": periods, AXES[kind]: levels} | ({"root": _numbers(counts)} if kind == "ductility" else {}),
        registry(kind),
        records,
        title="Inelastic response spectra",
        parameters={
            "period": periods,
            "damping_ratio": oscillator.damping_ratio,
            "hardening_ratio": oscillator.hardening_ratio,
            "collapse_ductility": oscillator.collapse_ductility,
            kind: levels,
        },
        command="fdspec.inelastic_spectra",
    )


class Part(NamedTuple):
    """What a task returns of its periods (n,) and levels (m,)."""

    peaks: FloatArray
    strengths: FloatArray
    roots: FloatArray
    counts: IntArray
    elastic: FloatArray


def _work(
    oscillator: Oscillator,
    periods: FloatArray,
    kind: str,
    levels: FloatArray,
    items: IntArray,
    motion: GroundMotion,
) -> Part:
    shape = (items.size, levels.size)
    part = Part(
        np.empty((*shape, len(RESULTS))),
        np.empty(shape),
        np.full((*shape, MOST_ROOTS), np.nan),
        np.zeros(shape, np.int64),
        np.empty(items.size),
    )
    for k, period in enumerate(periods[items]):
        part.elastic[k] = elastic_strength(oscillator, period, motion)
        if kind == "strength":
            part.strengths[k] = levels
        elif kind == "reduction_factor":
            part.strengths[k] = part.elastic[k] / levels
        else:
            part.roots[k], part.counts[k] = ductility_strengths(oscillator, period, levels, motion)
            part.strengths[k] = part.roots[k, :, 0]
        part.peaks[k] = bilinear_peaks(oscillator, period, part.strengths[k], motion)
    return part


def _variables(
    kind: str,
    periods: FloatArray,
    peaks: FloatArray,
    strengths: FloatArray,
    roots: FloatArray,
    counts: IntArray,
    elastic: FloatArray,
) -> dict[str, NDArray[np.generic]]:
    """Return name -> values, for the registry of this kind."""
    named_peaks = {name: peaks[..., k] for k, name in enumerate(RESULTS)}
    stiffness = np.full(periods.size, np.inf)
    np.divide(4.0 * math.pi**2, periods**2, out=stiffness, where=periods > 0.0)
    displacement = named_peaks["peak_displacement"]
    with np.errstate(invalid="ignore"):
        ductility = displacement * stiffness[:, np.newaxis] / strengths
    rigid = periods == 0.0  # no yield displacement: at rest, or beyond every ductility
    ductility[:, rigid] = np.where(displacement[:, rigid] > 0.0, np.inf, 0.0)
    found: dict[str, NDArray[np.generic]] = {
        **named_peaks,
        "ductility": ductility,
        "transitions": named_peaks["transitions"].astype(np.int64),
        "status": named_peaks["status"].astype(np.int8),
        "elastic_strength": elastic,
    }
    if kind != "strength":
        found["strength"] = strengths
    if kind != "reduction_factor":
        found["reduction_factor"] = elastic[..., np.newaxis] / strengths
    if kind == "ductility":
        found["roots"] = counts
        found["root_strength"] = roots[..., : _numbers(counts).size]
    return found


def _numbers(counts: IntArray) -> IntArray:
    return np.arange(1, min(MOST_ROOTS, max(1, int(counts.max(initial=1)))) + 1)


def _warm() -> None:
    motion = GroundMotion([0.0, 1.0, 0.0], 0.1, name="warm")
    oscillator = Oscillator(0.05, 0.0, math.inf)
    bilinear_peaks(oscillator, 1.0, np.array([0.1]), motion)


def _levels(**given: ArrayLike | None) -> tuple[str, FloatArray]:
    """Return which of the three levels was given, and its values."""
    kinds = [name for name, values in given.items() if values is not None]
    if len(kinds) != 1:
        told = " and ".join(kinds) if kinds else "none"
        raise InvalidInput(f"give one of strength, ductility and reduction_factor; {told} was given")
    kind = kinds[0]
    values = given[kind]
    assert values is not None  # noqa: S101 - for the type checker; just counted
    levels = _increasing(kind, values)
    least = 0.0 if kind == "strength" else 1.0
    if levels[0] < least or (kind == "strength" and levels[0] == 0.0):
        text = "positive" if kind == "strength" else "1 or more"
        raise InvalidInput(f"{kind} must be {text}, not {levels[0]:g}")
    return kind, levels


def _increasing(argument: str, values: ArrayLike) -> FloatArray:
    try:
        axis = np.atleast_1d(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        raise InvalidInput(f"{argument} must be a number or a sequence of numbers, not {values!r}") from None
    if axis.ndim != 1 or axis.size == 0 or not np.isfinite(axis).all() or axis[0] < 0.0:
        raise InvalidInput(f"{argument} must be one or more finite numbers, 0 or more, not {values!r}")
    if (np.diff(axis) <= 0.0).any():
        raise InvalidInput(f"{argument} must be strictly increasing, not {values!r}")
    return axis


def _between(argument: str, value: float, least: float, below: float) -> float:
    value = finite_number(argument, value)
    if not (least <= value < below and math.isfinite(value)):
        text = f"below {below:g}" if math.isinf(least) else f"at least {least:g} and below {below:g}"
        raise InvalidInput(f"{argument} must be {text}, not {value:g}")
    return float(value)


def _collapse(given: float | None, hardening_ratio: float) -> float:
    if given is not None:
        if not given > 1.0:
            raise InvalidInput(f"collapse_ductility must be more than 1, not {given!r}")
        return float(given)
    return 1.0 - 1.0 / hardening_ratio if hardening_ratio < 0.0 else math.inf
