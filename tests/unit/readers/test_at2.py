"""PEER AT2: the four headers, values as Fortran leaves them, and every way a file can be wrong."""

import re

import numpy as np
import pytest

from fdspec.errors import RecordError
from fdspec.records import read_record
from fdspec.units import G

FIRST_THREE = """PEER NGA STRONG MOTION DATABASE RECORD
Somewhere-02, 10/15/1979, Old Mill, 225
ACCELERATION TIME SERIES IN UNITS OF G
"""
HEADERS = [
    "NPTS=     7, DT= .01000 SEC",
    "7    0.0100    NPTS, DT",
    "NPTS=      7, DT=   .0100 SEC,                                             ",
    "NPTS=      7, DT=   .0100 SEC, FILTER POINTS: HP=0.1 Hz LP=23.0 Hz",
    "NPTS= 7,\tDT=\t0.0100\tSEC   ",
    "NPTS= 7, DT= 0.0100",
    "npts= 7, dt= 1.0E-02 sec",
    "DT= .0100 SEC, NPTS=     7",
    "DT=.01 NPTS=7",
    "NPTS=7 DT=0.01",
    "  7    0.0100",
    "  0.0100    7",
    "0.0100   7   DT, NPTS",
    "NUMBER OF POINTS: 7  TIME STEP: 10 MS",
    "7 POINTS AT 100 SAMPLES/SEC",
]
ROWS = """  -.5561866E-05   .5521457E-05   .1234567E+00  -.5368685E-01   .0000000E+00
   .1000000E+00  -.2000000E+00
"""
GOOD = FIRST_THREE + HEADERS[0] + "\n" + ROWS
VALUES = [-0.5561866e-05, 0.5521457e-05, 0.1234567, -0.5368685e-01, 0.0, 0.1, -0.2]


@pytest.mark.parametrize("header", HEADERS)
@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_every_header_gives_every_value(record_file, header, line_end):
    path = record_file((FIRST_THREE + header + "\n" + ROWS).replace("\n", line_end))
    motion = read_record(path)
    assert motion.acceleration.tolist() == [value * G for value in VALUES]
    assert motion.dt == 0.01
    assert motion.source == "record.AT2 (PEER AT2)"
    assert motion.name == "record"


def test_values_without_a_blank_between_them(record_file):
    path = record_file(FIRST_THREE + "NPTS= 5, DT= .01 SEC\n.1234-.5678 +.5-.25E-1-1.D0\n")
    assert read_record(path, name="a").acceleration.tolist() == [
        x * G for x in (0.1234, -0.5678, 0.5, -0.025, -1.0)
    ]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("Imperial Valley-06, 10/15/1979, Calexico Fire Station, 225",
         ("Imperial Valley-06, 10/15/1979", "Calexico Fire Station", "225")),
        ("KOBE 01/16/95 2046, SHIN-OSAKA, 000 (CUE)", ("KOBE 01/16/95 2046", "SHIN-OSAKA", "000")),
        ("CHICHI AFTERSHOCK 09/20/99 2146, HWA031, V, (CWB)    ",
         ("CHICHI AFTERSHOCK 09/20/99 2146", "HWA031", "V")),
        ("NORTHRIDGE EQ 1/17/94, 12:31, CANYON COUNTRY - W LOST CANYON, 000 (USC STATION 90057)",
         ("NORTHRIDGE EQ 1/17/94, 12:31", "CANYON COUNTRY - W LOST CANYON", "000")),
        ("one phrase alone", ("one phrase alone", "", "")),
        ("", ("", "", "")),
    ],
)  # fmt: skip
def test_origin_as_agencies_write_it(record_file, line, expected):
    text = FIRST_THREE.replace("Somewhere-02, 10/15/1979, Old Mill, 225", line)
    motion = read_record(record_file(text + HEADERS[0] + "\n" + ROWS))
    assert (motion.event, motion.station, motion.component) == expected


