"""The line each key of a TOML text stands on."""

from fdspec.model.toml_lines import key_lines, line_of

TEXT = """\
# period = 1
records = [
    "FSR1",
    "a = b",
]
"floor_mass" = 20e3
brace.mass = 50

[period]  # axis
start = 0.1
stop = 2

[[pretension]]
num = 3
"""


def test_top_level_keys_tables_and_what_they_hold() -> None:
    lines = key_lines(TEXT)
    assert lines["records",] == 2
    assert lines["floor_mass",] == 6
    assert lines["brace",] == lines["brace", "mass"] == 7
    assert lines["period",] == 9
    assert lines["period", "stop"] == 11
    assert lines["pretension", "num"] == 14


def test_a_comment_is_no_key() -> None:
    assert ("start",) not in key_lines("# start = 1\n")


def test_an_array_of_arrays_opens_no_table() -> None:
    assert key_lines("period = [\n  [0.1],\n]\nfloor_mass = 1\n")["floor_mass",] == 4


def test_the_innermost_written_key_gives_the_line() -> None:
    lines = key_lines(TEXT)
    assert line_of(lines, ("period", "stop", 0)) == 11
    assert line_of(lines, ("records", 1)) == 2


def test_what_is_written_nowhere_is_told_at_the_first_line() -> None:
    assert line_of(key_lines(TEXT), ("damping_ratio",)) == 1
