"""What a reader hands over: one channel of a file, in SI units, with the file's own words about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Channel:
    """One acceleration channel of a record file.

    `name` is how a caller picks it among others of the file, `acceleration` is in m/s2, `dt` in s, `units`
    are those of the file, `processing` says what was done to the samples, by the agency or by us before they
    were written, one step an item. `source` and `scale_factor` are those of a motion that we wrote.

    A channel whose samples are not at equal steps has their `times`, s, and the text of its `refusal`; its
    `dt` is then the median step.
    """

    name: str
    acceleration: NDArray[np.float64]
    dt: float
    units: str
    event: str = ""
    station: str = ""
    component: str = ""
    processing: tuple[str, ...] = ()
    source: str = ""
    scale_factor: float = 1.0
    times: NDArray[np.float64] | None = None
    refusal: str = ""
