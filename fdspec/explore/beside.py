"""Cubes beside each other: the records of all on one page, each under the name of its cube."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fdspec.errors import InvalidInput
from fdspec.explore.content import AXES, Content
from fdspec.explore.rerun import Rerun


class Beside:
    """Hold cubes over the same axes as one content: what the page compares are records of either.

    Parameters
    ----------
    contents : sequence of Content
        Two or more, of different names.

    Raises
    ------
    InvalidInput
        When the cubes lie over different axes, have one name, or no index in common.
    """

    def __init__(self, contents: Sequence[Content]) -> None:
        first = contents[0]
        names = [content.name for content in contents]
        for n, content in enumerate(contents):
            if content.name in names[:n]:
                raise InvalidInput(f"{content.name} is given twice")
            for axis in AXES:
                mine, others = first.cube[axis].values, content.cube[axis].values
                if mine.shape != others.shape or not np.allclose(mine, others, rtol=1e-9, atol=0.0):
                    raise InvalidInput(
                        f"{first.name} and {content.name} differ in {axis}; cubes beside each other need the "
                        "same stiffness ratios, pretensions and periods"
                    )
        self.contents = tuple(contents)
        self.name = " and ".join(names)
        self.records = tuple(
            f"{record} ({content.name})" for content in contents for record in content.records
        )
        shared = set.intersection(*({index.name for index in content.indices} for content in contents))
        self._indices = [index.name for index in first.indices if index.name in shared]
        if not self._indices:
            raise InvalidInput(f"{self.name} have no result in common that can be shown")

    @property
    def about(self) -> dict[str, Any]:
        """What the first cube's content tells, with the records of all, and of what they share."""
        told = [content.about for content in self.contents]
        records = [{**record, "cube": n} for n, one in enumerate(told) for record in one["records"]]
        return {
            **told[0],
            "name": self.name,
            "cubes": [cube for one in told for cube in one["cubes"]],
            "records": [{**record, "name": name} for record, name in zip(records, self.records, strict=True)],
            "indices": [index for index in told[0]["indices"] if index["name"] in self._indices],
        }

    def record(self, k: int) -> bytes:
        """Return the numbers of one record, as `Content.record` does."""
        content, place = located(k, [len(one.records) for one in self.contents])
        return self.contents[content].record(place)


class Reruns:
    """Run the histories of cubes beside each other; records are counted on from cube to cube."""

    def __init__(self, reruns: Sequence[Rerun]) -> None:
        self.reruns = tuple(reruns)

    def of(self, record: int) -> tuple[Rerun, int]:
        """Return who runs the histories of a record, and its position there."""
        cube, place = located(record, [one.cube.sizes["record"] for one in self.reruns])
        return self.reruns[cube], place


def located(k: int, counts: Sequence[int]) -> tuple[int, int]:
    """Return the cube of the k-th record of all, and the record's position in it."""
    if not 0 <= k < sum(counts):
        raise InvalidInput(f"record must be a position from 0 to {sum(counts) - 1}, got {k}")
    ends = np.cumsum(counts)
    cube = int(np.searchsorted(ends, k, side="right"))
    return cube, k - int(ends[cube]) + counts[cube]


def files_of(given: Mapping[str, Path], cubes: Sequence[Sequence[str]]) -> list[dict[str, Path]]:
    """Return the files of each cube's records; raise InvalidInput for a name that no cube has."""
    for name in given:
        if not any(name in records for records in cubes):
            known = ", ".join(dict.fromkeys(record for records in cubes for record in records))
            raise InvalidInput(f"no cube has a record {name!r}; they have {known}")
    return [{name: file for name, file in given.items() if name in records} for records in cubes]
