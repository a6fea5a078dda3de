"""Columns of text: units, times, names, and what is refused."""

import numpy as np
import pytest

from fdspec.errors import InvalidInput, RecordError
from fdspec.records import read_record
from fdspec.units import G

TWO = "Time[s] Accel[g]\n0.00\t0.10\n0.01\t-0.20\n0.02\t0.05\n"


def test_two_columns_with_a_header(record_file):
    motion = read_record(record_file(TWO, "two.dat"))
    assert motion.acceleration.tolist() == [x * G for x in (0.1, -0.2, 0.05)]
    assert motion.dt == 0.01
    assert motion.source == "two.dat (columns of text)"


@pytest.mark.parametrize(
    ("units", "expected"),
    [
        ("g", 0.5 * G),
        ("m/s2", 0.5),
        ("m/s^2", 0.5),
        ("cm/s2", 0.005),
        ("Gal", 0.005),
        ("mm/s2", 0.0005),
    ],
)
def test_units_given(record_file, units, expected):
    motion = read_record(record_file("0.5\n0.25\n", "one.txt"), units=units, dt=0.02)
    assert motion.acceleration[0] == expected
    assert motion.dt == 0.02


@pytest.mark.parametrize(
    "content",
    [
        "0.00,0.10\n0.01,-0.20\n0.02,0.05\n",
        "0.00, 0.10\r\n0.01, -0.20\r\n0.02, 0.05\r\n",
        "0,00;0,10\n0,01;-0,20\n0,02;0,05\n",
        "0.00 0.10\n0.01 -0.20\n0.02 0.05\n\n\n",
        "\ufeff0.00 0.10\n0.01 -0.20\n0.02 0.05\n",
        "  0.0E+00  1.0D-01\n  1.0E-02 -2.0D-01\n  2.0E-02  5.0D-02\n",
    ],
)
def test_separators(record_file, content):
    motion = read_record(record_file(content, "two.csv"), units="m/s2")
    assert motion.acceleration.tolist() == [0.1, -0.2, 0.05]
    assert motion.dt == 0.01


def test_several_columns_are_channels_by_name(record_file):
    path = record_file("time,NS,EW\n0,1,2\n0.5,3,4\n1,5,6\n", "three.csv")
    assert read_record(path, units="m/s2", channel="ew").acceleration.tolist() == [2.0, 4.0, 6.0]
    with pytest.raises(
        RecordError, match=r"three\.csv: the file has 2 channels: give channel, one of 'NS', 'EW'"
    ):
        read_record(path, units="m/s2")
    with pytest.raises(RecordError, match="there is no channel 'UD': it has 'NS', 'EW'"):
        read_record(path, units="m/s2", channel="UD")


@pytest.mark.parametrize(
    ("content", "arguments", "problem"),
    [
        ("0.1\n0.2\n0.3\n", {"units": "g"}, "there is no column of times: give dt, in s"),
        ("0.1\n0.2\n0.3\n", {"dt": 0.01}, "does not say the unit of acceleration: give units"),
        ("[g] or [m/s2]\n0.1\n0.2\n0.3\n", {"dt": 0.01}, "contradicts itself on the unit"),
        (TWO, {"units": "m/s2"}, "units are given as m/s2, but the heading 'Accel.g.' says g"),
        (TWO, {"dt": 0.02}, "line 3: expected equal time steps of about 0.02 s, found 0.01 s"),
        (TWO + "0.03\n", {}, "line 5: expected 2 columns as in line 2, found 1"),
        (TWO + "\n0.04 0.1\n", {}, "line 6: expected equal time steps of about 0.01 s, found 0.02 s"),
        (TWO + "0.03 nan\n", {}, "line 5: expected a finite number, found 'nan'"),
        (TWO + "0.03 1e400\n", {}, "line 5: expected a finite number, found '1e400'"),
        (TWO + "0.03 __import__('os')\n", {}, "line 5: expected a finite number, found .__import__"),
        (TWO + "0.04 0.1\n", {}, "line 5: expected equal time steps of about 0.01 s, found 0.02 s"),
        (TWO + "0.01 0.1\n", {}, "line 5: expected times that grow, found 0.01"),
        ("0.0 1\n0.0 2\n0.0 3\n", {"units": "g"}, "there is no column of times: give dt"),
        ("0.00 1\n0.01 2\n0.01 3\n0.02 4\n0.02 5\n", {"units": "g"}, "too few digits to show it, give dt"),
        ("words\nand words\n", {}, "line 1: the format is not recognised"),
        ("1.0", {"units": "g", "dt": 0.1}, "line 1: the format is not recognised"),
        ("x\n" * 270 + "1\n2\n3\n", {"units": "g", "dt": 0.1}, "line 1: the format is not recognised"),
    ],
)
def test_refusals(record_file, content, arguments, problem):
    with pytest.raises(RecordError, match=problem):
        read_record(record_file(content, "two.dat"), **arguments)


