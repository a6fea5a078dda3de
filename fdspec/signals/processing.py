"""Signal steps on a ground motion: pure functions, each of which leaves a trace in the motion's history."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion
from fdspec.model.number_check import finite_number, positive_number
from fdspec.signals.intensity import arias_time, velocity

MAX_DENOMINATOR = 1000
"""Resampling by a ratio of whole numbers needs a filter as long as the larger of them."""


MAX_PADDING = 10_000_000
"""Samples; a day at 100 Hz. More is a slip of the finger, and may not fit the memory."""


def trimmed(motion: GroundMotion, start: float = 0.0, end: float | None = None) -> GroundMotion:
    """Return the samples from time `start` to `end`, s, both included; times count from 0 again."""
    start = finite_number("start", start)
    stop = motion.duration if end is None else finite_number("end", end)
    # Times such as 0.3 are a rounding away from their sample k dt.
    first = max(math.ceil(start / motion.dt - 1e-6), 0)
    last = min(math.floor(stop / motion.dt + 1e-6), motion.n - 1)
    if last - first < 1:
        raise InvalidInput(f"start and end must keep 2 samples or more, not {start!r} to {stop!r} s")
    kept = motion.acceleration[first : last + 1]
    return _changed(motion, kept, f"trimmed to {first * motion.dt:g} to {last * motion.dt:g} s")


def trimmed_by_arias(motion: GroundMotion, start: float = 0.05, end: float = 0.95) -> GroundMotion:
    """Return the samples between two shares of the Arias intensity, the sample before and after included."""
    if not 0.0 <= start < end <= 1.0:
        raise InvalidInput(f"start and end must be 0 <= start < end <= 1, not {start!r} and {end!r}")
    first = math.floor(arias_time(motion, start) / motion.dt + 1e-9)
    last = min(math.ceil(arias_time(motion, end) / motion.dt - 1e-9), motion.n - 1)
    kept = motion.acceleration[first : max(last, first + 1) + 1]
    return _changed(motion, kept, f"trimmed to {start:g} to {end:g} of the Arias intensity")


def padded(motion: GroundMotion, before: float = 0.0, after: float = 0.0) -> GroundMotion:
    """Return the motion with zeros for `before` and `after` seconds, rounded to whole samples."""
    counts = []
    for argument, seconds in (("before", before), ("after", after)):
        if finite_number(argument, seconds) < 0.0:
            raise InvalidInput(f"{argument} must be 0 s or more, not {seconds!r}")
        if seconds > MAX_PADDING * motion.dt:
            raise InvalidInput(f"{argument} must be at most {MAX_PADDING * motion.dt:g} s, not {seconds!r}")
        counts.append(round(seconds / motion.dt))
    return _changed(
        motion,
        np.pad(motion.acceleration, counts),
        f"padded with {counts[0] * motion.dt:g} s of zeros before and {counts[1] * motion.dt:g} s after",
    )


def resampled(motion: GroundMotion, dt: float) -> GroundMotion:
    """Return the motion at another time step, s, by a polyphase filter (scipy.signal.resample_poly).

    The filter takes out what the new step cannot carry. A finer step changes the motion too: between samples
    the original is linear and the filtered one is not. The solver needs no finer step. The line from the
    first to the last sample is left out of the filter, so that the ends do not fade towards zero; no sample
    stands behind the original's last.
    """
    from scipy.signal import resample_poly

    dt = positive_number("dt", dt, "s")
    ratio = Fraction(motion.dt / dt).limit_denominator(MAX_DENOMINATOR)
    if ratio == 0 or ratio.numerator > MAX_DENOMINATOR or abs(float(ratio) * dt / motion.dt - 1.0) > 1e-9:
        raise InvalidInput(
            f"dt must stand to {motion.dt!r} s as two whole numbers up to {MAX_DENOMINATOR}, not {dt!r}"
        )
    first, last = motion.acceleration[0], motion.acceleration[-1]
    share: NDArray[np.float64] = np.arange(motion.n, dtype=np.float64) / (motion.n - 1)
    filtered = resample_poly(
        motion.acceleration - (first + (last - first) * share), ratio.numerator, ratio.denominator
    )
    count = (motion.n - 1) * ratio.numerator // ratio.denominator + 1
    if count < 2:
        raise InvalidInput(f"dt must leave 2 samples or more of {motion.duration:g} s, not {dt!r}")
    share = np.arange(count, dtype=np.float64) * (ratio.denominator / ratio.numerator / (motion.n - 1))
    samples = np.asarray(filtered[:count] + (first + (last - first) * share), dtype=np.float64)
    changed = _changed(motion, samples, f"resampled from {motion.dt:g} to {dt:g} s")
    return replace(changed, dt=dt)


def baseline_corrected(motion: GroundMotion, order: int = 1) -> GroundMotion:
    """Return the motion less the polynomial of `order` in time that fits its velocity best, from rest.

    The polynomial's derivative is what is taken from the acceleration: order 1 removes a constant, 2 a line.
    """
    if order not in range(1, 9):
        raise InvalidInput(f"order must be a whole number from 1 to 8, not {order!r}")
    time = np.linspace(0.0, 1.0, motion.n)  # of the duration: powers of seconds would be ill-conditioned
    powers = np.stack([time**k for k in range(1, order + 1)], axis=1)
    weights = np.linalg.lstsq(powers, velocity(motion), rcond=None)[0]
    drift = sum(k * weight * time ** (k - 1) for k, weight in enumerate(weights, start=1)) / motion.duration
    return _changed(motion, motion.acceleration - drift, f"baseline corrected, velocity of order {order}")


def band_passed(motion: GroundMotion, low: float, high: float, order: int = 4) -> GroundMotion:
    """Return the motion filtered to `low` to `high`, Hz: Butterworth, forward and backward, so without delay.

    Passing twice doubles the order's effect. Pad the motion first when its ends matter.
    """
    from scipy.signal import butter, sosfiltfilt

    low, high = positive_number("low", low, "Hz"), positive_number("high", high, "Hz")
    nyquist = 0.5 / motion.dt
    if not low < high < nyquist:
        raise InvalidInput(f"low and high must be 0 < low < high < {nyquist:g} Hz, not {low!r} and {high!r}")
    if order not in range(1, 13):
        raise InvalidInput(f"order must be a whole number from 1 to 12, not {order!r}")
    sections = butter(order, [low, high], btype="bandpass", fs=1.0 / motion.dt, output="sos")
    samples = sosfiltfilt(sections, motion.acceleration, padlen=min(6 * order, motion.n - 1))
    return _changed(
        motion, samples, f"band-passed {low:g} to {high:g} Hz, Butterworth order {order} both ways"
    )


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> tuple[GroundMotion, GroundMotion]:
    """Return two components at right angles, turned by `angle` degrees from the first to the second.

    The first of the pair points along ``cos(angle) first + sin(angle) second``; the second is 90 degrees on.
    """
    angle = finite_number("angle", angle)
    if first.n != second.n or first.dt != second.dt:
        raise InvalidInput(
            "a pair must agree in samples and dt, "
            f"not {first.n} of {first.dt!r} s and {second.n} of {second.dt!r} s"
        )
    cosine, sine = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    a, b = first.acceleration, second.acceleration
    names = [motion.component or motion.name for motion in (first, second)]
    pair = f"rotated by {angle:g} degrees, from {names[0]} to {names[1]}"
    return (
        _changed(first, cosine * a + sine * b, pair),
        _changed(second, cosine * b - sine * a, pair),
    )


def _changed(motion: GroundMotion, samples: NDArray[np.float64], step: str) -> GroundMotion:
    return replace(motion, acceleration=samples, history=(*motion.history, step))
