"""What lies between samples."""

from __future__ import annotations

import numpy as np

from fdspec.course import FloatArray


def crest(samples: FloatArray) -> float:
    """Largest value of the parabola through the largest sample inside and its neighbours."""
    i = int(np.argmax(samples[1:-1])) + 1
    before, at, after = samples[i - 1 : i + 2]
    return float(at + (after - before) ** 2 / (8.0 * (2.0 * at - before - after)))
