"""The families of cases, in the order of the table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

from fdspec.errors import FdspecError, InvalidInput
from fdspec.verification import (
    closed_forms,
    devices,
    energy,
    engines,
    fixed_step,
    general_solver,
    limits_of_methods,
    linear_limits,
    steady_states,
    symmetry,
)
from fdspec.verification.row import Row


class Family(NamedTuple):
    """Some cases that belong together."""

    name: str
    run: Callable[[bool], Iterator[Row]]
    """Yields rows; told whether the slow ones are wanted."""


FAMILIES: Final = (
    Family("closed-forms", closed_forms.rows),
    Family("devices", devices.rows),
    Family("steady-states", steady_states.rows),
    Family("linear-limits", linear_limits.rows),
    Family("engines", engines.rows),
    Family("general-solver", general_solver.rows),
    Family("fixed-step", fixed_step.rows),
    Family("energy", energy.rows),
    Family("symmetry", symmetry.rows),
    Family("methods", limits_of_methods.rows),
)


def verify(
    families: Sequence[str] | None = None,
    *,
    full: bool = False,
    on_family: Callable[[str], None] | None = None,
    on_row: Callable[[Row], None] | None = None,
) -> list[Row]:
    """Run the verification cases and return their rows.

    families: names of FAMILIES, all unless given; full: with the slow cases; on_family: told the name of each
    family before it is run; on_row: told of each row as it is there.  A case that raises an error of fdspec's
    is a row that fails, with the error as its quantity.
    """
    known = {family.name: family for family in FAMILIES}
    wanted = list(known) if families is None else list(families)
    for name in wanted:
        if name not in known:
            raise InvalidInput(f"a family of cases must be one of {', '.join(known)}, got {name!r}")
    rows = []
    for name in wanted:
        if on_family is not None:
            on_family(name)
        for row in _guarded(known[name], full):
            rows.append(row)
            if on_row is not None:
                on_row(row)
    return rows


def _guarded(family: Family, full: bool) -> Iterator[Row]:
    try:
        yield from family.run(full)
    except (FdspecError, ArithmeticError) as error:
        yield Row(family.name, f"{type(error).__name__}: {error}", math.nan, math.nan, math.nan, 0.0)
