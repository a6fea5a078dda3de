"""Files written in a known way come back to the last digit, whatever the numbers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdspec.errors import RecordError
from fdspec.records.at2 import read as read_at2
from fdspec.records.given import given as options
from fdspec.records.numbers import parse_block
from fdspec.records.text import read as read_columns
from fdspec.records.textfile import TextFile
from fdspec.units import G

values = st.lists(st.floats(-5.0, 5.0), min_size=2, max_size=60)
steps = st.sampled_from([0.001, 0.002, 0.0025, 0.00390625, 0.005, 0.00976, 0.01, 0.02, 0.05])


def at2(rows: list[str], count: int) -> TextFile:
    third = "ACCELERATION TIME HISTORY IN UNITS OF G"
    return TextFile("f.AT2", ("PEER", "E, S, C", third, f"NPTS= {count}, DT= .01 SEC", *rows))


@given(values, st.integers(1, 9))
def test_at2_rows_of_any_length(samples, width):
    words = [repr(x) for x in samples]
    rows = [" ".join(words[k : k + width]) for k in range(0, len(words), width)]
    (channel,) = read_at2(at2(rows, len(samples)))
    assert channel.acceleration.tolist() == (np.array(samples) * G).tolist()


@given(values)
def test_at2_values_that_touch(samples):
    words = [f"{x:+.9E}" for x in samples]
    (channel,) = read_at2(at2(["".join(words)], len(samples)))
    assert channel.acceleration.tolist() == (np.array([float(word) for word in words]) * G).tolist()


@given(values, st.integers(0, 100))
def test_at2_never_takes_a_wrong_count(samples, claimed):
    if claimed != len(samples):
        with pytest.raises(RecordError):
            read_at2(at2([repr(x) for x in samples], claimed))


@given(values, steps, st.integers(3, 8))
def test_two_columns_with_times_rounded_or_not(samples, dt, decimals):
    rows = tuple(f"{k * dt:.{decimals}f} {x!r}" for k, x in enumerate(samples))
    shown = {round(k * dt, decimals) == k * dt for k in range(len(rows))}
    try:
        (channel,) = read_columns(TextFile("f", rows), options(units="m/s2"))
    except RecordError:
        # Times too coarse for their step may be refused, never read wrongly.
        assert 10.0**-decimals * 5 > dt
        assert shown != {True}
        return
    assert channel.acceleration.tolist() == samples
    # Both steps explain the last time from the first, each rounded by half a unit of its last digit.
    assert abs(channel.dt - dt) <= 2.0 * 10.0**-decimals / (len(rows) - 1) + 1e-15


@given(st.text(alphabet="0123456789+-.EeDd ", max_size=40))
def test_a_block_of_number_characters_is_read_or_refused(line):
    try:
        read = parse_block(TextFile("f", (line,)), 1, 1)
    except RecordError:
        return
    assert np.isfinite(read).all()