def test_the_agency_s_filter_opens_the_history(record_file):
    text = FIRST_THREE.replace("UNITS OF G", "UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=23.0 Hz")
    assert read_record(record_file(text + HEADERS[0] + "\n" + ROWS)).history == (
        "filtered by the agency: HP=0.1 Hz LP=23.0 Hz",
    )


def test_content_decides_and_not_the_ending(record_file):
    path = record_file(GOOD, "anything.txt")
    assert len(read_record(path)) == 7


@pytest.mark.parametrize(
    ("content", "line", "problem"),
    [
        (GOOD.replace("\n   .1000000E+00  -.2000000E+00\n", ""), 5, "expected 7 values, .* ends after 5"),
        (GOOD + " .1", 7, "expected 7 values, as line 4 says, .* 8"),
        (FIRST_THREE + HEADERS[0] + "\n", 4, "expected 7 values, .* ends after 0"),
        (FIRST_THREE, 4, "the file ends before the line with NPTS and DT"),
        (GOOD.replace(".1000000E+00", "NaN"), 6, "expected a finite number, found 'NaN'"),
        (GOOD.replace(".1000000E+00", "1E999"), 6, "expected a finite number"),
        (GOOD.replace(".1000000E+00", "*****"), 6, r"found '\*\*\*\*\*'"),
        (GOOD.replace(".1000000E+00", "1_0"), 6, "found '1_0'"),
        (GOOD.replace(".1000000E+00", "1.5.25"), 6, "found '1.5.25'"),
        (GOOD.replace(".1000000E+00", "1.234-105"), 6, "found '1.234-105'"),
        (FIRST_THREE + "NPTS= 7 values\n" + ROWS, 4, "expected 'NPTS= n, DT= t SEC'"),
        (FIRST_THREE + "NPTS= 7, DT= 0.0 SEC\n" + ROWS, 4, "expected a positive DT in s, found 0.0"),
        (FIRST_THREE + "NPTS= 7, DT= -.01 SEC\n" + ROWS, 4, "expected a positive DT in s, found -.01"),
        (FIRST_THREE + "NPTS= 7, DT= .01.0 SEC\n" + ROWS, 4, "expected 'NPTS= n, DT= t SEC'"),
        (FIRST_THREE + "NPTS= 1, DT= .01 SEC\n.1\n", 4, "expected NPTS of at least 2, found 1"),
        (FIRST_THREE + "NPTS= 9999999999999, DT= .01 SEC\n.1\n", 4, "expected 'NPTS= n, DT= t SEC'"),
        (GOOD.replace("ACCELERATION", "VELOCITY").replace("OF G", "OF CM/S"), 3,
         "expected ACCELERATION TIME HISTORY IN UNITS OF G, found 'VELOCITY"),
        (GOOD.replace("OF G", "OF CM/S"), 3, "IN UNITS OF G"),
        (GOOD.replace("OF G", "OF FURLONGS"), 3, "IN UNITS OF G"),
    ],
)  # fmt: skip
def test_refuses_damage_with_its_line(record_file, content, line, problem):
    with pytest.raises(RecordError, match=rf"^record\.AT2, line {line}: .*{problem}"):
        read_record(record_file(content))


@pytest.mark.parametrize(
    ("spelling", "unit"),
    [("CM/S/S", 0.01), ("CM/SEC**2", 0.01), ("M/S2.", 1.0), ("mm/s/s", 0.001), ("GAL", 0.01), ("G'S", G)],
)
def test_other_units_of_acceleration(record_file, spelling, unit):
    motion = read_record(record_file(GOOD.replace("OF G", f"OF {spelling}")))
    np.testing.assert_allclose(motion.acceleration, np.array(VALUES) * unit, rtol=3e-16)


def test_another_format_under_this_ending_is_asked_for_what_it_does_not_say(record_file):
    other = "Station Melipilla\nNPTS=  4 DT= 0.0050\n0.1\n0.2\n0.3\n0.4\n"
    with pytest.raises(RecordError, match=r"record\.AT2: the file does not say the unit .*: give units"):
        read_record(record_file(other))
    assert read_record(record_file(other), units="g").dt == 0.005
    with pytest.raises(RecordError, match=r"expected 5 rows, as line 2 says"):
        read_record(record_file(other.replace("NPTS=  4", "NPTS=  5")), units="g")


