"""Options for what a single-storey frame has beside its damper: columns that yield, gravity, a slot."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import click

_OPTIONS: Final = {
    "storey_height": ("M", "Height of the storey, m; needed with --gravity-load."),
    "yield_shear": ("N", "Shear at which the columns yield, N.  [default: never]"),
    "hardening_ratio": (
        "X",
        "Stiffness of yielding columns over their elastic one, less than 1.  [default: 0]",
    ),
    "gravity_load": ("N", "Weight on the columns, N: P-delta.  [default: none]"),
    "slot_length": ("M", "Free slip to either side before the bolts bear, m.  [default: no end]"),
    "slot_stiffness": ("N/M", "Of the bolts in bearing, N/m."),
    "recentring_stiffness": ("N/M", "Of a spring across the slider, N/m."),
    "collapse_drift": ("M", "Drift at which the frame has collapsed, m.  [default: a tenth of the height]"),
}

DEVICES: Final = tuple(_OPTIONS)
"""Parameters of the options."""


def device_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options; the command takes them as keywords, None where they are not given."""
    for name, (metavar, text) in reversed(_OPTIONS.items()):
        command = click.option("--" + name.replace("_", "-"), type=float, metavar=metavar, help=text)(command)
    return command


def given(options: dict[str, float | None]) -> dict[str, float]:
    """Return those that were given."""
    return {name: value for name, value in options.items() if value is not None}
