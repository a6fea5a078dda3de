"""How fast the parts of a frame of N storeys can move: what limits the steps of its histories."""

from __future__ import annotations

from typing import Any

import numpy as np

from fdspec.engines.trajectory import FloatArray
from fdspec.kernels.frame.model import BRACE_MASS, SLIP_FORCE, held_rates, rate_of, slip_norms
from fdspec.model.building import Frame


def rates_of(frame: Frame) -> FloatArray:
    """Bounds on the rates (1/s) that steps have to follow.

    The first is that of the frame with every damper stuck; one of each storey's follows, that of its
    brace where that has mass and may slip, else 0.  A massless brace asks for none that lasts.
    """
    # Plain Python: compiling them for this alone would take longer than most histories.
    held_of, norms_of, rate_in = (plain(rule) for rule in (held_rates, slip_norms, rate_of))
    held = held_of(frame.properties, frame.dense_stiffness, frame.dense_damping)
    size = frame.properties.shape[1]
    slips = (frame.properties[BRACE_MASS] > 0.0) & np.isfinite(frame.properties[SLIP_FORCE])
    own = [rate_in(*norms_of(frame.properties, held, i)) if slips[i] else 0.0 for i in range(size)]
    return np.array([rate_in(*held), *own])


def plain(rule: Any) -> Any:
    """Return a kernel's rule as the Python function that it was compiled from."""
    return getattr(rule, "py_func", rule)
