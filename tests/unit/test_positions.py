"""Places of numbers in a row, by name."""

from __future__ import annotations

from fdspec.compiler.positions import positions
from fdspec.kernels.batch.layout import N_ROWS, ROW
from fdspec.kernels.types import N_STATE, STATE


def test_each_name_has_one_number() -> None:
    assert positions(("a", "b", "c")) == (0, 1, 2)


def test_a_name_has_as_many_numbers_as_it_says() -> None:
    assert positions(("a", "b", "c", "end"), {"b": 12, "c": 2})._asdict() == {
        "a": 0,
        "b": 1,
        "c": 13,
        "end": 15,
    }


def test_the_packed_array_begins_with_the_state() -> None:
    assert ROW[:N_STATE] == tuple(STATE) == tuple(range(N_STATE))
    assert len(set(ROW)) == len(ROW)
    assert max(ROW) == N_ROWS
