"""Numbers in a row of an array by name: kernels write ``row[RESULT.slip_travel]``, never ``row[5]``."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Mapping, Sequence
from itertools import accumulate
from types import MappingProxyType
from typing import Any


def positions(names: Sequence[str], sizes: Mapping[str, int] = MappingProxyType({})) -> Any:
    """Return where each name's numbers begin, as a tuple with these names; to a kernel they are constants.

    sizes: how many numbers a name has, where that is not one.
    """
    ends = accumulate(sizes.get(name, 1) for name in names)
    places: list[Any] = [end - sizes.get(name, 1) for name, end in zip(names, ends, strict=True)]
    return namedtuple("Positions", names)(*places)  # noqa: PYI024 (the names come at run time)
