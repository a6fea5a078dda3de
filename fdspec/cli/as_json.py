"""Results as JSON on stdout, for programs: numbers in SI units, null for what is not finite."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import click

from fdspec.cli.echo import echo

if TYPE_CHECKING:
    import xarray as xr

P = ParamSpec("P")
R = TypeVar("R")


def json_option(command: Callable[P, R]) -> Callable[P, R]:
    """Add the option that gives results as JSON in place of text."""
    return click.option(
        "--json",
        "as_json",
        is_flag=True,
        help="Results as one JSON object on stdout, SI units, for programs.",
    )(command)


def echo_json(value: object) -> None:
    """Print what dicts, lists, numbers, text and arrays hold."""
    echo(json.dumps(plain(value), allow_nan=False, indent=1, ensure_ascii=True))


def plain(value: Any) -> Any:
    """Return what JSON can hold; an infinite number is the text "inf", as in a cube's parameters."""
    if hasattr(value, "tolist"):  # an array or a number of numpy, which help does without
        value = value.tolist()
    if isinstance(value, float):
        if math.isnan(value):
            return None
        return value if math.isfinite(value) else str(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def of_dataset(dataset: xr.Dataset) -> dict[str, Any]:
    """Return coordinates and variables by name, each with its dims, units and values."""
    return {
        kind: {
            str(name): {
                "dims": list(array.dims),
                "units": str(array.attrs.get("units", "")),
                "values": array.values,
            }
            for name, array in arrays.items()
        }
        for kind, arrays in (("coordinates", dataset.coords), ("variables", dataset.data_vars))
    }
