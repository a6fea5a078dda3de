"""The option `--at DIM=VALUE`: a part of a cube, by a value along a dim as the user wrote it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    import xarray as xr


def selected(opened: xr.Dataset, choice: str) -> xr.Dataset:
    """Select along a dim by its value, as the user wrote it."""
    import numpy as np

    dim, _, text = choice.partition("=")
    if dim not in opened.dims or not text:
        known = ", ".join(map(str, opened.dims))
        raise click.UsageError(f"--at {choice}: give DIM=VALUE with a dim among {known}")
    values = opened[dim].values
    if values.dtype.kind in "OU":
        match = [k for k, value in enumerate(values) if str(value) == text]
    else:
        try:
            number = float(text)
        except ValueError:
            raise click.UsageError(f"--at {choice}: {text!r} is no number") from None
        match = np.flatnonzero(np.isclose(values, number, rtol=1e-9, atol=0.0)).tolist()
    if not match:
        raise click.UsageError(f"--at {choice}: the cube has {', '.join(map(str, values[:20]))}")
    return opened.isel({dim: match[0]})
