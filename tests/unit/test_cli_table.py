"""Plain tables, numbers, times and sizes for a person."""

import pytest

from fdspec.cli import table as module
from fdspec.cli.echo import coloured
from fdspec.cli.table import (
    counted,
    filled,
    grouped,
    seconds,
    size,
    table,
    terminal_width,
    text_width,
)
from fdspec.printable import printable


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


@pytest.fixture
def narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give a terminal of 60 letters."""
    monkeypatch.setattr(module, "on_terminal", lambda: True)
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.delenv("NO_COLOR", raising=False)


HEAD = ("claim", "verdict", "the study says")
LONG = "beyond stiffness ratio 4 the response is least for a pretension of 100 to 250 kN"


def test_in_a_pipe_lines_stay_whole() -> None:
    assert f"(c)    holds    {LONG}" in table(HEAD, [("(c)", "holds", LONG)], left=HEAD)
    assert terminal_width() is None
    assert text_width() == 110


def test_a_last_column_of_text_is_folded_to_the_terminal(narrow: None) -> None:
    lines = table(HEAD, [("(c)", "holds", LONG), ("(d)", "holds", "short")], left=HEAD).splitlines()
    assert max(map(len, lines)) <= 60
    assert " ".join(line[16:].strip() for line in lines[1:-1]) == LONG
    assert lines[-1].split() == ["(d)", "holds", "short"]


def test_columns_of_numbers_stand_in_blocks_that_begin_with_the_name(narrow: None) -> None:
    head = ("record", *(f"column {k}" for k in range(9)))
    rows = [("FSR1", *(f"{k}.125" for k in range(9)))]
    text = table(head, rows, left=("record",))
    assert max(map(len, text.splitlines())) <= 60
    blocks = text.split("\n\n")
    assert len(blocks) == 2
    assert all(block.splitlines()[1].startswith("FSR1 ") for block in blocks)
    assert [cell for block in blocks for cell in block.splitlines()[1].split()[1:]] == list(rows[0][1:])


def test_running_text_breaks_between_words(narrow: None) -> None:
    lines = filled(LONG, first="c1  ", rest="    ").splitlines()
    assert max(map(len, lines)) <= 60
    assert " ".join(line[4:] for line in lines) == LONG


@pytest.mark.parametrize(("columns", "width"), [("20", 40), ("80", 80), ("300", 110)])
def test_running_text_is_never_too_wide_to_read(
    narrow: None, monkeypatch: pytest.MonkeyPatch, columns: str, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    assert text_width() == width


def test_colour_is_for_terminals_and_not_where_no_color_is_set(
    narrow: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    marked = table(("a", "b"), [("x", "pass")], colours={"pass": "green"})
    assert "\x1b[32mpass\x1b[0m" in coloured(printable(marked))
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in coloured(table(("a", "b"), [("x", "pass")], colours={"pass": "green"}))
    monkeypatch.delenv("NO_COLOR")
    monkeypatch.setattr(module, "on_terminal", lambda: False)
    assert "\x1b" not in coloured(table(("a", "b"), [("x", "pass")], colours={"pass": "green"}))
