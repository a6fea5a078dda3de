"""Numbers in a row of an array by name: kernels write ``row[RESULT.slip_travel]``, never ``row[5]``."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from typing import Any


def positions(names: Sequence[str]) -> Any:
    """Return each name's position among all, as a tuple with these names; to a kernel they are constants."""
    return namedtuple("Positions", names)(*range(len(names)))  # noqa: PYI024 (the names come at run time)
