"""What is written is read back."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdspec.errors import InvalidInput, RecordError
from fdspec.model.motion import GroundMotion
from fdspec.records import load_record, read_record
from fdspec.records.writing import write_record

samples = st.lists(st.floats(-40.0, 40.0), min_size=2, max_size=40)
steps = st.sampled_from([0.001, 0.0025, 0.00390625, 0.005, 0.00976, 0.01, 0.02, 1.0])
same_folder = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@same_folder
@given(samples, steps)
def test_columns_come_back_to_the_bit(tmp_path, acceleration, dt):
    again = read_record(write_record(GroundMotion(acceleration, dt, "a"), tmp_path / "a.txt"))
    assert again == GroundMotion(acceleration, dt, "a", source="a.txt (columns of fdspec)")


phrases = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)


@same_folder
@given(st.lists(phrases, max_size=80), phrases, phrases, st.floats(1e-6, 100.0), st.floats(-9.0, 9.0))
def test_columns_bring_back_the_whole_motion(tmp_path, history, event, source, dt, factor):
    about = {"event": event, "station": event[::-1], "component": source[::-1], "history": history}
    motion = GroundMotion([0.0, 1.0, -2.0], dt, "a", source=source, scale_factor=factor, **about)
    again = read_record(write_record(motion, tmp_path / "a.txt"))

    def lines(text):
        return " ".join(text.split())

    assert again.checksum == motion.checksum
    assert again.scale_factor == factor
    assert again.history == tuple(map(lines, history))
    assert again.event == lines(event)
    assert (again.station, again.component) == (lines(event[::-1]), lines(source[::-1]))
    assert again.source.removeprefix("a.txt (columns of fdspec)").removeprefix(", made from ") == lines(
        source
    )


def test_columns_written_twice_say_both(tmp_path):
    once = read_record(write_record(load_record("FSR1").scaled(2.0), tmp_path / "once.txt"))
    twice = read_record(write_record(once.scaled(0.5), tmp_path / "twice.txt"))
    assert len(twice.history) == len(load_record("FSR1").history) + 2
    assert twice.scale_factor == load_record("FSR1").scale_factor
    assert twice.source.startswith(
        "twice.txt (columns of fdspec), made from once.txt (columns of fdspec), made from stand-in for"
    )


@same_folder
@given(samples, steps)
def test_at2_comes_back_within_a_rounding(tmp_path, acceleration, dt):
    motion = GroundMotion(acceleration, dt, "a", event="E, 1999", station="S", component="090")
    again = read_record(write_record(motion, tmp_path / "a.AT2"))
    np.testing.assert_allclose(again.acceleration, motion.acceleration, rtol=3e-16, atol=1e-320)
    assert again.dt == dt
    assert (again.event, again.station, again.component) == ("E 1999", "S", "090")


@pytest.mark.parametrize("ending", ["txt", "at2"])
def test_a_real_record(tmp_path, ending):
    motion = load_record("FHR1", scaled=False)
    again = read_record(write_record(motion, tmp_path / f"a.{ending}"))
    np.testing.assert_allclose(again.acceleration, motion.acceleration, rtol=3e-16)
    assert (again.dt, again.n) == (motion.dt, motion.n)


def test_refusals_leave_nothing_behind(tmp_path):
    motion = GroundMotion([0.0, 1.0], 0.1)
    with pytest.raises(
        InvalidInput, match="layout must be one of at2, txt, as an option or as ending, not 'xls'"
    ):
        write_record(motion, tmp_path / "a.xls")
    with pytest.raises(RecordError, match="cannot be written"):
        write_record(motion, tmp_path / "nowhere" / "a.txt")
    (tmp_path / "folder.txt").mkdir()
    with pytest.raises(RecordError, match="cannot be written"):
        write_record(motion, tmp_path / "folder.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["folder.txt"]
