"""Blocks cover every cell of every variable once."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fdspec.store.blocks import Blocks, cut
from fdspec.variables import CUBE, STUDY_DIMS

lengths = st.integers(1, 7)
VARIABLES = [variable for variable in CUBE.values() if {"record", "period"} <= set(variable.dims)]


@st.composite
def cuts(draw: st.DrawFn) -> Blocks:
    sizes = {dim: draw(lengths) for dim in STUDY_DIMS}
    edges = {dim: draw(st.integers(1, size)) for dim, size in sizes.items()}
    return Blocks(sizes, edges | {"pretension": sizes["pretension"]})


@settings(max_examples=30)
@given(cuts())
def test_every_cell_of_a_variable_is_written_by_one_block(blocks: Blocks) -> None:
    for variable in VARIABLES:
        times = np.zeros(blocks.shape(variable), int)
        chunks = []
        for number in range(len(blocks)):
            if blocks.owns(number, variable):
                times[blocks.region(number, variable)] += 1
                chunks.append(blocks.chunk_of(number, variable))
        assert (times == 1).all(), variable.name
        assert len(set(chunks)) == len(chunks)


@settings(max_examples=30)
@given(cuts(), st.data())
def test_a_block_is_found_from_any_of_its_cells(blocks: Blocks, data: st.DataObject) -> None:
    number = data.draw(st.integers(0, len(blocks) - 1))
    at = {
        dim: data.draw(st.integers(part.start, part.stop - 1)) for dim, part in blocks.slices(number).items()
    }
    assert blocks.number(at) == number


@settings(max_examples=30)
@given(st.fixed_dictionaries(dict.fromkeys(STUDY_DIMS, st.integers(1, 50))), st.floats(1, 1e6))
def test_blocks_are_no_larger_than_asked_for_and_whole_along_pretensions(
    sizes: dict[str, int], cells: float
) -> None:
    blocks = cut(sizes, ("stiffness_ratio", "period"), cells, singly=["record"])
    assert blocks.edges["record"] == 1
    assert blocks.edges["pretension"] == sizes["pretension"]
    whole = CUBE["status"]
    of_each = [blocks.cells(number, whole) for number in range(len(blocks))]
    assert len(blocks) >= 1000 or max(of_each) <= max(cells, sizes["pretension"])
    assert sum(of_each) == math.prod(sizes.values())


def test_even_blocks() -> None:
    sizes = {"record": 9, "stiffness_ratio": 7, "pretension": 11, "period": 60}
    blocks = cut(sizes, ("stiffness_ratio", "period"), 11 * 60 * 4, singly=["record"])
    assert blocks.edges == {"record": 1, "stiffness_ratio": 4, "pretension": 11, "period": 60}
    fine = cut(sizes, ("stiffness_ratio", "period"), 11 * 45, singly=["record"])
    assert fine.edges == {"record": 1, "stiffness_ratio": 1, "pretension": 11, "period": 30}
