"""The variables of a cube that a study of frames may name as its outputs."""

from __future__ import annotations

from typing import Final

from fdspec.variables import CUBE, device_variables

_OUTPUTS: Final = tuple(v for v in CUBE.values() if v.dims[:1] == ("record",) and len(v.dims) > 1)
DEMANDS: Final = tuple(v.name for v in device_variables(()))
"""What it computes of frames with columns that yield, gravity, slots or re-centring springs alone."""

OUTPUTS: Final = tuple(v.name for v in _OUTPUTS if not v.on_request and v.name not in DEMANDS)
"""What a study computes unless it names its outputs: what depends on more than the record."""

ON_REQUEST: Final = tuple(v.name for v in _OUTPUTS if v.on_request)
"""What it computes only where it is named."""
