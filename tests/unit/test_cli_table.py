"""Plain tables, numbers, times and sizes for a person."""

import pytest

from fdspec.cli.table import counted, grouped, seconds, size, table


def test_columns_line_up_and_lines_end_with_no_blanks() -> None:
    text = table(("name", "g", "site"), [("FSR1", "0.345", "D"), ("x", "10", "")], left=("name", "site"))
    assert text.splitlines() == ["name      g  site", "FSR1  0.345  D", "x        10"]


def test_a_table_without_rows_is_its_head() -> None:
    assert table(("a", "b"), []) == "a  b"


@pytest.mark.parametrize(("number", "text"), [(7, "7"), (41_580, "41 580"), (1_234_567, "1 234 567")])
def test_thousands_stand_apart(number: int, text: str) -> None:
    assert grouped(number) == text


def test_one_and_many() -> None:
    assert counted(1, "record") == "1 record"
    assert counted(9, "record") == "9 records"
    assert counted(2000, "history", "histories") == "2 000 histories"


@pytest.mark.parametrize(
    ("time", "text"),
    [(0.04, "0.0 s"), (9.94, "9.9 s"), (9.96, "10 s"), (119.4, "119 s"), (600, "10 min"), (9000, "2.5 h")],
)
def test_times(time: float, text: str) -> None:
    assert seconds(time) == text


@pytest.mark.parametrize(
    ("n_bytes", "text"), [(12, "12 bytes"), (3.4e6, "3.4 MB"), (1234, "1.23 kB"), (5e12, "5e+03 GB")]
)
def test_sizes(n_bytes: float, text: str) -> None:
    assert size(n_bytes) == text
