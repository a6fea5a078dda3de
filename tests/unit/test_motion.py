"""GroundMotion: what it refuses, what it keeps, what its steps leave behind."""

import dataclasses
import hashlib
import pickle
import struct

import numpy as np
import pytest

from fdspec.errors import InvalidInput
from fdspec.model.motion import GroundMotion

SAMPLES = [0.0, 1.5, -2.0, 0.25]


def test_holds_a_read_only_contiguous_copy():
    given = np.arange(20.0)[::2]
    motion = GroundMotion(given, 0.01)
    given[0] = 99.0
    assert motion.acceleration[0] == 0.0
    assert motion.acceleration.flags.c_contiguous
    assert motion.acceleration.dtype == np.float64
    with pytest.raises(ValueError, match="read-only"):
        motion.acceleration[0] = 1.0


def test_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        GroundMotion(SAMPLES, 0.01).dt = 0.02


def test_integers_and_single_precision_are_numbers_too():
    assert GroundMotion([1, 2, 3], 1).acceleration.tolist() == [1.0, 2.0, 3.0]
    assert GroundMotion(np.float32([0.5, 1.5]), np.float32(0.5)).dt == 0.5


def test_derived_numbers():
    motion = GroundMotion(SAMPLES, 0.1, "mine")
    assert motion.pga == 2.0
    assert motion.n == len(motion) == 4
    assert motion.duration == 3 * 0.1
    assert motion.time.tolist() == [0.0, 0.1, 0.2, 3 * 0.1]


def test_time_is_not_accumulated():
    motion = GroundMotion(np.zeros(100_001), 0.01)
    assert motion.time[100_000] == 100_000 * 0.01
    assert np.add.accumulate(np.full(100_001, 0.01))[99_999] != motion.time[100_000]


@pytest.mark.parametrize(
    ("acceleration", "problem"),
    [
        ([1.0], "acceleration must have at least 2 samples, not 1"),
        ([], "acceleration must have at least 2 samples, not 0"),
        ([[1.0, 2.0], [3.0, 4.0]], r"one dimension, shape \(n,\), not shape \(2, 2\)"),
        (3.0, r"one dimension, shape \(n,\), not shape \(\)"),
        ([0.0, float("nan"), 1.0], "acceleration must be finite, but sample 1 .* is nan"),
        ([0.0, 1.0, -float("inf")], "acceleration must be finite, but sample 2 .* is -inf"),
        ([1j, 2j], "real numbers in m/s2, not of type complex128"),
        (["a", "b"], "real numbers in m/s2, not of type <U1"),
        ([True, False], "real numbers in m/s2, not of type bool"),
        ([[1.0], [2.0, 3.0]], "one-dimensional array of numbers"),
        (None, "real numbers in m/s2, not of type object"),
    ],
)
def test_refuses_samples(acceleration, problem):
    with pytest.raises(InvalidInput, match=problem):
        GroundMotion(acceleration, 0.01)


@pytest.mark.parametrize(
    ("dt", "problem"),
    [
        (0.0, "dt must be positive, in s, not 0.0"),
        (-0.01, "dt must be positive, in s, not -0.01"),
        (float("nan"), "dt must be finite, not nan"),
        (float("inf"), "dt must be finite, not inf"),
        ("fast", "dt must be a number, not 'fast'"),
        (None, "dt must be a number, not None"),
    ],
)
def test_refuses_time_steps(dt, problem):
    with pytest.raises(InvalidInput, match=problem):
        GroundMotion(SAMPLES, dt)


def test_refuses_texts_of_another_type():
    with pytest.raises(InvalidInput, match="station must be a string, not 7"):
        GroundMotion(SAMPLES, 0.01, station=7)
    with pytest.raises(InvalidInput, match="history must be a sequence of strings"):
        GroundMotion(SAMPLES, 0.01, history="scaled")


def test_warns_when_the_unit_looks_wrong():
    with pytest.warns(
        UserWarning, match=r"record mine has a peak of 345 m/s2, over 50: the unit looks wrong"
    ):
        GroundMotion([0.0, 345.0], 0.01, "mine")


def test_fifty_is_still_accepted():
    assert GroundMotion([0.0, -50.0], 0.01).pga == 50.0  # a warning would fail the test


def test_scaled_leaves_a_trace_and_the_original():
    motion = GroundMotion(SAMPLES, 0.01, "mine", event="E", station="S", component="C", source="file")
    twice = motion.scaled(2).scaled(-0.5)
    assert twice.acceleration.tolist() == [-x for x in SAMPLES]
    assert twice.scale_factor == -1.0
    assert twice.history == ("scaled by 2.0", "scaled by -0.5")
    assert (twice.event, twice.station, twice.component, twice.source) == ("E", "S", "C", "file")
    assert motion.history == ()


def test_scaled_to_pga():
    motion = GroundMotion(SAMPLES, 0.01).scaled_to_pga(3.0)
    assert motion.pga == 3.0
    assert motion.scale_factor == 1.5
    assert motion.history == ("scaled by 1.5 to a PGA of 3.0 m/s2",)


@pytest.mark.parametrize("pga", [0.0, -1.0, float("nan"), "0.3g"])
def test_refuses_a_pga(pga):
    with pytest.raises(InvalidInput, match="pga must be"):
        GroundMotion(SAMPLES, 0.01).scaled_to_pga(pga)


def test_a_zero_record_has_no_pga_to_scale():
    with pytest.raises(InvalidInput, match="record still is zero throughout"):
        GroundMotion([0.0, 0.0], 0.01, "still").scaled_to_pga(1.0)


def test_an_overflowing_factor_is_refused_and_does_not_warn():
    with pytest.raises(InvalidInput, match="acceleration must be finite"):
        GroundMotion(SAMPLES, 0.01).scaled(1e308)


def test_equality_and_hash_follow_samples_step_and_origin():
    motion = GroundMotion(SAMPLES, 0.01, "a")
    assert motion == GroundMotion(np.array(SAMPLES), 0.01, "a")
    assert hash(motion) == hash(GroundMotion(np.array(SAMPLES), 0.01, "a"))
    assert motion != GroundMotion(SAMPLES, 0.02, "a")
    assert motion != GroundMotion(SAMPLES, 0.01, "b")
    assert motion != GroundMotion([*SAMPLES, 0.0], 0.01, "a")
    assert motion != motion.scaled(1.0)
    assert motion != "a"


def test_checksum_is_over_samples_and_step_alone():
    expected = hashlib.sha256(struct.pack("<5d", *SAMPLES, 0.01)).hexdigest()
    assert GroundMotion(SAMPLES, 0.01, "a").checksum == expected
    assert GroundMotion(SAMPLES, 0.01, "b", event="E").checksum == expected


def test_a_pickled_motion_stays_read_only():
    motion = GroundMotion(SAMPLES, 0.01, "a", source="file")
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion
    assert not again.acceleration.flags.writeable


def test_repr_is_one_short_line():
    assert repr(GroundMotion(SAMPLES, 0.01, "a")) == "<GroundMotion 'a': 4 samples, dt 0.01 s, PGA 2 m/s2>"
