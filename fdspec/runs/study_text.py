"""What a study file writes: axes, records, links and devices as TOML, and axes read back from their ends."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from decimal import Decimal
from typing import Any, Final

import numpy as np

from fdspec.model.grid import FloatArray, Grid
from fdspec.model.link import Link
from fdspec.runs.record_scaling import Scaling
from fdspec.runs.study_records import RecordFile, is_finite

MAX_AXIS: Final = 1_000_000
"""Points of one axis; a step with a slipped decimal is refused before it fills the memory."""


def even_axis(spec: Mapping[str, Any]) -> FloatArray:
    """Return the points of { start, stop, step } or { start, stop, num }, both ends included.

    Steps are counted in decimals, so that 0.05, 0.10, ... are the floats one would write.
    """
    if unknown := [key for key in spec if key not in {"start", "stop", "step", "num"}]:
        raise ValueError(
            f"unknown key {unknown[0]!r}; {{ start, stop, step }} or {{ start, stop, num }} is known"
        )
    if "start" not in spec or "stop" not in spec or ("step" in spec) == ("num" in spec):
        raise ValueError(f"needs start, stop and one of step and num, got {', '.join(spec) or 'nothing'}")
    for key, value in spec.items():
        if not is_finite(value):
            raise ValueError(f"{key} must be a finite number, got {value!r:.60}")
    start, stop = Decimal(repr(spec["start"])), Decimal(repr(spec["stop"]))
    if "num" in spec:
        if not isinstance(spec["num"], int) or not 2 <= spec["num"] <= MAX_AXIS:
            raise ValueError(f"num must be an integer from 2 to {MAX_AXIS}, got {spec['num']!r:.60}")
        steps = spec["num"] - 1
        return np.array([float(start + (stop - start) * k / steps) for k in range(steps + 1)])
    step = Decimal(repr(spec["step"]))
    if step <= 0 or stop < start:
        raise ValueError(f"step must be positive and stop not before start, got {start} to {stop} by {step}")
    if (stop - start) / step >= MAX_AXIS:
        raise ValueError(f"has more than {MAX_AXIS} points: {start} to {stop} by {step}")
    if (stop - start) % step:
        raise ValueError(f"steps of {step} from {start} do not end on {stop}")
    return np.array([float(start + step * k) for k in range(int((stop - start) / step) + 1)])


def axis_text(axis: FloatArray) -> str:
    """Write an axis as { start, stop, step } where that gives the same floats, else as a list."""
    if axis.size > 3:
        start, second, stop = (Decimal(repr(float(axis[k]))) for k in (0, 1, -1))
        spec = {"start": float(start), "stop": float(stop), "step": float(second - start)}
        try:
            even = np.array_equal(even_axis(spec), axis)
        except ValueError:
            even = False
        if even:
            return "{ " + ", ".join(f"{key} = {value!r}" for key, value in spec.items()) + " }"
    return "[" + ", ".join(repr(float(value)) for value in axis) + "]"


def records_text(records: tuple[str | RecordFile, ...]) -> str:
    """Write a TOML list of records."""
    return (
        "["
        + ", ".join(string_text(one) if isinstance(one, str) else _table_text(one) for one in records)
        + "]"
    )


def _table_text(record: RecordFile) -> str:
    given = {key: value for key, value in vars(record).items() if value is not None and key != "scaling"}
    return _inline({**given, **({} if record.scaling is None else record.scaling.given)})


def scaling_text(scaling: Scaling | None) -> str:
    """Write how records are scaled, or an example as a comment."""
    if scaling is None:
        return "# scaling = { sa = 4.0, period = [0.2, 1.5] }"
    return f"scaling = {_inline(scaling.given)}"


def _inline(given: Mapping[str, Any]) -> str:
    parts = [
        f"{key} = {string_text(value) if isinstance(value, str) else repr(value)}"
        for key, value in given.items()
    ]
    return "{ " + ", ".join(parts) + " }"


def string_text(value: str) -> str:
    """Write a TOML string: JSON's escapes are TOML's, but for the delete character."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")


def strings_text(values: tuple[str, ...]) -> str:
    """Write a TOML list of strings."""
    return "[" + ", ".join(map(string_text, values)) + "]"


def bool_text(value: bool) -> str:
    """Write a TOML boolean."""
    return "true" if value else "false"


_DEVICE_EXAMPLES: Final = {
    "storey_height": 3.0,
    "yield_shear": 100e3,
    "hardening_ratio": 0.02,
    "gravity_load": 200e3,
    "slot_length": 0.03,
    "slot_stiffness": 50e6,
    "recentring_stiffness": 1e6,
    "collapse_drift": 0.3,
}


def device_lines(grid: Grid) -> str:
    """Write the parameters of devices, those that are not there as comments."""
    given = grid.devices
    return "".join(
        f"{name} = {given[name]!r}\n" if name in given else f"# {name} = {example!r}\n"
        for name, example in _DEVICE_EXAMPLES.items()
    )


def link_tables(grid: Grid) -> str:
    """Write the links as tables; what follows a table in TOML belongs to it, so they come last."""
    text = ""
    for link in grid.links:
        told = {key: value for key, value in asdict(link).items() if value is not None}
        lines = (
            f"{key} = {string_text(value) if isinstance(value, str) else repr(value)}\n"
            for key, value in told.items()
        )
        text += f"\n[[{'links' if isinstance(link, Link) else 'tension_braces'}]]\n{''.join(lines)}"
    return text
