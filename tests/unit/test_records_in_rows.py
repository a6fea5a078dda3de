"""NamedTuples in rows of arrays: read and written by one rule, compiled or not."""

from typing import NamedTuple

import numba
import numpy as np

from fdspec.compiler.records import read, size_of, write


class Pair(NamedTuple):
    first: float
    second: float


class Nested(NamedTuple):
    head: float
    pair: Pair
    tail: float


@numba.njit
def sum_of(rows, i):
    record = read(Nested, rows, i)
    return record.head + 10.0 * record.pair.first + 100.0 * record.pair.second + 1000.0 * record.tail


@numba.njit
def copy(rows, source, target):
    write(rows, target, read(Nested, rows, source))


@numba.njit
def pair_of(rows, i):
    return read(Pair, rows, i)


def test_size() -> None:
    assert size_of(Nested) == 4


def test_numbers_stand_in_the_order_of_the_fields() -> None:
    rows = np.array([[9.0, 9.0, 9.0, 9.0, 9.0], [1.0, 2.0, 3.0, 4.0, 9.0]])
    assert sum_of(rows, 1) == 4321.0


def test_what_is_written_is_read() -> None:
    rows = np.arange(15.0).reshape(3, 5)
    copy(rows, 2, 0)
    assert rows.tolist() == [
        [10.0, 11.0, 12.0, 13.0, 4.0],
        [5.0, 6.0, 7.0, 8.0, 9.0],
        [10.0, 11.0, 12.0, 13.0, 14.0],
    ]


def test_a_record_comes_back_as_its_class() -> None:
    assert pair_of(np.array([[1.0, 2.0]]), 0) == Pair(1.0, 2.0)
    assert type(pair_of(np.array([[1.0, 2.0]]), 0)) is Pair
