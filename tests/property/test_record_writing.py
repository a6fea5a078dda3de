"""What is written is read back."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdspec.errors import InvalidInput, RecordError
from fdspec.motion import GroundMotion
from fdspec.records import load_record, read_record
from fdspec.records.writing import write_record

samples = st.lists(st.floats(-40.0, 40.0), min_size=2, max_size=40)
steps = st.sampled_from([0.001, 0.0025, 0.00390625, 0.005, 0.00976, 0.01, 0.02, 1.0])
same_folder = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@same_folder
@given(samples, steps)
def test_columns_come_back_to_the_bit(tmp_path, acceleration, dt):
    motion = GroundMotion(acceleration, dt, "a", event="E 1999", station="Old Mill")
    again = read_record(write_record(motion, tmp_path / "a.txt"))
    assert again.checksum == motion.checksum
    assert (again.event, again.station) == ("E 1999", "Old Mill")


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
