"""What a caller tells about a file that does not say it itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from fdspec.errors import InvalidInput
from fdspec.model.number_check import positive_number
from fdspec.records.units import unit_named

LAYOUTS: Final = ("columns", "rows")


@dataclass(frozen=True)
class Given:
    """Hold the options of `read_record`, checked: `units` by our name, `dt` and `resample_to` in s."""

    units: str | None = None
    dt: float | None = None
    skip: int | None = None
    layout: str | None = None
    resample_to: float | None = None


def given(
    units: str | None = None,
    dt: float | None = None,
    skip: int | None = None,
    layout: str | None = None,
    resample_to: float | None = None,
) -> Given:
    """Check the options; an error names the option, its value and what would be right."""
    if skip is not None and (isinstance(skip, bool) or skip < 0):
        raise InvalidInput(f"skip must be a whole number of lines, 0 or more, not {skip!r}")
    if layout is not None and layout not in LAYOUTS:
        raise InvalidInput(f"layout must be 'columns' or 'rows', not {layout!r}")
    return Given(
        None if units is None else unit_named(units),
        None if dt is None else positive_number("dt", dt, "s"),
        skip,
        layout,
        None if resample_to is None else positive_number("resample_to", resample_to, "s"),
    )
