"""Files as people have them, with answers computed by hand: read to the printed digits, or refused."""

import json
import warnings
from pathlib import Path

import pytest

from fdspec.errors import RecordError
from fdspec.records import read_channels

CASES = Path(__file__).resolve().parents[4] / "shared" / "records" / "cases"
EXPECTED = json.loads((CASES / "EXPECTED.json").read_text()) if CASES.is_dir() else {}
CHANNELS = {
    "columns_acc_vel_disp.csv": ["Acceleration"],
    "csmip_v1_building_channel_names.v1": ["Up, Ground Floor: Center", "270 DegR, Roof: South End"],
    "sample_number_is_no_time.csv": ["a_x", "a_y", "a_z"],
    "jma_three_columns.csv": ["NS", "EW", "UD"],
    "three_columns_rate_in_words.txt": ["E", "N", "Z"],
    "asa_key_with_comma.dat": ["N90E", "N00E", "V"],
}


def options(expected):
    given = dict(word.split("=") for word in expected.get("options", "").split())
    return {key: float(value) if key == "dt" else value for key, value in given.items()}


def is_refused(name, expected):
    return "needs_refusal" in name or expected.get("note", "").startswith("refuse")


def test_the_cases_are_there(shared_records):
    assert len(EXPECTED) == 52
    assert {path.name for path in (shared_records / "cases").iterdir()} == {*EXPECTED, "EXPECTED.json"}


@pytest.mark.parametrize("name", [name for name, e in EXPECTED.items() if not is_refused(name, e)])
def test_a_case_is_read_as_computed_by_hand(name):
    expected = EXPECTED[name]
    motions = read_channels(CASES / name, **options(expected))
    counts = [expected["n"]] if isinstance(expected["n"], int) else map(int, expected["n"].split(" or "))
    assert {len(motion) for motion in motions.values()} <= set(counts)
    assert {motion.dt for motion in motions.values()} == {expected["dt"]}
    peaks = expected["pga"] if isinstance(expected["pga"], list) else [expected["pga"]]
    # Six digits are printed, of samples that the files round to six themselves.
    shown = [motion.pga for motion in motions.values()][: len(peaks)]
    assert shown == pytest.approx(peaks, rel=5e-6, abs=6e-7)
    if isinstance(expected.get("ch"), int):
        assert len(motions) == expected["ch"]
    if name in CHANNELS:
        assert list(motions) == CHANNELS[name]


@pytest.mark.parametrize("name", [name for name, e in EXPECTED.items() if is_refused(name, e)])
@pytest.mark.parametrize("given", [{}, {"units": "g"}, {"units": "g", "dt": 0.02}])
def test_what_is_no_acceleration_at_equal_steps_is_refused_whatever_is_given(name, given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(RecordError):
            read_channels(CASES / name, **given)


def test_film_is_interpolated_on_request():
    if not EXPECTED:
        pytest.skip("needs real record files in ../shared/records, which this machine does not have")
    path = CASES / "cdmg_v1_film_unequal_steps_refused.RAW"
    (motion,) = read_channels(path, resample_to=0.005).values()
    assert motion.dt == 0.005
    assert motion.duration == pytest.approx(7.466, abs=0.005)  # its last time
    assert motion.history[-1].startswith("on reading, interpolated from unequal steps of ")