def test_arguments_must_not_contradict_the_file(record_file):
    path = record_file(GOOD)
    assert read_record(path, units="g", dt=0.01, channel="225").dt == 0.01
    with pytest.raises(RecordError, match="units are given as m/s2, but the file is in g"):
        read_record(path, units="m/s2")
    with pytest.raises(RecordError, match=r"dt is given as 0.02 s, but the file says 0.01 s"):
        read_record(path, dt=0.02)
    with pytest.raises(RecordError, match="there is no channel 'EW': it has '225'"):
        read_record(path, channel="EW")


REAL = [
    ("real/CHY035-N.AT2", 18000, 0.005, 0.2462),
    ("real/KOBE_SHI000.AT2", 4096, 0.01, 0.2432),
    ("real/IMPVALL_H-E11140.AT2", 7807, 0.005, 0.3640),
    ("real/NORTHR_LOS000.AT2", 1999, 0.01, 0.4100),
    ("real/RSN161_IMPVALL.H_H-BRA315.AT2", 7575, 0.005, 0.2195),
    ("real/RSN162_IMPVALL.H_H-CXO225.AT2", 7569, 0.005, 0.2770),
    ("real/RSN765_LOMAP_G01090.AT2", 7998, 0.005, 0.4846),
    ("real/RSN753_LOMAP_CLS000.AT2", 7995, 0.005, 0.6447),
    ("real/RSN763_LOMAP_GIL067.AT2", 7999, 0.005, 0.3585),
    ("real/KOCAELI_ARC000.AT2", 6000, 0.005, 0.2188),
    ("real/KOCAELI_IZT090.AT2", 6000, 0.005, 0.2302),
    ("formats/peer_nga1_hdr_nptsdt__HWA031-V.AT2", 8200, 0.005, None),
    ("formats/peer_nga_east_hdr__RSN10590.AT2", 15306, 0.05, None),
    ("formats/peer_nga_tabhdr__MANJIL_T.AT2", 2300, 0.02, None),
    ("formats/peer_nga_west2__RSN763_LOMAP_GIL067.AT2", 7999, 0.005, 0.3585),
    ("formats/peer_old__CHY035-N.AT2", 18000, 0.005, 0.2462),
    ("formats/peer_old__KOBE_SHI000.AT2", 4096, 0.01, 0.2432),
]


def test_every_real_file_is_read_below(shared_records):
    found = {f"{path.parent.name}/{path.name}" for path in shared_records.glob("*/*.AT2")} - {
        f"cases/{path.name}"
        for path in shared_records.glob("cases/*.AT2")  # in test_cases.py
    }
    assert found == {name for name, *_ in REAL}


@pytest.mark.parametrize(("name", "count", "dt", "pga_g"), REAL)
def test_real_files_to_the_last_digit(shared_records, name, count, dt, pga_g):
    path = shared_records / name
    plain = [float(word) for line in path.read_text().splitlines()[4:] for word in line.split()]
    motion = read_record(path)
    assert motion.acceleration.tolist() == (np.array(plain) * G).tolist()
    assert (len(motion), motion.dt) == (count, dt)
    assert re.search(rf"\b{count}\b", path.read_text().splitlines()[3])
    if pga_g is not None:
        assert round(motion.pga / G, 4) == pytest.approx(pga_g, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("truncated__HECTOR_43.AT2", "line 329: expected 4531 values, as line 4 says, .* after 1621"),
        ("truncated__HECTOR_44.AT2", "line 59: expected 4531 values, as line 4 says, .* after 275"),
        ("at2_ext_but_not_peer__GM11.AT2", "does not say the unit of acceleration: give units"),
    ],
)
def test_real_bad_files_are_refused(shared_records, name, problem):
    with pytest.raises(RecordError, match=problem):
        read_record(shared_records / "formats" / "bad" / name)
