"""Channels whose samples stand at unequal times, as film was digitised: interpolated on request."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from fdspec.errors import RecordError
from fdspec.records.channel import Channel

MAX_SAMPLES: Final = 50_000_000


def at_equal_steps(name: str, channel: Channel, step: float | None) -> Channel:
    """Return the channel at equal steps of `step`, s, on the lines between its samples.

    Raises
    ------
    RecordError
        When the steps are unequal and no step is given, or equal and another is.
    """
    if channel.times is None:
        if step is not None and abs(step - channel.dt) > 1e-9 * channel.dt:
            raise RecordError(
                f"{name}: resample_to is for unequal steps, and these are equal, {channel.dt:g} s: "
                "fdspec.signals.processing.resampled, or `fdspec records convert --resample`, changes them"
            )
        return channel
    if step is None:
        raise RecordError(channel.refusal)
    times = channel.times - channel.times[0]
    count = int(np.floor(times[-1] / step * (1.0 + 1e-12))) + 1
    if not 2 <= count <= MAX_SAMPLES:
        raise RecordError(
            f"{name}: resample_to must leave 2 to {MAX_SAMPLES} samples of {times[-1]:g} s, not {count}"
        )
    samples = np.interp(np.arange(count) * step, times, channel.acceleration)
    steps = np.diff(channel.times)
    peaks = float(np.abs(channel.acceleration).max()), float(np.abs(samples).max())
    done = (
        f"on reading, interpolated from unequal steps of {steps.min():g} to {steps.max():g} s to {step:g} s; "
        f"the peak was {peaks[0]:.6g} and is {peaks[1]:.6g} m/s2"
    )
    return replace(
        channel,
        acceleration=samples,
        dt=step,
        times=None,
        refusal="",
        processing=(*channel.processing, done),
    )
