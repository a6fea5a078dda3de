"""How a cube is cut: a block is what one task computes, and one chunk of every variable.

Two tasks that write into one chunk lose values without a word; here no chunk has two tasks.  A variable that
lacks a dim along which the cube is cut, as the elastic limit lacks the stiffness ratio, belongs to the blocks
that come first along that dim.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np


class HasDims(Protocol):
    """A variable, of the registry or of a Dataset."""

    @property
    def dims(self) -> tuple[Any, ...]:
        """Names of its dims."""


@dataclass(frozen=True)
class Blocks:
    """Cut a cube into blocks, numbered with the last dim fastest.

    sizes: dim -> its length, slowest first; edges: dim -> length of a block along it.
    """

    sizes: Mapping[str, int]
    edges: Mapping[str, int]

    @property
    def counts(self) -> tuple[int, ...]:
        """Blocks along each dim."""
        return tuple(math.ceil(size / self.edges[dim]) for dim, size in self.sizes.items())

    def __len__(self) -> int:
        return math.prod(self.counts)

    def place(self, number: int) -> dict[str, int]:
        """Position of a block along each dim, counted in blocks."""
        return dict(zip(self.sizes, map(int, np.unravel_index(number, self.counts)), strict=True))

    def number(self, at: Mapping[str, int]) -> int:
        """Number of the block that holds the cell at these positions."""
        place = [at[dim] // self.edges[dim] for dim in self.sizes]
        return int(np.ravel_multi_index(place, self.counts))

    def slices(self, number: int) -> dict[str, slice]:
        """Where a block stands in the cube."""
        return {
            dim: slice(k * self.edges[dim], min((k + 1) * self.edges[dim], self.sizes[dim]))
            for dim, k in self.place(number).items()
        }

    def cells(self, number: int, variable: HasDims) -> int:
        """Cells that a block has of a variable."""
        return math.prod(part.stop - part.start for part in self.region(number, variable))

    def owns(self, number: int, variable: HasDims) -> bool:
        """Whether it is this block that holds the variable's chunk."""
        return all(k == 0 for dim, k in self.place(number).items() if dim not in variable.dims)

    def chunks(self, variable: HasDims) -> tuple[int, ...]:
        """Shape of the variable's chunks."""
        return tuple(self.edges[dim] for dim in variable.dims)

    def shape(self, variable: HasDims) -> tuple[int, ...]:
        """Shape of the whole variable."""
        return tuple(self.sizes[dim] for dim in variable.dims)

    def region(self, number: int, variable: HasDims) -> tuple[slice, ...]:
        """Where the block's chunk stands in the variable."""
        slices = self.slices(number)
        return tuple(slices[dim] for dim in variable.dims)

    def chunk_of(self, number: int, variable: HasDims) -> tuple[int, ...]:
        """Position of the block's chunk, counted in chunks."""
        place = self.place(number)
        return tuple(place[dim] for dim in variable.dims)


def cut(
    sizes: Mapping[str, int], along: Sequence[str], cells: float, *, singly: Sequence[str] = ()
) -> Blocks:
    """Cut a cube into blocks of at most so many cells where that can be.

    along: dims to cut, the first before the others; singly: dims of length 1 in every block; all other dims
    stay whole.  Along a dim the blocks are as even as they can be.
    """
    edges = {dim: 1 if dim in singly else size for dim, size in sizes.items()}
    for dim in along:
        others = math.prod(edges.values()) // edges[dim]
        edge = max(1, min(sizes[dim], math.floor(cells / others)))
        edges[dim] = math.ceil(sizes[dim] / math.ceil(sizes[dim] / edge))
        if edge > 1:
            break
    return Blocks(dict(sizes), edges)
