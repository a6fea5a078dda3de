"""Numbers in text: by blanks, stuck together, by columns."""

import pytest

from fdspec.errors import RecordError
from fdspec.records.numbers import parse_block, parse_columns, parse_number, parse_words
from fdspec.records.textfile import TextFile


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("1", 1.0), ("-.5", -0.5), ("+2.", 2.0), (".4599853E-05", 0.4599853e-5), ("1.5D+02", 150.0),
        ("1d2", 100.0), ("nan", None), ("inf", None), ("-Infinity", None), ("1e999", None), ("1_000", None),
        ("0x10", None), ("", None), (".", None), ("-", None),
        ("1e", None), ("1,5", None), ("١٢", None), ("1 2", None),
        ("--1", None),
    ],
)  # fmt: skip
def test_parse_number(word, value):
    assert parse_number(word) == value


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("1.234-5.678", [1.234, -5.678]),
        ("-1.5-2.5-3.5", [-1.5, -2.5, -3.5]),
        (".1E-05-.2E-05", [0.1e-5, -0.2e-5]),
        ("1.+2.", [1.0, 2.0]),
        ("  1 2\t3 ", [1.0, 2.0, 3.0]),
        ("", []),
    ],
)
def test_parse_words(line, values):
    assert parse_words(TextFile("f", (line,)), 1) == values


@pytest.mark.parametrize("line", ["1.5.5", "1-2", "1.234-105", "1.5-", "1.5-x", "1.5-1e999.", "a"])
def test_words_that_can_be_read_in_two_ways_are_refused(line):
    with pytest.raises(RecordError, match="f, line 1: expected a finite number, found"):
        parse_words(TextFile("f", (line,)), 1)


def test_parse_block_takes_the_lines_asked_for():
    text = TextFile("f", ("9", "1 2", "3.-4.", "5", "9"))
    assert parse_block(text, 2, 4).tolist() == [1.0, 2.0, 3.0, -4.0, 5.0]
    assert parse_block(text, 2, 2).tolist() == [1.0, 2.0]
    assert parse_block(text, 4, 99).tolist() == [5.0, 9.0]


def test_parse_block_names_the_line():
    text = TextFile("f", ("1 2", "3 1e400", "5"))
    with pytest.raises(RecordError, match="f, line 2: expected a finite number, found '1e400'"):
        parse_block(text, 1, 3)


def test_columns_part_values_that_touch():
    text = TextFile("f", ("123.456789.012", " -1.5   2.25"))
    assert parse_columns(text, 1, 2, 7, 4).tolist() == [123.456, 789.012, -1.5, 2.25]


def test_columns_refuse_gaps_and_counts():
    with pytest.raises(RecordError, match=r"line 1: expected a finite number in columns 1 to 4, found ''"):
        parse_columns(TextFile("f", ("    1.5",)), 1, 1, 4, 1)
    with pytest.raises(RecordError, match="line 1: expected 3 values up to here, found 2"):
        parse_columns(TextFile("f", (" 1.0 2.0",)), 1, 9, 4, 3)