def test_arguments_that_can_never_be_right(record_file):
    path = record_file(TWO, "two.dat")
    with pytest.raises(InvalidInput, match=r"units must be g, m/s2, cm/s2, .* not 'furlong'"):
        read_record(path, units="furlong")
    with pytest.raises(InvalidInput, match=r"dt must be positive, in s, not 0"):
        read_record(path, dt=0)
    with pytest.raises(InvalidInput, match="dt must be a number, not 'quick'"):
        read_record(path, dt="quick")


@pytest.mark.parametrize("pattern", ["{:.2f}", "{:.3f}", "{:g}", "{:.6e}", "{!r}"])
def test_rounded_times_give_back_the_step(record_file, pattern):
    rows = [f"{pattern.format(k * 0.02)} {k % 7 - 3}" for k in range(3000)]
    assert read_record(record_file("\n".join(rows), "two.dat"), units="m/s2").dt == 0.02


def test_a_given_step_helps_coarse_times(record_file):
    rows = [f"{k * 0.005:.2f} {k % 7 - 3}" for k in range(3000)]
    path = record_file("\n".join(rows), "two.dat")
    assert read_record(path, units="m/s2", dt=0.005).dt == 0.005
    with pytest.raises(RecordError, match=r"expected equal time steps of about 0.006 s"):
        read_record(path, units="m/s2", dt=0.006)


def test_a_step_that_its_times_cannot_show_exactly(record_file):
    rows = [f"{k * 0.00976:.4f} {k % 7 - 3}" for k in range(2590)]
    dt = read_record(record_file("\n".join(rows), "two.dat"), units="m/s2").dt
    assert dt == 0.00976


@pytest.mark.parametrize("lost", [1, 2, 50, 97, 98])
def test_one_lost_row_shows_wherever_it_is(record_file, lost):
    rows = [f"{k * 0.005:.3f} {k % 7 - 3}" for k in range(100) if k != lost]
    with pytest.raises(RecordError, match=rf"line {lost + 1}: expected equal time steps"):
        read_record(record_file("\n".join(rows), "two.dat"), units="m/s2")


@pytest.mark.parametrize("name", ["real/Kobe_KAKOGAWA_CUE90.dat", "formats/twocol_seismosoft__Kobe.dat"])
def test_the_real_fsr1(shared_records, name):
    path = shared_records / name
    plain = np.loadtxt(path, skiprows=5)
    motion = read_record(path)
    assert motion.acceleration.tolist() == (plain[:, 1] * G).tolist()
    assert (len(motion), motion.dt, round(motion.pga / G, 4)) == (4091, 0.01, 0.3447)


def test_the_real_kalamata(shared_records):
    motion = read_record(shared_records / "real" / "kalamata_ms2.txt", units="m/s2", dt=0.01)
    assert len(motion) == 2590
    assert motion.pga / G == pytest.approx(0.2968, abs=5e-5)
