"""A lognormal fragility curve by maximum likelihood, from histories that exceeded a limit and others.

P(exceeds | im) = Phi((ln im - ln median) / dispersion), each history an independent trial (Baker, 2015,
Earthquake Spectra 31(1), equations 10 and 11).  In a + b ln im, with b = 1/dispersion, the likelihood is
concave, so Newton's method finds its one maximum.

Histories of one record at several intensities are no independent trials, though.  The maximum is still a
consistent estimate, but its errors are those of as many trials as there are records: the covariance is the
clustered one (Liang and Zeger, 1986), which sums the scores of each record before it squares them.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

FITTED: Final = 0
NONE_EXCEEDS: Final = 1
ALL_EXCEED: Final = 2
SEPARATED: Final = 3
NOT_INCREASING: Final = 4
FIT_STATUSES: Final = ("fitted", "none_exceeds", "all_exceed", "separated", "not_increasing")
"""How a fit ended, by code.  Separated: every history above some intensity exceeds the limit and none below
it does, so that no dispersion is too small."""

STEPS: Final = 200
"""Newton takes about ten."""


class Fit(NamedTuple):
    """A fit: median and dispersion, the covariance of a and b, the log-likelihood, and its status."""

    median: float
    dispersion: float
    variance_a: float
    covariance: float
    variance_b: float
    log_likelihood: float
    status: int


def fit_lognormal(
    intensity: FloatArray, exceeds: BoolArray, record: IntArray, weight: FloatArray | None = None
) -> Fit:
    """Fit one curve to histories: intensity (n,), positive; exceeds (n,); record (n,), numbers of the
    records; weight (n,), a count of alike ones."""
    weight = np.ones(intensity.size) if weight is None else weight
    counted = weight > 0.0
    x, yes = np.log(intensity[counted]), exceeds[counted]
    record, weight = record[counted], weight[counted]
    status = _status(x, yes)
    if status != FITTED:
        return _no_fit(math.nan, status)
    centre, spread = float(np.mean(x)), float(np.std(x))
    z = (x - centre) / spread
    design = np.stack([np.ones_like(z), z])
    sign = np.where(yes, 1.0, -1.0)
    theta = np.array([0.0, 1.0])
    value = _log_likelihood(theta, design, sign, weight)
    scores, information = _derivatives(theta, design, sign, weight)
    for _ in range(STEPS):
        step = np.linalg.solve(information, scores.sum(axis=1))
        while (ahead := _log_likelihood(theta + step, design, sign, weight)) < value - 1e-12 * abs(value):
            step *= 0.5
        theta, value = theta + step, ahead
        scores, information = _derivatives(theta, design, sign, weight)
        if np.abs(step).max() <= 1e-13 * np.abs(theta).max():
            break
    to_log = np.array([[1.0, -centre / spread], [0.0, 1.0 / spread]])
    a, b = to_log @ theta
    if b <= 0.0:
        return _no_fit(value, NOT_INCREASING)
    covariance = to_log @ _clustered(information, scores, record) @ to_log.T
    return Fit(math.exp(-a / b), 1.0 / b, covariance[0, 0], covariance[0, 1], covariance[1, 1], value, FITTED)


def _no_fit(log_likelihood: float, status: int) -> Fit:
    missing = math.nan
    return Fit(missing, missing, missing, missing, missing, log_likelihood, status)


def _derivatives(
    theta: FloatArray, design: FloatArray, sign: FloatArray, weight: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The score of each history (2, n) and the information matrix (2, 2), its negative second derivative."""
    eta = sign * (theta @ design)
    mills = np.exp(-0.5 * eta * eta - 0.5 * math.log(2.0 * math.pi) - log_ndtr(eta))
    return design * (weight * sign * mills), (design * (weight * mills * (mills + eta))) @ design.T


def _clustered(information: FloatArray, scores: FloatArray, record: IntArray) -> FloatArray:
    """The covariance of the maximum from the information matrix and the scores (2, n) of each history."""
    names, cluster = np.unique(record, return_inverse=True)
    sums = np.stack([np.bincount(cluster, row, names.size) for row in scores])
    inverse = np.linalg.inv(information)
    few = names.size / max(names.size - 1, 1)
    return np.asarray(few * inverse @ (sums @ sums.T) @ inverse)


def _log_likelihood(theta: FloatArray, design: FloatArray, sign: FloatArray, weight: FloatArray) -> float:
    return float(weight @ log_ndtr(sign * (theta @ design)))


def _status(x: FloatArray, yes: BoolArray) -> int:
    if not yes.any():
        return NONE_EXCEEDS
    if yes.all():
        return ALL_EXCEED
    below, above = x[~yes], x[yes]
    if below.max() <= above.min() and below.min() < above.max():
        return SEPARATED
    return NOT_INCREASING if np.ptp(x) == 0.0 or above.max() <= below.min() else FITTED
