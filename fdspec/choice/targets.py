"""The least slip force at which a building meets limits, at every design level and bound of friction."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fdspec.choice.bench import Bench
from fdspec.choice.distribution import shape_of
from fdspec.errors import InvalidInput
from fdspec.model.building import Building
from fdspec.model.motion import GroundMotion
from fdspec.scheduling.progress import Shown
from fdspec.scheduling.progress import progress as progress_bar

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

LIMITED: Final = {
    "acceleration": "peak_acceleration",
    "drift": "peak_displacement",
    "drift_ratio": "peak_drift_ratio",
    "base_shear": "peak_base_shear",
    "residual_drift": "residual_displacement",
    "slip": "peak_slip",
    "slip_travel": "slip_travel",
}
"""What may be limited -> the response of `fdspec.choice.bench`; m/s2, m, 1, N, m, m, m."""

POINTS: Final = 257
"""Slip forces tried, evenly spaced from 0 to where no damper slips."""

SLIP_POINTS: Final = 65
"""The same where the slip of several storeys is limited, whose histories do not run side by side."""

FINEST: Final = 1e-4
"""Share of that range to which the ends of a band are located."""


AT_ONCE: Final = 32
"""Slip forces between two signs of progress."""


class Demand(NamedTuple):
    """One demand beside its limit: `value` is the statistic over the records, the largest over the bounds."""

    level: float
    name: str
    value: float
    limit: float


class Target(NamedTuple):
    """What slip forces meet all limits.

    bands (m, 2): first and last slip force of each stretch that does, N, of the storey with the largest; inf
    where it has no end.  slip_force (N,): the least, by storey, or where nothing meets all, that which comes
    closest.  demands: at that slip force.
    """

    met: bool
    bands: FloatArray
    slip_force: FloatArray
    demands: tuple[Demand, ...]

    @property
    def worst(self) -> Demand:
        """The demand that is largest against its limit."""
        return max(self.demands, key=lambda one: one.value / one.limit)

    @property
    def stretch(self) -> FloatArray:
        """First and last slip force (2,) of the lowest stretch, N; NaN where there is none."""
        return self.bands[0] if self.met else np.full(2, np.nan)


def target_of(choice: xr.Dataset) -> Target:
    """Return what a choice that was made to meet limits holds of them."""
    limits: dict[str, float] = json.loads(choice.attrs["parameters"])["limits"]
    force = choice["slip_force"].values
    of_all = choice["meeting_slip_force"].transpose("stretch", "bound", "storey").values
    told = tuple(
        Demand(float(level), str(name), float(choice["used"][i, j]) * limits[str(name)], limits[str(name)])
        for i, level in enumerate(choice["level"].values)
        for j, name in enumerate(choice["limited"].values)
    )
    bands = of_all.max(axis=2) if of_all.size else np.empty((0, 2))
    return Target(bool(choice["limits_met"]), bands, force, told)


def meet(
    building: Building,
    motions: GroundMotion | Sequence[GroundMotion],
    limits: Mapping[str, float],
    *,
    levels: Sequence[float] = (1.0,),
    statistic: str = "mean",
    distribution: str = "uniform",
    lower: float = 0.8,
    upper: float = 1.2,
    workers: int | None = None,
    progress: Shown = False,
) -> Target:
    """Find the slip forces at which a building meets limits.

    Parameters
    ----------
    building : Building
        With its braces, and with its storeys' heights where drift ratios are limited.
    motions : GroundMotion or sequence of them
    limits : mapping of str to float
        Of `LIMITED`: SI units, of many storeys the largest.
    levels : sequence of float
        Factors on the motions; the limits must be met at each.
    statistic : str
        "mean", "median", "p84" or "worst" of a demand over the records.
    distribution : str
        "uniform" or "shear"; see `fdspec.optimise`.
    lower, upper : float
        Factors on the slip force; the limits must be met at both and between, at 1.
    workers : int, optional
        Threads; one a core unless given.
    progress : bool or callable
        Show a bar on stderr where it is a terminal or a notebook's; or call this with (done, total).

    Returns
    -------
    Target

    Raises
    ------
    InvalidInput
        For an argument that cannot be used, by name and value.

    Notes
    -----
    A demand jumps from one slip force to the next where another peak becomes the largest, so that a stretch
    narrower than a step of the scan, `POINTS` or `SLIP_POINTS`, can be missed; one that is found does meet
    all limits at its ends.
    """
    if not limits:
        raise InvalidInput(f"limits must hold at least one of {', '.join(LIMITED)}")
    for name, limit in limits.items():
        if name not in LIMITED:
            raise InvalidInput(f"limit {name!r} is none of {', '.join(LIMITED)}")
        if not 0.0 < limit < np.inf:
            raise InvalidInput(f"limit {name} must be positive and finite, got {limit!r}")
    factors = sorted({float(level) for level in levels})
    if not factors or not 0.0 < factors[0] <= factors[-1] < np.inf:
        raise InvalidInput(f"levels must be positive factors, got {list(levels)!r}")
    if not 0.0 < lower <= 1.0 <= upper < np.inf:
        raise InvalidInput(f"lower and upper must be positive, about 1, got {lower!r} and {upper!r}")
    if distribution not in ("uniform", "shear"):
        raise InvalidInput(f"distribution must be uniform or shear, got {distribution!r}")
    bench = Bench(
        building,
        (motions,) if isinstance(motions, GroundMotion) else motions,
        "acceleration",
        statistic,
        workers,
        also=("peak_slip",) if "slip" in limits else (),
    )
    if "drift_ratio" in limits and np.isnan(bench.building.storey_height).any():
        raise InvalidInput("a limit on drift_ratio needs storey_height")
    benches = {level: replace(bench, motions=[m.times(level) for m in bench.motions]) for level in factors}
    shape = shape_of(bench, distribution)
    top = max(float(np.max(one.never_slips[shape > 0.0] / shape[shape > 0.0])) for one in benches.values())
    top /= lower
    bounds = np.array(sorted({lower, 1.0, upper}))

    def demands(force: FloatArray) -> FloatArray:
        """Demands over limits (levels, limits, forces), the largest over the bounds of friction."""
        rows = (force[:, np.newaxis] * bounds).ravel()[:, np.newaxis] * shape
        found = np.empty((len(factors), len(limits), force.size))
        for i, one in enumerate(benches.values()):
            responses = one.respond(rows)
            for j, (name, limit) in enumerate(limits.items()):
                found[i, j] = _of(one, name, responses).reshape(force.size, bounds.size).max(axis=1) / limit
        return found

    several = bench.storeys > 1 and not building.has_devices
    force = np.linspace(0.0, top, SLIP_POINTS if several and "slip" in limits else POINTS)
    parts = np.array_split(force, max(1, force.size // AT_ONCE))
    with progress_bar(len(parts), "slip forces", shown=progress) as done:
        found = []
        for part in parts:
            found.append(demands(part))
            done(1)
    shares = np.concatenate(found, axis=-1)
    worst = shares.max(axis=(0, 1))
    good = worst <= 1.0
    bands = _refined(force, good, lambda at: bool(demands(np.array([at])).max() <= 1.0), FINEST * top)
    best = float(bands[0, 0]) if good.any() else float(force[worst.argmin()])
    at_best = demands(np.array([best]))[..., 0]
    told = tuple(
        Demand(level, name, float(at_best[i, j] * limit), float(limit))
        for i, level in enumerate(factors)
        for j, (name, limit) in enumerate(limits.items())
    )
    return Target(bool(good.any()), bands, best * shape, told)


def _of(bench: Bench, name: str, responses: Mapping[str, FloatArray]) -> FloatArray:
    """The statistic of one demand over the records, (c,); inf where a history did not end well."""
    values = responses[LIMITED[name]]
    return bench.together(np.where(responses["status"] == 0.0, values, np.inf))


def _refined(
    force: FloatArray, good: NDArray[np.bool_], meets: Callable[[float], bool], finest: float
) -> FloatArray:
    """Stretches (m, 2) of forces that are good, their ends located by bisection from the inside."""
    steps = np.diff(good.astype(np.int8), prepend=0, append=0)
    found = []
    for first, after in zip(np.flatnonzero(steps == 1), np.flatnonzero(steps == -1), strict=True):
        start = force[first] if first == 0 else _edge(force[first], force[first - 1], meets, finest)
        end = np.inf if after == force.size else _edge(force[after - 1], force[after], meets, finest)
        found.append((start, end))
    return np.array(found).reshape(-1, 2)


def _edge(inside: float, outside: float, meets: Callable[[float], bool], finest: float) -> float:
    """The last place known to be good on the way from a good one to a bad one."""
    while abs(outside - inside) > finest:
        middle = 0.5 * (inside + outside)
        if meets(middle):
            inside = middle
        else:
            outside = middle
    return float(inside)
