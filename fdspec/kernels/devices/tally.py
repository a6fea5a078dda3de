"""What a link adds up from event to event."""

from __future__ import annotations

from fdspec.compiler.options import inner
from fdspec.kernels.devices.law import work_of_friction
from fdspec.kernels.devices.layout import (
    ANCHOR,
    KIND,
    ONE_SIDED,
    PHASE,
    STATIC,
    TRAVEL,
    WORK,
    O,
)
from fdspec.kernels.types import STICK


@inner
def work_since(frame, state, j, offset):
    """Energy (J) dissipated since the last event up to an instant with this offset."""
    if state.mode[PHASE, j] == STICK:
        return 0.0
    if frame.places[KIND, j] == ONE_SIDED:
        return frame.links[STATIC, j] * (offset - state.tally[ANCHOR, j]) if state.mode[PHASE, j] > 0 else 0.0
    return work_of_friction(frame, j, state.tally[ANCHOR, j], offset)


@inner
def travel_since(frame, state, j, offset):
    """Distance (m) slipped since the last event."""
    if state.mode[PHASE, j] == STICK or (frame.places[KIND, j] == ONE_SIDED and state.mode[PHASE, j] < 0):
        return 0.0
    return abs(offset - state.tally[ANCHOR, j])


@inner
def close_travel(frame, state, j):
    """Count work and distance up to now, and begin anew."""
    offset = state.sliders[O, j]
    state.tally[TRAVEL, j] += travel_since(frame, state, j, offset)
    state.tally[WORK, j] += work_since(frame, state, j, offset)
    state.tally[ANCHOR, j] = offset
